"""Ratings that break statistics programs: a report or one sentence, never a traceback, a NaN or a p of 0."""

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from hard_ratings import CASES, Hard, ratings, scattered
from thesis_study import stimulus, write_manifest

from analysis import write_report
from analysis.plan import AnalysisPlan
from fakesss.problem import BadInput

REPORTED = [case for case in CASES if not case.refused]
# columns that do not apply to independent samples stand empty in the table that holds both modes
BETWEEN = {"epsilon_gg", "p_gg", "epsilon_hf", "p_hf", "mauchly_w", "mauchly_p", "partial_eta_squared", "dropped"}


def report_on(case: Hard, folder: Path) -> dict[str, Any]:
    """results.json of the case, read from the disk."""
    path = folder / "ratings.csv"
    path.write_text(case.text, encoding="utf-8")
    write_report(path, folder / "out", plan=AnalysisPlan.model_validate(case.plan), **case.options)
    text = (folder / "out" / "results.json").read_text(encoding="utf-8")

    def refuse(name: str) -> None:
        raise AssertionError(f"results.json holds {name}")

    return dict(json.loads(text, parse_constant=refuse))


def rows_of(results: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Every row of every table."""
    for name, table in results.items():
        if isinstance(table, list):
            yield from ((name, row) for row in table if isinstance(row, dict))


@pytest.mark.parametrize("case", REPORTED, ids=lambda case: case.name)
def test_a_report_and_a_sentence(case: Hard, tmp_path: Path) -> None:
    """The report is written, its words are there, no p is 0, and what has no value has a reason."""
    results = report_on(case, tmp_path)
    assert any(case.said in sentence for sentence in results["warnings"]) or not case.said
    for name, row in rows_of(results):
        for key, value in row.items():
            is_p = key == "p" or key.startswith("p_") or key.endswith("_p")
            assert not (is_p and value == 0), f"{name}: {row}"
            told = row.get("reason") or key == "reason" or results["warnings"]
            does_not_apply = name == "anova" and row["method"] == "independent samples" and key in BETWEEN
            assert value is not None or told or does_not_apply, f"{name}: {key} of {row} is null without a reason"
    page = re.sub(
        r"<style>.*?</style>|<script.*?</script>|<svg.*?</svg>",
        "",
        (tmp_path / "out/index.html").read_text(),
        flags=re.S,
    )
    assert not re.search(r"\bnan\b|\binf\b|None(?!\.)|p = \.?0+\b(?!\d)", re.sub(r"<[^>]*>", " ", page))


@pytest.mark.parametrize("case", [case for case in CASES if case.refused], ids=lambda case: case.name)
def test_one_sentence_instead_of_a_report(case: Hard, tmp_path: Path) -> None:
    """With the file, the line and the mend; nothing is written."""
    with pytest.raises(BadInput) as error:
        report_on(case, tmp_path)
    assert case.said in str(error.value) and "\n" not in str(error.value)
    assert not (tmp_path / "out").exists()


def test_the_documentation_quotes_them() -> None:
    """Every sentence of the table in docs/statistics.md is one that a case gets, and every sentence is in it."""
    docs = (Path(__file__).parents[2] / "docs" / "statistics.md").read_text(encoding="utf-8")
    table = docs.partition("## Hard cases")[2].partition("\n## ")[0]
    quoted = dict(re.findall(r"^\| (.+?) \| “(.*)” \|$", table, re.M))
    assert quoted == {case.name: case.said for case in CASES if case.said}


def f_of(results: dict[str, Any]) -> list[float]:
    """F of both modes."""
    return [row["F"] for row in results["anova"]]


def test_an_offset_changes_nothing(csv_of: Callable[[str], Path], tmp_path: Path) -> None:
    """A scale whose zero lies 1e12 away gives the same F: sums are centred before they are squared."""
    near = write_report(csv_of(ratings(lambda who, what: 10 * scattered(who, what))), tmp_path / "a", scale=None)
    far = write_report(
        csv_of(ratings(lambda who, what: 10**12 + 10 * scattered(who, what))), tmp_path / "b", scale=None
    )
    assert f_of(far) == pytest.approx(f_of(near), rel=1e-9)


def test_pictures_stand_in_natural_order(csv_of: Callable[[str], Path], tmp_path: Path) -> None:
    """ "image 2" before "image 10"."""
    names = ("image 10", "image 2", "image 1")
    results = write_report(csv_of(ratings(pictures=names)), tmp_path / "out")
    assert [row["stimulus"] for row in results["cells"]] == ["image 1", "image 2", "image 10"]


def small_study(folder: Path) -> Path:
    """Three levels of one factor, each a picture."""
    entries = [
        stimulus(place, role="factor", rows=["backlight"], label=f"backlight {level}", factors={"backlight": level})
        for place, level in enumerate((1.2, 0.8, 1.6), 1)
    ]
    return write_manifest(folder / "study", entries, {"completers_only": False})


def test_a_picture_and_a_level_nobody_rated(csv_of: Callable[[str], Path], tmp_path: Path) -> None:
    """The row has the levels that were rated; the picture is named."""
    text = ratings(pictures=("img01", "img02")).replace("shiny", "translucent")
    results = write_report(csv_of(text), tmp_path / "out", manifest=small_study(tmp_path))
    assert "Never rated: img03." in results["warnings"]
    assert {row["df1"] for row in results["anova"]} == {1}
    unseen = [row for row in results["cells"] if row["stimulus"] == "img03"]
    assert all((row["n_expected"], row["n_analysed"]) == (0, 0) for row in unseen)


@pytest.mark.long
def test_a_million_ratings(tmp_path: Path) -> None:
    """2,000 people x 500 pictures: the report is written, with every person and picture in it."""
    people, pictures = 2000, 500
    frame = pd.DataFrame(
        {
            "participant": [f"p{who}" for who in range(people) for _ in range(pictures)],
            "stimulus": [f"image {what}" for _ in range(people) for what in range(pictures)],
            "question": "shiny",
            "rating": [scattered(who, what) for who in range(people) for what in range(pictures)],
        }
    )
    frame.to_csv(tmp_path / "million.csv", index=False)
    results = write_report(tmp_path / "million.csv", tmp_path / "out")
    assert (results["n_analysed"], len(results["cells"]), len(results["participants"])) == (2000, 500, 2000)
