"""p values adjusted together: the family that `[analysis] family` declares, over the rows of the design's mode."""

from collections.abc import Sequence
from dataclasses import replace

import pandas as pd

from analysis.plan import AnalysisPlan
from analysis.results import Analysed
from analysis.rows import Row
from analysis.statistics.multiplicity import Adjusted
from analysis.wording import counted

NAMES = {"holm": "Holm", "fdr": "Benjamini–Hochberg"}


def adjusted(found: Sequence[Analysed], plan: AnalysisPlan) -> tuple[Analysed, ...]:
    """The rows with `p_holm` and `p_fdr`: main effects, interactions and declared comparisons alike."""
    tests = [(each.p, family_of(each.row, plan)) for each in found]
    table = pd.DataFrame(tests, columns=["p", "family"]).astype({"p": float})
    for method in ("holm", "fdr"):
        table = Adjusted("p", method, "family")(table)
    return tuple(
        each if each.p is None else replace(each, p_holm=float(row["p_holm"]), p_fdr=float(row["p_fdr"]))
        for each, (_, row) in zip(found, table.iterrows(), strict=True)
    )


def family_of(row: Row, plan: AnalysisPlan) -> str:
    """A name that the rows share whose p values are adjusted together."""
    family = {"all": "all", "question": row.question, "factor": row.name}[plan.family]
    return f"comparisons by themselves: {family}" if undeclared(row, plan) else f"declared: {family}"


def undeclared(row: Row, plan: AnalysisPlan) -> bool:
    """Whether the report adds this comparison by itself; such tests take nothing from those that were planned."""
    return row.kind == "comparison" and not plan.comparison


def family_words(plan: AnalysisPlan, found: Sequence[Analysed]) -> str:
    """all 10 tests; the tests of each question."""
    tested = [undeclared(each.row, plan) for each in found if each.p is not None]
    added = sum(tested) if not all(tested) else 0
    words = together(len(tested) - added) if plan.family == "all" else f"the tests of each {plan.family}"
    if not added:
        return words
    return f"{words}, and apart from them over {counted(added, 'comparison')} that [analysis] does not declare"


def together(count: int) -> str:
    """all 10 tests; the only test."""
    return {0: "no test", 1: "the only test", 2: "both tests"}.get(count, f"all {count} tests")


def deciding_words(plan: AnalysisPlan, found: Sequence[Analysed]) -> str:
    """Which p decides: how it is adjusted, and over which tests."""
    if plan.adjust == "none":
        return "not adjusted for the number of tests"
    if not any(each.p is not None for each in found):
        return "which has no value here"
    return f"{NAMES[plan.adjust]}-adjusted over {family_words(plan, found)}"
