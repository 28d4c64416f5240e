"""What weighs nothing changes nothing: the culled picture is, byte for byte, the one with the effect forced on."""

import random
from typing import Any

import pytest

from fakesss.calls import EFFECTS, Setting
from fakesss.camera import View
from fakesss.passes.shadow import layout_of
from fakesss.renderer import Renderer
from fakesss.scene import Scene

DARK: dict[str, Any] = {"diffuse": (0, 0, 0), "specular": (0, 0, 0)}
WEIGHTLESS: list[tuple[str, dict[str, Any]]] = [
    ("backlight", {"material.backlight": 0.0}),
    ("backlight", {"material.backlight": 0.0, "blur.enabled": False}),
    ("backlight", {"material.backlight": 0.0, "material.thickness": "bridged"}),
    ("backlight", {"material.backlight": 0.0, "material.thickness": "total-path"}),
    ("backlight", {"material.backlight": 0.0, "layers.method": "peel"}),
    ("backlight", {"material.backlight": 0.0, "layers.resolution": 2, "blur.kernel": "separable"}),
    ("backlight", {"material.thickness_exponent": 0.0, "layers.resolution": 4, "layers.depth": "float16"}),
    ("backlight", {"material.backlight": 0.0, "blur.kernel": "separable"}),
    ("backlight", {"material.backlight": 0.0, "blur.kernel": "9x9", "layers.depth": "float16"}),
    ("backlight", {"exposure": 0.0, "material.backlight": -0.5, "supersampling": 1}),
    ("backlight", {"material.diffuse": (0, 0, 0), "material.diffuse_weight": 0.0}),
    ("backlight", {"material.thickness_exponent": 0.0}),
    ("backlight", {"material.thickness_exponent": 0.0, "material.backlight": -0.5, "blur.enabled": False}),
    ("backlight", {"material.thickness_exponent": 0.0, "material.thickness": "bridged"}),
    ("backlight", {"material.thickness_exponent": 0.0, "object": "box", "open_surface": "thick"}),
    ("occlusion", {"exposure": 0.0}),
    ("occlusion", {"material.diffuse": (0, 0, 0)}),
    ("occlusion", {"material.diffuse": (1, 0, 0), "light.ambient": (0, 0, 1)}),
    ("occlusion", {"light.ambient": (0, 0, 0), "occlusion.method": "screen-space"}),
    ("occlusion", {"material.ambient": 0.0}),
    ("occlusion", {"light.ambient": (0, 0, 0)}),
    ("specular", {"material.specular": 0.0}),
    ("specular", {"material.specular_contribution": 0.0}),
    ("specular", {"light.specular": (0, 0, 0)}),
    ("specular", {"exposure": 0.0}),
    ("diffuse", {"material.diffuse_contribution": 0.0}),
    ("diffuse", {"material.diffuse": (0, 0, 0)}),
    ("diffuse", {"material.diffuse": (1, 0, 0), "light.diffuse": (0, 1, 1)}),
    ("diffuse", {"light.diffuse": (0, 0, 0), "light.kind": "spot"}),
    ("shadows", {"exposure": 0.0, "light.shadows": True}),
    ("shadows", {"material.diffuse": (0, 0, 0), "material.specular": 0.0, "light.shadows": True}),
    ("shadows", {"lights": [{"shadows": True, **DARK}]}),
    ("shadows", {"lights": [{"shadows": True, **DARK, "kind": "point", "distance": 0.3}]}),
]
PERMUTATIONS = {"diffuse", "specular"}  # of the shading, no passes of their own
FURTHER: list[list[dict[str, Any]]] = [
    [{"kind": "point", **DARK}],
    [{"kind": "spot", "falloff": "linear", **DARK}],
    [{"kind": "point", "shadows": True, **DARK}, {"azimuth": 70.0, "shadows": True}],
    [{"kind": "spot", "shadows": True, **DARK}, {"kind": "point", "azimuth": 70.0, "shadows": True}],
    [{"kind": "point", "diffuse": (0, 0, 1), "specular": (0, 0, 0)}],  # on red that is dark too
]


@pytest.mark.gl
@pytest.mark.parametrize(("effect", "changes"), WEIGHTLESS, ids=str)
def test_culling_changes_no_byte(renderer: Renderer, effect: str, changes: dict[str, Any]) -> None:
    scene = Scene(object="torus:8000", size=(128, 96)).replace(changes)
    assert EFFECTS[effect].why_not(scene)
    culled = renderer.render(scene)
    forced = renderer.render(scene, forced=frozenset(EFFECTS))
    assert culled.image.tobytes() == forced.image.tobytes()
    if effect not in PERMUTATIONS:
        assert len(forced.passes) + len(forced.baked) > len(culled.passes) + len(culled.baked)


@pytest.mark.gl
@pytest.mark.parametrize("effect", ["diffuse", "specular", "shadows"])
@pytest.mark.parametrize("lights", FURTHER, ids=str)
def test_dark_further_lights_change_no_byte(renderer: Renderer, lights: list[dict[str, Any]], effect: str) -> None:
    """The bright ones are computed the same way beside them; at these angles rounding would tell."""
    scene = Scene(object="knot:3000", size=(64, 64)).replace(
        {
            "material.diffuse": (0.8, 0.3, 0.0),
            "light.azimuth": 10.0,
            "light.elevation": 33.0,
            "lights": [{"ambient": (0.1, 0.1, 0.1), **light} for light in lights],
        }
    )
    culled, forced = renderer.render(scene), renderer.render(scene, forced=frozenset({effect}))
    assert culled.image.tobytes() == forced.image.tobytes()


def test_dark_lights_that_are_forced_in_leave_the_maps_of_the_others_their_size() -> None:
    scene = Scene(size=(1024, 1024)).replace({"light.shadows": True})
    dark = scene.replace({"lights": [{"kind": "point", "distance": 0.1, "shadows": True, **DARK}]})
    alone, forced = (
        layout_of(Setting(one, View.of(one.camera, one.size), one.size, 1, True, frozenset({"shadows"})))
        for one in (scene, dark)
    )
    assert (alone.maps, forced.maps) == (1, 7) and alone.side == forced.side


def test_what_is_switched_off_cannot_be_forced() -> None:
    """It would change the picture: occlusion.enabled = false means a = 1, not a weight of zero."""
    scene = Scene().replace({"occlusion.enabled": False, "blur.enabled": False})
    for effect in ("occlusion", "blur"):
        assert EFFECTS[effect].off(scene) and not EFFECTS[effect].weightless(scene)


def any_scene(lot: random.Random) -> Scene:
    """A small picture with some weights at zero, others far out, and up to two further lights of any kind."""
    dark, bright = (0.0, 0.0, 0.0), (1.0, 0.5, 0.25)
    kinds = ("directional", "point", "spot")
    light = {"kind": lot.choice(kinds), "shadows": lot.random() < 0.4}
    intensities = {term: lot.choice((dark, bright, (1e6, 1.0, 0.0))) for term in ("ambient", "diffuse", "specular")}
    weights = ("backlight", "ambient", "specular", "specular_contribution")
    return Scene(object="knot:4000", size=(48, 36), supersampling=lot.choice((1, 2))).replace(
        {
            "occlusion.rays": 16,
            "occlusion.method": lot.choice(("baked", "screen-space")),
            "material.thickness": lot.choice(("first-interval", "total-path", "bridged")),
            "blur.kernel": lot.choice(("5x5", "3x3", "9x9", "separable")),
            "layers.resolution": lot.choice((1, 2, 4)),
            "layers.depth": lot.choice(("float32", "float16")),
            "lights": [{**light, "kind": lot.choice(kinds), "diffuse": dark} for _ in range(lot.randint(0, 2))],
            **{f"light.{name}": value for name, value in (*light.items(), *intensities.items())},
            **{f"material.{name}": lot.choice((0.0, 0.7, 1e6)) for name in weights},
            "material.diffuse_contribution": lot.choice((-1.0, 0.0, 0.13)),
            "material.thickness_exponent": lot.choice((0.0, 25.0)),
        }
    )


@pytest.mark.gl
@pytest.mark.parametrize("seed", range(120))
def test_culling_changes_no_byte_of_any_scene(renderer: Renderer, seed: int) -> None:
    scene = any_scene(random.Random(seed))
    forced = renderer.render(scene, forced=frozenset(EFFECTS)).image
    assert renderer.render(scene).image.tobytes() == forced.tobytes()
