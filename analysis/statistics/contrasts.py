"""Paired contrasts between levels of one factor, adjusted for their number."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy import stats

from analysis.statistics.effect_size import d_z_interval
from analysis.statistics.multiplicity import adjusted
from analysis.statistics.undefined import Floats, complete_table, not_zero, spreadless

AT_ONCE = 512
D_Z = ("d_z", "d_z_low", "d_z_high")
Indices = npt.NDArray[np.intp]


@dataclass(frozen=True)
class PairedContrasts:
    """Paired t tests between pairs of levels with Holm's adjustment.

    `pairs`: "all" of them, each level with the first ("reference"; the other is subtracted from the first), or
    "neighbours", a chain in the order of the levels; only pairs that are tested are counted in the adjustment.
    Returns a row per pair: `a, b, difference` (mean of a less mean of b), `ci_low, ci_high` (unadjusted), `t, df, p,
    p_holm, d_z` (mean difference over the standard deviation of differences), `d_z_low, d_z_high` (its interval), `n`.
    A pair whose differences are all equal (but for rounding) has NaN for `t, p, p_holm, d_z` and its limits, and is not
    counted in the adjustment. Agrees with R `pairwise.t.test(paired = TRUE, p.adjust.method = "holm")`, and with
    pingouin.pairwise_tests(padjust="holm"), which it is not: that has no intervals, its d is d_av, and it takes a
    millisecond for each pair, of which 500 pictures have a hundred thousand."""

    value: str
    within: str
    subject: str
    confidence: float = 0.95
    pairs: Literal["all", "reference", "neighbours"] = "all"

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per participant and level."""
        wide, _ = complete_table(frame, self.value, self.within, self.subject)
        first, second = self.chosen(wide.shape[1])
        names = wide.columns.to_numpy(dtype=object)
        table = pd.DataFrame({"a": names[first], "b": names[second], **self.tests(wide.to_numpy(), first, second)})
        table["p_holm"] = adjusted(table["p"], "holm")
        return table[["a", "b", "difference", "ci_low", "ci_high", "t", "df", "p", "p_holm", *D_Z, "n"]]

    def chosen(self, k: int) -> tuple[Indices, Indices]:
        """Places of the first and second level of each pair that is tested."""
        if self.pairs == "all":
            return np.triu_indices(k, 1)
        second = np.arange(1, k)
        return (second - 1 if self.pairs == "neighbours" else np.zeros_like(second)), second

    def tests(self, wide: Floats, first: Indices, second: Indices) -> dict[str, Floats]:
        """Columns of the t tests of the pairs of columns (`first`, `second`) of a subjects x levels table."""
        # a column for each pair, few at once: the differences of all would be many times as large as the ratings
        pieces = -(-len(first) // AT_ONCE)
        parts = [
            self.tests_of(wide[:, a] - wide[:, b], spreadless(wide[:, a] - wide[:, b], wide))
            for a, b in zip(np.array_split(first, pieces), np.array_split(second, pieces), strict=True)
        ]
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def tests_of(self, differences: Floats, equal: npt.NDArray[np.bool_]) -> dict[str, Floats]:
        """One-sample t tests of each column against 0, not yet adjusted. `equal`: columns without spread."""
        mean, n = differences.mean(axis=0), len(differences)
        # a column without spread has no test; any spread keeps the library from warning of it
        varied = np.where(equal, np.arange(n)[:, None], differences) if equal.any() else differences
        found = stats.ttest_1samp(varied, 0.0, axis=0)
        interval = found.confidence_interval(self.confidence)
        d_z = mean / varied.std(axis=0, ddof=1)
        undefined = {"t": found.statistic, "p": not_zero(found.pvalue)}
        undefined |= dict(zip(D_Z, (d_z, *d_z_interval(d_z, n, self.confidence)), strict=True))
        limits = {"ci_low": interval.low, "ci_high": interval.high}
        return (
            {"difference": mean, "df": np.full(len(mean), n - 1), "n": np.full(len(mean), n)}
            | {name: np.where(equal, np.nan, column) for name, column in undefined.items()}
            | {name: np.where(equal, mean, column) for name, column in limits.items()}
        )
