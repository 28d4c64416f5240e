"""Lighting equation 3.6 for every sample of the front layer."""

from typing import Any

from fakesss.calls import Setting, ambient_colour, backlight_colour, no_backlight
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.passes import shadow
from fakesss.passes.lights import light_defines, light_uniforms

EXACT = "evaluates equation 3.6 at every sample in closed form"

THICKNESSES = ("thickness", "blurred_thickness")
SCREEN_OCCLUSION = ("screen_occlusion",)


def shade(setting: Setting) -> Pass:
    """Reads `surface` and what the scene calls for: a thickness, `front` where place matters, occlusion, shadow maps.

    Writes `shaded` (linear RGB over the background, 1 where covered).
    With `alpha` the background is black: what is added up for a pixel is then its colour times its coverage.
    """
    unread = {**thickness_not_read(setting), **screen_occlusion_not_read(setting), **shadow.not_read(setting)}
    layer = tuple(name for name in (*SCREEN_OCCLUSION, *THICKNESSES, "shadow_maps") if name not in unread)
    where = ("front",) if needs_position(setting) else ()
    constants, defines = uniforms(setting), permutation(setting)

    def draw(frame: Frame) -> None:
        frame.fill("shade.frag", constants, **defines)

    return Pass(
        "shade",
        draw,
        reads=("surface", "coverage", *where, *layer),
        unread=unread,
        writes={"shaded": TextureSpec(setting.size, 4)},
        mask="coverage",
        clear=(0.0, 0.0, 0.0, 0.0) if setting.scene.alpha else (*setting.scene.background, 0.0),
        merges=THICKNESSES,
    )


def uniforms(setting: Setting) -> dict[str, Any]:
    """What the permutation is fed."""
    where = needs_position(setting)
    return {
        **surface_uniforms(setting),
        **(light_uniforms(setting) if setting.shining else {}),
        **(shadow.shadow_uniforms(setting) if setting.casting else {}),
        **({"tangent": setting.view.tangent} if where or not setting.lacking("specular") else {}),
        **({"camera_distance": setting.view.distance} if where else {}),
        **backlight_uniforms(setting),
    }


def permutation(setting: Setting) -> dict[str, int]:
    """The defines of `glsl/shade.frag`."""
    shadows = shadow.shadow_defines(setting) if setting.casting else {}
    needs = {"NEEDS_POSITION": int(needs_position(setting)), "CONSTANT_BACKLIGHT": int(is_constant(setting))}
    return {**light_defines(setting), **shadows, **needs}


def needs_position(setting: Setting) -> bool:
    """Whether it matters where in space a sample lies: to a light that has a place, or casts shadows."""
    return bool(setting.casting) or any(light.kind != "directional" for light in setting.shining)


def is_constant(setting: Setting) -> bool:
    """Whether there is a backlight, and the same at any thickness."""
    return bool(setting.lacking("backlight")) and not no_backlight(setting.scene)


def thickness_not_read(setting: Setting) -> dict[str, str]:
    """Which thicknesses the picture does not call for, and why."""
    if in_vain := setting.lacking("backlight"):
        return dict.fromkeys(THICKNESSES, in_vain)
    if no_blur := setting.lacking("blur"):
        return {"blurred_thickness": no_blur}
    return {"thickness": "blur.enabled is true, so the softened one is read"}


def screen_occlusion_not_read(setting: Setting) -> dict[str, str]:
    """Why the ambient term needs no occlusion from the front layer, or nothing if it does."""
    if setting.scene.occlusion.method == "screen-space" and not setting.lacking("occlusion"):
        return {}
    return dict.fromkeys(SCREEN_OCCLUSION, setting.lacking("occlusion") or 'occlusion.method is "baked"')


def surface_uniforms(setting: Setting) -> dict[str, Any]:
    """What the ambient term needs, as eq. 3.7 multiplies it out; the lights' ambient intensities add up."""
    return {"ambient_colour": tuple(ambient_colour(setting.scene)), "exposure": setting.scene.exposure}


def backlight_uniforms(setting: Setting) -> dict[str, Any]:
    """What the backlight term needs (eq. 3.10), nothing without one."""
    colour = {"backlight_colour": tuple(backlight_colour(setting.scene))}
    if not setting.lacking("backlight"):
        return {**colour, "thickness_exponent": setting.scene.material.thickness_exponent}
    return colour if is_constant(setting) else {}
