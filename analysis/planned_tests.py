"""The declared tests of a study, ready to be made of thousands of simulated ones."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations
from typing import Literal

import numpy as np
import pandas as pd

from analysis.evidence import BETWEEN
from analysis.families import family_of
from analysis.plan import AnalysisPlan, Mode, PlannedContrast
from analysis.row_design import RowDesign
from analysis.rows import rows_of
from analysis.statistics.batches import Moments, repeated_p
from analysis.statistics.undefined import Floats
from analysis.study import StudyInfo
from analysis.tables import SHOWN_LEVELS
from analysis.wording import joined
from fakesss.problem import nearest

Kind = Literal["difference", "contrast", "equivalence"]
Adjust = Literal["none", "holm", "fdr"]
Means = Mapping[str, Mapping[str, float]]
SAME = 1e-9  # steps; expected means this close are the same up to rounding


@dataclass(frozen=True)
class PlannedTest:
    """One test. `p`: moments of all pictures' answers in the order of the manifest -> p values, (studies,).

    `difference`: the largest between the expected means of its samples, in steps (of an interaction: its largest
    departure from a sum of effects; of a contrast: its expected value); None where the samples are picked by the
    ratings. `margin`: of an equivalence test, else None. `family`: p values of tests with an equal one are adjusted
    together, by the method `adjust`.
    """

    title: str
    question: str
    name: str
    kind: Kind
    p: Callable[[Moments], Floats]
    alpha: float
    difference: float | None
    margin: float | None = None
    family: str = ""
    adjust: Adjust = "none"

    @property
    def together(self) -> tuple[str, Adjust]:
        """The family and its method: tests in which both are equal are adjusted together."""
        return self.family, self.adjust

    @property
    def hopeless(self) -> str:
        """Why no number of people would do; empty where one may."""
        if self.difference is None:
            return ""
        if self.margin is None and self.difference <= SAME:
            chance = f"{100 * self.alpha:g}%"
            return f"no effect is stated: significant by chance alone, in about {chance} of studies at the most"
        if self.margin is not None and self.difference >= self.margin - SAME:
            return (
                f"the expected difference of {self.difference:.2f} is not below the margin of {self.margin:g}: "
                "more people do not show equivalence"
            )
        return ""


def planned_tests(
    study: StudyInfo, plan: AnalysisPlan, mode: Mode, means: Means
) -> tuple[list[PlannedTest], list[str]]:
    """The tests of every row, the planned contrasts, equivalence of pictures compared; and what is left out, and why.

    `means`: question -> stimulus id -> expected answer. Pictures shown again are in no test.
    """
    shown_once = {picture.id for picture in study.pictures if picture.role != "repeat"}
    expected = pd.DataFrame(
        [
            {"participant": "expected", "stimulus": picture, "question": question, "rating": mean}
            for question, of_pictures in means.items()
            for picture, mean in of_pictures.items()
            if picture in shown_once
        ]
    )
    rows, notes = rows_of(study, plan, expected)
    if mode == "independent" and any(row.kind == "interaction" for row in rows):
        rows, notes = [row for row in rows if row.kind != "interaction"], [*notes, BETWEEN]
    notes += [f"{row.title}: one picture; a test needs at least two" for row in rows if len(row.levels) < 2]
    designs = [RowDesign.of(row, study, plan, mode, means[row.question]) for row in rows if len(row.levels) > 1]
    contrasts, lacking = contrasts_of(study, plan, mode, expected)
    tests = [difference_test(design, plan) for design in designs]
    tests += [contrast_test(contrast, study, plan, means[contrast.question]) for contrast in contrasts]
    tests += [test for design in designs for test in equivalence_tests(design, plan)]
    return tests, [*notes, *lacking, *chosen(designs, plan)]


def contrasts_of(
    study: StudyInfo, plan: AnalysisPlan, mode: Mode, expected: pd.DataFrame
) -> tuple[list[PlannedContrast], list[str]]:
    """The planned contrasts that the report would test, and why others are left out."""
    if mode == "independent":
        names = joined([f'"{contrast.name}"' for contrast in plan.contrast])
        said = [f"Planned contrasts are not tested between people: each is of one person's ratings. Left out: {names}."]
        return [], said if names else []
    kept, notes = [], []
    for contrast in plan.contrast:
        rated = set(expected.loc[expected["question"] == contrast.question, "stimulus"])
        lost = next((name for name, weight in contrast.weights.items() if weight and name not in rated), None)
        if lost is None:
            kept.append(contrast)
        else:
            where = f'contrast "{contrast.name}" on {contrast.question} is left out'
            notes.append(f'{where}: nobody rates "{lost}"; {nearest(lost, rated)}')
    return kept, notes


def chosen(designs: Sequence[RowDesign], plan: AnalysisPlan) -> list[str]:
    """What a picture picked by the ratings does to the tests it is in."""
    titles = [design.row.title for design in designs if design.best is not None and len(design.own) > 1]
    if not titles:
        return []
    return [
        f"{joined(titles)}: the same ratings pick the best of {len(designs[0].own)} own pictures, so that the test "
        f"finds a difference by chance alone in more than {100 * plan.alpha:g}% of studies (before any adjustment); "
        "not all of its power is an effect's."
    ]


def difference_test(design: RowDesign, plan: AnalysisPlan) -> PlannedTest:
    """The analysis of variance of a row."""
    row = design.row
    return PlannedTest(
        title=row.title,
        question=row.question,
        name=row.name,
        kind="difference",
        p=design.difference_p,
        alpha=plan.alpha,
        difference=None if design.best is not None else design.expected_difference(),
        family=family_of(row, plan),
        adjust=plan.adjust,
    )


def contrast_test(
    contrast: PlannedContrast, study: StudyInfo, plan: AnalysisPlan, means: Mapping[str, float]
) -> PlannedTest:
    """A planned contrast (`analysis.planned`): a paired t test is a repeated-measures effect of one contrast."""
    weights = np.array([[contrast.weights.get(picture.id, 0.0)] for picture in study.pictures])
    return PlannedTest(
        title=f"{contrast.question}: {contrast.name}",
        question=contrast.question,
        name=contrast.name,
        kind="contrast",
        p=partial(repeated_p, contrasts=weights),
        alpha=plan.alpha,
        difference=abs(sum(weight * means[name] for name, weight in contrast.weights.items() if weight)),
        family=f"contrasts on {contrast.question}",
        adjust="none" if plan.adjust == "none" else "holm",
    )


def equivalence_tests(design: RowDesign, plan: AnalysisPlan) -> Iterator[PlannedTest]:
    """Of each pair of a row's samples, where a margin is declared for its question (`analysis.margins.judge`)."""
    row = design.row
    margin = None if plan.equivalence is None else plan.equivalence.margin_of(row.question)
    many = row.kind != "comparison" and len(row.levels) > SHOWN_LEVELS
    if plan.equivalence is None or margin is None or row.kind == "interaction" or many:
        return
    for pair in combinations(range(len(row.levels)), 2):
        a, b = (row.levels[place].label for place in pair)
        yield PlannedTest(
            title=f"{row.title}: {a} like {b}",
            question=row.question,
            name=row.name,
            kind="equivalence",
            p=partial(design.equivalence_p, pair, margin),
            alpha=plan.equivalence.alpha,
            difference=None if design.best in pair else abs(design.plain_means[pair[0]] - design.plain_means[pair[1]]),
            margin=margin,
        )
