"""Everything that was read and computed for one report: what its sections present."""

from collections.abc import Callable
from dataclasses import dataclass

import pandas as pd

from analysis.factorials import factorials_of
from analysis.families import adjusted
from analysis.plan import AnalysisPlan, Mode
from analysis.results import Analysed, analyse
from analysis.rows import rows_of
from analysis.sample import Sample
from analysis.study import StudyInfo

BETWEEN = (
    "Interactions are not tested between people: each factor is analysed by itself, over the pictures of its levels."
)
Progress = Callable[[int, int, str], None]


@dataclass(frozen=True)
class Evidence:
    """A study, its plan, whose ratings count, and every row analysed.

    `ratings`: all that were read, those of people left out included. `main`: the rows in the mode that the design calls
    for; `other`: the same rows in the other mode. `notes`: sentences on what had to be left out.
    """

    study: StudyInfo
    plan: AnalysisPlan
    sample: Sample
    ratings: pd.DataFrame
    main: tuple[Analysed, ...]
    other: tuple[Analysed, ...]
    notes: tuple[str, ...] = ()


def gather(
    study: StudyInfo, plan: AnalysisPlan, sample: Sample, ratings: pd.DataFrame, progress: Progress | None = None
) -> Evidence:
    """All rows of the study analysed. `progress(done, total, what)` is called before each analysis and at the end."""
    rows, notes = rows_of(study, plan, sample.ratings)
    other: Mode = "independent" if sample.mode == "repeated" else "repeated"
    if sample.mode == "independent" and any(row.kind == "interaction" for row in rows):
        notes.append(BETWEEN)
    between = [row for row in rows if row.kind != "interaction"]
    jobs = [(row, mode) for mode in (sample.mode, other) for row in (rows if mode == "repeated" else between)]
    tell = progress or (lambda done, total, what: None)
    factorials = factorials_of(rows, sample.ratings)
    found = []
    for done, (row, mode) in enumerate(jobs):
        tell(done, len(jobs), row.title)
        found.append(analyse(row, sample, plan, mode, factorials))
    tell(len(jobs), len(jobs), "writing")
    main = adjusted([each for each in found if each.mode == sample.mode], plan)
    rest = tuple(each for each in found if each.mode == other)
    return Evidence(study, plan, sample, ratings, main, rest, tuple(notes))
