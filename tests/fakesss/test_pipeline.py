"""Only what a scene calls for: scene -> surviving passes, without a GPU."""

from typing import Any

import pytest

from fakesss.frame_graph import Bake
from fakesss.pipeline import build, samples_of
from fakesss.scene import Scene

EVERYTHING = "mesh occlusion front second blur shade resolve"
CASES: list[tuple[dict[str, Any], str]] = [
    ({}, EVERYTHING),
    ({"blur.enabled": False}, "mesh occlusion front second thickness shade resolve"),
    ({"material.backlight": 0.0}, "mesh occlusion front shade resolve"),
    ({"material.backlight": -0.5}, EVERYTHING),
    ({"material.backlight": 0.0, "blur.enabled": False}, "mesh occlusion front shade resolve"),
    ({"occlusion.enabled": False}, "mesh front second blur shade resolve"),
    ({"light.ambient": (0, 0, 0)}, "mesh front second blur shade resolve"),
    ({"light.ambient": (0, 0, 0.1)}, EVERYTHING),
    ({"material.ambient": 0.0}, "mesh front second blur shade resolve"),
    ({"material.backlight": 0.0, "occlusion.enabled": False}, "mesh front shade resolve"),
    ({"style": "as published"}, EVERYTHING),
]


def kept(scene: Scene, target: str = "image") -> str:
    return " ".join(node.name for node in build(scene).compile([target]).kept)


@pytest.mark.parametrize(("changes", "passes"), CASES, ids=[str(changes) for changes, _ in CASES])
def test_surviving_passes(changes: dict[str, Any], passes: str) -> None:
    assert kept(Scene().replace(changes)) == passes


@pytest.mark.parametrize(
    ("target", "passes"),
    [
        ("thickness", "mesh front second thickness"),
        ("front", "mesh front"),
        ("surface", "mesh occlusion front"),
        ("occlusion", "mesh occlusion"),
        ("blurred_thickness", "mesh front second blur"),
    ],
)
def test_data_targets_take_no_more_than_they_need(target: str, passes: str) -> None:
    assert kept(Scene(), target) == passes


def test_every_pass_is_always_declared() -> None:
    names = {node.name for node in build(Scene()).nodes}
    for changes, _ in CASES:
        assert {node.name for node in build(Scene().replace(changes)).nodes} == names


def test_reasons_name_the_setting() -> None:
    scene = Scene().replace({"material.backlight": 0.0, "occlusion.enabled": False})
    reasons = {v.node.name: v.because for v in build(scene).compile(["image"]).verdicts if not v.kept}
    assert reasons == {
        "occlusion": "not read by front: occlusion.enabled is false",
        "second": "read only by thickness and blur, which are culled",
        "thickness": "not read by shade: material.backlight is 0",
        "blur": "not read by shade: material.backlight is 0",
    }


def test_a_missing_mesh_is_no_matter_until_something_is_drawn() -> None:
    graph = build(Scene(object="no/such.ply"))
    assert [node.name for node in graph.nodes if isinstance(node, Bake)] == ["mesh", "occlusion"]


def test_the_published_program_had_one_sample() -> None:
    assert samples_of(Scene(supersampling=4)) == 4
    assert samples_of(Scene(supersampling=4, style="as published")) == 1
