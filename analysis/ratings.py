"""Ratings from a CSV file, one row per rating: checked line by line, the latest revision kept, ready for statistics."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from analysis.columns import LABELLED, read_cells
from analysis.labels import natural_order
from analysis.spreadsheets import of_distinct, unguarded
from fakesss.problem import BadInput

MEASURED = ("rt_ms", "focus_lost_ms")
LABELS = ("participant", "session", "stimulus", "question", "repeat_of")
DEFAULT_SCALE = 7
MOST_ANSWERS = 1000  # of a scale counted answer by answer; finer ones are read as any number
SMALLEST, LARGEST = 1e-50, 1e50  # sizes of a number whose square of squares float64 still holds
MODES = ("live", "simulated", "pilot")


def read_ratings(
    path: str | Path,
    columns: Mapping[str, str] | None = None,
    scale: int | Mapping[str, int | None] | None = DEFAULT_SCALE,
    *,
    wide: str | None = None,
    question: str | None = None,
) -> pd.DataFrame:
    """The ratings of one mode in `path`, sorted by participant, stimulus and question (natural order).

    `columns` maps our names to the file's (`{"stimulus": "photo"}`); the aliases in `analysis.columns.ALIASES` need no
    mapping. `scale` is the highest answer, for all questions or for each; None allows any finite number. `wide` and
    `question` as in `analysis.columns.read_cells`. Returns `participant, stimulus, question` (text), `rating` (float,
    NaN where the file has an empty cell) and those of `analysis.columns.OPTIONAL` that the file has (text; numbers for
    `rt_ms` and `focus_lost_ms`). A person's sessions stay apart, in the order of their start. Raises `BadInput` with
    the line number of the first bad row.
    """
    path = Path(path)
    if isinstance(scale, int):
        refuse_scale(scale, f"scale: {scale}")
    frame = read_cells(path, columns or {}, wide, question)
    if frame.empty:
        raise BadInput(f"{path}: has a header but no ratings; export again after people have answered")
    for name in (label for label in LABELS if label in frame):
        frame[name] = unguarded(frame[name])
    refuse_empty_labels(frame, path)
    frame = of_one_mode(frame).copy()
    frame["rating"] = numeric_ratings(frame, scale, path)
    for name in (measured for measured in MEASURED if measured in frame):
        frame[name] = of_distinct(frame[name], lambda texts: pd.to_numeric(texts, errors="coerce"))
    frame = latest_revision(frame)
    refuse_duplicates(frame, path)
    if "started_at" in frame:
        frame = frame.sort_values("started_at", kind="stable")
    order = [c for c in ("participant", "session", "stimulus", "question", "trial", "presentation") if c in frame]
    return frame.sort_values(order, key=ranks, kind="stable").reset_index(drop=True)


def refuse_scale(highest: int, where: str) -> None:
    """`BadInput` for a scale that is none, or whose answers are too many to be told one by one."""
    if not 2 <= highest <= MOST_ANSWERS:
        raise BadInput(f"{where}: must be a whole number from 2 to {MOST_ANSWERS}, or none for any number")


def refuse_empty_labels(frame: pd.DataFrame, path: Path) -> None:
    """A rating without a participant, stimulus or question belongs nowhere."""
    for name in LABELLED:
        empty = frame.index[frame[name] == ""]
        if len(empty):
            raise BadInput(f"{path}: line {empty[0] + 2}: {name} is empty; fill it in or delete the line")


def of_one_mode(frame: pd.DataFrame) -> pd.DataFrame:
    """The rows of the first of `MODES` that occurs, all where none is noted: modes are never analysed together."""
    if "mode" not in frame:
        return frame
    mode = frame["mode"].replace("", "live")
    present = next((known for known in MODES if (mode == known).any()), None)
    return frame[mode == present].assign(mode=present) if present is not None else frame


def numeric_ratings(
    frame: pd.DataFrame, scale: int | Mapping[str, int | None] | None, path: Path
) -> "pd.Series[float]":
    """The ratings as numbers, NaN for empty cells; `BadInput` for the first one that is not on its scale."""
    text = of_distinct(frame["rating"], lambda texts: texts.str.strip())
    value: pd.Series[float] = of_distinct(text, lambda texts: pd.to_numeric(texts, errors="coerce")).astype(float)
    unreadable = (text != "") & ~np.isfinite(value)
    if scale is None:
        highest = pd.Series(np.inf, index=frame.index)
    elif isinstance(scale, int):
        highest = pd.Series(float(scale), index=frame.index)
    else:
        highest = frame["question"].map(dict(scale)).astype(float).fillna(np.inf)
    off_scale = np.isfinite(highest) & value.notna() & ((value < 1) | (value > highest) | (value != value.round()))
    size = value.abs()
    off_scale |= ((size < SMALLEST) & (size > 0)) | (size > LARGEST)
    bad = np.flatnonzero(unreadable | off_scale)
    if len(bad):
        first, top = bad[0], highest.iloc[bad[0]]
        free = f"0 or a finite number of a size from {SMALLEST:g} to {LARGEST:g}"
        must = f"a whole number from 1 to {top:g}" if np.isfinite(top) else free
        other = "; another scale is named by --scale" if isinstance(scale, int) and np.asarray(off_scale)[first] else ""
        raise BadInput(
            f'{path}: line {frame.index[first] + 2}: rating "{text.iloc[first]}": must be {must}, or empty if it is '
            f"missing{other}"
        )
    return value


def latest_revision(frame: pd.DataFrame) -> pd.DataFrame:
    """Of an answer that was changed, the last one given."""
    if "revision" not in frame:
        return frame
    key = [c for c in ("session", "participant", "trial", "presentation", "stimulus", "question") if c in frame]
    number = of_distinct(frame["revision"], lambda texts: pd.to_numeric(texts, errors="coerce")).fillna(0)
    if number.nunique() == 1:
        return frame
    latest = number.groupby([frame[name] for name in key]).transform("max")
    return frame[number == latest].copy()


def refuse_duplicates(frame: pd.DataFrame, path: Path) -> None:
    """Two answers in one session to one question about one picture, neither a repeat nor a revision, are a mistake."""
    names = [c for c in ("session", "participant", "stimulus", "question") if c in frame]
    key = frame.loc[is_first_showing(frame), names]
    twice = key[key.duplicated()]
    if len(twice):
        row = twice.iloc[0]
        raise BadInput(
            f'{path}: line {twice.index[0] + 2}: participant "{row["participant"]}" rated "{row["stimulus"]}" on '
            f'"{row["question"]}" twice; delete one line, or say which is a repeat in column repeat_of'
        )


def is_first_showing(frame: pd.DataFrame) -> "pd.Series[bool]":
    """Rows that are neither repeats nor attention checks: what the tests are about."""
    return ~is_repeat(frame) & ~is_check(frame)


def is_repeat(frame: pd.DataFrame) -> "pd.Series[bool]":
    """Rows of a picture shown again for test-retest."""
    if "repeat_of" not in frame:
        return pd.Series(False, index=frame.index)
    return frame["repeat_of"] != ""


def is_check(frame: pd.DataFrame) -> "pd.Series[bool]":
    """Rows of an instructed item ("choose 2 here"): they measure attention, not the picture."""
    if "check_expected" not in frame:
        return pd.Series(False, index=frame.index)
    return frame["check_expected"] != ""


def ranks(column: "pd.Series[str]") -> "pd.Series[int]":
    """Each label's place, for sorting: sessions in the order in which they occur, all else in natural order."""
    codes, labels = pd.factorize(column)
    ordered = list(labels) if column.name == "session" else natural_order(labels)
    place = {label: rank for rank, label in enumerate(ordered)}
    return pd.Series(np.array([place[label] for label in labels])[codes], index=column.index)
