"""A contrast planned before the data: a weighted sum of conditions, tested within people against 0."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import pandas as pd
import pingouin
from scipy import stats

from analysis.statistics.undefined import Undefined, from_first, not_zero, require_columns, spreadless
from fakesss.problem import BadInput, nearest


@dataclass(frozen=True)
class PlannedContrast:
    """One-sample t test of each person's weighted sum of the named conditions' ratings.

    `weights`: level -> weight, adding up to 0. The error is the spread of the sums themselves, so nothing is assumed of
    other conditions or of sphericity. Returns one row: `estimate` (mean weighted sum), `ci_low, ci_high` (at
    `confidence`), `t, df, p` (two-sided), `d_z` (estimate over the standard deviation of the sums), `d_av` (the mean of
    the conditions with weights above 0 less that of those below, each weighted, over the root of their mean variance:
    pingouin's paired d; NaN where neither side varies), `n, dropped`. Agrees with R `t.test(as.matrix(wide) %*%
    weights)`. Raises `Undefined` for a condition nobody rated, fewer than two people with all conditions, and sums
    that are all equal; `BadInput` for weights that do not add up to 0, and for a doubled cell.
    """

    value: str
    within: str
    subject: str
    weights: Mapping[Any, float]
    confidence: float = 0.95

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The row for a long `frame`, one row per participant and condition."""
        weights = pd.Series(dict(self.weights), dtype=float)
        if not weights.abs().max() > 0 or abs(weights.sum()) > 1e-9 * weights.abs().max():
            raise BadInput(f"weights: add up to {weights.sum():g}; they must add up to 0, not all 0")
        weights = weights[weights != 0]
        ratings, dropped = self.table(frame, list(weights.index))
        sums = ratings @ weights
        estimate = float(sums.mean())
        if spreadless(sums.to_numpy(), ratings.to_numpy() * weights.abs().max()):
            raise Undefined(
                f"{self.value} by {self.within}: every {self.subject}'s weighted sum is {estimate:g}; without spread "
                "there is no test"
            )
        found = stats.ttest_1samp(sums, 0.0)
        interval = found.confidence_interval(self.confidence)
        row = {"estimate": estimate, "ci_low": float(interval.low), "ci_high": float(interval.high)}
        row |= {"t": float(found.statistic), "df": len(sums) - 1, "p": not_zero(found.pvalue)}
        row |= {"d_z": estimate / float(sums.std()), "d_av": d_av(ratings, weights)}
        return pd.DataFrame([{**row, "n": len(sums), "dropped": "; ".join(dropped)}])

    def table(self, frame: pd.DataFrame, named: list[object]) -> tuple[pd.DataFrame, list[str]]:
        """Complete people x named conditions, and who lacks one of them."""
        require_columns(frame, self.value, self.within, self.subject)
        present = frame[frame[self.within].isin(named)].dropna(subset=[self.value, self.subject])
        where = f"{self.value} by {self.within}"
        rated = set(frame.loc[frame[self.value].notna(), self.within])
        unrated = next((level for level in named if level not in rated), None)
        if unrated is not None:
            raise Undefined(f'{where}: nobody rated "{unrated}"; {nearest(str(unrated), map(str, sorted(rated)))}')
        if present.duplicated([self.subject, self.within]).any():
            raise BadInput(f"frame: a {self.subject} has two values at one {self.within}; average them first")
        wide = present.astype({self.within: object}).pivot(index=self.subject, columns=self.within, values=self.value)
        wide = wide[named].astype(float)
        kept = wide.dropna()
        if len(kept) < 2:
            raise Undefined(f"{where}: {len(kept)} {self.subject}s rated all of its conditions; at least two must have")
        # weights add up to 0, so what is taken off all ratings leaves every sum as it is and keeps its digits
        shifted = pd.DataFrame(from_first(kept.to_numpy()), kept.index, kept.columns)
        return shifted, [str(who) for who in wide.index[wide.isna().any(axis=1)]]


def d_av(ratings: pd.DataFrame, weights: "pd.Series[float]") -> float:
    """The two sides of the contrast as weighted means, their difference over their average standard deviation."""
    above, below = (ratings @ side / side.sum() for side in (weights.clip(lower=0), (-weights).clip(lower=0)))
    if all(spreadless(side.to_numpy(), ratings.to_numpy()) for side in (above, below)):
        return float("nan")
    return float(pingouin.compute_effsize(above, below, paired=True, eftype="cohen"))
