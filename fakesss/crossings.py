"""Every surface that a ray crosses, in order: for references and for what must know inside from outside."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fakesss.mesh import Mesh
from fakesss.ray_casting import NOTHING, Caster
from fakesss.vertex_normals import face_normals

Floats = NDArray[np.float64]

STEP = 1e-5  # past a hit before looking for the next, in sphere radii: some 40 float32 steps at the surface
MOST = 64  # hits of one ray that are followed, unless fewer are asked for


@dataclass(frozen=True)
class Hits:
    """What each of N rays crosses, nearest first, K at most: arrays (N, K)."""

    distances: Floats  # sphere radii; NaN where nothing more is hit
    sides: NDArray[np.int8]  # -1 where the ray meets a front face, 1 where it meets a back face, else 0
    faces: NDArray[np.int32]  # which one, else NOTHING


class Crossings:
    """Rays through a mesh: `Crossings(mesh)(origins, directions)`.

    Embree finds the triangles, distances are computed again in float64 from the triangle's plane.
    """

    def __init__(self, mesh: Mesh) -> None:
        self._caster = Caster(mesh)
        self.normals = face_normals(mesh.positions, mesh.faces)
        self.corner = mesh.positions[mesh.faces[:, 0]].astype(np.float64)

    def __call__(self, origins: Floats, directions: Floats, reach: Floats | None = None, most: int = MOST) -> Hits:
        """The first `most` hits of rays with these origins and unit directions (N, 3), no farther than `reach` (N,)."""
        rounds: list[tuple[Floats, NDArray[np.int8], NDArray[np.int32]]] = []
        start, going = np.zeros(len(origins)), np.arange(len(origins))
        left = np.full(len(origins), np.inf) if reach is None else reach
        while len(going) and len(rounds) < most:
            begin, along = origins[going] + start[going, None] * directions[going], directions[going]
            face = self._caster.first_face(begin, along, (left - start)[going])
            hit = face != NOTHING
            going, face, begin, along = going[hit], face[hit], begin[hit], along[hit]
            if not len(going):
                break
            cosine = (self.normals[face] * along).sum(axis=1)
            ahead = ((self.corner[face] - begin) * self.normals[face]).sum(axis=1)
            # a triangle edge-on has no one distance; where the ray meets it is then as good as its corner
            away = np.divide(ahead, cosine, out=np.zeros_like(ahead), where=np.abs(cosine) > 1e-9)
            distance, side = np.full(len(origins), np.nan), np.zeros(len(origins), np.int8)
            named = np.full(len(origins), NOTHING, np.int32)
            distance[going] = start[going] + np.maximum(away, 0)
            side[going], named[going] = np.sign(cosine), face
            start[going] = distance[going] + STEP
            going = going[start[going] < left[going]]
            rounds.append((distance, side, named))
        shape = (len(origins), len(rounds))
        distances, sides, faces = ([one[part] for one in rounds] for part in range(3))
        return Hits(
            np.array(distances, float).T.reshape(shape),
            np.array(sides, np.int8).T.reshape(shape),
            np.array(faces, np.int32).T.reshape(shape),
        )


def paths(hits: Hits, depths: Floats) -> Floats:
    """The way inside (N,): the sum of exits less the sum of entries; NaN for a ray that enters more or less often.

    `depths` (N, K) are the hits' places along whatever axis the way is measured on.
    """
    inside = np.nansum(np.where(hits.sides == 0, 0, hits.sides * depths), axis=1)
    return np.where(hits.sides.sum(axis=1) == 0, inside, np.nan)


def bridged_paths(hits: Hits, depths: Floats, gap: float, layers: int = 6) -> Floats:
    """The ways inside between the first `layers` hits (N,), each times exp(-width of the gaps before it / `gap`).

    Inside is where a ray has entered more often than left.
    """
    total, gaps = np.zeros(len(depths)), np.zeros(len(depths))
    entered = np.zeros(len(depths), int)
    for layer in range(min(layers, depths.shape[1]) - 1):
        entered -= hits.sides[:, layer]
        step = np.nan_to_num(depths[:, layer + 1] - depths[:, layer])
        total += np.where(entered > 0, np.exp(-gaps / gap) * step, 0)
        gaps += np.where(entered > 0, 0, step)
    return total
