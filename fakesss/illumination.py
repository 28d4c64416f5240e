"""What reaches a point from each light, and equation 3.6 summed over lights: the reference of `glsl/common_light.glsl`.

A light is what Phong-style shading calls one: it sends no more than its three intensities, has no size, and only what
is in its shadow map is hidden from it. Its ambient intensity comes from everywhere, so neither distance nor cone nor
shadow changes it. Points and vectors are (..., 3) in the eye frame with the sphere's centre as origin, radii.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fakesss.brdf import Array, backlight, blinn_phong, lambert, power
from fakesss.camera import View, direction
from fakesss.lights import Light
from fakesss.scene import Scene

NEAREST = 1e-3  # sphere radii; a light nearer than that fades as its distance to the point goes to 0
LEAST_DIVISOR = 1e-6  # of attenuation: at most a millionfold light, so that products stay within float32
EDGE = 0.1  # share of a cone's 1 - cos in which an exponent fall-off fades out, about 1/20 of a narrow cone's angle


def attenuation(distance: ArrayLike, coefficients: tuple[float, float, float]) -> Array:
    """1 / (kc + kl d + kq d^2); the divisor counts as at least `LEAST_DIVISOR`."""
    d, (kc, kl, kq) = np.asarray(distance, float), coefficients
    return np.asarray(1 / np.maximum(kc + d * (kl + d * kq), LEAST_DIVISOR))


def versine(a: Array, b: Array) -> Array:
    """1 - cos of the angle between unit vectors (..., 3), exact in float32 also where the cosine rounds to 1."""
    return np.asarray(0.5 * ((a - b) ** 2).sum(axis=-1))


def spot_exponent(v: ArrayLike, edge: ArrayLike, exponent: ArrayLike) -> Array:
    """max(cos, 0)^e at 1 - cos = v off the axis, fading smoothly to 0 at the cone's `edge` (its 1 - cos)."""
    v, edge = np.asarray(v, float), np.asarray(edge, float)
    inner = np.clip((edge - v) / (EDGE * edge), 0.0, 1.0)
    return np.asarray(power(np.maximum(1 - v, 0.0), exponent) * inner * inner * (3 - 2 * inner))


def spot_linear(v: ArrayLike, edge: ArrayLike) -> Array:
    """(c - cf) / (1 - cf) for the cosines c of the angle off the axis and cf of the cut-off, 0 outside the cone."""
    return np.asarray(np.maximum(edge - np.asarray(v, float), 0.0) / edge)


def cone(light: Light) -> tuple[float, float, bool]:
    """1 - cos of a spot's cut-off, exponent, whether the fall-off is linear; of other lights a cone of everything."""
    if light.kind != "spot":
        return 1e6, 0.0, False
    return 2 * float(np.sin(np.radians(light.cutoff) / 2) ** 2), light.spot_exponent, light.falloff == "linear"


def place(light: Light, view: View) -> Array:
    """Homogeneous (4,): where the light is, or, with 0 at the end, the unit vector towards it."""
    towards = view.rotation @ direction(light.azimuth, light.elevation)
    if light.kind == "directional":
        return np.array([*towards, 0.0])
    return np.array([*towards * light.distance, 1.0])


def arriving(light: Light, view: View, points: Array) -> tuple[Array, Array]:
    """Unit vectors (..., 3) from `points` to the light, and the share of its intensity that arrives (...)."""
    *where, local = place(light, view)
    towards = where - local * points
    distance = np.maximum(np.linalg.norm(towards, axis=-1), NEAREST)
    to_light = towards / distance[..., None]
    if light.kind == "directional":
        return to_light, np.ones(points.shape[:-1])
    axis = view.rotation @ direction(light.azimuth, light.elevation)  # defined also for a light at the centre
    v = versine(axis, to_light)
    edge, exponent, linear = cone(light)
    return to_light, attenuation(distance, light.attenuation) * (
        spot_linear(v, edge) if linear else spot_exponent(v, edge, exponent)
    )


def positions(view: View, front: NDArray[Any]) -> Array:
    """Eye-frame points (H, W, 3) of a front layer (H, W), top row first; they mean nothing where it is 0."""
    height, width = front.shape
    beyond = front.astype(np.float64) - 2.0  # the ORIGIN of common_layers.glsl
    x = ((np.arange(width) + 0.5) / width * 2 - 1) * view.tangent[0]
    y = (1 - (np.arange(height) + 0.5) / height * 2) * view.tangent[1]
    across = np.stack(np.meshgrid(x, y), axis=-1) * (view.distance + beyond)[..., None]
    return np.concatenate([across, -beyond[..., None]], axis=-1)


def to_viewer(view: View, points: Array) -> Array:
    """Unit vectors (..., 3) from `points` to the camera."""
    towards = np.array([0.0, 0.0, view.distance]) - points
    return np.asarray(towards / np.linalg.norm(towards, axis=-1, keepdims=True))


def lighting(
    scene: Scene, view: View, points: Array, normals: Array, a: Array, t: Array, lit: dict[int, Array] | None = None
) -> Array:
    """Equation 3.6: linear RGB (..., 3) of points with unit `normals`, occlusion `a` and thickness `t`.

    `lit` gives, for the number of a light (0 is `light`, i + 1 `lights.i`), the share of it that shadows let through.
    """
    m, reflectance = scene.material, np.array(scene.material.diffuse)
    lights = (scene.light, *scene.lights)
    total = np.multiply.outer(a, m.ambient * reflectance * np.sum([light.ambient for light in lights], axis=0))
    total += np.multiply.outer(backlight(t, m.thickness_exponent), m.backlight * (reflectance + m.diffuse_weight))
    viewer = to_viewer(view, points)
    for number, light in enumerate(lights):
        to_light, strength = arriving(light, view, points)
        strength = strength * (lit or {}).get(number, 1.0)
        between = to_light + viewer
        halfway = between / np.maximum(np.linalg.norm(between, axis=-1, keepdims=True), 1e-10)
        n_dot_l, n_dot_h = ((normals * vector).sum(axis=-1) for vector in (to_light, halfway))
        diffuse = m.diffuse_contribution * reflectance * np.array(light.diffuse)
        specular = m.specular_contribution * m.specular * np.array(light.specular)
        total += np.multiply.outer(strength * lambert(n_dot_l), diffuse)
        total += np.multiply.outer(strength * blinn_phong(n_dot_l, n_dot_h, m.shininess), specular)
    return np.asarray(total)
