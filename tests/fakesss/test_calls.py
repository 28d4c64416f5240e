"""What a scene calls for: zero is what a product comes to, and the reason names the setting that made it so."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fakesss.calls import EFFECTS, shining
from fakesss.pipeline import build
from fakesss.scene import Scene

BLACK = (0, 0, 0)
NO_LIGHT = "material.diffuse reflects none of the {} light"
REASONS: list[tuple[dict[str, Any], dict[str, str]]] = [
    ({}, {}),
    ({"exposure": 0.0}, dict.fromkeys(("backlight", "occlusion", "diffuse", "specular", "shadows"), "exposure is 0")),
    ({"material.backlight": 0.0}, {"backlight": "material.backlight is 0"}),
    (
        {"material.thickness_exponent": 0.0},
        {"backlight": "material.thickness_exponent is 0, so thickness does not matter"},
    ),
    ({"material.diffuse": BLACK}, {"occlusion": NO_LIGHT.format("ambient"), "diffuse": NO_LIGHT.format("diffuse")}),
    (
        {"material.diffuse": BLACK, "material.diffuse_weight": 0.0},
        {
            "backlight": "material.diffuse plus diffuse_weight is 0",
            "occlusion": NO_LIGHT.format("ambient"),
            "diffuse": NO_LIGHT.format("diffuse"),
        },
    ),
    ({"material.diffuse": (1, 0, 0), "light.ambient": (0, 1, 1)}, {"occlusion": NO_LIGHT.format("ambient")}),
    ({"material.diffuse": (1, 0, 0), "light.diffuse": (0, 1, 1)}, {"diffuse": NO_LIGHT.format("diffuse")}),
    ({"material.diffuse": (1, 0, 0), "light.ambient": (0, 1, 1), "lights": [{"ambient": (0.1, 0, 0)}]}, {}),
    ({"light.ambient": BLACK, "lights": [{"ambient": BLACK}]}, {"occlusion": "light.ambient is 0 in every light"}),
    (
        {"material.diffuse": BLACK, "material.specular": 0.0, "light.shadows": True},
        {
            "occlusion": NO_LIGHT.format("ambient"),
            "diffuse": NO_LIGHT.format("diffuse"),
            "specular": "material.specular is 0",
            "shadows": f"{NO_LIGHT.format('diffuse')} and material.specular is 0",
        },
    ),
]


@pytest.mark.parametrize(("changes", "reasons"), REASONS, ids=[str(changes) for changes, _ in REASONS])
def test_the_reason_is_the_setting(changes: dict[str, Any], reasons: dict[str, str]) -> None:
    scene = Scene().replace(changes)
    found = {name: effect.weightless(scene) for name, effect in EFFECTS.items()}
    assert found.pop("blur") == found["backlight"]
    assert {name: reason for name, reason in found.items() if reason} == reasons


@pytest.mark.parametrize(
    ("changes", "kept"),
    [
        ({"exposure": 0.0, "light.shadows": True}, "mesh front shade resolve"),
        ({"material.thickness_exponent": 0.0}, "mesh occlusion front shade resolve"),
        ({"material.thickness_exponent": 0.0, "material.thickness": "local"}, "mesh occlusion front shade resolve"),
        ({"material.thickness_exponent": 1e-3}, "mesh occlusion front back_faces shade resolve"),
        ({"material.diffuse": BLACK}, "mesh front back_faces shade resolve"),
        ({"material.diffuse": BLACK, "material.diffuse_weight": 0.0}, "mesh front shade resolve"),
        ({"material.diffuse": (0.5, 0.5, 0.5), "material.diffuse_weight": -0.5}, "mesh occlusion front shade resolve"),
        ({"material.diffuse": (1, 0, 0), "light.ambient": (0, 0, 1)}, "mesh front back_faces shade resolve"),
        (
            {"material.diffuse": BLACK, "light.shadows": True, "light.specular": BLACK},
            "mesh front back_faces shade resolve",
        ),
    ],
    ids=str,
)
def test_what_comes_to_zero_is_neither_baked_nor_drawn(changes: dict[str, Any], kept: str) -> None:
    plan = build(Scene().replace(changes), 3, solid=True).compile(["image"])
    assert " ".join(node.name for node in plan.kept) == kept


def test_a_light_of_a_colour_that_is_not_reflected_does_not_shine() -> None:
    further = [{"diffuse": (0, 0, 1), "specular": BLACK}, {"diffuse": BLACK, "specular": (0, 0, 1)}]
    scene = Scene().replace({"material.diffuse": (1, 1, 0), "lights": further})
    assert shining(scene) == (scene.light, scene.lights[1])
    assert shining(scene.replace({"material.specular": 0.0})) == (scene.light,)
    assert shining(scene.replace({"exposure": 0.0})) == ()


ZEROS = st.tuples(*[st.sampled_from([0.0, 0.5])] * 3)


@given(ZEROS, ZEROS, ZEROS, st.sampled_from([0.0, 1.0]), st.sampled_from([0.0, 1.0]))
def test_an_effect_weighs_something_exactly_where_its_colour_does(
    reflectance: Any, ambient: Any, diffuse: Any, weight: float, exposure: float
) -> None:
    """Independently: a colour is black if in each channel one of its factors is 0."""
    changes = {"material.diffuse": reflectance, "light.ambient": ambient, "light.diffuse": diffuse}
    scene = Scene().replace({**changes, "material.ambient": weight, "exposure": exposure})
    met = any(r and a for r, a in zip(reflectance, ambient, strict=True))
    assert bool(EFFECTS["occlusion"].weightless(scene)) == (not (met and weight and exposure))
    met = any(r and d for r, d in zip(reflectance, diffuse, strict=True))
    assert bool(EFFECTS["diffuse"].weightless(scene)) == (not (met and exposure))
