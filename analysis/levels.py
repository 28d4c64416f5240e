"""A study known by its ratings alone: its pictures, and its factors where columns of the file hold their levels."""

from collections.abc import Hashable, Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.columns import choose_columns, decimal_points, lines_of_answers, read_header, read_text
from analysis.labels import natural_order
from analysis.plan import AnalysisPlan
from analysis.ratings import is_check
from analysis.spreadsheets import unguarded
from analysis.study import Factor, Picture, Question, StudyInfo
from fakesss.problem import BadInput, nearest

Levels = Mapping[str, Mapping[str, Any]]


def from_ratings(
    ratings: pd.DataFrame, title: str, scale: int | None, factors: Sequence[str] = (), levels: Levels | None = None
) -> StudyInfo:
    """The study that `ratings` show. `factors`: names in the order of the tables; `levels`: picture -> factor -> level.

    Without factors every picture is compared with every other. A picture without any level stands outside the design,
    as one of other origin.
    """
    found = levels or {}
    pictures = [str(name) for name in natural_order(ratings["stimulus"])]
    placed = {name: found.get(name, {}) for name in pictures}
    design = design_of([row for row in placed.values() if row], factors)
    rows = rows_of_pictures(placed, factors, design)
    return StudyInfo(
        title=title,
        design=design,
        factors=tuple(
            Factor(name, level_order([row[name] for row in placed.values() if name in row])) for name in factors
        ),
        questions=tuple(
            Question(str(name), scale=scale) for name in ratings.loc[~is_check(ratings), "question"].unique()
        ),
        pictures=tuple(
            Picture(
                name,
                name,
                role="compare" if factors and not placed[name] else "factor",
                levels=tuple(placed[name].items()),
                rows=rows[name],
            )
            for name in pictures
        ),
        plan=AnalysisPlan(),
    )


def read_levels(path: Path, columns: Mapping[str, str], factors: Mapping[str, str]) -> dict[str, dict[str, Any]]:
    """Picture -> factor -> level, of the columns that `factors` names (factor -> column).

    Levels are numbers where all of a factor's are; an empty cell is no level. Raises `BadInput` for a column that is
    not there, for a picture with two levels of one factor, and for a factor with fewer than two.
    """
    header, delimiter = read_header(path)
    picture = choose_columns(header, columns, path, None)["stimulus"]
    for name, theirs in factors.items():
        if theirs not in header:
            raise BadInput(f'{path}: no column "{theirs}" (factor {name}); {nearest(theirs, header)}')
    frame = lines_of_answers(read_text(path, header, delimiter, list(dict.fromkeys([picture, *factors.values()]))))
    frame = frame.assign(**{picture: unguarded(frame[picture])}).drop_duplicates()
    found: dict[str, dict[str, Any]] = {}
    for name, theirs in factors.items():
        text = frame[theirs].str.strip()
        cells = decimal_points(text) if delimiter != "," else text
        values = as_levels(cells, f"{path}: factor {name}")
        for (line, value), stimulus in zip(values.items(), frame[picture], strict=True):
            if value is not None:
                place(
                    found.setdefault(stimulus, {}),
                    name,
                    value,
                    f'{path}: line {line_number(line)}: picture "{stimulus}"',
                )
    return found


def line_number(index: Hashable) -> int:
    """Of a row of `read_text`: the header is line 1."""
    return int(str(index)) + 2


def place(levels: dict[str, Any], name: str, value: Any, where: str) -> None:
    """A picture's level of one factor; it has but one."""
    if levels.setdefault(name, value) != value:
        raise BadInput(
            f'{where} has {name} "{value}" here and "{levels[name]}" before; a picture has one level of each'
        )


def as_levels(cells: "pd.Series[str]", where: str) -> dict[Hashable, Any]:
    """Line -> level: numbers where all are, else text; None for an empty cell."""
    numbers = pd.to_numeric(cells.where(cells != ""), errors="coerce")
    numeric = bool(((cells == "") == numbers.isna()).all())
    as_number = [number_of(value) for value in numbers.fillna(0.0)]
    levels = as_number if numeric else list(cells)
    values = {line: level if text else None for (line, text), level in zip(cells.items(), levels, strict=True)}
    distinct = {value for value in values.values() if value is not None}
    if len(distinct) < 2:
        only = f'only the level "{distinct.pop()}"' if distinct else "no level"
        raise BadInput(f"{where}: has {only}; a factor needs two levels, so leave it out")
    return values


def number_of(value: float) -> int | float:
    """18 for 18.0."""
    return int(value) if float(value).is_integer() else float(value)


def level_order(values: Sequence[Any]) -> tuple[Any, ...]:
    """The distinct levels: numbers by value, words as people sort them."""
    distinct = list(dict.fromkeys(values))
    return tuple(natural_order(distinct) if any(isinstance(v, str) for v in distinct) else sorted(distinct))


def design_of(placed: Sequence[Mapping[str, Any]], factors: Sequence[str]) -> str:
    """How the pictures' levels combine: "full-factorial", "one-at-a-time", "list", or "unknown" without factors."""
    if not factors:
        return "unknown"
    full = [row for row in placed if len(row) == len(factors)]
    seen = {tuple(row[name] for name in factors) for row in full}
    every = product(*(level_order([row[name] for row in full]) for name in factors))
    if len(full) == len(placed) and seen == set(every):
        return "full-factorial"
    return "one-at-a-time" if base_of(full, factors) is not None and len(full) == len(placed) else "list"


def base_of(placed: Sequence[Mapping[str, Any]], factors: Sequence[str]) -> Mapping[str, Any] | None:
    """The picture from which every other differs in one factor at most."""
    return next((row for row in placed if all(len(varied(row, other, factors)) <= 1 for other in placed)), None)


def varied(base: Mapping[str, Any], row: Mapping[str, Any], factors: Sequence[str]) -> list[str]:
    """The factors in which two pictures differ."""
    return [name for name in factors if row[name] != base[name]]


def rows_of_pictures(placed: Levels, factors: Sequence[str], design: str) -> dict[str, tuple[str, ...]]:
    """Picture -> the factors in whose rows it is compared: one at a time only where it varies, and the base in all."""
    if design != "one-at-a-time":
        return {name: tuple(factor for factor in factors if factor in row) for name, row in placed.items()}
    base = base_of([row for row in placed.values() if row], factors)
    assert base is not None
    return {name: tuple(varied(base, row, factors) or factors) if row else () for name, row in placed.items()}
