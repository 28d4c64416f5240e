"""Terms drawn alone add up to the picture, whatever the lights."""

from typing import Any

import numpy as np
import pytest

from fakesss.lighting_terms import BRIGHT, MOST, TERMS, alone, brightening, lighting_term
from fakesss.renderer import Renderer
from fakesss.scene import Scene

SCENE = Scene(object="knot:4000", size=(48, 40), background=(0.0, 0.0, 0.0))
CHANGES: list[dict[str, Any]] = [
    {},
    {"material.ambient": 0.0, "blur.enabled": False},
    {"lights": [{"kind": "point", "azimuth": 80.0}, {"kind": "spot", "elevation": -10.0, "shadows": True}]},
    {"material.backlight": -0.7, "material.specular_contribution": 3.0, "light.azimuth": 120.0},
]


@pytest.mark.gl
@pytest.mark.parametrize("changes", CHANGES, ids=str)
def test_the_terms_add_up_to_the_picture(renderer: Renderer, changes: dict[str, Any]) -> None:
    scene = SCENE.replace(changes)
    terms = [renderer.render(alone(scene, term)).image[..., :3] for term in TERMS]
    picture = renderer.render(scene).image[..., :3]
    assert np.abs(np.sum(terms, axis=0) - picture).max() < 1e-5 and np.abs(picture).max() > 0.1


@pytest.mark.gl
def test_notes_tell_what_is_shown(renderer: Renderer) -> None:
    background = np.zeros(3)
    pixels, note = lighting_term(SCENE.replace({"material.backlight": 0.0}), "backlight", background)
    assert note == "material.backlight is 0" and not pixels.any()
    assert lighting_term(SCENE.replace({"light.ambient": (0, 0, 0)}), "ambient", background)[1] == "the scene has none"
    dark = SCENE.replace({"material.diffuse_contribution": 0.01})
    pixels, note = lighting_term(dark, "diffuse", background)
    assert note.endswith("64 times") and pixels.max() > 100
    negative, note = lighting_term(SCENE.replace({"material.backlight": -1.2}), "backlight", background)
    assert note.startswith("- ") and (negative == lighting_term(SCENE, "backlight", background)[0]).all()


@pytest.mark.parametrize("bright", [1e-9, 1e-3, 0.011, 0.05, 0.2, 0.41, 0.8, 1.0, 1e5])
def test_brightening_is_the_largest_power_of_two_below_white(bright: float) -> None:
    factor = brightening(np.full((5, 3), bright))
    assert factor in 2 ** np.arange(7)
    assert factor == 1 or factor * bright <= BRIGHT
    assert factor == MOST or 2 * factor * bright > BRIGHT
