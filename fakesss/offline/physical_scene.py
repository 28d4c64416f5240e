"""A scene as Mitsuba 3 reads it (Jakob et al., *Mitsuba 3 renderer*, 2022): the shader's camera and lights, a medium.

The world frame is the shader's, so lengths are radii of the bounding sphere and the medium is scaled, not the mesh.
A light of diffuse intensity Id gives the irradiance pi Id, so that a white Lambertian surface shows Id as in eq. 3.8;
the ambient intensities add up to the radiance of a uniform environment (eq. 3.7). The boundary is index-matched and
the phase function isotropic with the reduced scattering coefficient (similarity).
"""

import math
from typing import Any

from fakesss.calls import lights_of
from fakesss.camera import View, direction
from fakesss.lights import Light
from fakesss.media import Medium, alpha_prime, sigma_t_prime
from fakesss.problem import BadInput
from fakesss.scene import Scene

ROULETTE_AFTER = 1000  # scatterings; Mitsuba's roulette ends one path in twenty or more, which starves high albedos
RADIUS = 1000.0  # of the bounding sphere in Mitsuba's lengths: its rays start (1 + |p|) 9e-5 beyond a surface
BLOCK = 16  # pixels a side; Mitsuba's own choice depends on the number of threads, and with it the picture


def physical_scene(scene: Scene, medium: Medium | None, size_mm: float) -> dict[str, Any]:
    """Integrator, lights and what the object is made of, as `mitsuba.load_dict` reads them; `opaque` without medium.

    The mesh, under "object", is not among it. Raises `BadInput` for a light that no physical light can be.
    """
    return {
        "integrator": integrator(medium),
        **lights(scene),
        "object": opaque(scene) if medium is None else filled(medium, size_mm / 2 / RADIUS),
    }


def integrator(medium: Medium | None) -> dict[str, Any]:
    """What follows the paths. The camera does not see the environment: the background is the shader's."""
    common = {"hide_emitters": True, "block_size": BLOCK}
    if medium is None:
        return {"type": "path", **common}
    return {"type": "volpathmis", "rr_depth": ROULETTE_AFTER, **common}


def opaque(scene: Scene) -> dict[str, Any]:
    """A Lambertian surface of the scene's diffuse reflectance, on both sides."""
    return {"bsdf": {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": rgb(scene.material.diffuse)}}}


def filled(medium: Medium, unit_mm: float) -> dict[str, Any]:
    """An index-matched surface with the medium inside; `unit_mm` is Mitsuba's unit of length."""
    extinction = sigma_t_prime(medium.sigma_s_prime, medium.sigma_a) * unit_mm
    scale = float(extinction.max())  # Mitsuba takes colours of a volume within 0..1 only
    albedo = alpha_prime(medium.sigma_s_prime, medium.sigma_a)
    inside = {"type": "homogeneous", "albedo": rgb(albedo), "sigma_t": rgb(extinction / scale), "scale": scale}
    return {"bsdf": {"type": "null"}, "interior": {**inside, "phase": {"type": "isotropic"}}}


def lights(scene: Scene) -> dict[str, Any]:
    """The uniform environment, and each light that shines."""
    made: dict[str, Any] = {}
    ambient = [sum(channel) for channel in zip(*(light.ambient for light in lights_of(scene)), strict=True)]
    if any(ambient):
        made["ambient"] = {"type": "constant", "radiance": rgb(ambient)}
    for number, light in enumerate(lights_of(scene)):
        if any(light.diffuse):
            place = "light" if number == 0 else f"lights.{number - 1}"
            made[f"light_{number}"] = emitter(light, place)
    return made


def emitter(light: Light, place: str) -> dict[str, Any]:
    """A directional or point light; `BadInput` names `place` where the scene's light is none."""
    towards = direction(light.azimuth, light.elevation)
    if light.kind == "directional":
        irradiance = rgb(math.pi * channel for channel in light.diffuse)
        return {"type": "directional", "direction": [float(-part) for part in towards], "irradiance": irradiance}
    if light.kind == "spot":
        raise BadInput(f'scene: {place}.kind: path-traced pictures have no spots; make it "directional" or "point"')
    constant, linear, quadratic = light.attenuation
    if constant or linear or not quadratic:
        raise BadInput(
            f"scene: {place}.attenuation: {list(light.attenuation)}: light falls with the square of distance in "
            f"path-traced pictures; write [0, 0, kq], or make the light directional"
        )
    where = [float(RADIUS * light.distance * part) for part in towards]
    return {
        "type": "point",
        "position": where,
        "intensity": rgb(math.pi * RADIUS**2 * channel / quadratic for channel in light.diffuse),
    }


def sensor(scene: Scene, seed: int) -> dict[str, Any]:
    """The shader's camera with a box filter as wide as a pixel, and an independent sampler of its own."""
    view = View.of(scene.camera, scene.size)
    right, up, towards = view.rotation
    # Mitsuba's camera looks along its z axis and has x to its left
    columns = [*zip(-right, up, -towards, RADIUS * view.distance * towards, strict=True)]
    width, height = scene.size
    return {
        "type": "perspective",
        "fov": scene.camera.field_of_view,
        "fov_axis": "smaller",
        "near_clip": RADIUS * view.near,
        "far_clip": RADIUS * view.far,
        "to_world": [[float(number) for number in row] for row in columns] + [[0.0, 0.0, 0.0, 1.0]],
        "film": {
            "type": "hdrfilm",
            "width": width,
            "height": height,
            "pixel_format": "rgb",
            "component_format": "float32",
            "rfilter": {"type": "box"},
        },
        "sampler": {"type": "independent", "seed": seed},
    }


def rgb(channels: Any) -> dict[str, Any]:
    """A colour, linear RGB with sRGB primaries."""
    return {"type": "rgb", "value": [float(channel) for channel in channels]}
