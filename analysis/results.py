"""Every declared analysis run, in both modes; what has no value is said in a sentence."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import pandas as pd

from analysis.plan import AnalysisPlan, Mode
from analysis.rows import Row
from analysis.sample import Sample
from analysis.statistics.anova import OneWayAnova, RepeatedMeasuresAnova
from analysis.statistics.contrasts import PairedContrasts
from analysis.statistics.friedman import Friedman
from analysis.statistics.intervals import MeanIntervals
from analysis.statistics.tukey import TukeyHSD
from analysis.statistics.undefined import Undefined
from analysis.statistics.wilcoxon import SignedRanks
from analysis.wording import thesis_verdict

METHODS: dict[Mode, str] = {"repeated": "repeated measures", "independent": "independent samples"}


@dataclass(frozen=True)
class Analysed:
    """One row in one mode. `anova` is None where it has no value, and `trouble` then says why."""

    row: Row
    mode: Mode
    n: tuple[int, ...]
    means: pd.DataFrame | None
    anova: dict[str, Any] | None
    tukey: pd.DataFrame | None
    friedman: dict[str, Any] | None
    wilcoxon: dict[str, Any] | None
    contrasts: pd.DataFrame | None
    answers: pd.DataFrame
    trouble: tuple[str, ...]

    @property
    def p(self) -> float | None:
        """The p value that decides: Greenhouse-Geisser corrected within people, plain between them."""
        return None if self.anova is None else float(self.anova["p_gg" if self.mode == "repeated" else "p"])

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


def analyse(row: Row, sample: Sample, plan: AnalysisPlan, mode: Mode) -> Analysed:
    """All statistics of `row` in `mode`."""
    cells = row.cells(sample.ratings)
    cells["condition"] = pd.Categorical(cells["condition"], [level.code for level in row.levels])
    subject = "participant" if mode == "repeated" else None
    trouble: list[str] = []

    def attempt(statistic: Callable[[pd.DataFrame], pd.DataFrame]) -> pd.DataFrame | None:
        try:
            return statistic(cells)
        except Undefined as reason:
            trouble.append(f"{row.title} ({METHODS[mode]}): {reason}")
            return None

    friedman = wilcoxon = contrasts = None
    if subject is None:
        anova = attempt(OneWayAnova("rating", "condition"))
    else:
        anova = attempt(RepeatedMeasuresAnova("rating", "condition", subject))
    if subject is not None and anova is not None:
        if anova["k"].iloc[0] > 2:
            friedman = attempt(Friedman("rating", "condition", subject))
        else:
            wilcoxon = attempt(SignedRanks("rating", "condition", subject))
        contrasts = attempt(PairedContrasts("rating", "condition", subject, plan.confidence))
    tukey = attempt(TukeyHSD("rating", "condition", subject, plan.confidence)) if anova is not None else None
    means = MeanIntervals("rating", "condition", subject if anova is not None else None, plan.confidence)(cells)
    return Analysed(
        row,
        mode,
        sizes(cells, anova),
        means,
        first_row(anova),
        tukey,
        first_row(friedman),
        first_row(wilcoxon),
        contrasts,
        cells,
        tuple(trouble),
    )


def sizes(cells: pd.DataFrame, anova: pd.DataFrame | None) -> tuple[int, ...]:
    """n of each sample: complete cases within people, ratings between them."""
    if anova is not None and "dropped" in anova:
        return (int(anova["n"].iloc[0]),) * int(anova["k"].iloc[0])
    return tuple(int(n) for n in cells["condition"].value_counts(sort=False) if n)


def first_row(table: pd.DataFrame | None) -> dict[str, Any] | None:
    """The only row of a statistic's table."""
    return None if table is None else {str(key): value for key, value in table.iloc[0].items()}


def anova_table(found: Iterable[Analysed]) -> pd.DataFrame:
    """A row per analysis: the `anova` part of results.json."""
    return pd.DataFrame([anova_entry(each) for each in found])


def anova_entry(each: Analysed) -> dict[str, Any]:
    """Question, factor, method and, where they have a value, the statistics."""
    entry: dict[str, Any] = {"question": each.row.question, "factor": each.row.name, "method": METHODS[each.mode]}
    if each.anova is None:
        nothing = ("F", "df1", "df2", "p", "effect_size", "ci")
        return {**entry, **dict.fromkeys(nothing), "reason": each.trouble[0]}
    name, size, low, high = each.effect
    entry |= {"F": each.anova["F"], "df1": int(each.anova["df1"]), "df2": int(each.anova["df2"]), "p": each.anova["p"]}
    entry |= {"effect_size": size, "ci": [low, high], "effect_size_name": name, "mse": each.mse, "n": list(each.n)}
    if each.mode == "repeated":
        keys = ("epsilon_gg", "p_gg", "epsilon_hf", "p_hf", "mauchly_w", "mauchly_p", "partial_eta_squared", "dropped")
        entry |= {key: each.anova[key] for key in keys}
    return entry


def tukey_table(found: Iterable[Analysed]) -> pd.DataFrame:
    """A row per pair of samples: the `tukey` part of results.json."""
    return pd.DataFrame([entry for each in found if each.tukey is not None for entry in pair_entries(each, each.tukey)])


def pair_entries(each: Analysed, table: pd.DataFrame) -> list[dict[str, Any]]:
    """The pairs of one analysis, by picture (or level) and by sample."""
    key = {level.code: level.stimuli[0] if len(level.stimuli) == 1 else level.label for level in each.row.levels}
    head = {"question": each.row.question, "factor": each.row.name, "method": METHODS[each.mode]}
    return [
        {
            **head,
            "a": key[pair["a"]],
            "b": key[pair["b"]],
            "samples": f"{pair['a']} vs {pair['b']}",
            **{name: pair[name] for name in ("difference", "q", "p", "ci_low", "ci_high")},
            "verdict": thesis_verdict(pair["difference"], pair["critical_05"], pair["critical_01"]),
        }
        for pair in table.to_dict("records")
    ]


def hsd_table(found: Iterable[Analysed]) -> pd.DataFrame:
    """The unrounded HSD of each analysis: the `hsd` part of results.json."""
    return pd.DataFrame(
        [
            {
                "question": each.row.question,
                "factor": each.row.name,
                "method": METHODS[each.mode],
                "hsd_05": hsd[0],
                "hsd_01": hsd[1],
            }
            for each in found
            if (hsd := each.hsd) is not None
        ]
    )


def means_table(found: Iterable[Analysed]) -> pd.DataFrame:
    """Mean, interval, SD and n of every sample."""
    parts = []
    for each in found:
        if each.means is None:
            continue
        labels = {level.code: level.label for level in each.row.levels}
        part = each.means.rename(columns={"level": "sample"})
        part.insert(0, "label", part["sample"].map(labels))
        for name, value in (("method", METHODS[each.mode]), ("factor", each.row.name), ("question", each.row.question)):
            part.insert(0, name, value)
        parts.append(part)
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()
