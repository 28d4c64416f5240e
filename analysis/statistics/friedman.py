"""Friedman's rank test: repeated measures without treating the scale as an interval."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats

from analysis.statistics.undefined import Undefined, complete_table, not_zero


@dataclass(frozen=True)
class Friedman:
    """Friedman's chi-squared (corrected for ties) and Kendall's coefficient of concordance.

    Returns one row: `chi2, df, p, kendalls_w` (0..1), `n, k, dropped`. Agrees with R `friedman.test`. Raises
    `Undefined` for fewer than three levels, and where everyone gave all levels the same rating.
    """

    value: str
    within: str
    subject: str

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The row for a long `frame`, one row per participant and level."""
        wide, dropped = complete_table(frame, self.value, self.within, self.subject)
        n, k = wide.shape
        where = f"{self.value} by {self.within}"
        if k < 3:
            raise Undefined(f"{where}: Friedman's test needs three levels and there are {k}; use Wilcoxon's test")
        # means over pictures that are equal may differ in the last bits, and ranks would take that for a difference
        ranked = wide.round(9).to_numpy()
        if (np.ptp(ranked, axis=1) == 0).all():
            raise Undefined(f"{where}: everyone rated all levels the same, so there are no ranks to compare")
        found = stats.friedmanchisquare(*ranked.T)
        chi2 = float(found.statistic)
        row = {"chi2": chi2, "df": k - 1, "p": not_zero(float(found.pvalue)), "kendalls_w": chi2 / (n * (k - 1))}
        return pd.DataFrame([{**row, "n": n, "k": k, "dropped": "; ".join(dropped)}])
