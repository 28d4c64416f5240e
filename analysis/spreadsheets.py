"""Text that a spreadsheet would run as a formula: written with an apostrophe before it, read without."""

import re
from collections.abc import Callable
from typing import Any

import pandas as pd

FORMULA = r"(?=[=+\-@\t\r\n])"
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", re.IGNORECASE)


def guarded(column: "pd.Series[Any]") -> "pd.Series[Any]":
    """The column as it is written: an apostrophe before every text that a spreadsheet would run, but for numbers."""
    if isinstance(column.dtype, pd.StringDtype):
        return of_distinct(column, lambda cells: cells.map(safe))
    return column.map(safe) if column.dtype == object else column


def safe(cell: Any) -> Any:
    """One cell, guarded where it has to be."""
    runs = isinstance(cell, str) and re.match(FORMULA, cell) and not NUMBER.fullmatch(cell)
    return f"'{cell}" if runs else cell


def unguarded(column: "pd.Series[str]") -> "pd.Series[str]":
    """Labels as they were before an export, or the report's own tables, made them safe for spreadsheets."""
    return of_distinct(column, lambda texts: texts.str.strip().str.replace(f"^'{FORMULA}", "", regex=True))


def of_distinct(column: "pd.Series[Any]", change: Callable[["pd.Series[Any]"], "pd.Series[Any]"]) -> "pd.Series[Any]":
    """`change(column)`, worked out once for each distinct cell: of a million few are different."""
    codes, distinct = pd.factorize(column, use_na_sentinel=False)
    changed = change(pd.Series(distinct, dtype=column.dtype))
    return pd.Series(changed.array.take(codes), index=column.index, name=column.name)
