"""The order of labels as a person reads them: "image 2" before "image 10"."""

import re
from collections.abc import Iterable

import pandas as pd


def natural_key(label: object) -> tuple[tuple[int, float, str], ...]:
    """Sorts digits by value and words without regard to case; equal keys are told apart by the label itself."""
    parts = re.split(r"(\d+)", str(label))
    words = [(0, float(part), "") if part.isdecimal() else (1, 0.0, part.casefold()) for part in parts if part]
    return (*words, (-1, 0.0, str(label)))


def natural_order(labels: Iterable[object]) -> list[object]:
    """The distinct labels in natural order."""
    distinct = labels.unique() if isinstance(labels, pd.Series) else dict.fromkeys(labels)
    return sorted(distinct, key=natural_key)


def levels_of(column: "pd.Series[str]") -> list[object]:
    """The distinct levels that occur: in the declared order of a categorical column, else in natural order."""
    if isinstance(column.dtype, pd.CategoricalDtype):
        used = set(column.dropna().unique())
        return [level for level in column.cat.categories if level in used]
    return natural_order(column.dropna().unique())
