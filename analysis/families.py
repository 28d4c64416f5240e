"""p values adjusted together: the family that `[analysis] family` declares, over the rows of the design's mode."""

from collections.abc import Sequence
from dataclasses import replace

import pandas as pd

from analysis.plan import AnalysisPlan
from analysis.results import Analysed
from analysis.statistics.multiplicity import Adjusted

NAMES = {"holm": "Holm", "fdr": "Benjamini–Hochberg"}


def adjusted(found: Sequence[Analysed], plan: AnalysisPlan) -> tuple[Analysed, ...]:
    """The rows with `p_holm` and `p_fdr`: main effects, interactions and comparisons alike."""
    tests = [(each.p, each.row.question, each.row.name) for each in found]
    table = pd.DataFrame(tests, columns=["p", "question", "factor"]).astype({"p": float})
    family = None if plan.family == "all" else plan.family
    for method in ("holm", "fdr"):
        table = Adjusted("p", method, family)(table)
    return tuple(
        each if each.p is None else replace(each, p_holm=float(row["p_holm"]), p_fdr=float(row["p_fdr"]))
        for each, (_, row) in zip(found, table.iterrows(), strict=True)
    )


def family_words(plan: AnalysisPlan, count: int) -> str:
    """all 10 tests; the tests of each question."""
    return f"all {count} tests" if plan.family == "all" else f"the tests of each {plan.family}"


def deciding_words(plan: AnalysisPlan, count: int) -> str:
    """Which p decides: how it is adjusted, and over which tests."""
    if plan.adjust == "none":
        return "not adjusted for the number of tests"
    return f"{NAMES[plan.adjust]}-adjusted over {family_words(plan, count)}"
