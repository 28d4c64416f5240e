"""Whether a closed surface bounds a solid: outside every face lies outside, not the inside of another part.

Parts that overlap, or lie inside one another facing the same way, make more layers than entries and exits; only the
peel is right there. Asked once for a mesh, then cached.
"""

import numpy as np
from numpy.typing import NDArray

from fakesss import cache
from fakesss.mesh import Mesh
from fakesss.vertex_normals import face_normals, normalised

Floats = NDArray[np.float64]

VERSION = 1  # raised whenever the answer may change, so that cached ones are asked again
CLEARANCE = 1e-5  # from the face to where its ray starts, and past each hit, in sphere radii
MOST_HITS = 64  # of one ray: more count as undecided
TILTS = (0.0, 0.31, 0.17)  # of a face's rays against its normal: one along an edge or a tangent may be miscounted
CHUNK = 1 << 18  # faces asked at once


def is_solid(mesh: Mesh) -> bool:
    """Whether `mesh` is watertight and winds once around its inside; in doubt, no.

    From the middle of each face a ray goes outwards. On a solid it enters as often as it leaves. Overlaps smaller
    than a face can be missed.
    """
    if not mesh.watertight:
        return False
    key = {"version": VERSION, "mesh": mesh.sha256}
    arrays, _ = cache.cached("solid", key, {"solid": (1,)}, lambda: {"solid": np.array([int(winds_once(mesh))])})
    return bool(arrays["solid"][0])


def winds_once(mesh: Mesh) -> bool:
    """The answer of `is_solid` for a watertight mesh."""
    crossings = Crossings(mesh)
    showing = np.flatnonzero(crossings.normals.any(axis=1))  # a face without area shows nowhere
    for start in range(0, len(showing), CHUNK):
        doubtful = showing[start : start + CHUNK]
        for tilt in TILTS:
            normal = crossings.normals[doubtful]
            aside = np.roll(normal, 1, axis=1) * tilt
            along = normalised(normal + np.where((aside * normal).sum(axis=1, keepdims=True) < 0, -aside, aside))
            middle = mesh.positions[mesh.faces[doubtful]].astype(np.float64).mean(axis=1)
            doubtful = doubtful[crossings(middle + CLEARANCE * normal, along) != 0]
            if not len(doubtful):
                break
        if len(doubtful):
            return False
    return True


class Crossings:
    """Exits less entries along rays through a mesh."""

    def __init__(self, mesh: Mesh) -> None:
        from fakesss.ray_casting import NOTHING, Caster  # Embree is needed only where the answer is not cached

        self.caster, self.nothing = Caster(mesh), NOTHING
        self.normals = face_normals(mesh.positions, mesh.faces)
        self.corner = mesh.positions[mesh.faces[:, 0]].astype(np.float64)

    def __call__(self, origins: Floats, along: Floats) -> NDArray[np.int64]:
        """For each ray (N, 3); one still going after `MOST_HITS` hits counts as it stands, plus one."""
        balance = np.zeros(len(origins), np.int64)
        going = np.arange(len(origins))
        for _ in range(MOST_HITS):
            face = self.caster.first_face(origins[going].astype(np.float32), along[going].astype(np.float32))
            going, face = going[face != self.nothing], face[face != self.nothing]
            if not len(going):
                return balance
            cosine = (self.normals[face] * along[going]).sum(axis=1)
            balance[going] += np.sign(cosine).astype(np.int64)
            ahead = ((self.corner[face] - origins[going]) * self.normals[face]).sum(axis=1)
            away = np.divide(ahead, cosine, out=np.zeros_like(ahead), where=np.abs(cosine) > 1e-9)
            origins[going] += (np.maximum(away, 0) + CLEARANCE)[:, None] * along[going]
        balance[going] += 1
        return balance
