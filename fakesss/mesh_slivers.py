"""Triangles without height, as where a vertex lies on its neighbour's side: flipped away, so that none has to be drawn.

A rasteriser gives such a triangle any depth and any side, and leaving it out lets the background through.
"""

import numpy as np
from numpy.typing import NDArray

from fakesss.mesh_repair import counted, half_edge_pairs
from fakesss.vertex_normals import face_normals, slivers

Floats32 = NDArray[np.float32]
Faces = NDArray[np.int32]
Indices = NDArray[np.int64]

ROUNDS = 16  # of flips: a side with so many vertices on it is cut all along


def without_slivers(positions: Floats32, faces: Faces, repairs: list[str]) -> Faces:
    """The same surface with fewer slivers, positions in sphere radii, faces wound alike.

    Two that lie back to back on the same corners go. One whose longest side is a proper triangle's is flipped with it:
    the common side gives way to the other diagonal. What no flip mends stays.
    """
    thin = np.flatnonzero(slivers(positions, faces))
    if not len(thin):
        return faces
    faces = without_folds(faces, thin)
    flipped = 0
    for _ in range(ROUNDS):
        thin, wide, first, second = flips(positions, faces)
        if not len(thin):
            break
        faces = faces.copy()
        faces[thin], faces[wide] = first, second
        flipped += len(thin)
    if flipped:
        repairs.append(f"Flipped the longest side of {counted(flipped, 'triangle', 'triangles')} without height.")
    return faces


def without_folds(faces: Faces, thin: Indices) -> Faces:
    """Without those of the slivers `thin` that are each other's reverse: together they close and show nothing."""
    corners = np.sort(faces[thin], axis=1)
    _, place, count = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    turns = np.array([(1, 2, 0), (2, 0, 1), (0, 1, 2)])[faces[thin].argmin(axis=1)]
    rising = np.take_along_axis(faces[thin], turns, axis=1)
    forwards = np.bincount(place.ravel(), rising[:, 0] < rising[:, 1], len(count))
    folded = (count == 2) & (forwards == 1)
    return np.delete(faces, thin[folded[place.ravel()]], axis=0)


def flips(positions: Floats32, faces: Faces) -> tuple[Indices, Indices, Faces, Faces]:
    """Slivers (N,) to flip, the neighbours (N,) to flip them with, and what both become, (N, 3) each."""
    thin = np.flatnonzero(slivers(positions, faces))
    half_a, half_b = half_edge_pairs(faces)
    partner = np.full(faces.size, -1)
    partner[half_a], partner[half_b] = half_b, half_a
    longest = 3 * thin + longest_sides(positions, faces[thin])
    across = partner[longest]
    thin, longest, across = thin[across >= 0], longest[across >= 0], across[across >= 0]
    # a proper triangle is flipped once in a round
    _, once = np.unique(across // 3, return_index=True)
    thin, longest, across = thin[once], longest[once], across[once]
    a, b, apex = corners_from(faces, longest)
    b_again, a_again, opposite = corners_from(faces, across)
    first, second = np.stack([apex, a, opposite], axis=1), np.stack([apex, opposite, b], axis=1)
    before = face_normals(positions, faces[across // 3])
    fits = (a == a_again) & (b == b_again) & (apex != opposite)
    for after in (first, second):
        fits &= ~slivers(positions, after) & ((face_normals(positions, after) * before).sum(axis=1) > 0.5)
    return thin[fits], across[fits] // 3, first[fits], second[fits]


def longest_sides(positions: Floats32, faces: Faces) -> Indices:
    """Which side (0..2, named by its first corner) of each triangle is the longest."""
    points = positions[faces].astype(np.float64)
    sides: Indices = ((np.roll(points, -1, axis=1) - points) ** 2).sum(axis=2).argmax(axis=1)
    return sides


def corners_from(faces: Faces, half_edges: Indices) -> tuple[Faces, Faces, Faces]:
    """The first, second and third corner of a triangle, counted from a half-edge's start."""
    face, corner = np.divmod(half_edges, 3)
    return faces[face, corner], faces[face, (corner + 1) % 3], faces[face, (corner + 2) % 3]
