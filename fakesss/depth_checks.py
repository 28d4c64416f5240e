"""What the depth layers can tell apart, and how far on the object the softening reaches."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.camera import View
from fakesss.hard_edges import either
from fakesss.passes.soften import PUBLISHED_STEP
from fakesss.scene import Scene
from fakesss.softening import KERNELS

Float = NDArray[np.float64]
Mask = NDArray[np.bool_]

ORIGIN = 2.0  # of the layers, in front of the sphere's centre: glsl/common_layers.glsl


def depth_precision(layer: NDArray[np.float32]) -> tuple[Float, Mask]:
    """Bits that part a pixel's depth from its neighbours' (H, W), and which pixels share a neighbour's depth exactly.

    Bits: log2 of the largest step to one of the four neighbours, in spacings of float32 at that depth; at least 0.
    """
    depth = np.where(layer > 0, layer.astype(np.float64), np.nan)
    largest, same = np.zeros(layer.shape), np.zeros(layer.shape, np.bool_)
    for axis in (0, 1):
        step = np.abs(np.diff(depth, axis=axis))
        same |= either(step == 0, axis)
        for side in ((0, 1), (1, 0)):
            of_pixel = np.pad(np.nan_to_num(step), [side if a == axis else (0, 0) for a in (0, 1)])
            largest = np.maximum(largest, of_pixel)
    spacing = np.spacing(np.maximum(layer, np.float32(1)))
    bits: Float = np.log2(np.maximum(largest / spacing, 1.0))
    return bits, same


def blur_width(second: NDArray[Any], scene: Scene) -> Float:
    """Width on the object over which the second layer is softened, in sphere diameters: (H, W), 0 where nothing is.

    From the first to the last tap of a row, where they meet the second layer (`second`, sphere radii).
    """
    view = View.of(scene.camera, scene.size)
    share = PUBLISHED_STEP if scene.style == "as published" else view.in_picture(2 * scene.blur.step)[0]
    intervals = KERNELS[scene.blur.kernel].width
    depth = np.asarray(second, np.float64) - ORIGIN + view.distance
    width: Float = np.where(np.asarray(second) > 0, intervals * share * depth * view.tangent[0], 0.0)
    return width
