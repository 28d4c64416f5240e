"""Shadow maps: what each light sees, where its map stands in the one texture, and how it is read.

The reference of `glsl/common_shadow.glsl`. Lengths are in sphere radii. A map holds linear depth along its axis. One
map serves a light that sees the object in a narrow enough cone; a light at or in the sphere takes the six sides of a
cube, which stand one after the other.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fakesss.brdf import Array
from fakesss.camera import NEAREST, SPHERE_MARGIN, View, direction
from fakesss.lights import Light

WIDEST = 60.0  # degrees: half angle of one perspective map; beyond it the texels at the edge grow too long
CUBE_HALF_WIDTH = 1.25  # of a side's map at depth 1: a quarter more than the side, for taps across its edge
TEXELS_PER_PIXEL = 4  # of the picture's longer side, where the scene gives no size
LARGEST = 4096  # texels, side of such a map
MOST_TEXELS = 8192  # side of all maps together, where the scene gives no size
STEEPEST = 30.0  # slope, depth per length across, from which on a surface counts as no steeper
REACH = 0.2  # how far before a surface its own plane is followed
FLIP = np.diag([1.0, 1.0, -1.0])  # between z towards the viewer and depth away from it
SIDES = np.array(  # of a cube: rotations that put ahead what was ahead, back, right, left, up, down
    [
        [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
        [[-1, 0, 0], [0, 1, 0], [0, 0, -1]],
        [[0, 0, -1], [0, 1, 0], [1, 0, 0]],
        [[0, 0, 1], [0, 1, 0], [-1, 0, 0]],
        [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
        [[1, 0, 0], [0, 0, 1], [0, -1, 0]],
    ],
    float,
)


@dataclass(frozen=True, eq=False)
class MapView:
    """One map: how camera coordinates (right, up, beyond the sphere's centre) become a place and a depth in it."""

    turn: Array  # (3, 3)
    centre: Array  # (3,), of the sphere as the map sees it
    width: tuple[float, float]  # a, b: what lies at depth z is seen in a width that grows as a + b z
    half_width: float  # of the map, in those widths
    ends: tuple[float, float]  # depths that the map spans

    @property
    def uniforms(self) -> dict[str, Any]:
        """Those of `glsl/shadow.vert`."""
        (near, far), (a, b) = self.ends, self.width
        return {
            "turn": tuple(self.turn.T.ravel()),
            "centre": tuple(self.centre),
            "opening": (a, b, self.half_width),
            "ends": (near, far, a + b * near, a + b * far),
        }


def light_rotation(light: Light) -> Array:
    """(3, 3) from the world frame to that of a camera that looks from the light to the sphere's centre."""
    towards, right = direction(light.azimuth, light.elevation), direction(light.azimuth + 90, 0)
    return np.array([right, np.cross(towards, right), towards])


def is_outside(light: Light) -> bool:
    """Whether the light is outside the bounding sphere."""
    return light.kind == "directional" or light.distance > 1


def half_angle(light: Light) -> float:
    """Degrees of the cone that the light reaches the bounding sphere in; 180 for a point light inside."""
    sphere = math.degrees(math.asin(1 / light.distance)) if is_outside(light) else 180.0
    return min(sphere, light.cutoff) if light.kind == "spot" else sphere


def map_views(light: Light, view: View) -> list[MapView]:
    """The one or six maps of a light, for points as the camera of `view` sees them."""
    turn = FLIP @ light_rotation(light) @ view.rotation.T @ FLIP
    wide, nothing = 1 + SPHERE_MARGIN, np.zeros(3)
    if light.kind == "directional":
        return [MapView(turn, nothing, (1.0, 0.0), wide, (-wide, wide))]
    d = light.distance
    if (half := half_angle(light)) <= WIDEST:
        near = max(d - wide, NEAREST) - d
        extent = math.tan(math.radians(half)) * wide
        return [MapView(turn, nothing, (d, 1.0), extent, (near, wide))]
    ends = (NEAREST, d + wide)
    away = np.array([0.0, 0.0, d])
    return [MapView(side @ turn, side @ away, (0.0, 1.0), CUBE_HALF_WIDTH, ends) for side in SIDES]


@dataclass(frozen=True)
class Atlas:
    """Square maps of equal size in rows of one texture."""

    maps: int
    side: int  # texels
    columns: int

    @property
    def size(self) -> tuple[int, int]:
        """Texels of the texture; one map's even if there is none."""
        rows = -(-self.maps // self.columns) or 1
        return self.columns * self.side, rows * self.side

    def corner(self, number: int) -> tuple[int, int]:
        """The first texel of a map."""
        return number % self.columns * self.side, number // self.columns * self.side


def atlas(lights: Sequence[Light], map_size: int | None, picture: tuple[int, int]) -> Atlas:
    """Room for the maps of `lights` (those that cast shadows); `picture` is its size in pixels."""
    maps = sum(1 if light.kind == "directional" or half_angle(light) <= WIDEST else 6 for light in lights)
    columns = max(math.ceil(math.sqrt(maps)), 1)
    side = map_size or max(min(TEXELS_PER_PIXEL * max(picture), LARGEST, MOST_TEXELS // columns), 16)
    return Atlas(maps, side, columns)


def slope_bias(bias: float, n_dot_l: ArrayLike) -> Array:
    """clamp(b tan(acos N.L), b, 2 b), finite also at 90 degrees."""
    c = np.asarray(n_dot_l, float)
    return np.asarray(bias * np.clip(np.sqrt(np.maximum(1 - c * c, 0)) / np.maximum(c, 0.25), 1, 2))


def cube_side(points: Array) -> NDArray[np.int64]:
    """Which of `SIDES` each of the points (..., 3) lies in, seen from the cube's middle."""
    x, y, z = np.moveaxis(points, -1, 0)
    ahead, aside = np.abs(z) >= np.maximum(np.abs(x), np.abs(y)), np.abs(x) >= np.abs(y)
    return np.where(ahead, np.where(z > 0, 0, 1), np.where(aside, np.where(x > 0, 2, 3), np.where(y > 0, 4, 5)))


def depth_slope(normal: Array, along: Array) -> Array:
    """(..., 2): how a surface's depth changes across the map, per length at its own depth, at most `STEEPEST`.

    `along` (..., 3) is the ray from the light, of length 1 along the map's axis.
    """
    slope = -normal[..., :2] / np.minimum((normal * along).sum(axis=-1), -1e-6)[..., None]
    length = np.maximum(np.linalg.norm(slope, axis=-1), 1e-6)
    return np.asarray(slope * np.minimum(1.0, STEEPEST / length)[..., None])
