"""A statistic that these data do not have, said in a sentence instead of a NaN; and the checks that find out."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from analysis.labels import levels_of
from fakesss.problem import BadInput, nearest

Floats = npt.NDArray[np.float64]
SMALLEST_P = float(np.finfo(np.float64).tiny)
ROUNDING = 1e-12  # a spread this small against that of all ratings is what float64 leaves of none
LAST_BITS = 4 * float(np.finfo(np.float64).eps)  # of the values themselves: equal decimals summed in another order


def not_zero(p: npt.ArrayLike) -> Any:
    """No p value is 0: one too small for a float64 stands as the bound 2.2e-308. A number or an array; NaN stays."""
    found = np.maximum(np.asarray(p, dtype=np.float64), SMALLEST_P)
    return found if found.ndim else float(found)


def spreadless(values: Floats, everything: Floats) -> npt.NDArray[np.bool_]:
    """Whether `values` (along the first axis) are equal but for rounding: 6.1 - 6.0 is not 3.1 - 3.0 in float64.

    `everything`: the ratings that the values come from, whose range is the measure.
    """
    return np.asarray(np.ptp(values, axis=0) <= ROUNDING * np.ptp(everything))


def from_first(values: Floats) -> Floats:
    """Values less the first of all; 0 in all places where they differ in their last bits alone."""
    shifted: Floats = values - values.flat[0]
    return shifted if np.ptp(shifted) > LAST_BITS * np.abs(values).max() else np.zeros_like(shifted)


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
    numbers: Floats = from_first(present[value].to_numpy(np.float64))
    places = present.groupby(group, observed=True, sort=False).indices
    parts: dict[object, Floats] = {level: numbers[places[level]] for level in levels}
    alone = next((level for level, part in parts.items() if len(part) < 2), None)
    if alone is not None:
        raise Undefined(f'{value} by {group}: level "{alone}" has one rating; each level needs at least two')
    if all(spreadless(part, numbers) for part in parts.values()):
        refuse_constant(numbers, value, group)
    return parts


def refuse_constant(numbers: Floats, value: str, group: str) -> None:
    """No spread inside any level: there is nothing to measure differences against."""
    why = "within each level all ratings are equal" if np.ptp(numbers) > 0 else "all ratings are equal"
    raise Undefined(f"{value} by {group}: {why}, so F has no value")


def refuse_doubled(present: pd.DataFrame, subject: str, within: str) -> None:
    """`BadInput` naming the first cell with two values."""
    twice = present.duplicated([subject, within])
    if twice.any():
        row = present[twice].iloc[0]
        raise BadInput(
            f'frame: {subject} "{row[subject]}" has two values at {within} "{row[within]}"; average them first'
        )


def complete_table(frame: pd.DataFrame, value: str, within: str, subject: str) -> tuple[pd.DataFrame, list[str]]:
    """Subjects x levels of complete cases (values less the first of all), and the subjects dropped for a missing cell.

    Rows without a level or a subject are left out. A subject or a level whose values are all missing counts.

    Raises `BadInput` for a doubled cell, `Undefined` for fewer than two levels or two complete subjects.
    """
    require_columns(frame, value, within, subject)
    named = frame.dropna(subset=[within, subject])
    present = named.dropna(subset=[value])
    levels = levels_of(named[within])
    if len(levels) < 2:
        raise Undefined(f"{value} by {within}: {len(levels)} level with ratings; a comparison needs at least two")
    refuse_doubled(present, subject, within)
    plain = present.astype({within: object})
    wide = plain.pivot(index=subject, columns=within, values=value).astype(float)
    silent = named.loc[~named[subject].isin(wide.index), subject].unique()
    wide = wide.reindex(columns=levels)
    if len(silent):
        wide = wide.reindex([*wide.index, *silent]).sort_index()
    kept = wide.dropna()
    if len(kept) < 2:
        raise Undefined(
            f"{value} by {within}: {len(kept)} of {len(wide)} {subject}s rated every level; at least two must have"
        )
    shifted = pd.DataFrame(from_first(kept.to_numpy()), kept.index, kept.columns)
    return shifted, [str(who) for who in wide.index[wide.isna().any(axis=1)]]


def residuals(wide: Floats) -> Floats:
    """What is left of a subjects x levels table when row and column means are taken out."""
    rows = wide.mean(axis=1, keepdims=True)
    columns = wide.mean(axis=0, keepdims=True)
    left: Floats = wide - rows - columns + wide.mean()
    return left
