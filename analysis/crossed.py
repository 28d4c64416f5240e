"""Full factorials: which pictures show which combination of levels, and whether every combination was rated."""

from dataclasses import dataclass
from itertools import product

import pandas as pd

from analysis.study import Factor, Picture, StudyInfo
from analysis.wording import joined, level_text


@dataclass(frozen=True)
class Crossed:
    """A question whose pictures show every combination of the factors' levels, each rated by somebody.

    `cells`: picture -> the text of its level of each factor.
    """

    question: str
    factors: tuple[Factor, ...]
    cells: tuple[tuple[str, tuple[str, ...]], ...]

    @property
    def names(self) -> tuple[str, ...]:
        """The factors' names."""
        return tuple(factor.name for factor in self.factors)

    def of(self, names: tuple[str, ...]) -> "Crossed":
        """The same pictures by these factors alone: ratings are then averaged over the others."""
        places = [self.names.index(name) for name in names]
        cells = tuple((picture, tuple(levels[place] for place in places)) for picture, levels in self.cells)
        return Crossed(self.question, tuple(self.factors[place] for place in places), cells)

    def frame(self, ratings: pd.DataFrame) -> pd.DataFrame:
        """One row per person and combination: `self.subject`, levels of each factor, `self.value` (the mean over its
        pictures)."""
        levels = dict(self.cells)
        mine = ratings[(ratings["question"] == self.question) & ratings["stimulus"].isin(list(levels))]
        frame = pd.DataFrame({self.subject: mine["participant"], self.value: mine["rating"]})
        for place, factor in enumerate(self.factors):
            texts = [level_text(value) for value in factor.levels]
            shown = mine["stimulus"].map({picture: cell[place] for picture, cell in levels.items()})
            frame[factor.name] = pd.Categorical(shown, texts)
        cells = frame.groupby([self.subject, *self.names], observed=True)
        return cells[self.value].mean().reset_index()

    @property
    def subject(self) -> str:
        """The column of people: a name that no factor has."""
        return free("participant", self.names)

    @property
    def value(self) -> str:
        """The column of ratings: a name that no factor has."""
        return free("rating", self.names)


def free(name: str, taken: tuple[str, ...]) -> str:
    """`name`, with apostrophes until nothing else is called so."""
    return free(f"{name}'", taken) if name in taken else name


def crossed_factors(study: StudyInfo) -> tuple[Factor, ...]:
    """The factors that a factorial design combines: those of two levels and more; none in other designs."""
    varied = tuple(factor for factor in study.factors if len(factor.levels) > 1)
    return varied if len(varied) > 1 and study.design != "one-at-a-time" else ()


def crossed_of(study: StudyInfo, question: str, ratings: pd.DataFrame) -> Crossed | str | None:
    """The factorial of a question; the sentence what a full factorial lacks; None where the design is no factorial.

    Pictures compared, repeats and controls are no part of it.
    """
    factors = crossed_factors(study)
    rated = set(ratings.loc[ratings["question"] == question, "stimulus"].unique())
    own = [picture for picture in study.pictures if picture.role == "factor" and picture.id in rated]
    cells = tuple((picture.id, cell_of(picture, factors)) for picture in own)
    every = list(product(*(map(level_text, factor.levels) for factor in factors)))
    missing = [cell for cell in every if cell not in {levels for _, levels in cells}]
    if not factors or (missing and study.design != "full-factorial"):
        return None
    if missing:
        named = joined([f"{factor.name} {level}" for factor, level in zip(factors, missing[0], strict=True)])
        more = f" (nor {len(missing) - 1} other combinations)" if len(missing) > 1 else ""
        return f"nobody rated a picture with {named}{more}"
    return Crossed(question, factors, tuple((picture, cell) for picture, cell in cells if cell in every))


def cell_of(picture: Picture, factors: tuple[Factor, ...]) -> tuple[str, ...]:
    """The picture's level of each factor, as text."""
    levels = dict(picture.levels)
    return tuple(level_text(levels[factor.name]) if factor.name in levels else "" for factor in factors)
