"""Where a fitted picture still differs: its squared error by thickness and by how the surface faces the light.

Noise is taken out: of a bin's squared error the noise variance of its pixels is subtracted, so shares are those of what
the shader cannot match, and one may be slightly below 0 where it matches to within noise.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss import illumination
from fakesss.camera import View
from fakesss.offline.fit_model import Floats
from fakesss.renderer import shared_renderer
from fakesss.scene import Scene

THICKNESSES = (0.0, 0.05, 0.1, 0.2, 0.4, 1.0)  # of t, sphere diameters
COSINES = (-1.0, -0.5, 0.0, 0.5, 1.0)  # of N.L, `scene.light`: negative on the shadow side


def leftover(scene: Scene, picture: NDArray[Any], target: NDArray[Any], noise: NDArray[Any]) -> dict[str, Any]:
    """Bins of the covered pixels (JSON); `picture` and `target` (H, W, 4), `noise` (H, W, 3) of the target.

    Of each bin: its ends, its share of the pixels, its share of the squared error, and the mean error in RGB, positive
    where the shader is too bright.
    """
    layer = "blurred_thickness" if scene.blur.enabled else "thickness"
    data = shared_renderer().data(scene, (layer, "front", "surface"))
    inside = data["front"] > 0
    view = View.of(scene.camera, scene.size)
    towards = illumination.arriving(scene.light, view, illumination.positions(view, data["front"]))[0]
    cosine = (data["surface"][..., :3] * towards).sum(axis=-1)
    difference = picture[..., :3].astype(np.float64) - target[..., :3]
    misfit = (difference**2 - noise.astype(np.float64) ** 2).sum(axis=2)
    pairs = {"thickness": (data[layer], THICKNESSES), "n_dot_l": (cosine, COSINES)}
    return {
        name: bins(values[inside], ends, difference[inside], misfit[inside]) for name, (values, ends) in pairs.items()
    }


def bins(values: NDArray[Any], ends: tuple[float, ...], difference: Floats, misfit: Floats) -> list[dict[str, Any]]:
    """One entry for each stretch of `ends` that holds any of the `values` (P,); `difference` (P, 3), `misfit` (P,)."""
    number = np.clip(np.digitize(values, ends) - 1, 0, len(ends) - 2)
    total = misfit.sum()
    return [
        {
            "from": ends[index],
            "to": ends[index + 1],
            "pixels": float(chosen.mean()),
            "share": float(misfit[chosen].sum() / total) if total > 0 else None,
            "mean_error": [float(channel) for channel in difference[chosen].mean(axis=0)],
        }
        for index in range(len(ends) - 1)
        if (chosen := number == index).any()
    ]
