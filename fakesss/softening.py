"""The depth-aware Gaussian in numpy: the reference of `glsl/common_blur.glsl`, and where its taps stand.

The thesis softens with the usual integer table of 5 x 5 taps, one standard deviation apart (appendix C.2.2). Its
variance along an axis is v = 268/273 squared steps, and the other kernels have the same one:

- 3x3: the three-point Gauss-Hermite rule (Abramowitz and Stegun 1964, 25.4.46), weights 1 : 4 : 1 at 0 and
  +-sqrt(3 v). It has a Gaussian's moments up to the fifth.
- 9x9: a Gaussian sampled every half step and cut where the 5 x 5 taps end, at two steps; its own deviation, 1.1244
  steps, makes up for the cut.
- separable: the sums of the 5 x 5 table's rows, first along a row, then down a column of what came out. For equal
  depths that is the table to 0.5 % of its largest weight. The depth weights do not separate: a tap off both axes is
  judged by the depths along its way (Pham and van Vliet, Separable bilateral filtering, 2005).

Layers are (H, W), bottom row first as OpenGL holds them, depths in sphere radii, 0 where nothing is.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]

TABLE = np.array([[1, 4, 7, 4, 1], [4, 16, 26, 16, 4], [7, 26, 41, 26, 7], [4, 16, 26, 16, 4], [1, 4, 7, 4, 1]], float)
VARIANCE = 268 / 273  # of TABLE along an axis, squared steps
DEVIATION_9 = 1.1243561  # of the Gaussian whose nine samples up to two steps off have that variance


@dataclass(frozen=True)
class Kernel:
    """Where the taps of a softening stand."""

    taps: int  # across and down
    spacing: float  # of the taps, in units of `blur.step`
    separable: bool = False

    @property
    def width(self) -> float:
        """From the first tap of a row to the last, in units of `blur.step`."""
        return (self.taps - 1) * self.spacing

    @property
    def side(self) -> Float:
        """Weights (taps,) along an axis, to a factor."""
        away = np.abs(np.arange(self.taps) - self.taps // 2)
        if self.taps == 5:
            return np.asarray(TABLE.sum(axis=0))
        return np.where(away, 1.0, 4.0) if self.taps == 3 else np.exp(-((away * self.spacing / DEVIATION_9) ** 2) / 2)

    @property
    def table(self) -> Float:
        """Weights (taps, taps), to a factor, of a kernel that is not separated."""
        return TABLE if self.taps == 5 else np.outer(self.side, self.side)


KERNELS = {
    "5x5": Kernel(5, 1.0),
    "3x3": Kernel(3, math.sqrt(3 * VARIANCE)),
    "9x9": Kernel(9, 0.5),
    "separable": Kernel(5, 1.0, separable=True),
}


def softened(layer: NDArray[np.floating], kernel: Kernel, tap: tuple[float, float], depth_range: float) -> Float:
    """`layer` (H, W) as the kernel leaves it; `tap`: distance between taps in texels across and down.

    `depth_range`, in sphere radii, is the difference at which a tap's weight reaches 0 (thesis eq. C.1).
    """
    if not kernel.separable:
        return weighted(layer, kernel.table, tap, depth_range)
    row = weighted(layer, kernel.side[None, :], tap, depth_range)
    return weighted(row, kernel.side[:, None], tap, depth_range)


def weighted(layer: NDArray[np.floating], weights: Float, tap: tuple[float, float], depth_range: float) -> Float:
    """The depth-aware mean (H, W) over taps with these `weights` (rows, columns); 0 where `layer` is 0."""
    height, width = layer.shape
    total, counted = np.zeros((2, height, width))
    for (row, column), weight in np.ndenumerate(weights):
        y = nearest(np.arange(height), (row - weights.shape[0] // 2) * tap[1], height)
        x = nearest(np.arange(width), (column - weights.shape[1] // 2) * tap[0], width)
        depth = layer[np.ix_(y, x)].astype(np.float64)
        counts = np.where(depth > 0, weight * (1 - np.clip(np.abs(depth - layer) / depth_range, 0, 1)), 0)
        total += counts * (depth - layer)
        counted += counts
    return np.where(layer > 0, layer + total / np.where(counted > 0, counted, 1), 0)


def nearest(place: NDArray[np.int64], offset: float, size: int) -> NDArray[np.int64]:
    """The texels that hold the points `offset` off the centres of texels `place`; the last one beyond the edge."""
    texels: NDArray[np.int64] = np.clip(np.floor(place + 0.5 + offset), 0, size - 1).astype(np.int64)
    return texels
