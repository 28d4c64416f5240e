"""Every declared analysis run, in both modes; what has no value is said in a sentence."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import pandas as pd

from analysis.factorials import Factorial
from analysis.plan import AnalysisPlan, Mode
from analysis.reasons import reader_words
from analysis.rows import Row
from analysis.sample import Sample
from analysis.statistics.anova import OneWayAnova, RepeatedMeasuresAnova
from analysis.statistics.contrasts import PairedContrasts
from analysis.statistics.friedman import Friedman
from analysis.statistics.intervals import MeanIntervals
from analysis.statistics.tukey import TukeyHSD
from analysis.statistics.undefined import Undefined
from analysis.statistics.wilcoxon import SignedRanks

METHODS: dict[Mode, str] = {"repeated": "repeated measures", "independent": "independent samples"}


@dataclass(frozen=True)
class Analysed:
    """One row in one mode. `anova` is None where it has no value, and `trouble` then says why.

    `p_holm`, `p_fdr`: its p adjusted over the declared family; None where it has no p and in the mode that is not the
    design's. `simple`: the simple effects of an interaction, which has no Tukey, no ranks and no contrasts.
    """

    row: Row
    mode: Mode
    n: tuple[int, ...]
    means: pd.DataFrame | None
    anova: dict[str, Any] | None
    answers: pd.DataFrame
    tukey: pd.DataFrame | None = None
    friedman: dict[str, Any] | None = None
    wilcoxon: dict[str, Any] | None = None
    contrasts: pd.DataFrame | None = None
    simple: pd.DataFrame | None = None
    trouble: tuple[str, ...] = ()
    p_holm: float | None = None
    p_fdr: float | None = None

    @property
    def p(self) -> float | None:
        """The p value of the test: Greenhouse-Geisser corrected within people, plain between them; not adjusted."""
        return None if self.anova is None else float(self.anova["p_gg" if self.mode == "repeated" else "p"])

    def deciding_p(self, plan: AnalysisPlan) -> float | None:
        """The p value that `[analysis] adjust` calls for."""
        return {"none": self.p, "holm": self.p_holm, "fdr": self.p_fdr}[plan.adjust]

    @property
    def df(self) -> tuple[float, float]:
        """Degrees of freedom that belong to `p`."""
        assert self.anova is not None
        shrink = float(self.anova["epsilon_gg"]) if self.mode == "repeated" else 1.0
        return float(self.anova["df1"]) * shrink, float(self.anova["df2"]) * shrink

    @property
    def rank_p(self) -> float | None:
        """The p value of the test of ranks, where one was made."""
        test = self.friedman or self.wilcoxon
        return None if test is None else float(test["p"])

    @property
    def mse(self) -> float:
        """Mean square of error."""
        assert self.anova is not None
        return float(self.anova["ms_error" if self.mode == "repeated" else "ms_within"])

    @property
    def effect(self) -> tuple[str, float, float, float]:
        """Name, value and 90% interval of the effect size."""
        assert self.anova is not None
        name = "generalized_eta_squared" if self.mode == "repeated" else "eta_squared"
        return name, float(self.anova[name]), float(self.anova["ci_low"]), float(self.anova["ci_high"])

    @property
    def hsd(self) -> tuple[float, float] | None:
        """Unrounded HSD at .05 and .01; None where sample sizes differ and every pair has its own."""
        if self.tukey is None or len(set(self.n)) > 1:
            return None
        first = self.tukey.iloc[0]
        return float(first["critical_05"]), float(first["critical_01"])


Statistic = Callable[[pd.DataFrame], pd.DataFrame]


class Attempts:
    """Statistics tried one after the other; the sentences on those without a value are kept."""

    def __init__(self, where: str, labels: Mapping[str, str]) -> None:
        self.where = where
        self.labels = labels
        self.trouble: list[str] = []

    def __call__(self, statistic: Statistic, frame: pd.DataFrame) -> pd.DataFrame | None:
        """The table, or None and one more sentence."""
        try:
            return statistic(frame)
        except Undefined as reason:
            self.trouble.append(f"{self.where}: {reader_words(reason, self.labels)}")
            return None


def analyse(row: Row, sample: Sample, plan: AnalysisPlan, mode: Mode, factorials: Mapping[str, Factorial]) -> Analysed:
    """All statistics of `row` in `mode`. An interaction has them within people alone.

    `factorials`: question -> its full factorial; a row that is part of one has the error terms of the whole, and its
    people: who rated every combination. Where the whole has no value the row has none.
    """
    attempt = Attempts(f"{row.title} ({METHODS[mode]})", row.labels)
    cells = row.cells(sample.ratings)
    cells["condition"] = pd.Categorical(cells["condition"], [level.code for level in row.levels])
    whole = factorials[row.question] if row.crossed is not None and mode == "repeated" else None
    effect = whole.effect(row.name) if whole is not None else None
    if isinstance(effect, str):
        # a one-way analysis of each person's averages would take one factor's effect for another's: they rated unlike
        # sets of combinations
        means = MeanIntervals("rating", "condition", None, plan.confidence)(cells)
        return Analysed(
            row, mode, sizes(cells, None), means, None, cells, trouble=(f"{attempt.where}: {reader_words(effect)}",)
        )
    if whole is not None:
        cells = cells[cells["participant"].isin(whole.people)]
    if row.kind == "interaction":
        assert whole is not None and effect is not None
        return analyse_interaction(row, plan, mode, cells, whole, effect)
    subject = "participant" if mode == "repeated" else None
    one_way: Statistic = OneWayAnova("rating", "condition")
    if subject is not None:
        one_way = RepeatedMeasuresAnova("rating", "condition", subject)
    anova = attempt(one_way, cells)
    found: dict[str, Any] = {}
    if anova is not None:
        if subject is not None:
            if "ranks" in plan.tests:
                ranks = Friedman if anova["k"].iloc[0] > 2 else SignedRanks
                name = "friedman" if ranks is Friedman else "wilcoxon"
                found[name] = first_row(attempt(ranks("rating", "condition", subject), cells))
            contrasts = PairedContrasts("rating", "condition", subject, plan.confidence, plan.contrasts)
            found["contrasts"] = attempt(contrasts, cells)
        found["tukey"] = attempt(TukeyHSD("rating", "condition", subject, plan.confidence), cells)
    found["means"] = MeanIntervals("rating", "condition", subject if anova is not None else None, plan.confidence)(
        cells
    )
    found["n"] = sizes(cells, anova)
    found["anova"] = first_row(anova)
    if found["anova"] is not None and effect is not None:
        # the mean square that goes with n means of persons, as the HSD does; the factorial's is that of single pictures
        found["anova"] = {**effect, "ms_error": found["anova"]["ms_error"]}
    return Analysed(row, mode, answers=cells, trouble=tuple(attempt.trouble), **found)


def analyse_interaction(
    row: Row, plan: AnalysisPlan, mode: Mode, cells: pd.DataFrame, whole: Factorial, effect: dict[str, Any]
) -> Analysed:
    """Cell means, the interaction of the factorial, and its simple effects."""
    means = MeanIntervals("rating", "condition", "participant", plan.confidence)(cells)
    n = (int(effect["n"]),) * len(row.levels)
    return Analysed(row, mode, n, means, effect, cells, simple=whole.simple(row.factors))


def sizes(cells: pd.DataFrame, anova: pd.DataFrame | None) -> tuple[int, ...]:
    """n of each sample: complete cases within people, ratings between them."""
    if anova is not None and "dropped" in anova:
        return (int(anova["n"].iloc[0]),) * int(anova["k"].iloc[0])
    return tuple(int(n) for n in cells["condition"].value_counts(sort=False) if n)


def first_row(table: pd.DataFrame | None) -> dict[str, Any] | None:
    """The only row of a statistic's table."""
    return None if table is None else {str(key): value for key, value in table.iloc[0].items()}
