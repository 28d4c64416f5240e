"""What is mended in a mesh on loading, and the sentences that say so.

Done: triangles with two equal corners are dropped, vertices at one place become one, copies of a triangle are dropped,
neighbours are wound alike, closed surfaces are turned outwards.
Not done: holes are not filled and self-intersections are not resolved. Triangles whose corners lie on a line are not
dropped, which would open the surface: see `mesh_slivers`.
"""

from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, connected_components

from fakesss.nested_boxes import NestedBoxes

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.integer[Any]]
Faces = NDArray[np.int32]

NO_VOLUME = 1e-12  # of the sum of its wedges' volumes: the rounding of a closed surface that encloses nothing


def counted(number: int, one: str, many: str) -> str:
    return f"{number:,} {one if number == 1 else many}"


def drop_collapsed_faces(positions: Floats, faces: Indices, repairs: list[str]) -> Indices:
    """The faces whose corners are three different points."""
    a, b, c = (positions[faces[:, corner]] for corner in range(3))
    collapsed = (a == b).all(axis=1) | (b == c).all(axis=1) | (c == a).all(axis=1)
    if collapsed.any():
        repairs.append(
            f"Dropped {counted(int(collapsed.sum()), 'triangle', 'triangles')} with two corners at one place."
        )
    distinct: Indices = faces[~collapsed]
    return distinct


def row_ids(columns: list[NDArray[np.int64]]) -> NDArray[np.int64]:
    """For each row the index of the first row equal to it. Columns hold integers in 0..2^32-1."""
    first = columns[0]
    for column in columns[1:]:
        _, ids = np.unique(first, return_inverse=True)
        first = ids * np.int64(2**32) + column
    _, index, inverse = np.unique(first, return_index=True, return_inverse=True)
    return index[inverse]


def weld(scaled: Floats, faces: Indices, repairs: list[str]) -> tuple[Floats32, Faces]:
    """Vertices (V', 3) that differ in float32, in the order of their first use, and the faces over them.

    Two vertices are one if the GPU could not tell them apart, that is if they are equal after rounding the scaled
    positions to float32 (a relative distance of about 6e-8).
    """
    single = scaled.astype(np.float32) + np.float32(0)  # -0.0 and 0.0 become equal bits
    bits = single.view(np.uint32).astype(np.int64)
    same = row_ids([bits[:, axis] for axis in range(3)])
    merged = same[faces]
    tiny = (merged == np.roll(merged, -1, axis=1)).any(axis=1)
    if tiny.any():
        repairs.append(f"Dropped {counted(int(tiny.sum()), 'triangle', 'triangles')} too small for float32.")
        merged = merged[~tiny]
    merged = merged[first_copies(merged, repairs)]
    kept = np.zeros(len(single), bool)
    kept[merged] = True
    used = np.zeros(len(single), bool)
    used[faces] = True
    if used.sum() > kept.sum():
        repairs.append(f"Merged {len(single):,} vertices into {int(kept.sum()):,}.")
    new_index = np.cumsum(kept) - 1
    return single[kept], new_index[merged].astype(np.int32)


def first_copies(faces: NDArray[np.int64], repairs: list[str]) -> NDArray[np.bool_]:
    """True for each face that repeats no earlier one. A face wound the other way is no copy: it is the other side."""
    turned = np.take_along_axis(faces, (faces.argmin(axis=1)[:, None] + np.arange(3)) % 3, axis=1)
    fresh: NDArray[np.bool_] = row_ids([turned[:, corner] for corner in range(3)]) == np.arange(len(faces))
    if not fresh.all():
        copies = int((~fresh).sum())
        repairs.append(f"Dropped {counted(copies, 'copy of another triangle', 'copies of other triangles')}.")
    return fresh


def half_edges(faces: Faces) -> tuple[NDArray[np.int64], NDArray[np.int8]]:
    """For half-edge 3f+c (corner c of face f to the next): a number naming the edge, and +1 or -1 for the direction."""
    start = faces.ravel().astype(np.int64)
    end = np.roll(faces, -1, axis=1).ravel().astype(np.int64)
    name = np.minimum(start, end) * np.int64(2**31) + np.maximum(start, end)
    return name, np.where(start < end, 1, -1).astype(np.int8)


def half_edge_pairs(faces: Faces, most: int = 2) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The two half-edges of every edge that exactly two triangles share.

    With `most` above 2 also every pair of opposite half-edges on edges with up to so many triangles.
    """
    name, direction = half_edges(faces)
    order = np.argsort(name, kind="stable")
    ordered = name[order]
    starts = np.flatnonzero(np.concatenate([[True], ordered[1:] != ordered[:-1]]))
    sizes = np.diff(np.concatenate([starts, [len(ordered)]]))
    pairs = []
    for size in range(2, most + 1):
        corners = order[starts[sizes == size][:, None] + np.arange(size)]
        left, right = (corners[:, list(side)].ravel() for side in zip(*combinations(range(size), 2), strict=True))
        opposite = (direction[left] != direction[right]) | (size == 2)
        pairs.append((left[opposite], right[opposite]))
    return np.concatenate([left for left, _ in pairs]), np.concatenate([right for _, right in pairs])


def is_closed(faces: Faces) -> bool:
    """Whether every edge is walked as often one way as the other: no border, and neighbours wound alike."""
    name, direction = half_edges(faces)
    order = np.argsort(name, kind="stable")
    starts = np.flatnonzero(np.concatenate([[True], np.diff(name[order]) != 0]))
    return not np.add.reduceat(direction[order].astype(np.int64), starts).any()


def orient(positions: Floats32, faces: Faces, repairs: list[str]) -> Faces:
    """Faces wound alike across every edge that two of them share, and closed surfaces turned outwards."""
    half_a, half_b = half_edge_pairs(faces)
    _, direction = half_edges(faces)
    against = direction[half_a] == direction[half_b]
    graph = coo_array((np.ones(len(half_a), bool), (half_a // 3, half_b // 3)), shape=(len(faces),) * 2)
    parts, part = connected_components(graph, directed=False)
    if against.any():
        faces = wind_alike(faces, half_a // 3, half_b // 3, against, (parts, part), repairs)
    return turn_outwards(positions, faces, part, repairs)


def wind_alike(
    faces: Faces,
    left: NDArray[np.int64],
    right: NDArray[np.int64],
    against: NDArray[np.bool_],
    parts: tuple[int, NDArray[np.int32]],
    repairs: list[str],
) -> Faces:
    """Faces flipped so that neighbours agree; in each connected part the smaller share is flipped."""
    count, part = parts
    _, first = np.unique(part, return_index=True)
    root = len(faces)  # one node above all parts makes a single tree of them
    rows = np.concatenate([left, np.full(count, root)])
    columns = np.concatenate([right, first])
    weights = np.concatenate([against + 1, np.ones(count)]).astype(np.int8)  # 2: the two disagree
    graph = coo_array((weights, (rows, columns)), shape=(root + 1,) * 2).tocsr()
    graph = (graph + graph.T).tocsr()
    _, above = breadth_first_order(graph, root, directed=False)
    above[root] = root
    flip = np.zeros(root + 1, bool)
    flip[:root] = np.asarray(graph[np.arange(root), above[:root]]).ravel() == 2
    # each step doubles how far up the tree a face has looked
    while (above != root).any():
        flip ^= flip[above]
        above = above[above]
    flip = flip[:root]
    flip ^= (np.bincount(part, flip) * 2 > np.bincount(part))[part]
    repairs.append(f"Reversed {counted(int(flip.sum()), 'triangle', 'triangles')} wound against the neighbours.")
    return np.where(flip[:, None], faces[:, ::-1], faces)


def turn_outwards(positions: Floats32, faces: Faces, part: NDArray[np.int32], repairs: list[str]) -> Faces:
    """Faces of closed surfaces that faced inwards reversed, with whatever closed surfaces lie inside them.

    A cavity (a closed surface facing inwards inside another) is meant and stays, and so does a surface around nothing.
    """
    corners = positions[faces].astype(np.float64)
    wedges = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    inwards = np.bincount(part, wedges) < -NO_VOLUME * np.bincount(part, np.abs(wedges))
    suspects = np.flatnonzero(inwards & ~open_parts(faces, part))
    if not len(suspects):
        return np.ascontiguousarray(faces)
    boxes = NestedBoxes(*part_bounds(corners, part, len(inwards)))
    order = np.argsort(part, kind="stable")
    start = np.searchsorted(part[order], np.arange(len(inwards) + 1))

    def surface(index: int) -> Floats:
        return corners[order[start[index] : start[index + 1]]]

    def holds(outer: int, inner: int) -> bool:
        return abs(winding_number(surface(outer), surface(inner)[0].mean(axis=0))) > 0.5

    reverse = np.zeros(len(inwards), bool)
    for index in suspects.tolist():
        if any(holds(other, index) for other in boxes.around(index).tolist()):
            continue
        for other in boxes.within(index).tolist():
            reverse[other] |= other == index or holds(index, other)
    if reverse.any():
        number = counted(int(reverse.sum()), "closed surface", "closed surfaces")
        repairs.append(f"Turned {number} that faced inwards.")
    return np.ascontiguousarray(np.where(reverse[part][:, None], faces[:, ::-1], faces))


def open_parts(faces: Faces, part: NDArray[np.int32]) -> NDArray[np.bool_]:
    """Whether a connected part is no closed surface by itself, as `is_closed` says of a whole."""
    name, direction = half_edges(faces)
    owner = np.repeat(part, 3)
    order = np.lexsort((name, owner))
    changes = (np.diff(name[order]) != 0) | (np.diff(owner[order]) != 0)
    starts = np.flatnonzero(np.concatenate([[True], changes]))
    unbalanced = np.add.reduceat(direction[order].astype(np.int64), starts) != 0
    return np.bincount(owner[order][starts], unbalanced) > 0


def part_bounds(corners: Floats, part: NDArray[np.int32], parts: int) -> tuple[Floats, Floats]:
    """Lowest and highest coordinates (parts, 3) of each connected part."""
    low, high = np.full((parts, 3), np.inf), np.full((parts, 3), -np.inf)
    np.minimum.at(low, part, corners.min(axis=1))
    np.maximum.at(high, part, corners.max(axis=1))
    return low, high


def winding_number(corners: Floats, point: Floats) -> float:
    """How often triangles (F, 3, 3) wrap around `point`: 1 inside a closed surface facing outwards, 0 outside.

    Van Oosterom and Strackee, *The solid angle of a plane triangle*, 1983, equation 8.
    """
    a, b, c = (corners[:, corner] - point for corner in range(3))
    la, lb, lc = (np.sqrt((side**2).sum(axis=1)) for side in (a, b, c))
    numerator = np.einsum("ij,ij->i", a, np.cross(b, c))
    denominator = (
        la * lb * lc
        + np.einsum("ij,ij->i", a, b) * lc
        + np.einsum("ij,ij->i", b, c) * la
        + np.einsum("ij,ij->i", c, a) * lb
    )
    return float(np.arctan2(numerator, denominator).sum() / (2 * np.pi))
