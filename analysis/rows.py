"""The comparisons a study calls for: which pictures make which samples M1..Mk, on which question."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, product
from typing import Any, Literal

import pandas as pd

from analysis.crossed import Crossed, crossed_of
from analysis.labels import natural_order
from analysis.plan import BEST, AnalysisPlan, Comparison
from analysis.statistics.factorial import CROSS
from analysis.study import Factor, Picture, StudyInfo
from analysis.wording import joined, level_text, sentence_case, true_minus
from fakesss.problem import nearest

Kind = Literal["factor", "interaction", "comparison", "all"]


@dataclass(frozen=True)
class Level:
    """One sample: the pictures whose ratings it holds (averaged within a person), and what it is called."""

    code: str
    label: str
    stimuli: tuple[str, ...]
    value: Any = None

    @property
    def printed(self) -> str:
        """The label as it is read: a true minus before numbers."""
        return true_minus(self.label)


@dataclass(frozen=True)
class Row:
    """One analysis: a question by a factor, by an interaction of factors ("A × B"; its samples are the combinations of
    their levels), or by pictures compared.

    `factors`: their names; `crossed`: the full factorial that a factor or an interaction is part of; `picked_best`: the
    ratings themselves chose one of the pictures compared.
    """

    name: str
    kind: Kind
    question: str
    levels: tuple[Level, ...]
    crossed: Crossed | None = None
    factors: tuple[str, ...] = ()
    picked_best: bool = False

    @property
    def title(self) -> str:
        """As in table 4.4: question vs factor."""
        return sentence_case(self.name if self.kind == "comparison" else f"{self.question} vs {self.name}")

    @property
    def compared(self) -> str:
        """What a comparison is called where its question stands beside it."""
        return self.name.removeprefix(f"{self.question}: ")

    @property
    def labels(self) -> dict[str, str]:
        """Code -> the sample as it is read."""
        return {level.code: level.printed for level in self.levels}

    def cells(self, ratings: pd.DataFrame) -> pd.DataFrame:
        """`participant, condition` (M1..Mk), `rating`: one row per person and sample, averaged over its pictures."""
        code = {stimulus: level.code for level in self.levels for stimulus in level.stimuli}
        mine = ratings[(ratings["question"] == self.question) & ratings["stimulus"].isin(list(code))]
        condition = mine["stimulus"].map(code).rename("condition")
        return mine.groupby(["participant", condition], sort=True)["rating"].mean().reset_index()


def rows_of(study: StudyInfo, plan: AnalysisPlan, ratings: pd.DataFrame) -> tuple[list[Row], list[str]]:
    """Every row by factor and question (as figure 4.5), interactions, then comparisons; and sentences on what had to be
    left out."""
    rated, asked = (set(ratings[column].unique()) for column in ("stimulus", "question"))
    questions = [q.name for q in study.questions if q.name in asked]
    found = {question: crossed_of(study, question, ratings) for question in questions}
    crossed = {question: made for question, made in found.items() if isinstance(made, Crossed)}
    notes = lacking({question: made for question, made in found.items() if isinstance(made, str)})
    rows = [
        row
        for factor in study.factors
        for q in questions
        if (row := factor_row(study, factor, q, rated, crossed.get(q))) is not None
    ]
    rows += interaction_rows(crossed)
    for comparison in declared(study, plan, questions, rated):
        made = comparison_row(study, comparison, ratings)
        if isinstance(made, str):
            notes.append(made)
        else:
            rows.append(made)
    if not rows:
        rows = [whole_row(study, q, rated) for q in questions]
    return rows, notes


def lacking(reasons: dict[str, str]) -> list[str]:
    """A sentence for each reason why a full factorial has no interactions: question -> reason."""
    return [
        f"Interactions on {joined([q for q in reasons if reasons[q] == reason])} are not tested: {reason}; "
        "the main effects average over unlike sets of pictures."
        for reason in dict.fromkeys(reasons.values())
    ]


def factor_row(study: StudyInfo, factor: Factor, question: str, rated: set[str], crossed: Crossed | None) -> Row | None:
    """The factor's levels in the order of the design; None where fewer than two were rated."""
    levels: list[Level] = []
    for value in factor.levels:
        stimuli = tuple(p.id for p in study.pictures if in_row(p, factor, value) and p.id in rated)
        if stimuli:
            levels.append(Level(f"M{len(levels) + 1}", level_text(value), stimuli, value))
    return Row(factor.name, "factor", question, tuple(levels), crossed, (factor.name,)) if len(levels) > 1 else None


def interaction_rows(crossed: dict[str, Crossed]) -> Iterator[Row]:
    """Every interaction of two factors, then of three and so on, on each question."""
    most = max((len(each.factors) for each in crossed.values()), default=0)
    for order in range(2, most + 1):
        for question, whole in crossed.items():
            for names in combinations(whole.names, order):
                yield interaction_row(question, whole, names)


def interaction_row(question: str, whole: Crossed, names: tuple[str, ...]) -> Row:
    """A sample for each combination of the named factors' levels."""
    part = whole.of(names)
    levels: list[Level] = []
    for values in product(*(factor.levels for factor in part.factors)):
        texts = tuple(map(level_text, values))
        stimuli = tuple(picture for picture, cell in part.cells if cell == texts)
        levels.append(Level(f"M{len(levels) + 1}", ", ".join(texts), stimuli, values))
    return Row(CROSS.join(names), "interaction", question, tuple(levels), whole, names)


def in_row(picture: Picture, factor: Factor, value: Any) -> bool:
    """Whether the picture shows that level in the factor's row."""
    return picture.role == "factor" and factor.name in picture.rows and dict(picture.levels).get(factor.name) == value


def declared(study: StudyInfo, plan: AnalysisPlan, questions: list[str], rated: set[str]) -> Iterator[Comparison]:
    """The plan's comparisons; without any, our best picture beside all of other origin, and beside all controls."""
    yield from plan.comparison
    for role, named in (("compare", "others"), ("control", "controls")):
        beside = tuple(p.id for p in study.pictures if p.role == role and p.id in rated)
        if not plan.comparison and beside:
            yield from (
                Comparison(name=f"{question}: {named} vs ours", question=question, stimuli=(BEST, *beside))
                for question in questions
            )


def comparison_row(study: StudyInfo, comparison: Comparison, ratings: pd.DataFrame) -> Row | str:
    """The row of a declared comparison, or the sentence why it is left out."""
    where = f'comparison "{comparison.name}"'
    asked = ratings[ratings["question"] == comparison.question]
    if asked.empty:
        return f'{where}: nobody answered question "{comparison.question}"; left out'
    rated = {str(name) for name in asked["stimulus"].unique()}
    own = asked[asked["stimulus"].isin([p.id for p in study.pictures if p.role == "factor"])]
    levels: list[Level] = []
    for name in comparison.stimuli:
        if name == BEST and own.empty:
            return f'{where}: "best" needs own pictures with ratings; left out'
        identity = best_of(own) if name == BEST else name
        if identity not in rated:
            return f'{where}: nobody rated picture "{identity}"; left out ({nearest(identity, rated)})'
        label = study.picture(identity).label
        levels.append(Level(f"M{len(levels) + 1}", f"best own, {label}" if name == BEST else label, (identity,)))
    if len({level.stimuli for level in levels}) < len(levels):
        return f'{where}: "best" turned out to be a picture that is also named; left out'
    best = BEST in comparison.stimuli
    return Row(comparison.name, "comparison", comparison.question, tuple(levels), picked_best=best)


def best_of(own: pd.DataFrame) -> str:
    """The picture with the highest mean; of equals the first in natural order."""
    means = {str(name): part.mean() for name, part in own.groupby("stimulus")["rating"]}
    return next(str(name) for name in natural_order(means) if means[str(name)] == max(means.values()))


def whole_row(study: StudyInfo, question: str, rated: set[str]) -> Row:
    """Without factors: every picture a sample."""
    pictures = [study.picture(str(name)) for name in natural_order(rated)]
    levels = (Level(f"M{i}", p.label, (p.id,)) for i, p in enumerate(pictures, 1))
    return Row("picture", "all", question, tuple(levels))
