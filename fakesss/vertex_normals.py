"""Normals at vertices: smooth over gentle edges, hard at creases.

A vertex normal is the mean of the surrounding triangles' normals weighted by their angle at the vertex (Thürmer and
Wüthrich, *Computing vertex normals from polygonal facets*, 1998), which does not depend on how the surface was cut
into triangles. It is not an estimate of curvature and reads no normals stored in files.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from fakesss.mesh_repair import half_edge_pairs

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Faces = NDArray[np.int32]

CREASE_DEGREES = 60.0  # between face normals; a box (90) keeps its edges, a coarse scan of a smooth body gets none
MANY_SIDED = 6  # edges with more triangles than this are hard
ROUNDED = 1e-5  # of a unit normal times radians: what float32 positions leave of a sum that is 0
SLIVER = 5e-7  # sphere radii; the normal of a triangle less high than some eight roundings to float32 is noise


def normalised(vectors: Floats) -> Floats:
    """Unit vectors along (..., 3) `vectors`; a zero vector stays zero."""
    length = np.sqrt((vectors**2).sum(axis=-1, keepdims=True))
    unit: Floats = np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)
    return unit


def face_normals(positions: NDArray[np.floating[Any]], faces: Faces) -> Floats:
    """Unit normals (F, 3) in float64; zero for a triangle without area."""
    a, b, c = (positions[faces[:, corner]].astype(np.float64) for corner in range(3))
    # scaled before the product, so that a tiny triangle keeps its direction
    return normalised(np.cross(normalised(b - a), normalised(c - a)))


def slivers(positions: NDArray[np.floating[Any]], faces: Faces) -> NDArray[np.bool_]:
    """Whether each triangle is so thin that rounding its corners turned it anywhere; positions in sphere radii."""
    a, b, c = (positions[faces[:, corner]].astype(np.float64) for corner in range(3))
    sides = b - a, c - b, a - c
    longest = np.sqrt(np.max([np.einsum("ij,ij->i", side, side) for side in sides], axis=0))
    doubled = np.cross(sides[0], sides[1])
    doubled_area = np.sqrt(np.einsum("ij,ij->i", doubled, doubled))
    thin: NDArray[np.bool_] = doubled_area < SLIVER * longest
    return thin


def corner_angles(positions: NDArray[np.floating[Any]], faces: Faces) -> Floats:
    """The triangles' angles (F, 3), radians, at their three corners."""
    points = positions[faces].astype(np.float64)
    sides = normalised(np.roll(points, -1, axis=1) - points)  # from each corner to the next
    angles: Floats = np.arccos(np.clip(-(sides * np.roll(sides, 1, axis=1)).sum(axis=2), -1, 1))
    return angles


def with_creases(positions: Floats32, faces: Faces) -> tuple[Floats32, Floats32, Faces]:
    """Positions and normals (V', 3) and faces (F, 3), vertices on creases split so that each side has its own normal.

    A crease is an edge where the face normals differ by more than `CREASE_DEGREES`; where more than two triangles meet,
    as on a sheet that was modelled from both sides, each goes on smoothly into those that face like it. Slivers do not
    count, and make no crease. Where the weighted normals cancel, surfaces that only touch are parted; where they cancel
    within one surface the vertex takes the normal of one of its triangles, and where all are slivers, the direction
    away from the centre.
    """
    flat = face_normals(positions, faces)
    flat[slivers(positions, faces)] = 0
    weighted = corner_angles(positions, faces)[:, :, None] * flat[:, None, :]
    origin, faces = split_at_creases(positions, faces, flat, cancels(weighted_sum(weighted, faces, len(positions))))
    positions = positions[origin]
    total = weighted_sum(weighted, faces, len(positions))
    normals = normalised(total)
    cancelled = cancels(total)
    some_face = np.zeros((len(positions), 3))
    has_area = (flat**2).sum(axis=1) > 0
    some_face[faces[has_area]] = flat[has_area][:, None, :]
    normals[cancelled] = some_face[cancelled]
    still_zero = ~normals.any(axis=1)
    outward = positions[still_zero].astype(np.float64)
    normals[still_zero] = np.where(outward.any(axis=1, keepdims=True), normalised(outward), (0.0, 0.0, 1.0))
    return positions, normals.astype(np.float32), faces


def weighted_sum(weighted: Floats, faces: Faces, vertices: int) -> Floats:
    """The sums (V, 3) at the vertices of vectors (F, 3, 3) at the triangles' corners."""
    corner = faces.ravel()
    return np.stack([np.bincount(corner, weighted[:, :, axis].ravel(), vertices) for axis in range(3)], axis=1)


def cancels(total: Floats) -> NDArray[np.bool_]:
    """Whether nothing but rounding is left of sums (V, 3) of unit normals times radians."""
    nothing: NDArray[np.bool_] = (total**2).sum(axis=1) < ROUNDED**2
    return nothing


def split_at_creases(
    positions: Floats32, faces: Faces, flat: Floats, cancelled: NDArray[np.bool_]
) -> tuple[NDArray[np.int64], Faces]:
    """For each new vertex the old one it copies, and the faces in new vertices; no crease: nothing changes.

    So is a vertex whose normals are `cancelled` (V,), where surfaces only touch: the tips of two cones.
    """
    vertices = len(positions)
    half_a, half_b = half_edge_pairs(faces, most=MANY_SIDED)
    compared = with_lent_normals(positions, faces, flat, (half_a, half_b))
    smooth = (compared[half_a // 3] * compared[half_b // 3]).sum(axis=1) >= np.cos(np.radians(CREASE_DEGREES))
    # a half-edge that no smooth pair joins to a neighbour lies on a crease, a border or a many-sided edge
    joined = np.zeros(faces.size, bool)
    joined[half_a[smooth]] = joined[half_b[smooth]] = True
    corner_vertex = faces.ravel()
    following = np.roll(faces, -1, axis=1).ravel()
    on_crease = np.zeros(vertices, bool)
    on_crease[corner_vertex[~joined]] = on_crease[following[~joined]] = True
    touched = np.flatnonzero((on_crease | cancelled)[corner_vertex])
    if not len(touched):
        return np.arange(vertices), faces
    fans = corner_fans(faces, half_a[smooth], half_b[smooth], touched)
    # the first fan of a vertex keeps its index, the others are appended
    _, first, inverse = np.unique(fans, return_index=True, return_inverse=True)
    old = corner_vertex[touched[first]].astype(np.int64)
    order = np.argsort(old, kind="stable")
    repeated = np.concatenate([[False], old[order][1:] == old[order][:-1]])
    new = old.copy()
    new[order[repeated]] = vertices + np.arange(repeated.sum())
    corners = corner_vertex.copy()
    corners[touched] = new[inverse]
    return np.concatenate([np.arange(vertices), old[order[repeated]]]), corners.reshape(-1, 3)


def with_lent_normals(
    positions: Floats32, faces: Faces, flat: Floats, pairs: tuple[NDArray[np.int64], NDArray[np.int64]]
) -> Floats:
    """Face normals in which a triangle without its own has that of its neighbour across the longest side.

    It lies in that side, so it bends there no more than rounding; across the other two it then bends as much as its
    neighbours do. Where that neighbour has none to lend, another's is taken.
    """
    if flat.any(axis=1).all():
        return flat
    lent = flat.copy()
    corners = positions[faces].astype(np.float64)
    length = ((np.roll(corners, -1, axis=1) - corners) ** 2).sum(axis=2)
    longest = (length == length.max(axis=1, keepdims=True)).ravel()
    mine, other = np.concatenate(pairs), np.concatenate(pairs[::-1])
    for allowed in (longest[mine], np.ones(len(mine), bool)):
        while True:
            has: NDArray[np.bool_] = np.any(lent != 0, axis=1)
            gets = allowed & ~has[mine // 3] & has[other // 3]
            if not gets.any():
                break
            lent[mine[gets] // 3] = lent[other[gets] // 3]
    return lent


def corner_fans(
    faces: Faces, half_a: NDArray[np.int64], half_b: NDArray[np.int64], touched: NDArray[np.int64]
) -> NDArray[np.int32]:
    """A label for each of the `touched` corners; equal where a walk over smooth edges around the vertex joins them."""
    place = np.full(faces.size, -1)
    place[touched] = np.arange(len(touched))
    corner_vertex = faces.ravel()
    next_corner = np.roll(np.arange(faces.size).reshape(-1, 3), -1, axis=1).ravel()
    same_way = corner_vertex[half_a] == corner_vertex[half_b]  # an edge that both triangles walk in one direction
    ends_a = np.concatenate([half_a, next_corner[half_a]])
    ends_b = np.concatenate(
        [np.where(same_way, half_b, next_corner[half_b]), np.where(same_way, next_corner[half_b], half_b)]
    )
    inside = (place[ends_a] >= 0) & (place[ends_b] >= 0)
    rows, columns = place[ends_a[inside]], place[ends_b[inside]]
    graph = coo_array((np.ones(len(rows), bool), (rows, columns)), shape=(len(touched),) * 2)
    labels: NDArray[np.int32] = connected_components(graph, directed=False)[1]
    return labels
