"""The declared models of every row: ordinal regression and mixed models; a full factorial is one model."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from analysis.crossed import free
from analysis.evidence import Evidence
from analysis.results import Analysed
from analysis.rows import Row
from analysis.statistics.mixed import MixedFit, MixedModel, NoRandomTerm
from analysis.statistics.ordinal import OrdinalFit, OrdinalRegression
from analysis.statistics.undefined import Undefined
from analysis.statistics.variance import VarianceComponents
from analysis.study import StudyInfo
from analysis.wording import level_text


@dataclass(frozen=True)
class Modelled:
    """The models of one row, or of all rows of a full factorial. `missing`: kind of model -> why it has no value.

    `by_design`: the kinds among them that the design rules out, whatever people answer: nothing is wrong.
    """

    found: tuple[Analysed, ...]
    ordinal: OrdinalFit | None
    mixed: MixedFit | None
    missing: dict[str, str]
    by_design: tuple[str, ...] = ()

    def test(self, fit: OrdinalFit | MixedFit | None, each: Analysed) -> dict[str, Any] | None:
        """The test of that row, where its model was fitted."""
        if fit is None:
            return None
        rows = fit.tests if each.row.crossed is None else fit.tests[fit.tests["term"] == each.row.name]
        return {str(key): value for key, value in rows.iloc[0].items()}


def models_of(evidence: Evidence) -> list[Modelled]:
    """A model for each row that stands alone, and one for all rows of a question's full factorial."""
    together: dict[object, list[Analysed]] = {}
    for place, each in enumerate(evidence.main):
        key = place if each.row.crossed is None else each.row.question
        together.setdefault(key, []).append(each)
    return [modelled(tuple(found), evidence) for found in together.values()]


def modelled(found: tuple[Analysed, ...], evidence: Evidence) -> Modelled:
    """The models that the plan asks for."""
    row, plan = found[0].row, evidence.plan
    names = factor_names(row)
    value, person, picture = (free(name, names) for name in ("rating", "participant", "picture"))
    frame = model_frame(row, evidence.study, evidence.sample.ratings)
    repeated = found[0].mode == "repeated"
    missing: dict[str, str] = {}
    by_design: list[str] = []

    def attempt(kind: str, fit: Callable[[pd.DataFrame], Any]) -> Any:
        """The fit, or None and in `missing` the reason why there is none."""
        try:
            return fit(frame)
        except Undefined as reason:
            missing[kind] = str(reason).removeprefix(f"{value} by {' and '.join(names)}: ")
            if isinstance(reason, NoRandomTerm) and not repeated:  # one rating a person, one picture a level
                by_design.append(kind)
            return None

    ordinal = mixed = None
    if "ordinal" in plan.tests:
        cluster = person if repeated else None
        ordinal = attempt("ordinal", OrdinalRegression(value, names, cluster, len(names) > 1, plan.confidence).fit)
    if "mixed" in plan.tests:
        mixed = attempt("mixed", MixedModel(value, names, person if repeated else None, picture, len(names) > 1).fit)
    return Modelled(found, ordinal, mixed, missing, tuple(by_design))


def factor_names(row: Row) -> tuple[str, ...]:
    """The factors of the row's model."""
    return (row.name,) if row.crossed is None else row.crossed.names


def model_frame(row: Row, study: StudyInfo, ratings: pd.DataFrame) -> pd.DataFrame:
    """One row per rating: its value, participant, picture (equal pictures under one name) and level of each factor."""
    names = factor_names(row)
    if row.crossed is not None:
        shown = dict(row.crossed.cells)
        levels = [list(map(level_text, factor.levels)) for factor in row.crossed.factors]
    else:
        texts = distinct_labels(row)
        pairs = zip(texts, row.levels, strict=True)
        shown = {picture: (text,) for text, level in pairs for picture in level.stimuli}
        levels = [texts]
    mine = ratings[(ratings["question"] == row.question) & ratings["stimulus"].isin(list(shown))]
    columns = {
        free("rating", names): mine["rating"],
        free("participant", names): mine["participant"],
        free("picture", names): mine["stimulus"].map(same_pictures(study)).fillna(mine["stimulus"]),
    }
    for place, (name, known) in enumerate(zip(names, levels, strict=True)):
        of_picture = {picture: cell[place] for picture, cell in shown.items()}
        columns[name] = pd.Series(pd.Categorical(mine["stimulus"].map(of_picture), known), index=mine.index)
    return pd.DataFrame(columns)


def distinct_labels(row: Row) -> list[str]:
    """The samples' labels, with their codes where two share one."""
    labels = [level.label for level in row.levels]
    alike = len(set(labels)) < len(labels)
    return [f"{level.code} {level.label}" for level in row.levels] if alike else labels


def same_pictures(study: StudyInfo) -> dict[str, str]:
    """Picture -> the first that is equal to it, byte by byte."""
    return {picture.id: picture.same_picture_as or picture.id for picture in study.pictures}


def variance_of(evidence: Evidence) -> tuple[pd.DataFrame, dict[str, str]]:
    """A row per question and part (`question, term, variance, share, n`), and question -> why it has none."""
    parts, missing = [], {}
    ratings = evidence.sample.ratings
    asked: Sequence[str] = [question.name for question in evidence.study.questions]
    for question in asked if evidence.sample.mode == "repeated" and "mixed" in evidence.plan.tests else ():
        mine = ratings[ratings["question"] == question]
        if mine.empty:
            continue
        frame = mine[["rating", "participant"]].assign(
            picture=mine["stimulus"].map(same_pictures(evidence.study)).fillna(mine["stimulus"])
        )
        try:
            table = VarianceComponents("rating", "participant", "picture")(frame)
        except Undefined as reason:
            missing[question] = str(reason).removeprefix("variance of rating: ")
            continue
        table.insert(0, "question", question)
        parts.append(table.assign(n=len(frame)))
    return (pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()), missing
