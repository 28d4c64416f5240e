"""Each term of the lighting equation 3.6 alone, for every light of a scene at once."""

import numpy as np
from numpy.typing import NDArray

from fakesss.colour import decode_srgb, to_8bit
from fakesss.renderer import shared_renderer
from fakesss.scene import Scene

TERMS = {  # the weight that a term is multiplied with, and the term
    "ambient": ("material.ambient", "a ka Kd Ia"),
    "diffuse": ("material.diffuse_contribution", "wd Kd Id max(N.L, 0)"),
    "specular": ("material.specular_contribution", "ws ks Is max(N.H, 0)^n"),
    "backlight": ("material.backlight", "wb (1 - t)^r (Kd + Kb)"),
}
BRIGHT = 0.8  # of the display's white: what the brightest pixels of a dark term are raised to at most
BRIGHTEST = 99.5  # percentile
MOST = 64


def alone(scene: Scene, term: str) -> Scene:
    """`scene` with the weights of all other terms 0."""
    return scene.replace({weight: 0.0 for name, (weight, _) in TERMS.items() if name != term})


def lighting_term(scene: Scene, term: str, background: NDArray[np.float64]) -> tuple[NDArray[np.uint8], str]:
    """8-bit RGB (H, W, 3) of one term over `background` (sRGB code values 0..1), and a note of what it shows.

    A dark term is shown brighter by a power of two, and a negative one by its size; the note says so.
    """
    image = shared_renderer().render(alone(scene, term).replace({"background": (0.0, 0.0, 0.0)})).image
    light, coverage = np.abs(image[..., :3].astype(np.float64)), image[..., 3:]
    behind = (1 - coverage) * decode_srgb(background)
    weight, note = TERMS[term]
    if not light.any():
        return to_8bit(behind), "the scene has none" if scene.at(weight) else f"{weight} is 0"
    factor = brightening(light[coverage[..., 0] > 0])
    sign = "- " if image.min() < 0 else ""
    return to_8bit(factor * light + behind), f"{sign}{note}{f', {factor} times' if factor > 1 else ''}"


def brightening(light: NDArray[np.float64]) -> int:
    """The power of two, 1 to MOST, that shows covered pixels (N, 3) of linear light well."""
    bright = float(np.percentile(light.max(axis=1), BRIGHTEST))
    return int(2 ** np.clip(np.floor(np.log2(BRIGHT / max(bright, BRIGHT / MOST))), 0, np.log2(MOST)))
