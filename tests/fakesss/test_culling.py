"""What weighs nothing changes nothing: the culled picture is, byte for byte, the one with the effect forced on."""

from typing import Any

import pytest

from fakesss.calls import EFFECTS
from fakesss.renderer import Renderer
from fakesss.scene import Scene

WEIGHTLESS: list[tuple[str, dict[str, Any]]] = [
    ("backlight", {"material.backlight": 0.0}),
    ("backlight", {"material.backlight": 0.0, "blur.enabled": False}),
    ("backlight", {"material.backlight": 0.0, "material.thickness": "bridged"}),
    ("backlight", {"material.backlight": 0.0, "material.thickness": "total-path"}),
    ("backlight", {"material.backlight": 0.0, "layers.method": "peel"}),
    ("occlusion", {"material.ambient": 0.0}),
    ("occlusion", {"light.ambient": (0, 0, 0)}),
    ("specular", {"material.specular": 0.0}),
    ("specular", {"material.specular_contribution": 0.0}),
    ("specular", {"light.specular": (0, 0, 0)}),
]


@pytest.mark.gl
@pytest.mark.parametrize(("effect", "changes"), WEIGHTLESS, ids=str)
def test_culling_changes_no_byte(renderer: Renderer, effect: str, changes: dict[str, Any]) -> None:
    scene = Scene(object="torus:8000", size=(128, 96)).replace(changes)
    assert EFFECTS[effect].why_not(scene)
    culled = renderer.render(scene)
    forced = renderer.render(scene, forced=frozenset(EFFECTS))
    assert culled.image.tobytes() == forced.image.tobytes()
    if effect != "specular":  # a permutation, not a pass
        assert len(forced.passes) + len(forced.baked) > len(culled.passes) + len(culled.baked)


def test_what_is_switched_off_cannot_be_forced() -> None:
    """It would change the picture: occlusion.enabled = false means a = 1, not a weight of zero."""
    scene = Scene().replace({"occlusion.enabled": False, "blur.enabled": False})
    for effect in ("occlusion", "blur"):
        assert EFFECTS[effect].off(scene) and not EFFECTS[effect].weightless(scene)
