"""The softening of the second layer as the integral that its taps stand for.

    z(p) = z2(p) + int G(u) w(z2(p + u) - z2(p)) (z2(p + u) - z2(p)) du  /  int G(u) w(z2(p + u) - z2(p)) du,
    w(d) = max(1 - |d| / range, 0), 0 where there is no second layer,

over the square |ux|, |uy| <= 2.5 steps, G a Gaussian so wide that, cut there, its variance is that of every kernel's
taps (`softening.VARIANCE`). With cells of one step by one step its integrals, 1 : 0.631 : 0.158 along a side, are what
the 5x5 table rounds to 41 : 26 : 7. Thesis section 3.1 and appendix C.2.2, in linear depth.
Here cells are at most a quarter of a step wide, so that there are 400 taps or more.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import ndtr

from fakesss.camera import View
from fakesss.problem import BadInput
from fakesss.scene import Scene
from fakesss.softening import VARIANCE

Floats32 = NDArray[np.float32]
Integers = NDArray[np.int64]

HALF_WIDTH = 2.5  # of the square, in steps
CELLS = 4  # in a step, at least
LEAST = 1 / 32  # pixels: a step below softens nothing that a pixel shows, and needs cells without end
MOST = 10**8  # cells of one tile: 400 MB
EMPTY = np.float32(1e9)  # stands for no second layer: farther from any depth than any range


@dataclass(frozen=True)
class Kernel:
    """Taps on a grid of depths: `weights` (2 R + 1,) along a side, `stride` grid cells apart."""

    weights: NDArray[np.float64]
    stride: int
    depth_range: float  # sphere radii

    @property
    def margin(self) -> int:
        """Grid cells from the middle to the outermost tap."""
        return len(self.weights) // 2 * self.stride

    def __call__(self, second: NDArray[Any], rows: Integers, columns: Integers) -> Floats32:
        """Softened depths (N,), NaN where there is none, of the cells of a grid of depths (H, W) in these places.

        They lie `margin` or more from its edges.
        """
        depths = np.where(np.isnan(second), EMPTY, second).astype(np.float32)
        result = depths[rows, columns]
        found = np.flatnonzero(result < EMPTY)
        here, middle, flat = (rows * depths.shape[1] + columns)[found], result[found], depths.ravel()
        total, weights, steepness = np.zeros_like(middle), np.zeros_like(middle), np.float32(1 / self.depth_range)
        away = (np.arange(len(self.weights)) - len(self.weights) // 2) * self.stride
        for down, of_row in zip(away, self.weights.astype(np.float32), strict=True):
            for right, of_column in zip(away, self.weights.astype(np.float32), strict=True):
                off = flat[here + (down * depths.shape[1] + right)] - middle
                weight = of_row * of_column * np.maximum(1 - np.abs(off) * steepness, 0)
                total += weight * off
                weights += weight
        result[found] += total / weights
        result[result == EMPTY] = np.nan
        return result


def step_of(scene: Scene, view: View, width: int) -> float:
    """`blur.step` in cells of a grid with `width` of them across the picture."""
    return float(view.in_picture(2 * scene.blur.step)[0] * width)


def kernel(scene: Scene, view: View, size: tuple[int, int]) -> Kernel:
    """The filter of `scene` on a grid of depths of `size` over the picture, which should have `CELLS` in a step."""
    step = step_of(scene, view, size[0])
    return dense(step, max(int(step / CELLS), 1), 2 * scene.blur.depth_range)


def dense(step: float, stride: int, depth_range: float) -> Kernel:
    """Taps `stride` cells apart, `step` of which are a step: integrals over theirs of a Gaussian of the variance."""
    return Kernel(integrals(stride / step), stride, depth_range)


@cache
def integrals(width: float) -> NDArray[np.float64]:
    """Of the Gaussian over cells `width` steps wide: so that a mean over their middles has `VARIANCE`."""
    reach = int(np.ceil(HALF_WIDTH / width - 0.5))
    middles = (np.arange(2 * reach + 1) - reach) * width
    edges = np.clip((np.arange(2 * reach + 2) - reach - 0.5) * width, -HALF_WIDTH, HALF_WIDTH)

    def beyond(deviation: float) -> float:
        weights = np.diff(ndtr(edges / deviation))
        return float((weights * middles**2).sum() / weights.sum() - VARIANCE)

    return np.asarray(np.diff(ndtr(edges / brentq(beyond, 0.5, 2))))


def finer(scene: Scene, view: View, width: int) -> int:
    """How many times finer than `width` samples in a row depths must be known: odd, so that samples are among them."""
    step = step_of(scene, view, width)
    return 2 * int(np.ceil((CELLS / step - 1) / 2)) + 1 if step < CELLS else 1


def check_cells(scene: Scene, shape: tuple[int, int]) -> None:
    """`BadInput` where a tile's softening looks at more cells (rows, columns) than memory should hold."""
    if shape[0] * shape[1] > MOST:
        raise BadInput(
            f"blur.step: {scene.blur.step:g} sphere diameters take {shape[1]} x {shape[0]} rays to soften one tile of "
            "the exact picture; take a smaller step or a smaller picture"
        )
