"""Lighting equation 3.6 for every sample of the front layer."""

from typing import Any

import numpy as np

from fakesss.camera import View, direction
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.scene import Scene


def shade(scene: Scene, view: View, size: tuple[int, int]) -> Pass:
    """Reads `front`, `surface` and one thickness; writes `shaded` (linear RGB times coverage, coverage)."""
    unread = thickness_not_read(scene)
    layer = tuple(name for name in ("thickness", "blurred_thickness") if name not in unread)
    constants = {
        **surface_uniforms(scene, view),
        **(backlight_uniforms(scene) if layer else {}),
    }
    return Pass(
        "shade",
        lambda frame: draw(frame, constants),
        reads=("front", "surface", *layer),
        unread=unread,
        writes={"shaded": TextureSpec(size, 4)},
    )


def draw(frame: Frame, uniforms: dict[str, Any]) -> None:
    frame.fill("shade.frag", uniforms)


def thickness_not_read(scene: Scene) -> dict[str, str]:
    """Which thicknesses the picture does not call for, and why."""
    if scene.material.backlight == 0:
        return dict.fromkeys(("thickness", "blurred_thickness"), "material.backlight is 0")
    if scene.blur.enabled:
        return {"thickness": "blur.enabled is true, so the softened one is read"}
    return {"blurred_thickness": "blur.enabled is false"}


def surface_uniforms(scene: Scene, view: View) -> dict[str, Any]:
    """What the ambient, diffuse and specular terms need, as eq. 3.7 to 3.9 multiply it out."""
    material, light = scene.material, scene.light
    reflectance = np.array(material.diffuse)
    return {
        "tangent": view.tangent,
        "to_light": tuple(view.rotation @ direction(light.azimuth, light.elevation)),
        "ambient_colour": tuple(material.ambient * reflectance * light.ambient),
        "diffuse_colour": tuple(material.diffuse_contribution * reflectance * light.diffuse),
        "specular_colour": tuple(material.specular_contribution * material.specular * np.array(light.specular)),
        "shininess": material.shininess,
        "exposure": scene.exposure,
    }


def backlight_uniforms(scene: Scene) -> dict[str, Any]:
    """What the backlight term needs (eq. 3.10)."""
    material = scene.material
    colour = material.backlight * (np.array(material.diffuse) + material.diffuse_weight)
    return {"backlight_colour": tuple(colour), "thickness_exponent": material.thickness_exponent}
