"""Whether a closed surface bounds a solid: outside every face lies outside, not the inside of another part.

Parts that overlap, or lie inside one another facing the same way, make more layers than entries and exits; only the
peel is right there. Asked once for a mesh, then cached.
"""

import numpy as np

from fakesss import cache
from fakesss.mesh import Mesh
from fakesss.vertex_normals import normalised

VERSION = 1  # raised whenever the answer may change, so that cached ones are asked again
CLEARANCE = 1e-5  # from the face to where its ray starts, in sphere radii
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
    from fakesss.crossings import Crossings  # loads Embree, which is needed only where the answer is not cached

    crossings = Crossings(mesh)
    showing = np.flatnonzero(crossings.normals.any(axis=1))  # a face without area shows nowhere
    for start in range(0, len(showing), CHUNK):
        doubtful = showing[start : start + CHUNK]
        for tilt in TILTS:
            normal = crossings.normals[doubtful]
            aside = np.roll(normal, 1, axis=1) * tilt
            along = normalised(normal + np.where((aside * normal).sum(axis=1, keepdims=True) < 0, -aside, aside))
            middle = mesh.positions[mesh.faces[doubtful]].astype(np.float64).mean(axis=1)
            _, sides = crossings(middle + CLEARANCE * normal, along)
            doubtful = doubtful[sides.sum(axis=1) != 0]
            if not len(doubtful):
                break
        if len(doubtful):
            return False
    return True
