"""Every pass declares its knobs, or that it approximates nothing: a new one without that fails here."""

from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from fakesss.frame_graph import Bake, Pass
from fakesss.knob import Knob, knobs, modules
from fakesss.pipeline import build
from fakesss.scene import Scene, scene_paths


def declared(module: Any) -> list[str]:
    return [name for name in ("KNOBS", "EXACT") if hasattr(module, name)]


@pytest.mark.parametrize("name", modules())
def test_a_module_of_passes_declares_knobs_or_why_it_has_none(name: str) -> None:
    assert len(declared(modules()[name])) == 1, f'{name}: declare KNOBS = (Knob(...), ...) or EXACT = "why"'


def test_every_pass_of_the_pipeline_stands_in_such_a_module() -> None:
    made = {node.name: node.draw if isinstance(node, Pass) else node.make for node in nodes()}
    homes = {name: made_by.__module__ for name, made_by in made.items()}
    known = {f"fakesss.passes.{name}" for name, module in modules().items() if declared(module)}
    assert {name: home for name, home in homes.items() if home not in known} == {}


def nodes() -> list[Any]:
    return [node for node in build(Scene()).nodes if isinstance(node, Pass | Bake)]


@pytest.mark.parametrize("knob", knobs(), ids=lambda knob: knob.name)
def test_a_knob_sets_scene_fields_to_values_they_take(knob: Knob) -> None:
    assert set(knob.paths) <= set(scene_paths())
    for level in knob.all_levels:
        Scene().replace(level.changes, knob.name)
    assert knob.besides in knob.all_levels


def test_knobs_have_their_own_names_and_fields() -> None:
    names = [knob.name for knob in knobs()]
    paths = [path for knob in knobs() for path in knob.paths]
    assert len(set(names)) == len(names)
    assert len(set(paths)) == len(paths)


def test_the_docs_say_where_knobs_stand_while_others_are_measured_and_what_order_is_expected() -> None:
    text = " ".join((Path(__file__).parents[2] / "docs" / "accuracy.md").read_text(encoding="utf-8").split())
    beside = [f"{knob.name} ({knob.beside})" for knob in knobs() if knob.beside is not None]
    orders = [f"{knob.name} {Fraction(knob.order).limit_denominator(9)}" for knob in knobs() if knob.order]
    assert beside and orders
    assert [said for said in (*beside, *orders) if said not in text] == []


@pytest.mark.parametrize("knob", knobs(), ids=lambda knob: knob.name)
def test_values_of_one_knob_differ_and_rise_where_they_are_counted(knob: Knob) -> None:
    values = [level.value for level in knob.all_levels]
    assert len(set(values)) == len(values)
    if knob.order is not None:
        assert values == sorted(values, key=int)


SECOND = {"second-layer faces", "second-layer resolution"}
USED = [
    ({}, {*SECOND, "layer method", "blur kernel", "depth format", "occlusion rays", "supersampling"}),
    ({"material.backlight": 0.0}, {"occlusion rays", "supersampling"}),
    ({"occlusion.method": "screen-space", "material.backlight": 0.0}, {"screen-space samples", "supersampling"}),
    (
        {"layers.method": "peel", "occlusion.enabled": False},
        {"layer method", "blur kernel", "depth format", "supersampling"},
    ),
    ({"style": "as published"}, {"occlusion rays", "supersampling"}),
    (
        {"light.shadows": True, "material.backlight": 0.0, "material.ambient": 0.0},
        {"shadow map size", "shadow filter", "supersampling"},
    ),
    (
        {"light.shadows": True, "shadow.filter": "disc", "material.backlight": 0.0, "material.ambient": 0.0},
        {"shadow map size", "shadow taps", "supersampling"},
    ),
    ({"exposure": 0.0}, {"supersampling"}),
]


@pytest.mark.parametrize(
    ("changes", "used"), USED, ids=lambda value: " ".join(value) if isinstance(value, dict) else ""
)
def test_a_scene_uses_the_knobs_of_what_it_calls_for(changes: dict[str, Any], used: set[str]) -> None:
    scene = Scene(object="torus:4000").replace(changes)
    reasons = {knob.name: knob.unused(scene) for knob in knobs()}
    unexpected = {name: why for name, why in reasons.items() if (not why) != (name in used)}
    assert unexpected == {}
