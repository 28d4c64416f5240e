"""Screen-space ambient occlusion in numpy: the reference of `glsl/sample_occlusion.frag` and `screen_occlusion.frag`.

Images are (H, W), bottom row first as OpenGL holds them, since the tile of rotations is counted from there. Lengths are
in sphere radii. References stand in the GLSL.
"""

import math

import numpy as np
from numpy.typing import NDArray

from fakesss.camera import View
from fakesss.scene import Occlusion

Floats = NDArray[np.floating]
Float = NDArray[np.float64]

POINTS = 4  # of each direction
TILE = np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]]) / 16
GOLDEN_ANGLE = math.pi * (3 - math.sqrt(5))
PLASTIC = 0.75487766625  # 1 / 1.32472
ORIGIN = 2.0  # of layers, glsl/common_layers.glsl
EDGE = np.array([0.5, 1.0, 1.0, 1.0, 0.5])  # weights of the taps along a side: each of four rotations once


def sampled(front: Floats, surface: Floats, view: View, settings: Occlusion) -> Float:
    """Share (H, W) of directions that nothing in `front` blocks; 0 where nothing is covered.

    `surface` (H, W, 4) holds the unit normals in the eye frame.
    """
    height, width = front.shape
    y, x = np.nonzero(front > 0)
    middle = unprojected(x, y, front, view)
    normal = surface[y, x, :3].astype(np.float64)
    frame = (*frame_around(normal), normal)
    tile = TILE[y & 3, x & 3]
    count = settings.samples // POINTS
    blocked = np.zeros(len(x))
    for number in range(count):
        local = direction((number + 0.5) / count, 2 * math.pi * tile + number * GOLDEN_ANGLE, settings.sampling)
        ray = sum(local[:, [axis]] * frame[axis] for axis in range(3))
        first = (tile + number * PLASTIC) % 1
        points = [middle + (2 * settings.radius * (k + first) / POINTS)[:, None] * ray for k in range(POINTS)]
        blocked += np.max([hidden(point, middle, normal, front, view, settings) for point in points], axis=0)
    result = np.zeros((height, width))
    result[y, x] = 1 - blocked / count
    return result


def unprojected(x: NDArray[np.int64], y: NDArray[np.int64], front: Floats, view: View) -> Float:
    """Points (N, 3) of the texels in the eye frame, from the sphere's centre."""
    height, width = front.shape
    layer = front[y, x].astype(np.float64)
    beyond = layer - ORIGIN
    depth = beyond + view.distance
    across = (2 * (x + 0.5) / width - 1) * view.tangent[0] * depth
    return np.column_stack([across, (2 * (y + 0.5) / height - 1) * view.tangent[1] * depth, -beyond])


def frame_around(n: Float) -> tuple[Float, Float]:
    """Two unit vectors (N, 3) that make a frame with unit `n`: Duff and others (2017)."""
    x, y, z = n.T
    sign = np.where(z >= 0, 1.0, -1.0)
    a = -1 / (sign + z)
    b = x * y * a
    return np.column_stack([1 + sign * x * x * a, sign * b, -sign * x]), np.column_stack([b, sign + y * y * a, -y])


def direction(share: float, turn: Float, sampling: str) -> Float:
    """Unit directions (N, 3) around the third axis: `share` 0..1 from the pole outwards, `turn` in radians."""
    up = 1 - share if sampling == "uniform" else math.sqrt(1 - share)
    across = math.sqrt(1 - up * up)
    return np.column_stack([across * np.cos(turn), across * np.sin(turn), np.full(len(turn), up)])


def hidden(point: Float, middle: Float, normal: Float, front: Floats, view: View, settings: Occlusion) -> Float:
    """Whether the front layer hides `point` in the hemisphere around `middle` (all (N, 3)): 0..1, (N,)."""
    height, width = front.shape
    depth = view.distance - point[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        place = 0.5 + 0.5 * point[:, :2] / (depth[:, None] * view.tangent)
    seen = (depth > 0) & (place >= 0).all(axis=1) & (place <= 1).all(axis=1)
    texel = np.minimum(np.where(seen[:, None], place, 0) * (width, height), (width - 1, height - 1)).astype(np.int64)
    occluder = unprojected(texel[:, 0], texel[:, 1], front, view)
    layer, bias = front[texel[:, 1], texel[:, 0]], 2 * settings.bias
    in_front = (layer > 0) & (ORIGIN - point[:, 2] > layer + bias)
    above = ((occluder - middle) * normal).sum(axis=1) > bias
    reach = np.clip(2 - (ORIGIN - middle[:, 2] - layer) / (2 * settings.radius), 0, 1)
    return np.where(seen & in_front & above, reach, 0)


def smoothed(front: Floats, values: Floats, depth_range: float) -> Float:
    """The mean (H, W) of `values` over the tile of rotations, without taps on another part of the object.

    `depth_range` is the difference in depth at which a tap counts nothing. 0 where nothing is covered.
    """
    layers = np.pad(front.astype(np.float64), 2, mode="edge")
    padded = np.pad(values.astype(np.float64), 2, mode="edge")
    height, width = front.shape
    total, weights = np.zeros((2, height, width))
    for row in range(5):
        for column in range(5):
            here = slice(row, row + height), slice(column, column + width)
            weight = EDGE[row] * EDGE[column] * (1 - np.clip(np.abs(layers[here] - front) / depth_range, 0, 1))
            weight = np.where(layers[here] > 0, weight, 0)
            total += weight * padded[here]
            weights += weight
    return np.where(front > 0, total / np.where(weights > 0, weights, 1), 0)
