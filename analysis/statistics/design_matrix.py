"""Factors as columns of numbers: sum-to-zero coding, so that a factor's columns test its main effect in any design."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import pandas as pd

from analysis.labels import levels_of
from analysis.statistics.factorial import CROSS
from analysis.statistics.undefined import Floats, Undefined


@dataclass(frozen=True)
class Term:
    """A main effect (one factor) or an interaction (several), and where its columns stand in the matrix."""

    factors: tuple[str, ...]
    columns: slice

    @property
    def name(self) -> str:
        """thickness × backlight."""
        return CROSS.join(self.factors)


@dataclass(frozen=True)
class Coding:
    """Sum-to-zero coding of `factors`; `interactions`: with all of them, up to that of all factors.

    A level's row has 1 in its own column, the last level's row -1 in every column (R: `contr.sum`). A coefficient is
    then a level's distance from the plain mean over levels, whatever the other factors are, and the joint test of a
    factor's columns is the main effect ("type III") also beside interactions.
    """

    factors: tuple[str, ...]
    levels: tuple[tuple[object, ...], ...]
    interactions: bool

    @property
    def terms(self) -> list[Term]:
        """Main effects in their order, then interactions of two, of three, ..."""
        sizes = range(1, len(self.factors) + 1 if self.interactions else 2)
        widths = dict(zip(self.factors, (len(levels) - 1 for levels in self.levels), strict=True))
        found, start = [], 0
        for names in (names for size in sizes for names in combinations(self.factors, size)):
            width = int(np.prod([widths[name] for name in names]))
            found.append(Term(names, slice(start, start + width)))
            start += width
        return found

    def matrix(self, cells: pd.DataFrame) -> Floats:
        """A row per row of `cells` (a column per factor), without a constant."""
        coded = {name: self.rows(name)[self.codes(cells, name)] for name in self.factors}
        parts = []
        for term in self.terms:
            part = np.ones((len(cells), 1))
            for name in term.factors:
                part = (part[:, :, None] * coded[name][:, None, :]).reshape(len(cells), -1)
            parts.append(part)
        return np.hstack(parts)

    def rows(self, factor: str) -> Floats:
        """Levels x columns of one factor."""
        count = len(self.levels[self.factors.index(factor)])
        return np.vstack([np.eye(count - 1), -np.ones((1, count - 1))])

    def codes(self, cells: pd.DataFrame, factor: str) -> "np.ndarray[tuple[int], np.dtype[np.int64]]":
        """Each row's level as its place among the factor's levels."""
        place = {level: index for index, level in enumerate(self.levels[self.factors.index(factor)])}
        return np.array([place[level] for level in cells[factor]], dtype=np.int64)

    @property
    def at_first(self) -> Floats:
        """The row of the cell where every factor has its first level."""
        first = pd.DataFrame([{name: found[0] for name, found in zip(self.factors, self.levels, strict=True)}])
        row: Floats = self.matrix(first)[0]
        return row

    def against_first(self, factor: str) -> Floats:
        """(levels - 1) x all columns: each level less the first, at the plain mean over the other factors' levels."""
        columns = next(term.columns for term in self.terms if term.factors == (factor,))
        rows = self.rows(factor)
        contrast = np.zeros((len(rows) - 1, self.terms[-1].columns.stop))
        contrast[:, columns] = rows[1:] - rows[0]
        return contrast


def coding_of(frame: pd.DataFrame, value: str, factors: Sequence[str], interactions: bool) -> Coding:
    """The coding of the levels that occur; `Undefined` where a factor has one."""
    levels = tuple(tuple(levels_of(frame[name])) for name in factors)
    for name, found in zip(factors, levels, strict=True):
        if len(found) < 2:
            raise Undefined(f"{value} by {name}: {len(found)} level with ratings; a comparison needs at least two")
    return Coding(tuple(factors), levels, interactions)


def refuse_empty_cells(coding: Coding, cells: pd.DataFrame, value: str) -> None:
    """`Undefined` where the rated `cells` (each once) cannot tell all terms apart."""
    if len(cells) == np.prod([len(levels) for levels in coding.levels]):
        return
    matrix = np.column_stack([np.ones(len(cells)), coding.matrix(cells)])
    if np.linalg.matrix_rank(matrix) == matrix.shape[1]:
        return
    seen = set(cells[list(coding.factors)].itertuples(index=False, name=None))
    every = pd.MultiIndex.from_product(coding.levels).to_list()
    empty = [cell for cell in every if cell not in seen]
    named = ", ".join(f'{name} "{level}"' for name, level in zip(coding.factors, empty[0], strict=True))
    raise Undefined(
        f"{value} by {CROSS.join(coding.factors)}: {len(empty)} of {len(every)} cells have no rating "
        f"(such as {named}), so effects and interactions cannot be told apart"
    )
