"""Are two pictures rated alike? Two one-sided tests against a margin declared before the data."""

from dataclasses import dataclass
from itertools import combinations

import numpy as np
import pandas as pd
from scipy import stats
from statsmodels.stats.weightstats import ttost_paired

from analysis.statistics.undefined import Undefined, complete_table
from fakesss.problem import BadInput

VERDICTS = {(True, False): "different", (False, True): "equivalent", (True, True): "both", (False, False): "undecided"}


@dataclass(frozen=True)
class Equivalence:
    """Paired equivalence tests (TOST) between all pairs of levels.

    `margin`: the smallest difference that would matter, in points of the scale, > 0; there is no default. Returns a
    row per pair: `a, b, difference, ci_low, ci_high` (at 1 - 2 alpha), `p_low, p_high, p_equivalence` (the larger of
    the two), `p_difference` (paired t test), `verdict` ("different", "equivalent", "both": a difference smaller than
    matters, "undecided"), `n`. Agrees with R `TOSTER::t_TOST(paired = TRUE, eqb = margin)`. Schuirmann (1987). Raises
    `Undefined` where a pair's differences are all equal.
    """

    value: str
    within: str
    subject: str
    margin: float
    alpha: float = 0.05

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per participant and level."""
        if not (self.margin > 0 and np.isfinite(self.margin)):
            raise BadInput(
                f"margin: {self.margin}: must be above 0, the smallest difference that matters in scale points"
            )
        wide, _ = complete_table(frame, self.value, self.within, self.subject)
        return pd.DataFrame([self.pair(a, b, wide) for a, b in combinations(wide.columns, 2)])

    def pair(self, a: object, b: object, wide: pd.DataFrame) -> dict[str, object]:
        """The row of one pair."""
        difference = wide[a] - wide[b]
        if np.ptp(difference.to_numpy()) == 0:
            raise Undefined(
                f'{self.value} by {self.within}: every {self.subject} rates "{a}" and "{b}" exactly '
                f"{difference.iloc[0]:g} apart; without spread there is no test"
            )
        p, low, high = ttost_paired(wide[a].to_numpy(), wide[b].to_numpy(), -self.margin, self.margin)
        plain = stats.ttest_1samp(difference, 0.0)
        interval = plain.confidence_interval(1 - 2 * self.alpha)
        return {
            "a": a,
            "b": b,
            "difference": float(difference.mean()),
            "ci_low": float(interval.low),
            "ci_high": float(interval.high),
            "p_low": float(low[1]),
            "p_high": float(high[1]),
            "p_equivalence": float(p),
            "p_difference": float(plain.pvalue),
            "verdict": VERDICTS[bool(plain.pvalue < self.alpha), bool(p < self.alpha)],
            "n": len(difference),
        }
