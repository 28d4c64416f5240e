"""Polygons of mesh files, cut into triangles: the readers' fan from the first corner is wrong where one bends inwards.

A fan from a corner fills a simple polygon exactly if none of its triangles is turned against the polygon's own
normal; every convex polygon, every quad and most others have such a corner.
"""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

OVERLAP = 1e-3  # share of the polygon's area that a fan may cover wrongly: a polygon that is not quite flat
SLIVER = 1e-6  # area, in squares of the polygon's extent, below which a polygon draws nothing
NEEDS_CUTTING = re.compile(rb"^[ \t]*f(?:[ \t]+\S+){4}", re.MULTILINE)
COUNTS_BACK = re.compile(rb"^[ \t]*f[^\n]*[ \t]-", re.MULTILINE)
VERTEX_0 = re.compile(rb"^[ \t]*f[^\n]*[ \t]0+(?![0-9])", re.MULTILINE)
PLY_CORNERS = ("vertex_indices", "vertex_index")


class UnfitPolygons(ValueError):
    """What is wrong with the polygons of a file, and the mend, as the end of a sentence about that file."""


def triangles(positions: Floats, polygons: Sequence[Sequence[int] | Indices]) -> Indices:
    """Triangles (F, 3) that fill the polygons, in the order of their number of corners.

    Raises `UnfitPolygons` for vertices that are not there, and where no fan fills a polygon.
    """
    counts = np.array([len(polygon) for polygon in polygons])
    found = [np.zeros((0, 3), np.int64)]
    bad = 0
    for corners in np.unique(counts[counts > 2]):
        block = np.array([polygon for polygon in polygons if len(polygon) == corners], np.int64)
        check_vertices(positions, block)
        first, fits = best_fans(positions, block)
        bad += int((~fits).sum())
        turned = np.take_along_axis(block, (first[:, None] + np.arange(corners)) % corners, axis=1)
        fan = [turned[:, [0, corner, corner + 1]] for corner in range(1, corners - 1)]
        found.append(np.stack(fan, axis=1).reshape(-1, 3))
    if bad:
        have = "1 polygon that bends" if bad == 1 else f"{bad:,} polygons that bend"
        raise UnfitPolygons(f"has {have} inwards too much to be cut into triangles; triangulate when exporting")
    return np.concatenate(found)


def check_vertices(positions: Floats, corners: NDArray[np.integer[Any]]) -> None:
    """`UnfitPolygons` unless every corner is the index of a vertex."""
    missing = ((corners < 0) | (corners >= len(positions))).any(axis=1).sum()
    if missing:
        name = "1 face that names" if missing == 1 else f"{missing:,} faces that name"
        raise UnfitPolygons(f"has {name} vertices that are not there; export it again")


def best_fans(positions: Floats, block: Indices) -> tuple[Indices, NDArray[np.bool_]]:
    """For polygons (N, k) the corner to fan from, the first that fits, and whether one does."""
    points = positions[block]
    finite = np.asarray(np.isfinite(points).all(axis=(1, 2)))  # the others are refused later, for what they are
    points = np.where(finite[:, None, None], points, 0)
    points = points / max(np.abs(points).max(), np.finfo(float).tiny)
    points = points - points[:, :1]
    extent = np.abs(points).max(axis=(1, 2), keepdims=True)
    points = points / np.where(extent > 0, extent, 1)
    normal = np.cross(points, np.roll(points, -1, axis=1)).sum(axis=1)
    area = np.sqrt((normal**2).sum(axis=1))
    unit: Floats = normal / np.where(area > 0, area, 1)[:, None]
    first = np.zeros(len(block), np.int64)
    fits = area < SLIVER
    if block.shape[1] == 3:
        fits[:] = True
    for corner in range(block.shape[1]):
        left = np.flatnonzero(~fits)
        around = np.roll(points[left], -corner, axis=1) - points[left, corner][:, None]
        turns = np.einsum("nki,ni->nk", np.cross(around[:, 1:-1], around[:, 2:]), unit[left])
        good = left[-np.minimum(turns, 0).sum(axis=1) <= OVERLAP * area[left]]
        first[good], fits[good] = corner, True
    return first, fits


def cut_obj(text: bytes) -> tuple[Floats, Indices] | None:
    """Vertices and triangles of an OBJ with polygons or with indices that count back; None where all is plain.

    Plain files are left to the library, which is much faster on them. Raises `UnfitPolygons`, and ValueError for
    what is no OBJ.
    """
    if VERTEX_0.search(text):
        raise UnfitPolygons("has a face that names vertex 0, and an OBJ counts from 1; export it again")
    if not NEEDS_CUTTING.search(text) and not COUNTS_BACK.search(text):
        return None
    vertices: list[list[bytes]] = []
    polygons = []
    for line in re.sub(rb"\\\r?\n", b" ", text).splitlines():
        words = line.split(b"#")[0].split()
        if words[:1] == [b"v"]:
            vertices.append(words[1:4])
        elif words[:1] == [b"f"]:
            named = [int(word.split(b"/")[0]) for word in words[1:]]
            polygons.append([index - 1 if index > 0 else index + len(vertices) for index in named])
    positions = np.array(vertices).astype(np.float64)
    return positions, triangles(positions, polygons)


def cut_ply(elements: Mapping[str, Any]) -> tuple[Floats, Indices] | None:
    """Vertices and triangles of a PLY with polygons, from its elements as read; None if it has none."""
    faces = elements["face"]["data"]
    names = faces.dtype.names if isinstance(faces, np.ndarray) else faces
    name = next((known for known in PLY_CORNERS if known in names), None)
    if name is None:
        return None
    polygons = faces[name]["f1"] if isinstance(faces, np.ndarray) else faces[name]
    if (polygons.ndim == 2 and polygons.shape[1] == 3) or all(len(polygon) == 3 for polygon in polygons):
        return None
    vertices = elements["vertex"]["data"]
    positions = np.column_stack([np.ravel(vertices[axis]) for axis in "xyz"]).astype(np.float64)
    return positions, triangles(positions, list(polygons))
