"""Presets: which combination is which, the file that is shipped, and what `quality` makes of it in a scene."""

import datetime
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fakesss import quality, render
from fakesss.accuracy.errors import JUST_NOTICEABLE
from fakesss.accuracy.measuring import Timing
from fakesss.accuracy.measuring_combinations import Combination
from fakesss.accuracy.presets import as_toml, chosen
from fakesss.inspect import explain
from fakesss.knob import knobs
from fakesss.problem import BadInput
from fakesss.scene import Scene

ROOT = Path(__file__).parents[2]
NAMES = ("interactive", "survey", "reference")


def combination(ms: float, flip: float, everywhere: float, **values: Any) -> Combination:
    found = {"rmse": flip / 10, "max_abs": flip, "flip": flip, "flip_everywhere": everywhere}
    exact = {name: value + 0.2 for name, value in found.items()} | {"flip": flip}  # what no knob mends
    return Combination(values, {}, (Timing((ms / 11, *(ms / 10,) * 6, ms / 9), 10.0),), (exact,), (found,))


FAST, GOOD, FINE, BEST = (
    combination(5, 0.09, 0.5),
    combination(30, 0.04, 0.2),
    combination(60, 0.02, JUST_NOTICEABLE - 0.001),
    combination(200, 0.001, 0.03),
)


def test_the_presets_are_the_best_in_the_budget_the_cheapest_below_noticeable_and_the_best() -> None:
    found = chosen([FAST, GOOD, FINE, BEST], BEST, 33.0)
    assert [found[name].combination for name in NAMES] == [GOOD, FINE, BEST]
    assert all(preset.met for preset in found.values())


def test_what_cannot_be_kept_is_said() -> None:
    found = chosen([GOOD, FAST], GOOD, 1.0)
    assert (found["interactive"].combination, found["interactive"].met) == (FAST, False)
    assert (found["survey"].combination, found["survey"].met) == (GOOD, False)
    assert "nothing keeps within 1 ms" in found["interactive"].because
    assert "nothing stays below" in found["survey"].because


def test_of_times_that_cannot_be_told_apart_the_nearer_to_the_reference_is_taken() -> None:
    other = combination(60.5, 0.03, JUST_NOTICEABLE - 0.05)
    alike = replace(other, timings=(Timing(tuple(np.roll(other.timings[0].ratios, 3)[::-1]), 10.0),))
    slower = combination(80, 0.001, 0.0)
    assert chosen([FINE, alike, slower], BEST, 33.0)["survey"].combination == alike


def test_of_several_scenes_the_worst_counts() -> None:
    easy, hard = combination(10, 0.01, 0.05), combination(90, 0.05, 0.3)
    both = Combination(
        {}, {}, (*easy.timings, *hard.timings), (*easy.errors, *hard.errors), easy.from_reference + hard.from_reference
    )
    assert both.worst.ms == pytest.approx(90)
    assert both.costs[1:] == (0.05, 0.3)


@pytest.fixture
def presets(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    """A presets file of what a search may find, instead of the shipped one."""
    values = {
        "blur kernel": "3x3",
        "second-layer faces": 8000,
        "supersampling": 2,
        "occlusion rays": 64,
        "screen-space samples": 32,
    }
    low = combination(30, 0.04, 0.2, **values)
    high = combination(
        99, 0.0, 0.0, **{**values, "blur kernel": "9x9", "second-layer faces": "all", "supersampling": 8}
    )
    text = as_toml(chosen([low], high, 33.0), knobs(), {"command": "fakesss tradeoff figure"})
    (tmp_path / "presets.toml").write_text(text, encoding="utf-8")
    monkeypatch.setattr(quality, "PRESETS", tmp_path / "presets.toml")
    quality.presets.cache_clear()
    yield
    quality.presets.cache_clear()


@pytest.mark.usefixtures("presets")
def test_quality_fills_what_the_scene_leaves_alone() -> None:
    scene = Scene.from_dict({"quality": "survey", "occlusion": {"rays": 77, "bias": 0.01}}, "scene.toml")
    assert (scene.supersampling, scene.layers.faces, scene.blur.kernel) == (2, 8000, "3x3")
    assert (scene.occlusion.rays, scene.occlusion.bias, scene.occlusion.samples) == (77, 0.01, 32)
    assert Scene().layers.faces is None  # a default shared between scenes


@pytest.mark.usefixtures("presets")
def test_a_knob_of_which_the_scene_sets_one_field_is_the_scenes() -> None:
    scene = Scene.from_dict({"quality": "survey", "blur": {"enabled": False}}, "scene.toml")
    assert (scene.blur.enabled, scene.blur.kernel) == (False, "5x5")


@pytest.mark.usefixtures("presets")
def test_another_quality_and_none_begin_from_what_the_scene_says() -> None:
    scene = Scene.from_dict({"quality": "survey", "occlusion": {"rays": 77}}, "scene.toml")
    best = scene.replace({"quality": "reference"})
    assert (best.supersampling, best.layers.faces, best.occlusion.rays) == (8, None, 77)
    assert best.replace({"quality": None}) == Scene().replace({"occlusion.rays": 77})
    assert scene.replace({"supersampling": 1}).supersampling == 1


@pytest.mark.usefixtures("presets")
def test_a_scene_read_from_a_manifest_keeps_its_settings() -> None:
    scene = Scene.from_dict({"quality": "survey", "material": {"backlight": 0.5}}, "scene.toml")
    again = Scene.from_dict(scene.model_dump(mode="json"), "manifest.json")
    assert again == scene
    assert again.sha256() == scene.sha256()


@pytest.mark.usefixtures("presets")
def test_another_quality_of_a_manifests_scene_begins_from_what_was_asked() -> None:
    """Every field is set there: what is as its quality has it is the quality's."""
    asked = Scene.from_dict({"quality": "survey", "occlusion": {"rays": 77}}, "scene.toml")
    read = Scene.from_dict(asked.model_dump(mode="json"), "manifest.json")
    best = read.replace({"quality": "reference"})
    assert (best.supersampling, best.blur.kernel, best.occlusion.rays) == (8, "9x9", 77)
    assert read.replace({"quality": None}).supersampling == Scene().supersampling
    assert read.replace({"camera.azimuth": 9.0}).supersampling == read.supersampling


@pytest.mark.usefixtures("presets")
def test_a_quality_that_would_change_nothing_is_refused() -> None:
    whole = Scene.from_dict(Scene().model_dump(mode="json"), "manifest.json")
    with pytest.raises(BadInput, match=r'^--set: quality "reference" has nothing to fill: the scene sets every knob'):
        whole.replace({"quality": "reference"}, "--set")
    assert whole.replace({"quality": None}) == whole


@pytest.mark.usefixtures("presets")
def test_explain_tells_who_gave_a_setting() -> None:
    scene = Scene(object="torus:4000").replace({"quality": "survey", "supersampling": 1})
    told = explain(scene)["quality"]
    assert told["name"] == "survey"
    assert told["settings"]["supersampling"] == {"value": 1, "from": "scene"}
    assert told["settings"]["layers.faces"] == {"value": 8000, "from": "quality"}
    assert "quality" not in explain(Scene(object="torus:4000"))


def test_quality_contradicts_the_published_style() -> None:
    with pytest.raises(BadInput, match=r'^scene\.toml: quality "survey" contradicts style "as published"; leave one'):
        Scene.from_dict({"quality": "survey", "style": "as published"}, "scene.toml")


def test_the_shipped_presets_are_a_run_of_the_documented_scenes_by_the_documented_command() -> None:
    """The docs name the command that made them."""
    measured = quality.presets()["measured"]
    text = " ".join((ROOT / "docs" / "accuracy.md").read_text(encoding="utf-8").split())
    words = measured["command"].split()
    assert words[:2] == ["fakesss", "tradeoff"] and not {"--knob", "--quick"} & set(words)
    assert measured["command"] in text
    assert measured["scenes"] == ["figure", "knot", "benchmarks/lit_head.toml"]
    assert words[2:5] == measured["scenes"]
    assert measured["size"] == [256, 256]
    assert datetime.date.fromisoformat(measured["date"])
    assert {"gl_renderer", "processor", "cores", "load"} <= measured["machine"].keys()
    assert measured["machine"]["processor"] not in ("", "x86_64", "arm64", "aarch64"), "no name of a processor"
    assert measured["rounds"]["knobs"] >= 15 and measured["rounds"]["combinations"] >= 9


@pytest.mark.parametrize("name", NAMES)
def test_the_shipped_presets_are_of_knobs_that_there_are(name: str) -> None:
    shipped = quality.presets()[name]
    numbers = ("ms", "ratio", "rmse", "max_abs", "flip", "flip_everywhere", "flip_everywhere_from_reference")
    assert all(shipped[number] >= 0 for number in numbers)
    assert set(shipped) == {*numbers, "because", "settings"}
    known = {knob.name: knob for knob in knobs()}
    unused = {"shadow taps", "local thickness rays"}  # by all of the documented scenes
    assert shipped["settings"].keys() == known.keys() - unused
    for knob, settings in shipped["settings"].items():
        levels = [level.changes for level in known[knob].all_levels]
        assert settings in [{path: to for path, to in changes.items() if to is not None} for changes in levels]


@pytest.mark.gl
@pytest.mark.parametrize("name", NAMES)
def test_the_shipped_presets_can_be_drawn(name: str) -> None:
    shipped = quality.presets()[name]["settings"]
    filled = Scene(object="torus:1000", size=(48, 48)).replace({"quality": name, "light.shadows": True})
    for settings in shipped.values():
        assert {path: filled.at(path) for path in settings} == settings
    picture = render(filled)
    assert np.isfinite(picture).all()
    assert 0.1 < (picture[..., 3] > 0).mean() < 0.9
    assert np.ptp(picture[..., :3]) > 0.1
