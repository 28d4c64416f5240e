"""A second layer at every n-th sample: where its samples stand, and the numpy reference of `glsl/common_upsample.glsl`.

Texel (i, j) of the sparse layer stands exactly where sample (n i, n j) of the picture does, so that the front layer
says which part of the object it belongs to. Layers are (H, W), bottom row first, depths in sphere radii, 0 for nothing.

A sample of the front layer with no second layer at any of the four texels around is thinner than they can tell: of a
solid, what lies between them is at most n samples wide. It counts as having none, so that its thickness is 0.

Constants are from trials on the figure, head, relief, shell and a thin plate at 256 to 1024 pixels, n = 2 and 4: half
or twice as much made more pixels wrong.
"""

import numpy as np
from numpy.typing import NDArray

from fakesss.camera import View

Floats = NDArray[np.floating]
Float = NDArray[np.float64]

STEEPEST = 8.0  # rise of a surface from texel to texel, in their width: front layers farther apart are different parts
LEAST = 1e-4  # of a weight, so that whoever is left is taken


def sparse_size(size: tuple[int, int], every: int) -> tuple[int, int]:
    """Width and height of a layer with every n-th sample of a picture of `size`, the first among them."""
    return -(-size[0] // every), -(-size[1] // every)


def placing(size: tuple[int, int], every: int) -> dict[str, tuple[float, float]]:
    """The uniforms of `glsl/sparse.vert`: what window coordinates are scaled and shifted by, both from -1 to 1."""
    texels = sparse_size(size, every)
    scale = tuple(samples / (every * count) for samples, count in zip(size, texels, strict=True))
    shift = tuple(s - 1 + (every - 1) / (every * count) for s, count in zip(scale, texels, strict=True))
    return {"scale": (scale[0], scale[1]), "shift": (shift[0], shift[1])}


def texel_width(view: View, size: tuple[int, int], every: int) -> float:
    """Width of a texel of the sparse layer at the sphere's centre, in sphere radii."""
    return every / (view.in_picture(1.0)[0] * size[0])


def upsampled(sparse: Floats, front: Floats, every: int, texel_width: float) -> Float:
    """The layer (H, W) at every sample of `front`; 0 where `front` is, or where no texel around lies behind it."""
    (height, width), (rows, columns) = front.shape, sparse.shape
    y, x = np.mgrid[:height, :width]
    total, weights = np.zeros((2, height, width))
    for down in (0, 1):
        for right in (0, 1):
            row, column = np.minimum(y // every + down, rows - 1), np.minimum(x // every + right, columns - 1)
            second, guide = sparse[row, column].astype(np.float64), front[row * every, column * every]
            side = np.abs(1 - right - x % every / every), np.abs(1 - down - y % every / every)
            alike = np.maximum(1 - np.abs(guide.astype(np.float64) - front) / (STEEPEST * texel_width), LEAST)
            other = (second == 0) | (second < front.astype(np.float64) - texel_width)
            weight = np.where(other, 0, np.maximum(side[0] * side[1], LEAST) * alike)
            total += weight * (second - front)
            weights += weight
    found = (front > 0) & (weights > 0)
    return np.where(found, front + np.maximum(total / np.where(weights > 0, weights, 1), 0), 0)
