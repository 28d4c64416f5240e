"""A depth map drawn as a landscape seen from above and in front: Gascons (2011), figure 3.7.

A parallel projection without exaggeration. Every column of the picture is solved on its own, from the front row to
the back: what rises above the rows before it is seen (the floating horizon of Wright, *A two-space solution to the
hidden line problem for plotting functions of two variables*, 1973).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib import colormaps
from numpy.typing import NDArray
from scipy import ndimage

from fakesss.contact_sheet import EMPTY

Float = NDArray[np.float64]
Mask = NDArray[np.bool_]
Bytes = NDArray[np.uint8]

TURN = np.radians(-22)  # around the upright
TILT = np.radians(52)  # between the line of sight and the upright
LIGHT = np.array([-0.6, 0.25, 0.76])  # to the light: right, to the back, up
SAMPLES = 2  # along a side of a drawn pixel, in each direction
FILLED = 0.95  # share of the picture's width or height
RIM = 0.07  # of the board around what stands on it, shares of its longer side
BOARD, LINE = (58, 58, 62), (74, 74, 79)  # the ground and the lines on it
SMOOTH = (6, 3)  # standard deviation of the slopes' smoothing, rows and columns of the ground


@dataclass(frozen=True, eq=False)
class Ground:
    """Where the columns and rows of the drawing lie on the map: rows from the front to the back."""

    shape: tuple[int, int]  # of the map
    column: Float  # (R, width), in samples of the map
    row: Float  # (R, width)
    foot: Float  # (R,) drawn pixels from the picture's top to the ground
    scale: float  # drawn pixels of a unit of width

    @property
    def rise(self) -> float:
        """Drawn pixels of a unit of height."""
        return float(self.scale * np.sin(TILT))


def relief(heights: Float, covered: Mask, spacing: float, size: tuple[int, int], colours: str, lines: float) -> Bytes:
    """8-bit RGB (height, width, 3) of `size` (width, height): `heights` (H, W) >= 0 on a board around what is covered.

    `spacing` is the distance between samples and `lines` that between the board's lines, in the unit of the heights.
    Where nothing is `covered` the board shows. `colours` names the matplotlib colour map of heights, the lowest first.
    """
    heights, covered = (around(covered, values) for values in (heights, covered))
    drawn = (size[0] * SAMPLES, size[1] * SAMPLES)
    place = placed(np.where(covered, heights, 0.0), spacing, drawn)
    z, there = sampled(heights, covered, place)
    crest = np.where(inside(place), place.foot[:, None] - z * place.rise, np.inf)
    seen = floating_horizon(crest, drawn[1])
    edge = np.where(np.isfinite(crest).any(axis=0), place.foot[np.argmax(np.isfinite(crest), axis=0)], -np.inf)
    shown = (seen >= 0) & (np.arange(drawn[1])[:, None] <= edge)
    colour = painted(place, z, there, seen, colours, lines / spacing)
    picture: Float = np.where(shown[..., None], colour, np.array(EMPTY))
    blocks = picture.reshape(size[1], SAMPLES, size[0], SAMPLES, 3).mean(axis=(1, 3))
    rounded: Bytes = np.floor(blocks + 0.5).astype(np.uint8)
    return rounded


def around(covered: Mask, values: NDArray[Any]) -> NDArray[Any]:
    """The rectangle of `values` (H, W) that holds what is covered, with a margin of nothing; all of it without any."""
    if not covered.any():
        return values
    (top, bottom), (left, right) = ((at.min(), at.max() + 1) for at in np.nonzero(covered))
    return np.pad(values[top:bottom, left:right], max(1, round(RIM * max(bottom - top, right - left))))


def placed(heights: Float, spacing: float, size: tuple[int, int]) -> Ground:
    """The ground of a map (H, W), as large as fits a picture of `size` together with what stands on it."""
    rows, columns = heights.shape
    cos, sin = np.cos(TURN), np.sin(TURN)
    wide = spacing * (columns * abs(cos) + rows * abs(sin))
    deep = spacing * (columns * abs(sin) + rows * abs(cos))
    right, down = np.arange(columns) - (columns - 1) / 2, np.arange(rows)[:, None] - (rows - 1) / 2
    crests = spacing * (sin * right - cos * down) * np.cos(TILT) + heights * np.sin(TILT)
    front, back = -deep / 2 * np.cos(TILT), max(float(crests.max()), deep / 2 * np.cos(TILT))
    scale = FILLED * min(size[0] / wide, size[1] / (back - front))
    steps = max(2, int(np.ceil(2 * deep * scale * np.cos(TILT))))
    x = (np.arange(size[0]) + 0.5 - size[0] / 2) / scale
    y = np.linspace(-deep / 2, deep / 2, steps)[:, None]
    column = (cos * x + sin * y) / spacing + (columns - 1) / 2
    row = (rows - 1) / 2 - (cos * y - sin * x) / spacing
    foot = size[1] / 2 + scale * ((front + back) / 2 - y[:, 0] * np.cos(TILT))
    return Ground((rows, columns), column, row, foot, scale)


def inside(place: Ground) -> Mask:
    """Which places (R, width) lie on the map."""
    ends = zip((place.row, place.column), place.shape, strict=True)
    down, across = (np.abs(at - (samples - 1) / 2) <= samples / 2 for at, samples in ends)
    on: Mask = down & across
    return on


def sampled(heights: Float, covered: Mask, place: Ground) -> tuple[Float, Mask]:
    """Heights and coverage (R, width) at the places of a ground."""
    if covered.any():  # what lies beyond an outline goes on as beside it, so that no rim slopes to the ground
        nearest = ndimage.distance_transform_edt(~covered, return_distances=False, return_indices=True)
        heights = heights[tuple(nearest)]
    at = np.stack([place.row, place.column])
    z = ndimage.map_coordinates(np.asarray(heights, np.float64), at, order=1, mode="nearest")
    there: Mask = ndimage.map_coordinates(covered.astype(np.float64), at, order=1, mode="constant") > 0.5
    return np.where(there & inside(place), z, 0.0), there


def floating_horizon(crest: Float, height: int) -> NDArray[np.int64]:
    """The row of the ground seen at each pixel (height, width), -1 where none is.

    `crest` (R, width) is the upper end of each row in pixels from the top; rows hang down from there.
    """
    horizon = np.minimum.accumulate(crest, axis=0)
    rises = np.isfinite(horizon)
    rises[1:] &= horizon[1:] < horizon[:-1]
    rows, columns = np.nonzero(rises)
    rows, columns = rows[::-1], columns[::-1]  # of the rows that start at one pixel the first one is to stay
    start = np.clip(np.ceil(horizon[rows, columns]), 0, height - 1).astype(np.int64)
    first = np.full((height, crest.shape[1]), -1)
    first[start, columns] = rows
    above = np.maximum.accumulate(np.where(first >= 0, np.arange(height)[:, None], -1), axis=0)
    seen: NDArray[np.int64] = np.where(above >= 0, np.take_along_axis(first, np.maximum(above, 0), axis=0), -1)
    return seen


def painted(place: Ground, z: Float, there: Mask, seen: NDArray[np.int64], colours: str, every: float) -> Float:
    """RGB 0..255 (height, width, 3) of what is `seen`: heights by colour, slopes by shade, the board elsewhere."""
    row, column = np.maximum(seen, 0), np.arange(seen.shape[1])
    height = (place.foot[row] - np.arange(len(seen))[:, None]) / place.rise  # on a wall that of the pixel itself
    share = np.clip(height / max(z.max(), 1e-12), 0, 1)
    colour = colormaps[colours](share)[..., :3] * 255 * shades(place, z)[row, column][..., None]
    board = np.where(ruled(place, every)[row, column][..., None], LINE, BOARD)
    painted: Float = np.where(there[row, column][..., None], np.clip(colour, 0, 255), board)
    return painted


def shades(place: Ground, z: Float) -> Float:
    """Brightness of slopes (R, width) under a distant light; level ground has 1."""
    step = (place.foot[0] - place.foot[1]) / np.cos(TILT) / place.scale
    y, x = np.gradient(ndimage.gaussian_filter(z, SMOOTH), step, 1 / place.scale)
    lit = np.maximum(LIGHT[2] - LIGHT[0] * x - LIGHT[1] * y, 0) / np.sqrt(1 + x * x + y * y)
    shade: Float = 0.3 + 0.7 * lit / LIGHT[2]
    return shade


def ruled(place: Ground, every: float) -> Mask:
    """Whether a place (R, width) lies on one of the board's lines, `every` so many samples of the map."""
    lines = np.zeros(place.row.shape, np.bool_)
    for at, samples in zip((place.row, place.column), place.shape, strict=True):
        thick = abs(at[0, 1] - at[0, 0]) + abs(at[1, 0] - at[0, 0])  # of a drawn pixel, in samples of the map
        from_middle = (at - (samples - 1) / 2) / every
        lines |= np.abs(from_middle - np.round(from_middle)) * every < 0.7 * SAMPLES * thick
    return lines
