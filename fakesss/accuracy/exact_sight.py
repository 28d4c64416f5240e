"""What the camera sees of an object, and how deep, by rays alone: no rasteriser, no depth buffer, no layers.

Embree finds the triangles, depths and places in them are computed in float64. A ray that slips between two triangles
of a closed mesh is turned by some 2e-6 radians and cast again (`reference.SLIP`). Depths lie along the view axis, in
sphere radii from the sphere's centre. N rays; M of them meet the object.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.camera import View
from fakesss.crossings import MOST, Crossings, Hits, bridged_paths, paths
from fakesss.mesh import Mesh
from fakesss.passes.peel import DEEPEST
from fakesss.reference import ATTEMPTS, SLIP
from fakesss.scene import Scene
from fakesss.vertex_normals import normalised

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Seen:
    """What rays through samples of the picture meet."""

    hit: Mask  # (N,) whether the object is met between the clip planes
    front: Floats  # (N,) depth of the first surface, NaN where there is none
    second: Floats  # (N,) depth of the second layer, whichever `material.thickness` asks for, NaN where there is none
    points: Floats  # (M, 3) the first surface, world frame
    faces: NDArray[np.int32]  # (M,) its triangles
    from_behind: Mask  # (M,) whether these are seen from the back


class Sight:
    """Rays from a scene's camera through any samples: `Sight(scene, mesh, view, rays)(size, rows, columns)`.

    `rays` a vertex are baked where `material.thickness` is "local".
    """

    def __init__(self, scene: Scene, mesh: Mesh, view: View, rays: int) -> None:
        self.mesh, self.view, self.rays = mesh, view, rays
        self.kind, self.layers = scene.material.thickness, scene.layers

    @cached_property
    def crossings(self) -> Crossings:
        """Built when the first ray is cast."""
        return Crossings(self.mesh)

    def __call__(self, size: tuple[int, int], rows: Integers, columns: Integers) -> Seen:
        """What is seen through the cells in these rows and columns (N,) of a grid of `size` over the picture.

        Cells may lie beyond the picture's border.
        """
        origins, directions = rays_through(self.view, size, rows, columns)
        cosine = -(directions @ self.view.rotation[2])
        # rays start at the near plane: what it cuts away is not there, and a far camera costs no digits
        origins = origins + (self.view.near / cosine)[:, None] * directions
        reach = (self.view.far - self.view.near) / cosine
        hits = self.cast(origins, directions, reach)
        depths = hits.distances * cosine[:, None] + self.view.near - self.view.distance
        hit = hits.sides[:, 0] != 0
        points = origins[hit] + hits.distances[hit, :1] * directions[hit]
        return Seen(
            hit,
            front=np.where(hit, depths[:, 0], np.nan),
            second=self.second(hits, depths, points),
            points=points,
            faces=hits.faces[hit, 0],
            from_behind=hits.sides[hit, 0] > 0,
        )

    def cast(self, origins: Floats, directions: Floats, reach: Floats) -> Hits:
        """All that this kind of thickness needs to know of the rays, two columns at least."""
        hits = self.met(origins, directions, reach)
        for attempt in range(ATTEMPTS if self.mesh.watertight else 0):
            doubtful = np.flatnonzero(~self.sound(hits))
            if not len(doubtful):
                break
            aside = np.roll(directions[doubtful], attempt + 1, axis=1) * SLIP * (-1) ** attempt
            again = self.met(origins[doubtful], normalised(directions[doubtful] + aside), reach[doubtful])
            hits = replaced(hits, doubtful, again)
        return hits

    def met(self, origins: Floats, directions: Floats, reach: Floats) -> Hits:
        """The rays' hits: two of each, or all where the way inside is added up."""
        most = MOST if self.kind in ("total-path", "bridged") else 2
        return padded(self.crossings(origins, directions, reach, most), 2)

    def sound(self, hits: Hits) -> Mask:
        """Whether rays (N,) cross a closed surface as they must: in by a front, out by a back, as often out as in."""
        first, after = hits.sides[:, 0], hits.sides[:, 1]
        if hits.sides.shape[1] > 2:
            return np.asarray((first <= 0) & (hits.sides.sum(axis=1) == 0))
        return np.asarray((first == 0) | ((first < 0) & (after > 0)))

    def second(self, hits: Hits, depths: Floats, points: Floats) -> Floats:
        """Where the first stretch inside ends, or would if it were as long as this thickness says (N,)."""
        hit = hits.sides[:, 0] != 0
        if self.kind == "first-interval":
            return np.where(hit, depths[:, 1], np.nan)
        if self.kind == "local":
            ends = np.full(len(depths), np.nan)
            ends[hit] = depths[hit, 0] + 2 * self.local(hits.faces[hit, 0], points)
            return ends
        if self.kind == "total-path":
            return np.where(hit, depths[:, 0] + np.maximum(paths(hits, depths), 0), np.nan)
        inside = bridged_paths(hits, depths, 2 * self.layers.gap, DEEPEST)
        return np.where(hit & (hits.sides[:, 1] != 0), depths[:, 0] + inside, np.nan)

    def local(self, faces: NDArray[np.int32], points: Floats) -> Floats:
        """Baked thickness (M,) at points on `faces`, in sphere diameters."""
        return interpolated(self.mesh, self.baked_local, faces, corner_shares(self.mesh, faces, points))

    @cached_property
    def baked_local(self) -> NDArray[np.float32]:
        """Local thickness at the vertices (V,)."""
        from fakesss.local_thickness import bake_local_thickness

        values: NDArray[np.float32] = bake_local_thickness(self.mesh, self.rays, self.layers.reach).values
        return values


def rays_through(view: View, size: tuple[int, int], rows: Integers, columns: Integers) -> tuple[Floats, Floats]:
    """Origins and unit directions (N, 3) through the middles of cells, as `reference.camera_rays` of a whole grid."""
    across = ((columns + 0.5) / size[0] * 2 - 1) * view.tangent[0]
    up = (1 - (rows + 0.5) / size[1] * 2) * view.tangent[1]
    right, above, towards = view.rotation
    directions = across[:, None] * right + up[:, None] * above - towards
    return np.tile(view.distance * towards, (len(rows), 1)), normalised(directions)


def padded(hits: Hits, columns: int) -> Hits:
    """The same hits with so many columns at least: no further ones."""
    missing = ((0, 0), (0, max(columns - hits.distances.shape[1], 0)))
    return Hits(
        np.pad(hits.distances, missing, constant_values=np.nan),
        np.pad(hits.sides, missing),
        np.pad(hits.faces, missing, constant_values=-1),
    )


def replaced(hits: Hits, which: NDArray[np.intp], by: Hits) -> Hits:
    """`hits` with the rays `which` taken from `by`."""
    columns = max(hits.distances.shape[1], by.distances.shape[1])
    hits, by = padded(hits, columns), padded(by, columns)
    for mine, theirs in ((hits.distances, by.distances), (hits.sides, by.sides), (hits.faces, by.faces)):
        mine[which] = theirs
    return hits


def corner_shares(mesh: Mesh, faces: NDArray[np.int32], points: Floats) -> Floats:
    """Barycentric coordinates (M, 3) of points on `faces`, each 0..1; a third each in a triangle without area."""
    a, b, c = (mesh.positions[mesh.faces[faces, corner]].astype(np.float64) for corner in range(3))
    normal = np.cross(b - a, c - a)
    opposite = [np.cross(second - first, points - first) for first, second in ((b, c), (c, a), (a, b))]
    areas = np.maximum(np.stack([(part * normal).sum(axis=1) for part in opposite], axis=1), 0)
    whole = areas.sum(axis=1, keepdims=True)
    shares: Floats = np.divide(areas, whole, out=np.full_like(areas, 1 / 3), where=whole > 0)
    return shares


def interpolated(mesh: Mesh, values: NDArray[Any], faces: NDArray[np.int32], shares: Floats) -> Floats:
    """Values at vertices (V, ...) carried into `faces` (M,) linearly, as a rasteriser does: (M, ...) float64."""
    at_corners = values[mesh.faces[faces]].astype(np.float64)
    return np.asarray((shares.reshape(*shares.shape, *[1] * (values.ndim - 1)) * at_corners).sum(axis=1))
