"""The tuner's panel has every field of a scene, with the limits that the scene itself has."""

import re
from collections import Counter
from html.parser import HTMLParser

import pytest

from fakesss.calls import EFFECTS
from fakesss.lights import Light
from fakesss.problem import BadInput
from fakesss.scene import Scene, scene_paths
from fakesss.tuner import fields
from fakesss.tuner.controls import Control
from fakesss.tuner.page import PANELS, page
from fakesss.tuner.panel import EFFECTS as SWITCHED
from fakesss.tuner.panel import NO_CONTROL, controls
from fakesss.tuner.presets import qualities

ALL = tuple(controls())
NUMBERS = [control for control in ALL if control.kind in ("number", "colour", "triple", "size")]
OWN_SYMBOLS = {"material.thickness": "t", "light.spot_exponent": "e", "occlusion.enabled": "a"}  # nowhere in brackets


# attenuation by three zeros is refused as a whole: of triples the least value is not tried


def named(control: Control) -> str:
    return control.path


def filled(control: Control, value: float) -> object:
    """`value` in every number of the control's field."""
    parts = len(Scene().at(control.path)) if control.kind != "number" else 0
    number = int(value) if fields.limits(control.path).whole else float(value)
    return [number] * parts if parts else number


def test_every_field_has_one_control_or_a_reason_for_none() -> None:
    places = Counter(control.path for control in ALL)
    assert {path for path, times in places.items() if times > 1} == set()
    assert set(places) | set(NO_CONTROL) == set(scene_paths())
    assert not set(places) & set(NO_CONTROL)
    assert {f"light.{name}" for name in Light.model_fields} <= set(places)


def test_effects_are_those_that_can_be_switched() -> None:
    assert set(SWITCHED) == set(EFFECTS)


@pytest.mark.parametrize("control", NUMBERS, ids=named)
def test_a_slider_covers_the_default_and_stays_within_the_limits(control: Control) -> None:
    found = fields.limits(control.path)
    default = Scene().at(control.path)
    for value in default if isinstance(default, tuple) else [default]:
        assert value is None or control.low <= value <= control.high
    assert control.low < control.high
    for end in (control.low, control.high) if control.kind != "triple" else (control.high,):
        Scene().replace({control.path: filled(control, end)})
    assert found.least is None or control.low >= found.least
    assert not control.log or control.low > 0


@pytest.mark.parametrize("control", NUMBERS, ids=named)
def test_hard_limits_are_those_of_the_scene(control: Control) -> None:
    found = fields.limits(control.path)
    step = 1 if found.whole else 1e-6
    if found.most is not None:
        Scene().replace({control.path: filled(control, found.most)})
        with pytest.raises(BadInput):
            Scene().replace({control.path: filled(control, found.most + step * max(1, found.most))})
    if found.least is None:
        return
    if not found.above and control.kind != "triple":
        Scene().replace({control.path: filled(control, found.least)})
    with pytest.raises(BadInput):
        Scene().replace({control.path: filled(control, found.least if found.above else found.least - step)})


@pytest.mark.parametrize("control", ALL, ids=named)
def test_a_tip_says_what_the_field_is_and_cites_its_symbol(control: Control) -> None:
    assert control.path in control.tip
    if control.path in OWN_SYMBOLS:
        assert control.symbol == OWN_SYMBOLS[control.path]
    else:
        assert re.findall(r"\[(\w+)\]", control.tip) == ([control.symbol] if control.symbol else [])


@pytest.mark.parametrize("control", [one for one in ALL if one.needs], ids=named)
def test_needs_name_values_that_the_other_field_has(control: Control) -> None:
    for need in control.needs:
        choices = fields.field(need.path).get("enum", (True, False))
        assert set(need.values) < set(choices)


class Page(HTMLParser):
    """What of a page refers to what."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.references: set[str] = set()
        self.paths: list[str] = []
        self.inline: list[str] = []
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name == "id":
                self.ids.append(str(value))
            if name in ("for", "aria-describedby", "aria-labelledby", "aria-controls"):
                self.references |= set(str(value).split())
            if name == "data-path":
                self.paths.append(str(value))
            if name == "style" or name.startswith("on"):
                self.inline.append(f"{tag} {name}")
        if tag == "style" or (tag == "script" and "src" not in dict(attrs)):
            self.inline.append(tag)


def test_the_page_holds_every_control_and_refers_to_what_is_there() -> None:
    found = Page(page(Scene()))
    assert [name for name, times in Counter(found.ids).items() if times > 1] == []
    assert found.references - set(found.ids) == set()
    assert {control.path for control in ALL} <= set(found.paths)
    assert {f"panel-{name}" for name in PANELS} <= set(found.ids)
    assert found.inline == []  # the content-security policy would refuse it


def test_the_name_of_an_object_is_text_and_nothing_else() -> None:
    html = page(Scene(object="<script>alert(1)</script>.obj"))
    assert "<script>alert" not in html


def test_what_qualities_fill() -> None:
    found = qualities(Scene())
    assert set(found) == {"", "interactive", "survey", "reference"}
    for name in ("interactive", "survey", "reference"):
        scene = Scene().replace({"quality": name})
        assert found[name]
        assert all(scene.at(path) == value for knob in found[name] for path, value in knob.items())
    assert {path for knob in found[""] for path in knob} >= {path for knob in found["survey"] for path in knob}


def test_a_quality_leaves_alone_what_the_scene_sets() -> None:
    found = qualities(Scene.from_dict({"quality": "survey", "supersampling": 3}, "test"))
    for name in ("interactive", "survey", "reference"):
        assert not any("supersampling" in knob for knob in found[name])
    assert {"supersampling": 3} in found[""]


def test_a_scene_as_published_has_no_quality() -> None:
    assert set(qualities(Scene(style="as published"))) == {""}
