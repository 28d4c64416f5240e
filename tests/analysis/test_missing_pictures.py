"""A picture that a person has no line for is an answer missing, where the file shows that all were to rate all."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from hard_ratings import EVERYBODY, ratings, without

from analysis import write_report
from analysis.absent import with_absent
from analysis.plan import AnalysisPlan

Write = Callable[[str], Path]
SOME = without(ratings(people=14), 'p1,"a"', 'p2,"b"', 'p2,"c"', 'p3,"c"')


def report(path: Path, **plan: Any) -> tuple[dict[str, Any], str]:
    """results.json and the text of the page."""
    out = path.parent / "out"
    write_report(path, out, plan=AnalysisPlan.model_validate(plan))
    page = re.sub(r"<(style|script|svg).*?</\1>", "", (out / "index.html").read_text(), flags=re.S)
    return json.loads((out / "results.json").read_text()), " ".join(re.sub(r"<[^>]*>", " ", page).split())


def test_absent_lines_are_missing_answers(csv_of: Write) -> None:
    """Counted for each picture and for each person, and said at the head how many the tests rest on."""
    results, page = report(csv_of(SOME), **EVERYBODY)
    cells = {row["stimulus"]: (row["n_expected"], row["n_answered"], row["n_missing"]) for row in results["cells"]}
    assert cells == {"a": (14, 13, 1), "b": (14, 13, 1), "c": (14, 12, 2)}
    missing = {row["participant"]: row["missing"] for row in results["participants"]}
    assert {who: n for who, n in missing.items() if n} == {"p1": 1, "p2": 2, "p3": 1}
    assert "4 answers missing." in results["warnings"]
    head = page.partition("Before believing")[0]
    assert "14 started, 11 completed, 14 are analysed" in head.replace("people ", "") and "11 of the 14" in head
    assert "3 of 14 participants stand out" in head
    assert "12 of 14" in page and '"40 of 44"' not in page


def test_a_legend_explains_a_cell_that_is_there(csv_of: Write) -> None:
    """The first cell with fewer answers than people."""
    _, page = report(csv_of(SOME), **EVERYBODY)
    assert "&#34;13 of 14&#34;: 13 answers are analysed" in page


def test_a_part_of_the_pictures_each_lacks_nothing(csv_of: Write) -> None:
    """An incomplete design: nobody has all pictures, and nobody is said to have left one out."""
    text = without(ratings(people=9), *(f'p{who},"{"abc"[who % 3]}"' for who in range(9)))
    results, _ = report(csv_of(text), **EVERYBODY)
    assert {row["missing"] for row in results["participants"]} == {0}


@pytest.mark.parametrize("mode", ["repeated", "independent"])
def test_lines_are_added_for_first_showings(mode: Any) -> None:
    """With the person's session and mode, every other text empty; not between people; repeats need no line."""
    rows = [(f"p{who}", f"s{who}", "live", what, "q", 3.0, 900.0, "") for who in range(4) for what in "ab"]
    frame = pd.DataFrame(
        [*rows[:-1], ("p0", "s0", "live", "ar", "q", 3.0, 900.0, "a")],
        columns=["participant", "session", "mode", "stimulus", "question", "rating", "rt_ms", "repeat_of"],
    )
    added = with_absent(frame, mode).iloc[len(frame) :]
    if mode == "independent":
        assert added.empty
        return
    (line,) = added.astype(object).fillna("none").itertuples(index=False, name=None)
    assert line == ("p3", "s3", "live", "b", "q", "none", "none", "")


def test_one_sample_of_people_declared_as_two(csv_of: Write) -> None:
    """The declared mode is used, and said to be wrong; right samples have no such warning."""
    results, _ = report(csv_of(ratings()), mode="independent")
    assert any("samples of the same people are not independent" in sentence for sentence in results["warnings"])
    apart = "participant,stimulus,question,rating\n" + "".join(
        f"p{who},{'ab'[who % 2]},shiny,{1 + who % 5}\n" for who in range(12)
    )
    results, _ = report(csv_of(apart), mode="independent")
    assert not any("not independent" in sentence for sentence in results["warnings"])
