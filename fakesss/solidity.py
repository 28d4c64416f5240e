"""Whether a closed surface bounds a solid: it does not pass through itself, and outside every face lies outside.

Parts that overlap, or lie inside one another facing the same way, make more layers than entries and exits; only the
peel is right there. Asked once for a mesh, then cached.
"""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fakesss import cache
from fakesss.mesh import Mesh
from fakesss.mesh_repair import weld
from fakesss.vertex_normals import normalised

if TYPE_CHECKING:
    from fakesss.crossings import Crossings

Floats = NDArray[np.float64]
Indices = NDArray[np.integer[Any]]

VERSION = 2  # raised whenever the answer may change, so that cached ones are asked again
CLEARANCE = 1e-5  # from the face or the corner to where its ray starts, in sphere radii
THROUGH = 1e-6  # how far both ends of an edge lie off a face that it passes through, in sphere radii
TILTS = (0.0, 0.31, 0.17)  # of a face's rays against its normal: one along an edge or a tangent may be miscounted
CHUNK = 1 << 18  # rays at once


def is_solid(mesh: Mesh) -> bool:
    """Whether `mesh` is watertight, no edge of it passes through a face, and it winds once around its inside.

    In doubt, no. What stays unseen are crossings shallower than `THROUGH` and parts that only touch.
    """
    if not mesh.watertight:
        return False
    key = {"version": VERSION, "mesh": mesh.sha256}
    arrays, _ = cache.cached("solid", key, {"solid": (1,)}, lambda: {"solid": np.array([int(bounds_solid(mesh))])})
    return bool(arrays["solid"][0])


def bounds_solid(mesh: Mesh) -> bool:
    """The answer of `is_solid` for a watertight mesh."""
    from fakesss.crossings import Crossings  # loads Embree, which is needed only where the answer is not cached

    crossings = Crossings(mesh)
    return not passes_through_itself(mesh, crossings) and winds_once(mesh, crossings)


def passes_through_itself(mesh: Mesh, crossings: "Crossings") -> bool:
    """Whether an edge passes through a face that it has no corner in common with: two surfaces cannot cross else."""
    positions, faces = weld(mesh.positions.astype(np.float64), mesh.faces, [])  # creases had split corners
    if len(faces) != len(mesh.faces):
        return True  # copies of faces, or faces too thin to tell
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges = edges[edges[:, 0] < edges[:, 1]]  # each once
    ends = positions.astype(np.float64)
    return any(
        pass_through(crossings, faces, edges[start : start + CHUNK], ends) for start in range(0, len(edges), CHUNK)
    )


def pass_through(crossings: "Crossings", faces: Indices, edges: Indices, positions: Floats) -> bool:
    """Whether any of `edges` (E, 2) has its ends clearly on both sides of a face that it meets between them."""
    first, last = positions[edges[:, 0]], positions[edges[:, 1]]
    length = np.sqrt(((last - first) ** 2).sum(axis=1))
    along = (last - first) / length[:, None]
    hits = crossings(first + CLEARANCE * along, along, length - 2 * CLEARANCE)
    for face in hits.faces.T:
        met = np.flatnonzero(face >= 0)
        met = met[(faces[face[met]][:, :, None] != edges[met][:, None, :]).all(axis=(1, 2))]
        corner, normal = crossings.corner[face[met]], crossings.normals[face[met]]
        before, after = (((end[met] - corner) * normal).sum(axis=1) for end in (first, last))
        if ((before * after < 0) & (np.minimum(np.abs(before), np.abs(after)) > THROUGH)).any():
            return True
    return False


def winds_once(mesh: Mesh, crossings: "Crossings") -> bool:
    """Whether from the middle of each face a ray outwards enters the surface as often as it leaves it."""
    showing = np.flatnonzero(crossings.normals.any(axis=1))  # a face without area shows nowhere
    for start in range(0, len(showing), CHUNK):
        doubtful = showing[start : start + CHUNK]
        for tilt in TILTS:
            normal = crossings.normals[doubtful]
            aside = np.roll(normal, 1, axis=1) * tilt
            along = normalised(normal + np.where((aside * normal).sum(axis=1, keepdims=True) < 0, -aside, aside))
            middle = mesh.positions[mesh.faces[doubtful]].astype(np.float64).mean(axis=1)
            hits = crossings(middle + CLEARANCE * normal, along)
            doubtful = doubtful[hits.sides.sum(axis=1) != 0]
            if not len(doubtful):
                break
        if len(doubtful):
            return False
    return True
