"""Which column of a CSV file is which: names of other programs, delimiters, and files with a column a picture."""

import csv
import re
from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from fakesss.problem import BadInput, nearest

LABELLED = ("participant", "stimulus", "question")
REQUIRED = (*LABELLED, "rating")
OPTIONAL = (
    "session",
    "started_at",
    "mode",
    "trial",
    "presentation",
    "revision",
    "repeat_of",
    "check_expected",
    "check_passed",
    "rt_ms",
    "focus_lost_ms",
    "answered_at",
)
# What other programs and the thesis-shaped files call the same column; the first one found in the file counts.
ALIASES = {
    "participant": ("participant", "participant_id", "subject", "subject_id", "rater", "person", "respondent",
                    "respondent_id", "responseid", "prolific_pid"),
    "stimulus": ("stimulus", "stimulus_id", "image", "picture", "item"),
    "question": ("question", "scale", "attribute", "dimension"),
    "rating": ("rating", "response", "score", "answer", "value"),
}  # fmt: skip
NUMBERS = ("rating", "rt_ms", "focus_lost_ms")
DELIMITERS = ",;\t|"
ENCODING = "utf-8-sig"
UNNAMED = "rating"  # the question of a file that names none


def read_cells(
    path: Path, columns: Mapping[str, str], wide: str | None = None, question: str | None = None
) -> pd.DataFrame:
    """One row per rating under our names, every cell text; the index counts lines, the first below the header is 0.

    `columns`: ours -> the file's. `wide`: the form of the columns that hold a picture's ratings each ("img*", or
    "{stimulus}_{question}"). `question`: what was asked, where the file does not say; else the rating column's name.
    Raises `BadInput` for a file that is no table, and for a column that is not there.
    """
    header, delimiter = read_header(path)
    chosen = choose_columns(header, columns, path, wide)
    melted = wide_columns(header, wide, path, chosen) if wide is not None else {}
    frame = read_text(path, header, delimiter, [*chosen.values(), *melted])
    frame = lines_of_answers(frame).rename(columns={theirs: ours for ours, theirs in chosen.items()})
    if wide is not None:
        frame = long_form(frame, melted)
    if "question" not in frame:
        frame["question"] = question or chosen.get("rating", UNNAMED)
    if delimiter != ",":
        for name in (number for number in NUMBERS if number in frame):
            frame[name] = decimal_points(frame[name])
    return frame


def read_header(path: Path) -> tuple[list[str], str]:
    """The column names of a CSV file and its delimiter, or `BadInput` when it cannot be read as one."""
    found = {}
    try:
        for delimiter in DELIMITERS:
            with path.open(newline="", encoding=ENCODING) as file:
                found[delimiter] = next(csv.reader(file, delimiter=delimiter), [])
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise unreadable(path, error) from None
    delimiter = max(DELIMITERS, key=lambda each: len(found[each]))
    header = found[delimiter]
    if not any(name.strip() for name in header):
        raise BadInput(f"{path}: is empty; it needs a header line with {', '.join(REQUIRED)}")
    twice = next((name for name in header if header.count(name) > 1), None)
    if twice is not None:
        raise BadInput(f'{path}: two columns are called "{twice}"; rename one')
    return header, delimiter


def unreadable(path: Path, error: Exception) -> BadInput:
    """The sentence for a file that is no table."""
    if isinstance(error, FileNotFoundError):
        return BadInput(f"{path}: no such file; check the path")
    excel = "; an Excel file must be saved as CSV first" if path.suffix.lower() in (".xls", ".xlsx") else ""
    return BadInput(f"{path}: cannot be read ({str(error).strip()}); it must be a CSV file in UTF-8{excel}")


def choose_columns(header: list[str], columns: Mapping[str, str], path: Path, wide: str | None) -> dict[str, str]:
    """Our name -> the file's name, for every column that is there; `BadInput` when a required one is not."""
    by_plain = {plain(name): name for name in reversed(header)}
    melted = ("stimulus", "question", "rating") if wide is not None else ()
    chosen: dict[str, str] = {}
    for ours, theirs in columns.items():
        if ours not in (*REQUIRED, *OPTIONAL):
            raise BadInput(f'columns: "{ours}" is no column of ratings; {nearest(ours, (*REQUIRED, *OPTIONAL))}')
        if theirs not in header:
            raise BadInput(f'{path}: no column "{theirs}" (wanted as {ours}); {nearest(theirs, header)}')
        chosen[ours] = theirs
    refuse_two_roles(chosen, melted, path)
    for ours in (name for name in (*REQUIRED, *OPTIONAL) if name not in (*chosen, *melted)):
        found = next((by_plain[alias] for alias in ALIASES.get(ours, (ours,)) if alias in by_plain), None)
        if found is not None and found not in chosen.values():
            chosen[ours] = found
    missing = next((ours for ours in ("participant", "stimulus", "rating") if ours not in (*chosen, *melted)), None)
    if missing is not None:
        raise BadInput(
            f'{path}: no column "{missing}"; {nearest(missing, header)} Rename it in the header line, or say '
            f"--column {missing}=NAME"
        )
    return chosen


def refuse_two_roles(chosen: Mapping[str, str], melted: tuple[str, ...], path: Path) -> None:
    """`BadInput` for a column named as two of ours, and for one that a wide file has in its columns of pictures."""
    roles = list(chosen)
    for place, ours in enumerate(roles):
        if ours in melted and ours != "question":
            raise BadInput(f"{path}: the columns of --wide hold picture and rating; leave --column {ours} out")
        other = next((name for name in roles[:place] if chosen[name] == chosen[ours]), None)
        if other is not None:
            raise BadInput(f'{path}: column "{chosen[ours]}" cannot be both {other} and {ours}; name another for one')


def plain(name: str) -> str:
    """A column's name without regard to case, spaces and hyphens."""
    return re.sub(r"[\s-]+", "_", name.strip().lower())


def wide_columns(header: list[str], wide: str, path: Path, chosen: Mapping[str, str]) -> dict[str, dict[str, str]]:
    """Column -> the picture (and question) that its name says, of every column of the form `wide`."""
    pieces = re.split(r"(\*|\{stimulus\}|\{question\})", wide)
    twice = next((piece for piece in ("{stimulus}", "{question}") if pieces.count(piece) > 1), None)
    if twice is not None:
        raise BadInput(f'columns: {twice} stands twice in --wide "{wide}"; a column\'s name says it once')
    groups = {"*": ".*", "{stimulus}": "(?P<stimulus>.+)", "{question}": "(?P<question>.+)"}
    form = re.compile("".join(groups.get(piece, re.escape(piece)) for piece in pieces))
    names = [name for name in header if name not in chosen.values()]
    found = {name: {"stimulus": name, **match.groupdict()} for name in names if (match := form.fullmatch(name))}
    if not found:
        raise BadInput(f'{path}: no column has the form "{wide}" (wide); {nearest(wide, names)}')
    return found


def read_text(path: Path, header: list[str], delimiter: str, names: list[str]) -> pd.DataFrame:
    """The named columns, every cell text; an absent cell is empty."""
    try:
        refuse_surplus(path, header, delimiter)
        return pd.read_csv(
            path, sep=delimiter, dtype=str, keep_default_na=False, usecols=names, encoding=ENCODING, index_col=False,
            skip_blank_lines=False,
        )  # fmt: skip
    except (OSError, UnicodeDecodeError, csv.Error, pd.errors.ParserError) as error:
        raise unreadable(path, error) from None


def refuse_surplus(path: Path, header: list[str], delimiter: str) -> None:
    """A line with more cells than the header has names: pandas would move or drop its cells without a word."""
    width, mark = len(header), delimiter.encode()
    with path.open("rb") as file:
        if all(line.count(mark) < width for line in file):  # as good as always, and quick
            return
    with path.open(newline="", encoding=ENCODING) as file:
        reader = csv.reader(file, delimiter=delimiter)
        for cells in reader:
            if any(cells[width:]):
                raise BadInput(
                    f"{path}: line {reader.line_num}: has {len(cells)} cells, the header {width}; put a cell that "
                    f'holds "{delimiter}" in quotes'
                )


def lines_of_answers(frame: pd.DataFrame) -> pd.DataFrame:
    """Without blank lines; and Qualtrics writes two more below the header: its questions, and {"ImportId": ...}."""
    repeated = len(frame) > 1 and frame.iloc[1].str.startswith('{"ImportId"').any()
    below = frame.iloc[2:] if repeated else frame
    blank = (below.iloc[:, 0] == "") & (below == "").all(axis=1)
    return below[~blank] if blank.any() else below


def long_form(frame: pd.DataFrame, melted: Mapping[str, Mapping[str, str]]) -> pd.DataFrame:
    """One row per rating of a frame with a column a picture; a row keeps its line as index."""
    kept = [name for name in frame.columns if name not in melted]
    long = frame.melt(kept, list(melted), "stimulus", "rating", ignore_index=False)
    column = long["stimulus"]
    for name in ("question", "stimulus"):
        if name in next(iter(melted.values())):
            long[name] = column.map({key: said[name] for key, said in melted.items()})
    return long


def decimal_points(column: "pd.Series[str]") -> "pd.Series[str]":
    """Numbers of a file that writes 3,5 for 3.5; only where the comma does not part the cells."""
    return column.str.replace(r"^(\s*[+-]?\d+),(\d+\s*)$", r"\1.\2", regex=True)
