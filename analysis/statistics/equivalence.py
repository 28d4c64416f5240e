"""Are two pictures rated alike? Two one-sided tests against a margin declared before the data."""

from dataclasses import dataclass
from itertools import combinations

import numpy as np
import pandas as pd
from scipy import stats
from statsmodels.stats.weightstats import ttost_ind, ttost_paired

from analysis.labels import levels_of
from analysis.statistics.multiplicity import adjusted
from analysis.statistics.undefined import (
    Floats,
    Undefined,
    complete_table,
    from_first,
    not_zero,
    require_columns,
    spreadless,
)
from fakesss.problem import BadInput

VERDICTS = {(True, False): "different", (False, True): "equivalent", (True, True): "both", (False, False): "undecided"}
UNTESTED = "untested"
TESTED = (
    "ci_low", "ci_high", "df", "t_low", "p_low", "t_high", "p_high", "p_equivalence", "t_difference", "p_difference",
)  # fmt: skip
COLUMNS = ("a", "b", "difference", *TESTED, "p_equivalence_holm", "verdict", "n_a", "n_b", "reason")


@dataclass(frozen=True)
class Equivalence:
    """Equivalence tests (TOST) between all pairs of levels: paired with `subject`, Welch's without.

    `margin`: the smallest difference that would matter, in points of the scale, > 0; there is no default. `alpha`: the
    level of each one-sided test, 0 to 0.5. Returns a row per pair: `a, b, difference` (mean of a less mean of b),
    `ci_low, ci_high` (at 1 - 2 alpha), `df`, `t_low, p_low` (against: the difference is -margin or less), `t_high,
    p_high` (against: it is +margin or more), `p_equivalence` (the larger of the two), `p_equivalence_holm` (adjusted
    for the number of pairs tested), `t_difference, p_difference` (two-sided t test against 0), `verdict` by the
    unadjusted p values ("different", "equivalent", "both": a difference smaller than matters, "undecided"), `n_a, n_b`
    (ratings; people with all levels where paired) and `reason`: empty, or why the pair is "untested".

    Schuirmann (1987), J. Pharmacokinet. Biopharm. 15. Agrees with R `TOSTER::t_TOST(paired = TRUE or FALSE, eqb =
    margin)` and `equivalence::tost`. Raises `Undefined` where no pair can be tested, `BadInput` for a margin or an
    alpha out of range.
    """

    value: str
    within: str
    subject: str | None
    margin: float
    alpha: float = 0.05

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per rating."""
        if not (self.margin > 0 and np.isfinite(self.margin)):
            raise BadInput(
                f"margin: {self.margin}: must be above 0, the smallest difference that matters in scale points"
            )
        if not 0 < self.alpha < 0.5:
            raise BadInput(f"alpha: {self.alpha}: must lie between 0 and 0.5; 0.05 is usual")
        samples = self.samples(frame)
        everything = np.concatenate(list(samples.values()))
        rows = [self.pair(a, b, samples[a], samples[b], everything) for a, b in combinations(samples, 2)]
        table = pd.DataFrame(rows)
        tested = table["reason"] == ""
        if not tested.any():
            raise Undefined(f"{self.value} by {self.within}: {table['reason'].iloc[0]}")
        table["p_equivalence_holm"] = adjusted(table["p_equivalence"], "holm")
        return table[list(COLUMNS)]

    def samples(self, frame: pd.DataFrame) -> dict[object, Floats]:
        """Level -> its values less the first of all; with `subject`, of the same people in the same order."""
        if self.subject is not None:
            wide, _ = complete_table(frame, self.value, self.within, self.subject)
            return {level: np.asarray(wide[level], dtype=np.float64) for level in wide.columns}
        require_columns(frame, self.value, self.within)
        present = frame.dropna(subset=[self.value, self.within])
        levels = levels_of(present[self.within])
        if len(levels) < 2:
            raise Undefined(
                f"{self.value} by {self.within}: {len(levels)} level with ratings; a comparison needs at least two"
            )
        centred = from_first(present[self.value].to_numpy(np.float64))
        return {level: centred[(present[self.within] == level).to_numpy()] for level in levels}

    def pair(self, a: object, b: object, of_a: Floats, of_b: Floats, everything: Floats) -> dict[str, object]:
        """The row of one pair, not yet adjusted."""
        head = {"a": a, "b": b, "difference": float(of_a.mean() - of_b.mean()), "n_a": len(of_a), "n_b": len(of_b)}
        reason = self.hindrance(a, b, of_a, of_b, everything)
        if reason:
            return {**head, **dict.fromkeys(TESTED, np.nan), "verdict": UNTESTED, "reason": reason}
        if self.subject is not None:
            _, low, high = ttost_paired(of_a, of_b, -self.margin, self.margin)
            plain = stats.ttest_1samp(of_a - of_b, 0.0)
        else:
            _, low, high = ttost_ind(of_a, of_b, -self.margin, self.margin, usevar="unequal")
            plain = stats.ttest_ind(of_a, of_b, equal_var=False)
        interval = plain.confidence_interval(1 - 2 * self.alpha)
        p_low, p_high, p_plain = (not_zero(p) for p in (low[1], high[1], plain.pvalue))
        different, alike = p_plain < self.alpha, max(p_low, p_high) < self.alpha
        row = {"ci_low": float(interval.low), "ci_high": float(interval.high), "df": float(plain.df)}
        row |= {"t_low": float(low[0]), "p_low": p_low, "t_high": float(high[0]), "p_high": p_high}
        row |= {"p_equivalence": max(p_low, p_high), "t_difference": float(plain.statistic), "p_difference": p_plain}
        return {**head, **row, "verdict": VERDICTS[different, alike], "reason": ""}

    def hindrance(self, a: object, b: object, of_a: Floats, of_b: Floats, everything: Floats) -> str:
        """Why this pair cannot be tested; empty where it can."""
        if self.subject is not None:
            if not spreadless(of_a - of_b, everything):
                return ""
            apart = f"{float((of_a - of_b).mean()):g}"
            return f'every {self.subject} rates "{a}" and "{b}" exactly {apart} apart; without spread there is no test'
        alone = next((level for level, values in ((a, of_a), (b, of_b)) if len(values) < 2), None)
        if alone is not None:
            return f'"{alone}" has one rating; a test of "{a}" and "{b}" needs at least two of each'
        if not (spreadless(of_a, everything) and spreadless(of_b, everything)):
            return ""
        return f'all ratings of "{a}" are equal and so are those of "{b}"; without spread there is no test'
