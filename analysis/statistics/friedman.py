"""Friedman's rank test: repeated measures without treating the scale as an interval."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats

from analysis.statistics.undefined import Undefined, complete_table


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
        if (np.ptp(wide.to_numpy(), axis=1) == 0).all():
            raise Undefined(f"{where}: everyone rated all levels the same, so there are no ranks to compare")
        found = stats.friedmanchisquare(*(wide[level] for level in wide.columns))
        chi2 = float(found.statistic)
        row = {"chi2": chi2, "df": k - 1, "p": float(found.pvalue), "kendalls_w": chi2 / (n * (k - 1))}
        return pd.DataFrame([{**row, "n": n, "k": k, "dropped": "; ".join(dropped)}])
