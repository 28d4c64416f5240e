"""The softening of the second layer as the integral that its taps stand for.

    z(p) = z2(p) + int G(u) w(z2(p + u) - z2(p)) (z2(p + u) - z2(p)) du  /  int G(u) w(z2(p + u) - z2(p)) du,
    w(d) = max(1 - |d| / range, 0), 0 where there is no second layer,

over the square |ux|, |uy| <= 2.5 steps, G the Gaussian whose standard deviation is one step. A tap of the 5x5 table
stands for its cell of one step by one step: the Gaussian's integral over the cells, 1 : 0.631 : 0.158 along a side, is
what the table rounds to 41 : 26 : 7. Thesis section 3.1 and appendix C.2.2, in linear depth.
Here cells are at most a quarter of a step wide, so that there are 400 taps or more.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from fakesss.camera import View
from fakesss.scene import Scene

Floats32 = NDArray[np.float32]

HALF_WIDTH = 2.5  # of the square, in steps
CELLS = 4  # in a step, at least
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

    def __call__(self, second: NDArray[Any], every: int = 1) -> Floats32:
        """Softened depths, NaN where there is none, of the cells in the middle of each square of `every` x `every`.

        `second` is a grid of depths (H every + 2 margin, W every + 2 margin), `every` is odd; the result is (H, W).
        """
        depths = np.where(np.isnan(second), EMPTY, second).astype(np.float32)
        middle = depths[self.margin + every // 2 : len(depths) - self.margin : every]
        middle = middle[:, self.margin + every // 2 : depths.shape[1] - self.margin : every]
        height, width = middle.shape
        total, weights, steepness = np.zeros_like(middle), np.zeros_like(middle), np.float32(1 / self.depth_range)
        for row, of_row in enumerate(self.weights.astype(np.float32)):
            for column, of_column in enumerate(self.weights.astype(np.float32)):
                tap = depths[row * self.stride + every // 2 :: every, column * self.stride + every // 2 :: every]
                off = tap[:height, :width] - middle
                weight = of_row * of_column * np.maximum(1 - np.abs(off) * steepness, 0)
                total += weight * off
                weights += weight
        return np.where(middle < EMPTY, middle + total / weights, np.float32(np.nan))


def kernel(scene: Scene, view: View, size: tuple[int, int]) -> Kernel:
    """The filter of `scene` on a grid of depths of `size` over the picture, which should have `CELLS` in a step."""
    step = view.in_picture(2 * scene.blur.step)[0] * size[0]
    return dense(step, max(int(step / CELLS), 1), 2 * scene.blur.depth_range)


def dense(step: float, stride: int, depth_range: float) -> Kernel:
    """Taps `stride` cells apart for a Gaussian whose standard deviation is `step` cells: its integrals over theirs."""
    reach = int(np.ceil(HALF_WIDTH * step / stride - 0.5))
    edges = (np.arange(2 * reach + 2) - reach - 0.5) * stride / step
    return Kernel(np.diff(ndtr(np.clip(edges, -HALF_WIDTH, HALF_WIDTH))), stride, depth_range)


def finer(scene: Scene, view: View, width: int) -> int:
    """How many times finer than `width` samples in a row depths must be known: odd, so that samples are among them."""
    step = view.in_picture(2 * scene.blur.step)[0] * width
    return 2 * int(np.ceil((CELLS / step - 1) / 2)) + 1 if step < CELLS else 1
