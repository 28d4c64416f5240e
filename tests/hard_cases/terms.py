"""How bright and how dark a scene's terms can make a pixel, from equation 3.6 alone."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.scene import Scene

Floats = NDArray[np.float64]


def terms(scene: Scene) -> list[Floats]:
    """What each term of equation 3.6 is at its largest, linear RGB before exposure; each lies between that and 0.

    The factors left out (occlusion, cosines, (1 - t)^r, a spot's fall-off, a shadow) are all in 0..1.
    """
    material = scene.material
    reflectance = np.array(material.diffuse)
    found = [material.backlight * (reflectance + material.diffuse_weight)]
    for light in (scene.light, *scene.lights):
        near = nearest_gain(light)
        found.append(material.ambient * reflectance * light.ambient)
        found.append(near * material.diffuse_contribution * reflectance * light.diffuse)
        found.append(near * material.specular_contribution * material.specular * np.array(light.specular))
    return found


def nearest_gain(light: Any) -> float:
    """The most that any point of the sphere can get: 1 / (kc + kl d + kq d^2), held to a millionfold."""
    if light.kind == "directional":
        return 1.0
    distance = max(light.distance - 1, 0.0)
    return float(1 / max(np.dot(light.attenuation, (1, distance, distance**2)), 1e-6))


def range_of(scene: Scene) -> tuple[Floats, Floats]:
    """The darkest and the brightest linear RGB (3,) that a covered sample may have."""
    each = scene.exposure * np.array(terms(scene))
    low, high = np.minimum(each, 0).sum(axis=0), np.maximum(each, 0).sum(axis=0)
    return (np.zeros(3), np.clip(high, 0, 1)) if scene.style == "as published" else (low, high)


def largest(scene: Scene) -> float:
    """The sum of all terms' sizes in the channel where it is largest, or the background if that is brighter."""
    low, high = range_of(scene)
    return float(max((high - low).max(), *scene.background, 1e-30))
