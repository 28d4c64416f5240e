"""Paired contrasts between all levels of one factor, adjusted for their number."""

from dataclasses import dataclass
from itertools import combinations

import numpy as np
import pandas as pd
from scipy import stats
from statsmodels.stats.multitest import multipletests

from analysis.statistics.undefined import complete_table


@dataclass(frozen=True)
class PairedContrasts:
    """Paired t tests between all pairs of levels with Holm's adjustment.

    Returns a row per pair: `a, b, difference` (mean of a less mean of b), `ci_low, ci_high` (unadjusted), `t, df, p,
    p_holm, d_z` (mean difference over the standard deviation of differences), `n`. A pair whose differences are all
    equal has NaN for `t, p, p_holm, d_z` and is not counted in the adjustment. Agrees with R `pairwise.t.test(paired =
    TRUE, p.adjust.method = "holm")`.
    """

    value: str
    within: str
    subject: str
    confidence: float = 0.95

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per participant and level."""
        wide, _ = complete_table(frame, self.value, self.within, self.subject)
        table = pd.DataFrame([self.pair(a, b, wide[a] - wide[b]) for a, b in combinations(wide.columns, 2)])
        tested = table["p"].notna()
        table["p_holm"] = np.nan
        if tested.any():
            table.loc[tested, "p_holm"] = multipletests(table.loc[tested, "p"], method="holm")[1]
        return table[["a", "b", "difference", "ci_low", "ci_high", "t", "df", "p", "p_holm", "d_z", "n"]]

    def pair(self, a: object, b: object, difference: "pd.Series[float]") -> dict[str, object]:
        """One pair, not yet adjusted."""
        n = len(difference)
        mean, row = float(difference.mean()), {"a": a, "b": b, "df": n - 1, "n": n}
        if np.ptp(difference.to_numpy()) == 0:
            nothing = dict.fromkeys(("t", "p", "d_z"), np.nan)
            return {**row, **nothing, "difference": mean, "ci_low": mean, "ci_high": mean}
        found = stats.ttest_1samp(difference, 0.0)
        interval = found.confidence_interval(self.confidence)
        row |= {"difference": mean, "ci_low": float(interval.low), "ci_high": float(interval.high)}
        return {**row, "t": float(found.statistic), "p": float(found.pvalue), "d_z": mean / float(difference.std())}
