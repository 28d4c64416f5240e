"""Which pictures are rated alike, by the margins that the plan declares."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import comb
from typing import Any

import numpy as np
import pandas as pd

from analysis.plan import EquivalencePlan
from analysis.reasons import reader_words
from analysis.results import METHODS, Analysed
from analysis.statistics.equivalence import UNTESTED, Equivalence
from analysis.statistics.undefined import Undefined
from analysis.tables import SHOWN_LEVELS


@dataclass(frozen=True)
class Judged:
    """One row and the equivalence tests of all its pairs (`Equivalence`'s table, levels by code)."""

    each: Analysed
    margin: float
    alpha: float
    pairs: pd.DataFrame

    @property
    def labels(self) -> dict[str, str]:
        """Code -> what the sample is called."""
        return self.each.row.labels

    @property
    def records(self) -> list[dict[str, Any]]:
        """The pairs, each as a dictionary."""
        return [{str(key): value for key, value in pair.items()} for pair in self.pairs.to_dict("records")]

    def named(self, pair: dict[str, Any]) -> str:
        """The two samples, of which the second is subtracted."""
        return f"{self.labels[pair['a']]} minus {self.labels[pair['b']]}"

    @property
    def spreads(self) -> list[float]:
        """The standard deviation of people's differences, of each undecided pair; empty between different people."""
        if self.each.mode != "repeated":
            return []
        undecided = self.pairs[self.pairs["verdict"] == "undecided"]
        errors = 2 * self.margin / (undecided["t_low"] - undecided["t_high"])  # t_low, t_high: (mean ± margin) / error
        return [float(spread) for spread in errors * np.sqrt(undecided["n_a"])]

    @property
    def shown(self) -> bool:
        """Whether its pairs are few enough for a page."""
        return len(self.each.row.levels) <= SHOWN_LEVELS


def judge(found: Sequence[Analysed], plan: EquivalencePlan) -> tuple[list[Judged], list[str]]:
    """All pairs of every comparison, and of factors and pictures with at most 8 levels; and why a row or pair has none.

    Interactions have no pairs: a difference of differences has no margin.
    """
    judged: list[Judged] = []
    said: list[str] = []
    for each in found:
        row, margin = each.row, plan.margin_of(each.row.question)
        if row.kind == "interaction":
            continue
        if margin is None:
            said.append(
                f"Question “{row.question}” has no margin in [analysis.equivalence]: nothing is said about pictures "
                "being rated alike on it."
            )
        elif row.kind != "comparison" and len(row.levels) > SHOWN_LEVELS:
            said.append(
                f"{row.title}: {len(row.levels)} levels make {comb(len(row.levels), 2)} pairs; none was tested for "
                "equivalence. Name the pictures that matter in an [[analysis.comparison]]."
            )
        else:
            one, reasons = judge_row(each, margin, plan.alpha)
            judged += one
            said += reasons
    return judged, list(dict.fromkeys(said))


def judge_row(each: Analysed, margin: float, alpha: float) -> tuple[list[Judged], list[str]]:
    """The tests of one row (none where no pair has one), and the sentences on pairs without a test."""
    subject = "participant" if each.mode == "repeated" else None
    try:
        pairs = Equivalence("rating", "condition", subject, margin, alpha)(each.answers)
    except Undefined as reason:
        return [], [f"Equivalence of {each.row.title}: {reader_words(reason, each.row.labels)}."]
    judged = Judged(each, margin, alpha, pairs)
    reasons = [pair["reason"] for pair in judged.records if pair["verdict"] == UNTESTED]
    return [judged], [f"Equivalence of {each.row.title}: {reader_words(reason, judged.labels)}." for reason in reasons]


def equivalence_table(judged: Iterable[Judged]) -> pd.DataFrame:
    """A row per pair: tables/equivalence.csv, and the `equivalence` part of results.json."""
    entries = []
    for one in judged:
        row = one.each.row
        key = {level.code: level.stimuli[0] if len(level.stimuli) == 1 else level.label for level in row.levels}
        head = {"question": row.question, "factor": row.name, "method": METHODS[one.each.mode]}
        for pair in one.records:
            names = {"a": key[pair["a"]], "b": key[pair["b"]], "samples": f"{pair['a']} vs {pair['b']}"}
            reason = reader_words(pair["reason"], one.labels)
            entries.append({**head, **pair, **names, "margin": one.margin, "alpha": one.alpha, "reason": reason})
    return pd.DataFrame(entries)
