"""Every surface that a ray crosses, in order: for references and for what must know inside from outside."""

import numpy as np
from numpy.typing import NDArray

from fakesss.mesh import Mesh
from fakesss.ray_casting import NOTHING, Caster
from fakesss.vertex_normals import face_normals

Floats = NDArray[np.float64]

STEP = 1e-5  # past a hit before looking for the next, in sphere radii: some 40 float32 steps at the surface
MOST = 64  # hits of one ray that are followed


class Crossings:
    """Rays through a mesh: `Crossings(mesh)(origins, directions)`.

    Embree finds the triangles, distances are computed again in float64 from the triangle's plane.
    """

    def __init__(self, mesh: Mesh) -> None:
        self._caster = Caster(mesh)
        self.normals = face_normals(mesh.positions, mesh.faces)
        self._corner = mesh.positions[mesh.faces[:, 0]].astype(np.float64)

    def __call__(self, origins: Floats, directions: Floats) -> tuple[Floats, NDArray[np.int8]]:
        """Distances and sides (N, K) of the K <= `MOST` first hits of each of N rays, nearest first.

        Origins and unit directions are (N, 3). Distances are in sphere radii, NaN where nothing more is hit. A side is
        -1 where the ray meets a front face, 1 where it meets a back face, else 0.
        """
        distances: list[Floats] = []
        sides: list[NDArray[np.int8]] = []
        start, going = np.zeros(len(origins)), np.arange(len(origins))
        while len(going) and len(distances) < MOST:
            begin, along = origins[going] + start[going, None] * directions[going], directions[going]
            face = self._caster.first_face(begin.astype(np.float32), along.astype(np.float32))
            hit = face != NOTHING
            going, face, begin, along = going[hit], face[hit], begin[hit], along[hit]
            if not len(going):
                break
            cosine = (self.normals[face] * along).sum(axis=1)
            ahead = ((self._corner[face] - begin) * self.normals[face]).sum(axis=1)
            # a triangle edge-on has no one distance; where the ray meets it is then as good as its corner
            away = np.divide(ahead, cosine, out=np.zeros_like(ahead), where=np.abs(cosine) > 1e-9)
            distance, side = np.full(len(origins), np.nan), np.zeros(len(origins), np.int8)
            distance[going] = start[going] + np.maximum(away, 0)
            side[going] = np.sign(cosine)
            start[going] = distance[going] + STEP
            distances.append(distance)
            sides.append(side)
        shape = (len(origins), len(distances))
        return np.array(distances).T.reshape(shape), np.array(sides, np.int8).T.reshape(shape)


def paths(distances: Floats, sides: NDArray[np.int8]) -> Floats:
    """The way inside (N,): the sum of exits less the sum of entries; NaN for a ray that enters more or less often."""
    inside = np.nansum(np.where(sides == 0, 0, sides * distances), axis=1)
    return np.where(sides.sum(axis=1) == 0, inside, np.nan)


def bridged_paths(distances: Floats, gap: float, intervals: int = 3) -> Floats:
    """The first `intervals` stretches inside (N,), each times exp(-width of the gaps before it / `gap`)."""
    total, gaps = np.zeros(len(distances)), np.zeros(len(distances))
    for entry in range(0, min(2 * intervals, distances.shape[1] - 1), 2):
        if entry:
            gaps += np.nan_to_num(distances[:, entry] - distances[:, entry - 1], nan=np.inf)
        total += np.exp(-gaps / gap) * np.nan_to_num(distances[:, entry + 1] - distances[:, entry])
    return total
