"""What the trade-off measures: bands, orders, errors, the document's shape; an interrupted run that continues."""

import csv
import io
import json
import math
import tomllib
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from scipy.stats import binom

import fakesss.cli_measure  # noqa: F401  (adds its commands)
from fakesss.accuracy import measuring, measuring_knobs, tradeoff_kept
from fakesss.accuracy.measuring import Timing, coverage, faster, in_rounds, median_band, timing
from fakesss.accuracy.tradeoff import Effort, Found, pictures, tradeoff
from fakesss.accuracy.tradeoff_document import as_csv, as_text, documents
from fakesss.cli import commands
from fakesss.knob import knobs
from fakesss.problem import BadInput
from fakesss.scene import Scene

SMALL = Scene(object="torus:1000", size=(48, 40)).replace({"light.shadows": True, "occlusion.rays": 16})
KNOBS = ("supersampling", "shadow filter", "occlusion rays")
EFFORT = Effort(rounds=3, combinations=5, again=2)
ERRORS = {"rmse", "max_abs", "flip", "flip_everywhere"}


@pytest.fixture(scope="module", autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Nothing of the user's, nothing left there."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FAKESSS_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.fixture(scope="module")
def found(own_cache: None) -> Found:
    return tradeoff([SMALL], KNOBS, EFFORT, budget_ms=33.0, quiet=True)


@pytest.fixture(scope="module")
def document(found: Found) -> dict[str, Any]:
    return documents(found, ["torus:1000"], "fakesss tradeoff torus:1000")[0]


@pytest.mark.parametrize("rounds", [6, 7, 9, 15, 40])
def test_the_band_holds_the_median_as_often_as_it_says(rounds: int) -> None:
    low, high = median_band(range(1, rounds + 1))
    achieved = binom.cdf(high - 1, rounds, 0.5) - binom.cdf(low - 1, rounds, 0.5)
    narrower = binom.cdf(high - 2, rounds, 0.5) - binom.cdf(low, rounds, 0.5)
    assert narrower < 0.95 <= achieved
    assert coverage(rounds) == pytest.approx(achieved)


def test_of_few_rounds_the_band_is_all_of_them() -> None:
    assert median_band([3.0, 1.0, 2.0]) == (1.0, 3.0)
    assert [coverage(rounds) for rounds in (2, 3, 5)] == [0.5, 0.75, 0.9375]


@pytest.mark.parametrize("mood", [lambda now: 1 + now, lambda now: 1.5 + math.sin(9 * now)], ids=["tiring", "moody"])
def test_what_a_machine_does_within_a_round_does_not_tell_equal_levels_apart(
    monkeypatch: pytest.MonkeyPatch, mood: Callable[[float], float]
) -> None:
    """Eight levels that are the same, on a machine that takes between one and five times as long as it goes on."""
    clock = {"now": 0.0}

    def draw() -> None:
        clock["now"] += 0.01 * mood(clock["now"] % 1.0)

    monkeypatch.setattr(measuring.time, "perf_counter", lambda: clock["now"])
    pairs = in_rounds(dict.fromkeys(range(8), draw), draw, 15)
    found = [timing(each, 10.0) for each in pairs.values()]
    assert [one.ratio for one in found] == pytest.approx([1.0] * 8, abs=0.03)


def test_each_round_has_an_order_of_its_own_and_every_run_the_same() -> None:
    def run() -> str:
        drawn: list[str] = []
        in_rounds({name: partial(drawn.append, name) for name in "abcdef"}, partial(drawn.append, "-"), 4)
        return "".join(drawn[1::2])  # each is drawn once before it counts

    told = run()
    rounds = [told[13 * number : 13 * (number + 1)] for number in range(4)]
    assert all(one[::2] == "-" * 7 and sorted(one[1::2]) == list("abcdef") for one in rounds)
    assert len({one[1::2] for one in rounds}) > 1
    assert run() == told


def test_what_is_told_apart_is_told_round_by_round() -> None:
    """Each round is of another speed, so separate bands overlap where the pairs do not."""
    slow, fast = Timing((1.0, 2.0, 3.0, 4.0, 5.0, 6.0), 1.0), Timing((0.9, 1.8, 2.8, 3.7, 4.6, 5.5), 1.0)
    assert fast.band[1] > slow.band[0]
    assert faster(fast.ratios, slow.ratios) and not faster(slow.ratios, fast.ratios)
    assert not faster((0.9, *slow.ratios[1:5], 6.1), slow.ratios)


def test_the_document_has_the_contracts_shape(document: dict[str, Any]) -> None:
    document = json.loads(json.dumps(document))
    assert {"knobs", "presets", "combinations", "unused", "machine", "method", "command"} <= document.keys()
    assert [knob["name"] for knob in document["knobs"]] == list(KNOBS)
    for knob in document["knobs"]:
        assert {"name", "reference", "points", "pareto", "recommended"} <= knob.keys()
        values = [point["value"] for point in knob["points"]]
        assert knob["recommended"] in values
        assert set(knob["pareto"]) <= set(values)
        for point in knob["points"]:
            assert {"value", "ms", *ERRORS} <= point.keys()
            assert point["total"].keys() == ERRORS
            assert point["ratio_low"] <= point["ratio"] <= point["ratio_high"]
    assert document["presets"].keys() == {"interactive", "survey", "reference"}


def test_a_reference_is_not_off_and_what_is_worse_is(document: dict[str, Any]) -> None:
    by_name = {knob["name"]: {point["value"]: point for point in knob["points"]} for knob in document["knobs"]}
    assert by_name["supersampling"][8]["rmse"] == by_name["shadow filter"]["pcf"]["flip"] == 0
    falling = [by_name["supersampling"][samples]["rmse"] for samples in (1, 2, 4, 8)]
    assert falling == sorted(falling, reverse=True)
    assert by_name["shadow filter"]["hard"]["rmse"] > 0


def test_bakes_are_told_in_seconds_and_the_rest_is_not(document: dict[str, Any]) -> None:
    baked = {knob["name"]: ["bake_seconds" in point for point in knob["points"]] for knob in document["knobs"]}
    assert {name for name, are in baked.items() if all(are)} == {"occlusion rays"}
    assert not any(baked["supersampling"])


def test_combinations_are_one_level_of_each_knob_that_some_nothing_beats(document: dict[str, Any]) -> None:
    measured = document["combinations"]
    assert all(entry["values"].keys() == set(KNOBS) for entry in measured)
    best = [(entry["ms"], entry["flip"]) for entry in measured if entry["front"]]
    assert best
    assert all(not (a[0] < b[0] and a[1] < b[1]) for a in best for b in best)
    assert document["presets"]["reference"]["values"]["occlusion rays"] == 16384


def test_pictures_are_those_of_every_level_and_reference(found: Found) -> None:
    made = pictures(found.places[0])
    expected = {(knob.name, str(level.value)) for knob in knobs() if knob.name in KNOBS for level in knob.all_levels}
    assert made.keys() == {*expected, ("", "reference")}
    assert all(picture.shape == (40, 48, 4) for picture in made.values())


def test_the_table_has_one_row_a_level(document: dict[str, Any]) -> None:
    rows = list(csv.DictReader(io.StringIO(as_csv(document))))
    assert len(rows) == sum(len(knob["points"]) for knob in document["knobs"]) + 3
    point = document["knobs"][0]["points"][0]
    assert (float(rows[0]["ms"]), float(rows[0]["total_flip"])) == (point["ms"], point["total"]["flip"])
    survey, preset = rows[-2], document["presets"]["survey"]
    assert (survey["knob"], survey["value"], survey["reference"]) == ("preset", "survey", "reference")
    assert float(survey["flip_everywhere"]) == preset["from_reference"]["flip_everywhere"]
    assert float(survey["total_flip_everywhere"]) == preset["flip_everywhere"]
    text = as_text(document)
    for what, found in (("exact picture", preset), ("reference preset", preset["from_reference"])):
        assert f"from the {what}: FLIP {found['flip']:.4f}, everywhere {found['flip_everywhere']:.3f}" in text
    assert all(str(word) in text for word in ("SHADOW FILTER", "pcf", "SURVEY"))


def left() -> set[Path]:
    """What is kept of runs that have not written their results."""
    return set((Path(tradeoff_kept.cache.folder()) / tradeoff_kept.KIND).glob("*.npz"))


def test_an_interrupted_run_continues_and_a_finished_one_is_measured_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    timed: list[Any] = []
    real = measuring_knobs.in_rounds

    def counted(ways: Any, *others: Any) -> Any:
        timed.append(list(ways))
        if len(timed) == 2:
            raise KeyboardInterrupt
        return real(ways, *others)

    before = left()
    monkeypatch.setattr(measuring_knobs, "in_rounds", counted)
    asked = ("shadow filter", "supersampling")
    with pytest.raises(KeyboardInterrupt):
        tradeoff([SMALL], asked, EFFORT, quiet=True)
    tradeoff([SMALL], asked, EFFORT, quiet=True)
    assert [len(ways) for ways in timed] == [2, 6, 6]  # the filter was measured once
    tradeoff([SMALL], asked, EFFORT, quiet=True).kept.forget()
    assert len(timed) == 3  # nothing was written yet
    tradeoff([SMALL], asked, EFFORT, quiet=True).kept.forget()
    assert [len(ways) for ways in timed[3:]] == [2, 6]
    assert left() == before


def test_an_unknown_knob_names_the_nearest() -> None:
    with pytest.raises(BadInput, match=r'^--knob "shadow tabs": is no knob; did you mean "shadow taps"'):
        tradeoff([SMALL], ["shadow tabs"], EFFORT)


def test_a_scene_without_use_for_the_knobs_says_why() -> None:
    with pytest.raises(BadInput, match=r'uses none of the knobs \(shadow taps: shadow\.filter is "pcf"\)'):
        tradeoff([SMALL], ["shadow taps"], EFFORT)


def test_the_command_writes_page_data_and_presets(tmp_path: Path) -> None:
    first, second = tmp_path / "first.toml", tmp_path / "second.toml"
    lines = 'object = "torus:1000"\nsize = [48, 40]\nlight.shadows = true\nocclusion.enabled = false\n'
    first.write_text(lines, encoding="utf-8")
    second.write_text(lines + "light.azimuth = 10.0\n", encoding="utf-8")
    out, presets = tmp_path / "out", tmp_path / "presets.toml"
    arguments = ["tradeoff", str(first), str(second), "--knob", "shadow filter", "--quick", "--json"]
    ran = CliRunner().invoke(commands, [*arguments, "-o", str(out), "--presets-out", str(presets)])
    assert ran.exit_code == 0, ran.output
    told = json.loads(ran.stdout)["scenes"]
    for number, document in enumerate(told, 1):
        folder = out / f"{number}-{'first' if number == 1 else 'second'}"
        assert json.loads((folder / "tradeoff.json").read_text(encoding="utf-8")) == document
        assert {"index.html", "tradeoff.csv"} <= {path.name for path in folder.iterdir()}
    written = tomllib.loads(presets.read_text(encoding="utf-8"))
    assert written["measured"]["scenes"] == [str(first), str(second)]
    worst = max(document["presets"]["reference"]["flip"] for document in told)
    assert written["reference"]["flip"] == pytest.approx(worst, abs=1e-5)
    assert written["reference"]["settings"]["shadow filter"] == {"shadow.filter": "pcf"}


def test_nothing_is_lost_where_the_page_cannot_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same command goes on from what was measured: nothing is timed again."""
    scene = tmp_path / "scene.toml"
    scene.write_text('object = "torus:1000"\nsize = [48, 40]\nlight.shadows = true\n', encoding="utf-8")
    arguments = ["tradeoff", str(scene), "--knob", "shadow filter", "--quick", "-o", str(tmp_path / "out")]

    before = left()

    def full(*_: Any) -> None:
        raise BadInput("index.html: cannot be written (No space left on device)")

    with monkeypatch.context() as patch:
        patch.setattr("fakesss.accuracy.page.write_page", full)
        ran = CliRunner().invoke(commands, arguments)
        assert isinstance(ran.exception, BadInput)
    assert left() > before
    with monkeypatch.context() as patch:
        patch.setattr(measuring_knobs, "in_rounds", None)
        assert CliRunner().invoke(commands, arguments).exit_code == 0
    assert left() == before


@pytest.mark.parametrize("name", ["index.html", "tradeoff.csv", "tradeoff.json"])
def test_what_cannot_be_written_is_told_before_measuring(tmp_path: Path, name: str) -> None:
    (tmp_path / "out" / name).mkdir(parents=True)
    ran = CliRunner().invoke(commands, ["tradeoff", "torus:1000", "--quick", "-o", str(tmp_path / "out")])
    assert name in str(ran.exception) + ran.output
    assert ran.exit_code != 0


@pytest.mark.parametrize("budget", ["nan", "inf", "0", "-3"])
def test_a_budget_is_a_number_of_milliseconds(budget: str) -> None:
    ran = CliRunner().invoke(commands, ["tradeoff", "torus:1000", "--budget-ms", budget])
    assert ran.exit_code == 2
    assert "--budget-ms" in ran.output
