"""Wilcoxon's signed-rank test: two samples of the same people without treating the scale as an interval."""

from dataclasses import dataclass

import pandas as pd
from scipy import stats

from analysis.statistics.undefined import Undefined, complete_table, not_zero


@dataclass(frozen=True)
class SignedRanks:
    """Wilcoxon's signed-rank test, two-sided, of people who rated both of two levels; equal pairs are left out.

    Returns one row: `t` (the smaller sum of ranks), `p` (exact to 13 people and without ties to 50, else from the
    normal distribution without continuity correction), `r` (matched-pairs rank-biserial correlation, -1..1, above 0
    where the first level is rated higher; Kerby 2014, Comprehensive Psychology 3), `n`, `n_unequal`, `dropped`. Raises
    `Undefined` unless there are two levels, and where everyone rated both the same.
    """

    value: str
    within: str
    subject: str

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The row for a long `frame`, one row per participant and level."""
        wide, dropped = complete_table(frame, self.value, self.within, self.subject)
        where = f"{self.value} by {self.within}"
        if wide.shape[1] != 2:
            raise Undefined(f"{where}: Wilcoxon's test needs two levels and there are {wide.shape[1]}; use Friedman's")
        # means over pictures that are equal may differ in the last bits, and ranks would take that for a difference
        difference = (wide.iloc[:, 0] - wide.iloc[:, 1]).round(9)
        unequal = difference[difference != 0]
        if unequal.empty:
            raise Undefined(f"{where}: everyone rated both levels the same, so there are no ranks to compare")
        found = stats.wilcoxon(unequal.to_numpy())
        ranks = unequal.abs().rank()
        r = float((ranks * ((unequal > 0) * 2 - 1)).sum() / ranks.sum())
        row = {
            "t": float(found.statistic),
            "p": not_zero(float(found.pvalue)),
            "r": r,
            "n": len(wide),
            "n_unequal": len(unequal),
        }
        return pd.DataFrame([{**row, "dropped": "; ".join(dropped)}])
