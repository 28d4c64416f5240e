"""The files of a report: the same bytes on any number of cores, none left from before, none that a spreadsheet runs."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from hard_ratings import HEAD, ratings, scattered
from thesis_study import thesis_stimuli, write_manifest

from analysis import write_report
from analysis.plan import AnalysisPlan
from analysis.spreadsheets import guarded, unguarded

DATA = Path(__file__).parents[1] / "data" / "statistics"
PROGRAM = """
import sys
from pathlib import Path
from analysis import write_report
write_report(Path(sys.argv[1]), Path(sys.argv[2]), manifest=Path(sys.argv[3]))
"""


def bytes_of(folder: Path) -> dict[str, bytes]:
    """Every number that a report holds."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*.[cj]s*")}


def test_the_number_of_threads_changes_no_digit(tmp_path: Path) -> None:
    """A library of linear algebra adds in another order on two cores than on one."""
    manifest = write_manifest(tmp_path / "study", thesis_stimuli(), {"tests": ["mixed"]})
    frame = pd.read_csv(DATA / "thesis_shaped_repeated_n44.csv")
    frame[frame["scale"] == "translucent"].to_csv(tmp_path / "ratings.csv", index=False)
    for threads in ("1", "2"):
        names = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
        words = [sys.executable, "-c", PROGRAM, "ratings.csv", threads, str(manifest)]
        subprocess.run(words, check=True, cwd=tmp_path, env={**os.environ, **dict.fromkeys(names, threads)})
    one, two = bytes_of(tmp_path / "1"), bytes_of(tmp_path / "2")
    assert one.keys() == two.keys() and [name for name in one if one[name] != two[name]] == []


def test_a_second_report_leaves_nothing_of_the_first(csv_of: Callable[[str], Path], tmp_path: Path) -> None:
    """Tables and figures that the new page does not list are gone; what the researcher put there stays."""
    out = tmp_path / "out"
    plan = AnalysisPlan.model_validate({"equivalence": {"margin": 1}})
    write_report(csv_of(ratings()), out, plan=plan)
    (out / "report.pdf").write_bytes(b"the page as it was")
    theirs = [out / "tables" / "mine.csv", out / "figures" / "sketch.png", out / "notes.txt"]
    for path in theirs:
        path.write_text("mine")
    assert (out / "tables" / "equivalence.csv").is_file() and list((out / "figures").glob("figure-equivalence*.svg"))
    write_report(csv_of(ratings()), out)
    assert not (out / "tables" / "equivalence.csv").exists() and not (out / "report.pdf").exists()
    assert not list((out / "figures").glob("figure-equivalence*"))
    assert all(path.read_text() == "mine" for path in theirs)
    again = tmp_path / "again"
    write_report(csv_of(ratings()), again)
    left = {str(path.relative_to(out)) for path in out.rglob("*") if path.is_file() and path not in theirs}
    assert left == {str(path.relative_to(again)) for path in again.rglob("*") if path.is_file()}


def test_a_page_that_is_not_ours_names_nothing_of_ours(csv_of: Callable[[str], Path], tmp_path: Path) -> None:
    """Of a folder with another index.html nothing is removed but what has our names."""
    out = tmp_path / "out"
    (out / "tables").mkdir(parents=True)
    (out / "tables" / "theirs.csv").write_text("a\n")
    (out / "index.html").write_text('<a href="tables/theirs.csv">mine</a>')
    write_report(csv_of(ratings()), out)
    assert (out / "tables" / "theirs.csv").is_file()


@pytest.mark.parametrize("name", ["=1+1", "@x", "-x", "+x", "\tx"])
def test_a_spreadsheet_runs_no_cell(csv_of: Callable[[str], Path], tmp_path: Path, name: str) -> None:
    """A participant's name that is a formula has an apostrophe in every table, and none where it is read again."""
    rows = [f'{name.strip() if who == 0 else f"p{who}"},{what},shiny,{scattered(who, ord(what) - 97)}\n'
            for who in range(6) for what in "abc"]  # fmt: skip
    name = name.strip()
    text = HEAD + "".join(row for place, row in enumerate(rows) if place != 1)
    write_report(csv_of(text), tmp_path / "out")
    table = pd.read_csv(tmp_path / "out" / "tables" / "participants.csv", dtype=str)["participant"]
    if name.startswith(tuple("=@-+")):
        assert f"'{name}" in set(table)
    assert name in set(unguarded(table))
    for path in (tmp_path / "out" / "tables").glob("*.csv"):
        cells = pd.read_csv(path, dtype=str, keep_default_na=False).to_numpy(str).ravel()
        assert not [cell for cell in cells if cell[:1] in "=@" and cell]
        assert name not in cells or name == "x"


def test_numbers_stay_numbers() -> None:
    """A negative number is no formula, as text either; guarding and reading back is the identity."""
    cells = pd.Series(["-35", "-1.5e3", "-35 minus 0", "=A1", "+2", "+a", "plain", ""])
    safe = guarded(cells)
    assert list(safe) == ["-35", "-1.5e3", "'-35 minus 0", "'=A1", "+2", "'+a", "plain", ""]
    assert list(unguarded(safe)) == list(cells)
