"""The screen check on the server: only known values in their ranges are kept, and the columns never change."""

import math
import re
from collections.abc import Callable
from pathlib import Path

import httpx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from study_fixture import write_study
from survey_client import Participant

from study_server.screen import screen_check
from study_server.screen.plates import PLATES
from study_server.screen.screen_check import ANSWER, CARD_MM, DERIVED, MATCHES, PARTS, asked, columns, found, gamma
from study_server.serve import served

HERE = Path(screen_check.__file__).parents[1]
DOCS = (Path(__file__).parents[2] / "docs" / "survey.md").read_text(encoding="utf-8")
ALL = ("card", "wedge", "plates")
CsvRows = Callable[..., list[dict[str, str]]]
FULL = {
    "width_px": "1920", "height_px": "1080", "window_width_px": "1280", "window_height_px": "700",
    "device_pixel_ratio": "1.25", "zoom": "1.25", "color_depth": "24", "gamut": "p3", "dynamic_range_high": "0",
    "card": "measured", "px_per_mm": "3.62", "dark_steps": "6", "light_steps": "8",
    "match_25": "136", "match_50": "186", "match_75": "224",
    "plate_1": "12", "plate_2": "47", "plate_3": "nothing", "plate_4": "26", "plate_5": "74",
}  # fmt: skip


@pytest.fixture
def screened(tmp_path: Path) -> Path:
    """A study that begins with every part of the screen check."""
    return write_study(tmp_path / "study", survey={"about": [], "screen_check": list(ALL)})


def test_what_follows_from_what_was_posted() -> None:
    told = found(FULL, ALL)
    assert set(told) == set(asked(ALL))
    assert (told["device_width_px"], told["device_height_px"], told["device_px_per_mm"]) == (2400, 1350, 4.525)
    assert told["gamma"] == pytest.approx(2.197, abs=5e-4)
    assert [told[f"plate_{index}_right"] for index in range(1, 6)] == [1, 1, 0, 0, 1]
    assert told["plates_right"] == 3


@pytest.mark.parametrize("share", [0.25, 0.5, 0.75])
@pytest.mark.parametrize("exponent", [1.0, 1.8, 2.2, 2.6])
def test_gamma_gives_back_the_exponent_of_a_screen(share: float, exponent: float) -> None:
    assert gamma(255 * share ** (1 / exponent), share) == pytest.approx(exponent)


@pytest.mark.parametrize(
    ("name", "good", "bad"),
    [
        ("px_per_mm", ("0.5", "15", "3.7812"), ("0.49", "15.1", "-3", "nan", "inf", "1e1", "3,7", "٣", "", " ")),
        ("dark_steps", ("0", "8"), ("9", "2.5", "-1", "five")),
        ("match_50", ("1", "254"), ("0", "255", "186.5")),
        ("card", ("measured", "unmoved", "none"), ("Measured", "yes", "=1+1")),
        ("gamut", ("srgb", "rec2020"), ("adobe", "<script>")),
        ("dynamic_range_high", ("0", "1"), ("2", "true", "0.5")),
        ("plate_2", ("7", "74", "nothing"), ("747", "seven", "=7", "-7", "")),
        ("width_px", ("320", "1920"), ("0", "1920.5", "9" * 400)),
    ],
)
def test_a_value_out_of_its_range_is_left_out(name: str, good: tuple[str, ...], bad: tuple[str, ...]) -> None:
    assert all(name in found({name: value}, ALL) for value in good)
    assert [value for value in bad if found({name: value}, ALL)] == []


@given(st.dictionaries(st.sampled_from([*asked(ALL), "token", "row"]), st.text() | st.floats().map(str)))
def test_whatever_is_posted_only_fitting_values_are_kept(posted: dict[str, str]) -> None:
    for name, value in found(posted, ALL).items():
        column = asked(ALL)[name]
        if column.type == "text":
            assert value in column.values or (not column.values and ANSWER.fullmatch(value))
        else:
            assert column.values == () or str(value) in column.values
            assert (column.minimum or 0) <= value <= (math.inf if column.maximum is None else column.maximum)


def test_nothing_derived_can_be_posted() -> None:
    assert found(dict.fromkeys(DERIVED, "1"), ALL) == {}


@pytest.mark.parametrize("parts", [(), ("card",), ("wedge",), ("plates",), ("plates", "card"), ALL])
def test_a_study_has_the_columns_of_its_parts_alone(parts: tuple[str, ...]) -> None:
    chosen = [part for part in PARTS if part in parts]
    expected = [name for part in (["facts", *chosen] if parts else []) for name in PARTS[part]]
    assert list(columns(parts)) == [f"screen_{name}" for name in expected]
    assert set(found(FULL, parts)) == set(expected)


def test_the_columns_stay_when_the_first_participant_leaves_the_check_out(screened: Path, csv_rows: CsvRows) -> None:
    with served(screened) as url:
        for posted in ({}, FULL):
            assert Participant(url).consent().post("screen", **posted)["step"] == "instructions"
        first, second = csv_rows(screened, url, "participants")
    names = list(columns(ALL))
    assert [name for name in first if name.startswith("screen_")] == names
    assert {first[name] for name in names} == {""}
    assert all(second[name] for name in names)
    assert (second["screen_px_per_mm"], second["screen_plate_3"], second["screen_card"]) == (
        "3.62",
        "nothing",
        "measured",
    )


def test_a_bad_form_leads_on_without_an_error(screened: Path, csv_rows: CsvRows) -> None:
    with served(screened) as url:
        person = Participant(url).consent()
        assert person.state["parts"] == list(ALL)
        junk = {"px_per_mm": "wide", "plate_1": "x" * 5000, "match_50": "\ufffd", "id": "other", "zoom": "1"}
        assert person.post("screen", **junk)["step"] == "instructions"
        person.post("screen", **FULL)  # too late: the step was left
        row = csv_rows(screened, url, "participants")[0]
    assert {name for name in columns(ALL) if row[name]} == {"screen_zoom"}


def test_a_simulated_participant_posts_what_is_kept() -> None:
    for seed in range(200):
        for parts in (ALL, ("card",), ("plates",)):
            posted = screen_check.simulated(np.random.default_rng(seed), parts)
            told = found(posted, parts)
            assert {
                name: str(told[name]) for name in posted if isinstance(told[name], str | int)
            }.items() <= posted.items()
            assert set(told) == set(asked(parts))


def test_plates_are_pictures_by_number(url: str) -> None:
    for index in range(1, len(PLATES) + 1):
        reply = httpx.get(f"{url}/plate/{index}.svg")
        assert (reply.status_code, reply.headers["content-type"]) == (200, "image/svg+xml")
        assert PLATES[index - 1].number not in re.sub(r"[\d.]+\"|#\w+", "", reply.text)
    for other in ("0", str(len(PLATES) + 1), "x", "%2e%2e", "1e0", "٣"):
        assert httpx.get(f"{url}/plate/{other}.svg").status_code == 404


def test_page_and_server_mean_the_same_things() -> None:
    page = (HERE / "templates" / "screen.html").read_text(encoding="utf-8")
    assert (
        set(re.findall(r'"(\w+)"', page[page.index("{% for name in [") : page.index("] %}")]))
        == set(PARTS["facts"]) - DERIVED
    )
    card = (HERE / "static" / "screen_card.js").read_text(encoding="utf-8")
    assert [float(mm) for mm in re.findall(r"(?:LONG|SHORT)_MM = ([\d.]+);", card)] == list(CARD_MM)
    stripes = (HERE / "static" / "screen_wedge.js").read_text(encoding="utf-8")
    lines = {int(a): int(white) / int(period) for a, period, white in re.findall(r"(\d+): \[(\d), (\d)\]", stripes)}
    assert lines == {percent: percent / 100 for percent in MATCHES}


def test_every_value_is_in_the_docs() -> None:
    about = DOCS[DOCS.index("## Screen check") :].split("\n## ")[0]
    told = [re.sub(r"plate_\d", "plate_N", name) for name in columns(ALL)]
    assert [name for name in told if f"`{name}`" not in about] == []
    for steps in (screen_check.DARK_STEPS, screen_check.LIGHT_STEPS):
        assert ", ".join(map(str, steps)) in about
