"""A first guess of what the shader needs to look like a measured medium, from the medium's numbers alone.

- Kd is the diffuse reflectance R_d of a half-space of it, without a boundary as in the path-traced pictures; ka and wd
  are 1, so that thick parts send back what so bright a Lambertian surface would.
- Deep inside, light falls as exp(-sigma_tr x). For a thin part (1 - t)^r = exp(-r t), so r = sigma_tr times the
  sphere's diameter; of the channels' sigma_tr the mean weighted by R_d, since it is the bright ones that are seen.
- wb is the light on the far side of a thin part: the irradiance, divided by pi, of a surface that faces away from the
  camera. Kb is 0.

What it is *not*: a fit. It knows neither shape nor how light that enters one side leaves another.
"""

import numpy as np

from fakesss.calls import lights_of
from fakesss.camera import View, direction
from fakesss.colour import luminance
from fakesss.media import Medium, sigma_tr, total_diffuse_reflectance
from fakesss.offline.fit_solver import EXPONENTS
from fakesss.scene import Scene


def starting_scene(scene: Scene, medium: Medium, size_mm: float) -> Scene:
    """`scene` with a material guessed for `medium`, its bounding sphere `size_mm` millimetres across."""
    reflectance = np.clip(total_diffuse_reflectance(medium.sigma_s_prime, medium.sigma_a, 1.0), 0.0, 1.0)
    fall = float(np.average(sigma_tr(medium.sigma_s_prime, medium.sigma_a), weights=reflectance))
    return scene.replace(
        {
            "material.diffuse": tuple(map(float, reflectance)),
            "material.ambient": 1.0,
            "material.diffuse_contribution": 1.0,
            "material.thickness_exponent": float(np.clip(fall * size_mm, *EXPONENTS)),
            "material.backlight": light_behind(scene),
            "material.diffuse_weight": 0.0,
        }
    )


def light_behind(scene: Scene) -> float:
    """Irradiance over pi of a surface at the sphere's centre that faces away from the camera, as luminance."""
    towards_camera = View.of(scene.camera, scene.size).rotation[2]
    total = 0.0
    for light in lights_of(scene):
        facing = max(float(-towards_camera @ direction(light.azimuth, light.elevation)), 0.0)
        total += float(luminance(np.array(light.ambient) + facing * np.array(light.diffuse)))
    return total
