"""Lighting equation 3.6 for every sample of the front layer."""

from typing import Any

import numpy as np

from fakesss.calls import Setting
from fakesss.camera import direction
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec

THICKNESSES = ("thickness", "blurred_thickness")
SCREEN_OCCLUSION = ("screen_occlusion",)


def shade(setting: Setting) -> Pass:
    """Reads `front`, `surface` and one thickness; writes `shaded` (linear RGB over the background, 1 where covered).

    With `alpha` the background is black: what is added up for a pixel is then its colour times its coverage.
    """
    unread = {**thickness_not_read(setting), **screen_occlusion_not_read(setting)}
    layer = tuple(name for name in THICKNESSES if name not in unread)
    occlusion = tuple(name for name in SCREEN_OCCLUSION if name not in unread)
    specular = not setting.lacking("specular")
    constants = {
        **surface_uniforms(setting),
        **(specular_uniforms(setting) if specular else {}),
        **(backlight_uniforms(setting) if layer else {}),
    }

    def draw(frame: Frame) -> None:
        frame.fill("shade.frag", constants, HIGHLIGHT=int(specular))

    return Pass(
        "shade",
        draw,
        reads=("surface", "coverage", *occlusion, *layer),
        unread=unread,
        writes={"shaded": TextureSpec(setting.size, 4)},
        mask="coverage",
        clear=(0.0, 0.0, 0.0, 0.0) if setting.scene.alpha else (*setting.scene.background, 0.0),
        merges=THICKNESSES,
    )


def thickness_not_read(setting: Setting) -> dict[str, str]:
    """Which thicknesses the picture does not call for, and why."""
    if no_backlight := setting.lacking("backlight"):
        return dict.fromkeys(THICKNESSES, no_backlight)
    if no_blur := setting.lacking("blur"):
        return {"blurred_thickness": no_blur}
    return {"thickness": "blur.enabled is true, so the softened one is read"}


def screen_occlusion_not_read(setting: Setting) -> dict[str, str]:
    """Why the ambient term needs no occlusion from the front layer, or nothing if it does."""
    if setting.scene.occlusion.method == "screen-space" and not setting.lacking("occlusion"):
        return {}
    return dict.fromkeys(SCREEN_OCCLUSION, setting.lacking("occlusion") or 'occlusion.method is "baked"')


def surface_uniforms(setting: Setting) -> dict[str, Any]:
    """What the ambient and diffuse terms need, as eq. 3.7 and 3.8 multiply it out."""
    material, light = setting.scene.material, setting.scene.light
    reflectance = np.array(material.diffuse)
    return {
        "to_light": tuple(setting.view.rotation @ direction(light.azimuth, light.elevation)),
        "ambient_colour": tuple(material.ambient * reflectance * light.ambient),
        "diffuse_colour": tuple(material.diffuse_contribution * reflectance * light.diffuse),
        "exposure": setting.scene.exposure,
    }


def specular_uniforms(setting: Setting) -> dict[str, Any]:
    """What the highlight needs (eq. 3.9)."""
    material, light = setting.scene.material, setting.scene.light
    return {
        "tangent": setting.view.tangent,
        "specular_colour": tuple(material.specular_contribution * material.specular * np.array(light.specular)),
        "shininess": material.shininess,
    }


def backlight_uniforms(setting: Setting) -> dict[str, Any]:
    """What the backlight term needs (eq. 3.10)."""
    material = setting.scene.material
    colour = material.backlight * (np.array(material.diffuse) + material.diffuse_weight)
    return {"backlight_colour": tuple(colour), "thickness_exponent": material.thickness_exponent}
