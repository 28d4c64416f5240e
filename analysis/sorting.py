"""The order of a table's rows by any of its columns, decided here: the page only moves rows."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from analysis.labels import natural_key
from analysis.tables import Table

NUMBER = re.compile(r"([<>]?)\s*([−-]?)((?:\d{1,3}(?:,\d{3})+(?!\d)|\d+)(?:\.\d+)?|\.\d+)(?:e([−+-]?\d+))?")
BEGINS_WITH_NUMBER = re.compile(r"[\[(|]?\s*[<>]?\s*[−-]?\.?\d")


@dataclass(frozen=True)
class Cell:
    """A cell as it is read; `meant` is what an empty first cell repeats from above. `place`: its rank in its column,
    from 0, equal for equal contents; None without a value, which comes last in either direction."""

    text: str
    meant: str
    place: int | None


@dataclass(frozen=True)
class Line:
    """A row of a table. `begins`: a group of rows begins here."""

    cells: tuple[Cell, ...]
    begins: bool


def sortable(table: Table) -> list[Line]:
    """The rows of `table`, each cell with its place in its column."""
    grouped = any(not row[0] for row in table.rows)
    meant: list[tuple[str, ...]] = []
    for row in table.rows:
        meant.append((row[0] or (meant[-1][0] if meant else ""), *row[1:]))
    columns = zip(*meant, strict=True)
    ranked = zip(*(places(cells, words=i < table.text_columns) for i, cells in enumerate(columns)), strict=True)
    return [
        Line(tuple(map(Cell, shown, full, place)), grouped and bool(shown[0]))
        for shown, full, place in zip(table.rows, meant, ranked, strict=True)
    ]


def places(cells: Sequence[str], words: bool) -> list[int | None]:
    """The rank of each cell: by its numbers, in a column of words as people sort words."""
    if words or not any(BEGINS_WITH_NUMBER.match(cell) for cell in cells):
        keys: list[tuple[object, ...] | None] = [natural_key(cell.casefold()) if cell else None for cell in cells]
    else:
        keys = [numbers_in(cell) if BEGINS_WITH_NUMBER.match(cell) else None for cell in cells]
    order = sorted({key for key in keys if key is not None})
    rank = {key: place for place, key in enumerate(order)}
    return [None if key is None else rank[key] for key in keys]


def numbers_in(cell: str) -> tuple[tuple[float, int], ...]:
    """Every number of the cell in turn, so that "2, 86" stands before "2, 129"; "< .0001" stands just below .0001."""
    found = []
    for relation, sign, digits, power in NUMBER.findall(cell):
        value = float(f"{digits.replace(',', '')}e{power.replace('−', '-') or 0}")
        found.append((-value if sign else value, {"<": -1, ">": 1}.get(relation, 0)))
    return tuple(found)
