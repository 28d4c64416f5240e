"""Equation 3.6 as a function of the material alone: what else a picture depends on is drawn once, and kept.

In linear light a pixel is the mean of its samples, so that with k = Kd, B_r = mean of (1 - t)^r over the samples,
and A and D the ambient and diffuse terms drawn with all weights and reflectances 1,

    C = ka k A + wd k D + wb (k + Kb) B_r,

exactly: the same samples, supersampling, lights and shadows as the renderer's own picture (tests: to float32 rounding).
The background is black: what shines through a medium unscattered is of no colour of the object, and not eq. 3.6's.
Not in it: highlights, `style = "as published"` (which clips before it averages), whatever changes t itself.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.lighting_terms import alone
from fakesss.pipeline import samples_of
from fakesss.problem import BadInput
from fakesss.renderer import shared_renderer
from fakesss.scene import Material, Scene

Floats = NDArray[np.float64]

NOTHING = -1e4  # stands for ln 0: at any exponent above 0.08, exp of it times the exponent is 0
BLACK = {"background": (0.0, 0.0, 0.0), "alpha": False}
WHITE = {"material.diffuse": (1.0, 1.0, 1.0), **BLACK}
UNIT = {"material.ambient": 1.0, "material.diffuse_contribution": 1.0, "material.backlight": 1.0}
THROUGH = {"material.thickness_exponent": 1.0, "material.diffuse_weight": 0.0}


@dataclass(frozen=True)
class Basis:
    """What the picture of a scene is made of, for the P pixels in which the shader draws the object."""

    covered: NDArray[np.bool_]  # (H, W)
    coverage: NDArray[np.float32]  # (H, W), 0..1
    ambient: Floats  # (P, 3): A times the exposure
    diffuse: Floats  # (P, 3): D times the exposure
    log_clear: Floats  # (n n, P): ln(1 - t) of the samples of a pixel, NOTHING where one misses the object
    exposure: float

    def backlight(self, exponent: float) -> tuple[Floats, Floats]:
        """B_r times the exposure (P,), and its derivative by ln r (P,); `exponent` > 0.08."""
        clear = self.exposure * np.exp(exponent * self.log_clear)
        return clear.mean(axis=0), exponent * (clear * self.log_clear).mean(axis=0)

    def picture(self, material: Material) -> NDArray[np.float32]:
        """Linear RGB over black, and coverage (H, W, 4), of the object in this material without highlights."""
        colour = np.array(material.diffuse)
        glow = material.backlight * (colour + material.diffuse_weight)
        object_ = colour * (material.ambient * self.ambient + material.diffuse_contribution * self.diffuse)
        object_ += np.multiply.outer(self.backlight(material.thickness_exponent)[0], glow)
        image = np.zeros((*self.covered.shape, 4), np.float32)
        image[self.covered, :3], image[..., 3] = object_, self.coverage
        return image


def matte(scene: Scene) -> Scene:
    """`scene` without highlights, over black: what is fitted, and compared."""
    return scene.replace({"material.specular_contribution": 0.0, **BLACK})


def basis(scene: Scene) -> Basis:
    """The basis of `scene`; of its material only the kind of thickness counts. `BadInput` where there is none."""
    if scene.style != "default":
        raise BadInput(
            'scene: style "as published" clips light before it is averaged; fit a scene in the default style'
        )
    if not scene.exposure:
        raise BadInput("scene: exposure is 0, so the picture is black at any parameters; raise it")
    white = scene.replace({**WHITE, **UNIT, **THROUGH})
    renderer = shared_renderer()
    ambient, diffuse = (renderer.render(alone(white, term)).image for term in ("ambient", "diffuse"))
    covered = ambient[..., 3] > 0
    if not covered.any():
        raise BadInput("scene: no pixel shows the object, so there is nothing to fit; move the camera")
    log_clear = np.ascontiguousarray(of_samples(white)[covered].T)
    if not (log_clear > NOTHING).any():
        raise BadInput(
            "scene: the object is as thick as its sphere at every pixel, so no backlight passes and its parameters "
            'cannot be fitted; set open_surface = "thin" or take a solid object'
        )
    terms = [image[covered][:, :3].astype(np.float64) for image in (ambient, diffuse)]
    return Basis(covered, ambient[..., 3], terms[0], terms[1], log_clear, scene.exposure)


def of_samples(scene: Scene) -> Floats:
    """ln(1 - t) (H, W, n n) of the n x n samples of each pixel."""
    samples = samples_of(scene)
    layer = "blurred_thickness" if scene.blur.enabled else "thickness"
    data = shared_renderer().data(scene, (layer, "front"), samples)
    clear = np.where(data["front"] > 0, 1.0 - np.clip(data[layer].astype(np.float64), 0.0, 1.0), 0.0)
    logarithm = np.full_like(clear, NOTHING)
    np.log(clear, out=logarithm, where=clear > 0)
    height, width = scene.size[1], scene.size[0]
    split: NDArray[Any] = logarithm.reshape(height, samples, width, samples).swapaxes(1, 2)
    return split.reshape(height, width, samples * samples)
