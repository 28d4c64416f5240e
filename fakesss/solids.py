"""Built-in objects whose thickness is known in closed form: sphere, box, torus, and the tube of the knot.

Vertices lie on the true surface and normals are the true surface's. Positions come in the world frame already.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.vertex_normals import normalised

Floats = NDArray[np.float64]
Surface = tuple[Floats, Floats, NDArray[np.integer[Any]]]  # positions (V, 3), unit normals (V, 3), triangles (F, 3)

BOX_HALF = (2 / 3, 2 / 3, 1 / 3)  # half the sides of `box`, in sphere radii; the corner (2, 2, 1) / 3 is at distance 1
TORUS_RADII = (0.7, 0.3)  # of the ring and of its tube, in sphere radii; the axis is z


def sphere(faces: int) -> Surface:
    """The unit sphere: an icosahedron with every edge divided n times, 20 n^2 triangles."""
    n = max(1, round(np.sqrt(faces / 20)))
    golden = (1 + np.sqrt(5)) / 2
    corners = np.array([(0, s, t * golden) for s in (1, -1) for t in (1, -1)], float)
    corners = normalised(np.concatenate([np.roll(corners, shift, axis=1) for shift in range(3)]))
    near = corners @ corners.T > 0.4  # neighbours have 0.447
    sides = [
        (i, j, k) for i in range(12) for j in range(i) for k in range(j) if near[i, j] and near[j, k] and near[i, k]
    ]
    row, column = np.array([(i, j) for i in range(n + 1) for j in range(n + 1 - i)]).T
    weights = np.stack([n - row - column, row, column], axis=1) / n
    start = np.cumsum([0] + [n + 1 - i for i in range(n)])
    up = [(start[i] + j, start[i + 1] + j, start[i] + j + 1) for i in range(n) for j in range(n - i)]
    down = [(start[i] + j + 1, start[i + 1] + j, start[i + 1] + j + 1) for i in range(n) for j in range(n - i - 1)]
    patch = np.array(up + down)
    points, triangles = [], []
    for number, side in enumerate(sides):
        triangle = corners[list(side)]
        if np.linalg.det(triangle) < 0:
            triangle = triangle[::-1]
        points.append(normalised(np.einsum("ij,jk->ik", weights, triangle)))
        triangles.append(patch + number * len(weights))
    # seams are computed twice with different rounding: equal to 9 digits is one point, far below any edge's length
    _, first, same = np.unique(np.round(np.concatenate(points), 9), axis=0, return_index=True, return_inverse=True)
    positions = np.concatenate(points)[first]
    return positions, positions, same.ravel()[np.concatenate(triangles)]


def box(faces: int) -> Surface:
    """A box with half sides `BOX_HALF` whose six sides are cut into equal squares."""
    half = np.array(BOX_HALF)
    area = 8 * (half[0] * half[1] + half[1] * half[2] + half[2] * half[0])
    cells = np.maximum(1, np.round(2 * half * np.sqrt(faces / 2 / area))).astype(int)
    points: list[Floats] = []
    normals: list[Floats] = []
    triangles: list[NDArray[np.int64]] = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            u, v = ((axis + 1) % 3, (axis + 2) % 3)[:: int(sign)]
            grid_u, grid_v = np.meshgrid(*(np.linspace(-half[a], half[a], cells[a] + 1) for a in (u, v)), indexing="ij")
            side = np.empty((grid_u.size, 3))
            side[:, axis], side[:, u], side[:, v] = sign * half[axis], grid_u.ravel(), grid_v.ravel()
            triangles.append(grid(cells[u] + 1, cells[v] + 1, closed=False) + sum(len(side) for side in points))
            points.append(side)
            normals.append(np.tile(sign * np.eye(3)[axis], (len(side), 1)))
    return np.concatenate(points), np.concatenate(normals), np.concatenate(triangles)


def torus(faces: int) -> Surface:
    """A ring around the z axis with the radii `TORUS_RADII`."""
    ring, tube = TORUS_RADII
    # multiples of four, so that the extremes in x, y and z are vertices
    across = 4 * max(1, round(np.sqrt(faces / 2 * tube / ring) / 4))
    along = 4 * max(1, round(faces / 2 / across / 4))
    u, v = angles(along, across)
    outward = np.stack([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)], axis=1)
    middle = np.stack([np.cos(u), np.sin(u), np.zeros_like(u)], axis=1)
    return ring * middle + tube * outward, outward, grid(along, across, closed=True)


def knot(faces: int) -> Surface:
    """A trefoil, its tube swelling from thin to thick and back; seen along the axis of its threefold symmetry."""

    def curve(u: Floats) -> Floats:
        x, y = (np.sin(u) + 2 * np.sin(2 * u), np.cos(u) - 2 * np.cos(2 * u))
        return np.stack([x, y, -1.1 * np.sin(3 * u)], axis=1)

    def radius(u: Floats) -> Floats:
        radii: Floats = 0.47 - 0.27 * np.cos(u - 0.9) - 0.09 * np.cos(2 * u)
        return radii

    return swept(curve, radius, faces)


def angles(along: int, across: int) -> tuple[Floats, Floats]:
    """Angle along a ring and around its tube (radians) for the vertices of a closed `grid`."""
    u, v = np.meshgrid(*(2 * np.pi * np.arange(n) / n for n in (along, across)), indexing="ij")
    return u.ravel(), v.ravel()


def grid(rows: int, columns: int, closed: bool) -> NDArray[np.int64]:
    """Two triangles for each cell of a grid of vertices; `closed`: the last row and column join the first."""
    cells = (rows, columns) if closed else (rows - 1, columns - 1)
    i, j = (index.ravel() for index in np.indices(cells))
    a, b = i * columns + j, (i + 1) % rows * columns + j
    c, d = (i + 1) % rows * columns + (j + 1) % columns, i * columns + (j + 1) % columns
    return np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3)


def swept(curve: Callable[[Floats], Floats], radius: Callable[[Floats], Floats], faces: int) -> Surface:
    """A tube of varying round section along a closed curve; both functions take angles (N,) in 0..2 pi.

    The section turns with a rotation-minimising frame (Wang et al., *Computation of rotation minimizing frames*, 2008),
    so that the grid does not shear; what is left of the turn after one round is spread over the curve.
    """
    fine = np.linspace(0, 2 * np.pi, 4097)
    length = np.concatenate([[0], np.cumsum(np.sqrt((np.diff(curve(fine), axis=0) ** 2).sum(axis=1)))])
    mean_section = 2 * np.pi * radius(fine).mean()
    across = max(3, round(np.sqrt(faces / 2 * mean_section / length[-1])))
    along = max(3, round(faces / 2 / across))
    u = np.interp(np.arange(along) / along * length[-1], length, fine)
    points, side = curve(u), frame(curve(u))
    tangent = normalised(np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0))
    other = np.cross(tangent, side)
    v = 2 * np.pi * np.arange(across) / across
    outward = side[:, None] * np.cos(v)[:, None] + other[:, None] * np.sin(v)[:, None]
    positions = points[:, None] + outward * radius(u)[:, None, None]
    # a growing section tilts the normal back along the curve
    step = np.sqrt(((np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)) ** 2).sum(axis=1))
    slope = (np.roll(radius(u), -1) - np.roll(radius(u), 1)) / step
    normals = normalised(outward - slope[:, None, None] * tangent[:, None])
    return positions.reshape(-1, 3), normals.reshape(-1, 3), grid(along, across, closed=True)[:, ::-1]


def frame(points: Floats) -> Floats:
    """Unit vectors (N, 3) across a closed curve through `points` that turn about it as little as possible."""
    tangent = normalised(np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0))
    side = np.cross(tangent[0], np.eye(3)[np.argmin(np.abs(tangent[0]))])
    sides = []
    for step in range(len(points) + 1):
        side = side - tangent[step % len(points)] * (side @ tangent[step % len(points)])
        side /= np.sqrt(side @ side)
        sides.append(side)
    first, last = sides[0], sides[-1]
    twist = np.arctan2(np.cross(first, last) @ tangent[0], first @ last)
    turn = -twist * np.arange(len(points)) / len(points)
    across = np.array(sides[:-1])
    turned: Floats = across * np.cos(turn)[:, None] + np.cross(tangent, across) * np.sin(turn)[:, None]
    return turned
