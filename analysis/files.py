"""The report's files: page, tables, figures, and results.json with a line for each record of a table."""

import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from html import unescape
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.figures.style import Drawing
from analysis.spreadsheets import guarded
from fakesss.problem import BadInput

OURS = '<p class="kicker">Report of ratings</p>'  # stands in every page of ours
LISTED = re.compile(r'href="((?:tables/[^"/\\]+\.csv)|(?:figures/[^"/\\]+\.(?:svg|png)))"')


def plain(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Records that JSON can hold; a number that does not exist is null."""
    names = [str(name) for name in table.columns]
    columns = (plain_column(table.iloc[:, place]) for place in range(len(names)))
    return [dict(zip(names, values, strict=True)) for values in zip(*columns, strict=True)]


def plain_column(column: "pd.Series[Any]") -> list[Any]:
    """The cells as Python's own types."""
    if isinstance(column.dtype, pd.StringDtype) and not column.hasnans:
        return list(column.to_numpy(object))  # tolist asks for one cell after the other
    values = column.tolist()
    if column.dtype.kind == "f":
        return [None if value != value else value for value in values] if column.hasnans else values
    return values if column.dtype.kind in "iub" else [machine(value) for value in values]


def machine(value: Any) -> Any:
    """Python's own types; NaN becomes None."""
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and math.isnan(value) else value


def save(
    out: Path, page: str, results: dict[str, Any], tables: Mapping[str, pd.DataFrame], drawings: Sequence[Drawing]
) -> None:
    """All files of the report, in place of those of an earlier one; `BadInput` where the folder cannot be written.

    Text in the tables that a spreadsheet would run as a formula is guarded (`analysis.spreadsheets`).
    """
    try:
        earlier = files_listed(out / "index.html")
        for name in ("tables", "figures"):
            (out / name).mkdir(parents=True, exist_ok=True)
        for name, table in tables.items():
            if not len(table.columns):  # nothing was shown twice, say: an empty file opens in no program
                continue
            safe = table.assign(**{str(column): guarded(table[column]) for column in table.columns})
            safe.to_csv(out / "tables" / f"{name}.csv", index=False, lineterminator="\n", encoding="utf-8")
        for drawing in drawings:
            (out / "figures" / f"{drawing.stem}.svg").write_text(drawing.svg, encoding="utf-8")
            (out / "figures" / f"{drawing.stem}.png").write_bytes(drawing.png)
        with (out / "results.json").open("w", encoding="utf-8") as file:
            file.writelines(json_lines(results))
        (out / "index.html").write_text(page, encoding="utf-8")
        stale = earlier - files_listed(out / "index.html")
        for address in {*stale, "report.pdf"} if earlier else ():  # the PDF is a print of the earlier page
            (out / address).unlink(missing_ok=True)
    except OSError as error:
        raise BadInput(f"{out}: cannot write the report ({error.strerror}); choose a folder you may write to") from None


def files_listed(page: Path) -> set[str]:
    """The tables and figures that a page of ours links to; none of another page, or of none."""
    text = page.read_text(encoding="utf-8", errors="replace") if page.is_file() else ""
    return set(map(unescape, LISTED.findall(text))) if OURS in text else set()


def json_lines(results: Mapping[str, Any]) -> Iterator[str]:
    """A JSON object, indented; of a list of records each stands on a line of its own.

    So a table reads like a table, and a quarter of a million pairs are encoded in a second (json.dumps with `indent`
    takes ten times as long for four times as many lines).
    """
    encode = json.JSONEncoder(ensure_ascii=False, allow_nan=False).encode
    before = "{\n"
    for name, value in results.items():
        yield f"{before}  {encode(name)}: "
        if isinstance(value, list) and value:
            yield "[\n    "
            yield encode(value[0])
            yield from (f",\n    {encode(each)}" for each in value[1:])
            yield "\n  ]"
        else:
            yield json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False).replace("\n", "\n  ")
        before = ",\n"
    yield "\n}\n"
