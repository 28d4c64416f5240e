"""Tables 4.4 and 4.5 of the thesis, digit by digit, from ratings shaped to print them; every number against R."""

import csv
import json
from pathlib import Path

import pandas as pd
import pytest
from thesis_study import COMPARISON, thesis_stimuli, write_manifest

from analysis.plan import AnalysisPlan
from analysis.ratings import read_ratings
from analysis.results import METHODS, Analysed, analyse
from analysis.rows import rows_of
from analysis.sample import draw_sample
from analysis.study import read_manifest
from analysis.tables import table_4_4, table_4_5

DATA = Path(__file__).parents[1] / "data" / "statistics"
FIXTURES = {"repeated": "thesis_shaped_repeated_n44", "independent": "thesis_shaped_independent_n29"}
FACTOR = {"Thickness": "thickness exponent", "Backlight": "backlight", "Diffuse": "diffuse weight"}
PRINTED = {"Thickness": "Thickness", "Backlight": "Backlight", "Diffuse": "Diffuse W."}
# tables 4.4 as printed, p as (thesis's digits); Translucent x diffuse weight was misprinted "< .0001": see below
TABLE_4_4 = {
    ("realistic", "Thickness"): ("0.087", "2.52"),
    ("translucent", "Thickness"): ("< .0001", "22.43"),
    ("varnished", "Thickness"): ("0.093", "2.45"),
    ("realistic", "Backlight"): ("0.5197", "0.66"),
    ("translucent", "Backlight"): ("0.0012", "7.27"),
    ("varnished", "Backlight"): ("0.398", "0.93"),
    ("realistic", "Diffuse"): ("0.887", "0.12"),
    ("varnished", "Diffuse"): ("0.423", "0.87"),
}
TABLE_4_5 = [
    ("M1 vs M2", "Non significant"),
    ("M1 vs M3", "P < .01"),
    ("M1 vs M4", "Non significant"),
    ("M2 vs M3", "P < .01"),
    ("M2 vs M4", "P < .05"),
    ("M3 vs M4", "P < .01"),
]


@pytest.fixture(scope="module", params=list(FIXTURES))
def found(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> list[Analysed]:
    """All rows of one fixture, analysed in the mode it was shaped for."""
    folder = tmp_path_factory.mktemp("thesis")
    study = read_manifest(write_manifest(folder / "study", thesis_stimuli(), {"comparison": [COMPARISON]}))
    sample = draw_sample(read_ratings(DATA / f"{FIXTURES[request.param]}.csv"), study.plan)
    rows, notes = rows_of(study, study.plan, sample.ratings)
    assert not notes
    return [analyse(row, sample, study.plan, request.param, {}) for row in rows]


def by_row(found: list[Analysed]) -> dict[tuple[str, str], Analysed]:
    """(question, factor) -> analysis."""
    return {(each.row.question, each.row.name): each for each in found}


def test_table_4_4_prints_the_thesis(found: list[Analysed]) -> None:
    """p to the thesis's digits (it gives three or four places) and F to two."""
    table = table_4_4(found, AnalysisPlan(alpha=0.10))
    assert METHODS[found[0].mode] in table.caption and "10%" in table.caption
    cells = {row[0]: row for row in table.rows}
    for (question, factor), (p, f) in TABLE_4_4.items():
        row = cells[f"{question.capitalize()} vs {FACTOR[factor]}"]
        assert row[2] == f
        if p.startswith("<"):
            assert row[1] == p
        else:
            assert f"{float(row[6]):.{len(p) - 2}f}" == p
            assert row[1] == (p if len(p) == 5 or float(p) < 0.01 else f"{float(p):.3f}")
    assert cells["Offline images vs ours"][1:3] == ("< .0001", "59.59")


def test_the_misprinted_row(found: list[Analysed]) -> None:
    """The thesis prints p < .0001 for F = 9.62; with its numbers of people p is .0002 (it needs df2 >= 211)."""
    row = next(row for row in table_4_4(found, AnalysisPlan()).rows if row[0] == "Translucent vs diffuse weight")
    assert row[1:3] == ("0.0002", "9.62")


def test_table_4_5_prints_the_thesis(found: list[Analysed]) -> None:
    """HSD[.05] = 0.82 and HSD[.01] = 1, and the six verdicts, though |M2 - M4| also prints as 1."""
    each = next(each for each in found if each.row.kind == "comparison")
    table = table_4_5(each)
    assert [row[:2] for row in table.rows] == TABLE_4_5
    assert "HSD[.05] = 0.82; HSD[.01] = 1)" in table.caption and METHODS[each.mode] in table.caption
    n, df = (44, 129) if each.mode == "repeated" else (29, 112)
    assert f"n = {n}, df = {df}, MSE = " in table.note


def test_every_number_agrees_with_r(found: list[Analysed]) -> None:
    """F, p, MSE and df to 1e-9 of R 4.2.2; HSD to 1e-7, the accuracy of R's qtukey."""
    reference = json.loads((DATA / "thesis_shaped_reference_R.json").read_text())[FIXTURES[found[0].mode]]
    rows = by_row(found)
    for name, expected in reference.items():
        question, _, factor = name.partition(" ")
        key = ("translucent", "offline images vs ours") if "samples" in expected else (question, FACTOR[factor])
        each = rows[key]
        assert each.anova is not None
        assert (each.anova["df1"], each.anova["df2"]) == (expected["df1"], expected["df2"])
        for mine, theirs in ((each.anova["F"], "F"), (each.anova["p"], "p"), (each.mse, "MSE")):
            assert mine == pytest.approx(expected[theirs], rel=1e-9)
        if "samples" in expected:
            assert [level.stimuli[0] for level in each.row.levels] == expected["samples"]
            assert each.hsd == pytest.approx((expected["HSD05"], expected["HSD01"]), rel=1e-7)
            check_pairs(each.tukey, expected)


def check_pairs(table: pd.DataFrame | None, expected: dict[str, list[str]]) -> None:
    """Verdict, difference and Tukey p of each pair, as far as R's reference prints them."""
    assert table is not None
    for pair, text in zip(table.to_dict("records"), expected["pairs"], strict=True):
        samples, _, rest = text.partition(": ")
        assert samples == f"{pair['a']} vs {pair['b']}"
        difference, p = (float(part.split("=")[1].rstrip(")")) for part in rest.split(" (")[1].split(", "))
        assert abs(pair["difference"]) == pytest.approx(difference, abs=5e-5)
        assert pair["p"] == pytest.approx(p, rel=5e-3) if p > 1e-6 else pair["p"] < 1e-9


def test_the_shared_table_is_the_one_tested() -> None:
    """The file of printed values says what `TABLE_4_4` says."""
    with (DATA / "table_4_4.csv").open() as file:
        rows = {row["configuration"]: row for row in csv.DictReader(file)}
    names = {"realistic": "Realistic", "translucent": "Translucent", "varnished": "Varnish finish"}
    for (question, factor), (p, f) in TABLE_4_4.items():
        row = rows[f"{names[question]} vs {PRINTED[factor]}"]
        assert (row["p_printed"].replace("<.", "< ."), row["F_printed"]) == (p, f)
