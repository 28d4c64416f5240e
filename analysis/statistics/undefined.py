"""A statistic that these data do not have, said in a sentence instead of a NaN; and the checks that find out."""

import numpy as np
import numpy.typing as npt
import pandas as pd

from analysis.labels import levels_of
from fakesss.problem import BadInput, nearest

Floats = npt.NDArray[np.float64]
SMALLEST_P = float(np.finfo(np.float64).tiny)


def not_zero(p: float) -> float:
    """No p value is 0: one too small for a float64 stands as the bound 2.2e-308."""
    return max(float(p), SMALLEST_P)


class Undefined(BadInput):
    """The statistic has no value for these ratings; the sentence says why."""


def require_columns(frame: pd.DataFrame, *names: str) -> None:
    """`BadInput` naming the first of `names` that the frame lacks."""
    missing = next((name for name in names if name not in frame), None)
    if missing is not None:
        raise BadInput(f'frame: no column "{missing}"; {nearest(missing, map(str, frame.columns))}')


def groups_of(frame: pd.DataFrame, value: str, group: str) -> dict[object, Floats]:
    """Level -> its values less the first value of all, so that sums of squares keep their digits.

    Missing values are left out. Raises `Undefined` for fewer than two levels, a level with one value, or no variation.
    """
    require_columns(frame, value, group)
    present = frame.dropna(subset=[value, group])
    levels = levels_of(present[group])
    if len(levels) < 2:
        raise Undefined(f"{value} by {group}: {len(levels)} level with ratings; a comparison needs at least two")
    numbers: Floats = present[value].to_numpy(np.float64)
    places = present.groupby(group, observed=True, sort=False).indices
    parts: dict[object, Floats] = {level: numbers[places[level]] - numbers[0] for level in levels}
    alone = next((level for level, part in parts.items() if len(part) < 2), None)
    if alone is not None:
        raise Undefined(f'{value} by {group}: level "{alone}" has one rating; each level needs at least two')
    if all(np.ptp(part) == 0 for part in parts.values()):
        refuse_constant(parts, value, group)
    return parts


def refuse_constant(parts: dict[object, Floats], value: str, group: str) -> None:
    """No spread inside any level: there is nothing to measure differences against."""
    same = len({float(part[0]) for part in parts.values()}) == 1
    why = "all ratings are equal" if same else "within each level all ratings are equal"
    raise Undefined(f"{value} by {group}: {why}, so F has no value")


def complete_table(frame: pd.DataFrame, value: str, within: str, subject: str) -> tuple[pd.DataFrame, list[str]]:
    """Subjects x levels of complete cases (values less the first of all), and the subjects dropped for a missing cell.

    Raises `BadInput` for a doubled cell, `Undefined` for fewer than two levels or two complete subjects.
    """
    require_columns(frame, value, within, subject)
    levels = levels_of(frame[within].dropna())
    if len(levels) < 2:
        raise Undefined(f"{value} by {within}: {len(levels)} level with ratings; a comparison needs at least two")
    twice = frame.duplicated([subject, within])
    if twice.any():
        row = frame[twice].iloc[0]
        raise BadInput(
            f'frame: {subject} "{row[subject]}" has two values at {within} "{row[within]}"; average them first'
        )
    wide = frame.assign(**{within: frame[within].astype(object)}).pivot(index=subject, columns=within, values=value)
    wide = wide[levels].astype(float)
    kept = wide.dropna()
    if len(kept) < 2:
        raise Undefined(
            f"{value} by {within}: {len(kept)} of {len(wide)} {subject}s rated every level; at least two must have"
        )
    return kept - kept.iloc[0, 0], [str(who) for who in wide.index[wide.isna().any(axis=1)]]


def residuals(wide: Floats) -> Floats:
    """What is left of a subjects x levels table when row and column means are taken out."""
    rows = wide.mean(axis=1, keepdims=True)
    columns = wide.mean(axis=0, keepdims=True)
    left: Floats = wide - rows - columns + wide.mean()
    return left
