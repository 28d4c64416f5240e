"""Only what a scene calls for: scene -> surviving passes, without a GPU."""

from typing import Any

import pytest

from fakesss.frame_graph import Bake, Choice
from fakesss.pipeline import build, samples_of
from fakesss.scene import Scene

LIT = "mesh occlusion front"
UNLIT = "mesh front"
CASES: list[tuple[dict[str, Any], str]] = [
    ({}, f"{LIT} back_faces blur+shade resolve"),
    ({"supersampling": 1}, f"{LIT} back_faces blur+shade"),
    ({"blur.enabled": False}, f"{LIT} back_faces thickness+shade resolve"),
    ({"material.backlight": 0.0}, f"{LIT} shade resolve"),
    ({"material.backlight": -0.5}, f"{LIT} back_faces blur+shade resolve"),
    ({"material.backlight": 0.0, "blur.enabled": False}, f"{LIT} shade resolve"),
    ({"material.backlight": 0.0, "material.thickness": "bridged"}, f"{LIT} shade resolve"),
    ({"occlusion.enabled": False}, f"{UNLIT} back_faces blur+shade resolve"),
    ({"light.ambient": (0, 0, 0)}, f"{UNLIT} back_faces blur+shade resolve"),
    ({"light.ambient": (0, 0, 0.1)}, f"{LIT} back_faces blur+shade resolve"),
    ({"material.ambient": 0.0}, f"{UNLIT} back_faces blur+shade resolve"),
    ({"material.backlight": 0.0, "occlusion.enabled": False}, f"{UNLIT} shade resolve"),
    ({"layers.method": "peel"}, f"{LIT} peel blur+shade resolve"),
    ({"camera.distance": 0.5}, f"{LIT} peel blur+shade resolve"),
    ({"camera.near": 3.5}, f"{LIT} peel blur+shade resolve"),
    ({"layers.faces": 8000}, "mesh occlusion coarse_mesh front back_faces blur+shade resolve"),
    ({"material.thickness": "total-path"}, f"{LIT} total_path path_exit blur+shade resolve"),
    ({"material.thickness": "local"}, "mesh occlusion local_thickness front local_exit blur+shade resolve"),
    (
        {"material.thickness": "bridged"},
        f"{LIT} peel_2 peel_3 peel_4 peel_5 peel_6 bridge blur+shade resolve",
    ),
    (
        {"material.thickness": "bridged", "layers.method": "peel", "blur.enabled": False},
        f"{LIT} peel_2 peel_3 peel_4 peel_5 peel_6 bridge thickness+shade resolve",
    ),
    ({"style": "as published"}, f"{LIT} peel blur+shade resolve"),
]


def kept(scene: Scene, target: str = "image", solid: bool = True) -> str:
    """Names of what runs, in order; `a+b` is one pass that does both."""
    plan = build(scene, samples_of(scene), solid).compile([target])
    merged = {node.name: [inner.name for inner in getattr(node, "merged", ())] for node in plan.kept}
    return " ".join("+".join([*merged[node.name], node.name]) for node in plan.kept)


@pytest.mark.parametrize(("changes", "passes"), CASES, ids=[str(changes) for changes, _ in CASES])
def test_surviving_passes(changes: dict[str, Any], passes: str) -> None:
    assert kept(Scene().replace(changes)) == passes


def test_what_is_no_solid_is_peeled() -> None:
    assert kept(Scene(), solid=False) == f"{LIT} peel blur+shade resolve"


@pytest.mark.parametrize(
    ("target", "passes"),
    [
        ("thickness", "mesh front back_faces thickness"),
        ("second", "mesh back_faces"),
        ("peeled", "mesh front peel"),
        ("front", "mesh front"),
        ("surface", "mesh occlusion front"),
        ("occlusion", "mesh occlusion"),
        ("blurred_thickness", "mesh front back_faces blur"),
        ("path_exit", "mesh front total_path path_exit"),
    ],
)
def test_data_targets_take_no_more_than_they_need(target: str, passes: str) -> None:
    assert kept(Scene(), target) == passes


def test_a_pass_that_is_asked_for_is_not_merged_away() -> None:
    plan = build(Scene(), 1, True).compile(["image", "blurred_thickness"])
    assert [node.name for node in plan.kept] == ["mesh", "occlusion", "front", "back_faces", "blur", "shade"]


def test_every_pass_is_always_declared() -> None:
    names = {node.name for node in build(Scene()).nodes}
    for changes, _ in CASES:
        assert {node.name for node in build(Scene().replace(changes)).nodes} == names


def reasons(changes: dict[str, Any], solid: bool, *names: str) -> dict[str, str]:
    verdicts = build(Scene().replace(changes), 3, solid).compile(["image"]).verdicts
    return {verdict.node.name: verdict.because for verdict in verdicts if verdict.node.name in names}


def test_reasons_name_the_setting() -> None:
    assert reasons({"material.backlight": 0.0, "occlusion.enabled": False}, True, "occlusion", "second", "blur") == {
        "occlusion": "not read by front: occlusion.enabled is false",
        "second": "read only by thickness, soften_across and blur, which are culled",
        "blur": "not read by shade: material.backlight is 0",
    }


@pytest.mark.parametrize(
    ("changes", "solid", "because"),
    [
        (
            {},
            True,
            "nearest_back: of a solid seen from outside, the nearest back face ends the first interval",
        ),
        ({}, False, "peeled: the mesh is open or passes through itself, so front faces do not hide all back faces"),
        ({"camera.distance": 0.1}, True, "peeled: a clip plane or the camera may cut the object open"),
        ({"layers.method": "peel"}, True, 'peeled: layers.method is "peel"'),
    ],
)
def test_the_choice_of_the_second_layer_is_said(changes: dict[str, Any], solid: bool, because: str) -> None:
    assert because in reasons(changes, solid, "first_exit")["first_exit"]


def test_effects_can_be_forced_to_show_that_they_are_in_vain() -> None:
    scene = Scene().replace({"material.backlight": 0.0, "light.ambient": (0, 0, 0)})
    assert kept(scene) == f"{UNLIT} shade resolve"
    forced = build(scene, 3, True, frozenset({"backlight", "occlusion", "blur"})).compile(["image"])
    assert [node.name for node in forced.kept] == ["mesh", "occlusion", "front", "back_faces", "shade", "resolve"]


def test_a_missing_mesh_is_no_matter_until_something_is_drawn() -> None:
    graph = build(Scene(object="no/such.ply"))
    baked = [node.name for node in graph.nodes if isinstance(node, Bake)]
    assert baked == ["mesh", "occlusion", "local_thickness", "coarse_mesh"]
    assert [node.name for node in graph.nodes if isinstance(node, Choice)] == ["first_exit", "second", "image"]


def test_the_published_program_had_one_sample() -> None:
    assert samples_of(Scene(supersampling=4)) == 4
    assert samples_of(Scene(supersampling=4, style="as published")) == 1
