"""What the shading is told of the lights that shine."""

from collections.abc import Sequence
from typing import Any

from fakesss.calls import Setting, diffuse_colour, specular_colour
from fakesss.camera import direction
from fakesss.illumination import cone, place

EXACT = "only hands numbers to the shading"


def array(values: Sequence[Any]) -> Any:
    """A uniform array's values; OpenGL's binding takes that of an array of one without the list."""
    return list(values) if len(values) > 1 else values[0]


def light_defines(setting: Setting) -> dict[str, int]:
    """The permutation of `glsl/common_lights.glsl`."""
    kinds = {light.kind for light in setting.shining}
    local = kinds & {"point", "spot"}
    return {
        "LIGHTS": len(setting.shining),
        **({"LOCAL_LIGHTS": int(bool(local)), "SPOTS": int("spot" in kinds)} if kinds else {}),
        **({"HIGHLIGHT": int(not setting.lacking("specular"))} if kinds else {}),
    }


def light_uniforms(setting: Setting) -> dict[str, Any]:
    """What the permutation of `light_defines` needs, as eq. 3.8 and 3.9 multiply it out."""
    lights, material, view = setting.shining, setting.scene.material, setting.view
    arrays, numbers = {}, {}
    arrays["light_place"] = [tuple(place(light, view)) for light in lights]
    arrays["diffuse_colour"] = [tuple(diffuse_colour(material, light)) for light in lights]
    if not setting.lacking("specular"):
        arrays["specular_colour"] = [tuple(specular_colour(material, light)) for light in lights]
        numbers["shininess"] = material.shininess
    if any(light.kind != "directional" for light in lights):
        constant = (1.0, 0.0, 0.0)
        arrays["light_attenuation"] = [
            constant if light.kind == "directional" else light.attenuation for light in lights
        ]
    if any(light.kind == "spot" for light in lights):
        towards = [direction(light.azimuth, light.elevation) for light in lights]
        arrays["light_axis"] = [tuple(view.rotation @ axis) for axis in towards]
        arrays["light_cone"] = [cone(light) for light in lights]
    return {**{name: array(values) for name, values in arrays.items()}, **numbers}
