"""Exact thickness along rays, to judge the rendered layers by: ray casting for any mesh, closed forms for solids.

An *interval* is the first stretch that a ray spends inside: distances of entry and exit along unit directions, (N,)
float64 in sphere radii, NaN where there is none. Rays are (N, 3) float64 origins and unit directions in the
world frame.
"""

import numpy as np
from numpy.typing import NDArray

from fakesss.camera import View
from fakesss.crossings import Crossings
from fakesss.mesh import Mesh, mesh_from_surface
from fakesss.solids import BOX_HALF, TORUS_RADII, sphere
from fakesss.vertex_normals import normalised

Floats = NDArray[np.float64]
Interval = tuple[Floats, Floats]

ATTEMPTS = 4  # at a ray that slips between two triangles, each turned by about SLIP radians
SLIP = 2e-6


def camera_rays(
    view: View, size: tuple[int, int], columns: range | None = None, rows: range | None = None
) -> tuple[Floats, Floats]:
    """Origins and unit directions through the pixel centres of a picture of `size` (width, height), top row first.

    `columns` and `rows` choose some of them, also beyond the picture's border.
    """
    width, height = size
    across = (np.array(columns or range(width)) + 0.5) / width * 2 - 1
    up = 1 - (np.array(rows or range(height)) + 0.5) / height * 2
    x, y = (side.ravel() for side in np.meshgrid(across * view.tangent[0], up * view.tangent[1]))
    right, above, towards = view.rotation
    directions = x[:, None] * right + y[:, None] * above - towards
    return np.tile(view.distance * towards, (len(x), 1)), normalised(directions)


def thickness(interval: Interval, directions: Floats, forward: Floats) -> Floats:
    """Eye-space thickness t in sphere diameters: exit less entry along the viewing direction `forward` (3,)."""
    entry, leave = interval
    depth: Floats = (leave - entry) * (directions @ forward) / 2
    return depth


class ExactInterval:
    """The first interval of a mesh by ray casting: `ExactInterval(mesh)(origins, directions)`.

    Embree finds the triangles, distances are computed again in float64. `exit` is the next surface behind the entry,
    whichever way it faces. On a closed mesh a ray that seems to enter through a back or to leave through a front has
    slipped through an edge or starts there; it is turned minutely and cast again.
    """

    def __init__(self, mesh: Mesh) -> None:
        self._crossings = Crossings(mesh)
        self._closed = mesh.watertight

    def __call__(self, origins: Floats, directions: Floats) -> Interval:
        entry, leave, sound = self._cast(origins, directions)
        for attempt in range(ATTEMPTS):
            doubtful = np.flatnonzero(~sound)
            if not len(doubtful) or not self._closed:
                break
            aside = np.roll(directions[doubtful], attempt + 1, axis=1) * SLIP * (-1) ** attempt
            turned = directions[doubtful] + aside
            turned /= np.sqrt((turned**2).sum(axis=1, keepdims=True))
            entry[doubtful], leave[doubtful], sound[doubtful] = self._cast(origins[doubtful], turned)
        return entry, leave

    def _cast(self, origins: Floats, directions: Floats) -> tuple[Floats, Floats, NDArray[np.bool_]]:
        """Entry, exit, and whether they face as they must on a closed mesh."""
        hits = self._crossings(origins, directions, most=2)
        absent = ((0, 0), (0, 2 - hits.distances.shape[1]))  # where no ray hits so often
        entry, leave = np.pad(hits.distances, absent, constant_values=np.nan).T
        front, back = np.pad(hits.sides, absent).T
        return entry.copy(), leave.copy(), np.isnan(entry) | ((front < 0) & (back > 0))


def sphere_interval(origins: Floats, directions: Floats, radius: float = 1.0) -> Interval:
    """A solid sphere at the origin."""
    middle = -(origins * directions).sum(axis=1)
    nearest = origins + middle[:, None] * directions
    with np.errstate(invalid="ignore"):
        half = np.sqrt(radius**2 - (nearest**2).sum(axis=1))
    return middle - half, middle + half


def shell_interval(origins: Floats, directions: Floats, outer: float = 1.0, inner: float = 0.8) -> Interval:
    """A sphere hollowed by a concentric one: the first wall."""
    entry, leave = sphere_interval(origins, directions, outer)
    cavity, _ = sphere_interval(origins, directions, inner)
    return entry, np.where(np.isnan(cavity), leave, cavity)


def box_interval(origins: Floats, directions: Floats, half: tuple[float, float, float] = BOX_HALF) -> Interval:
    """A box at the origin, half sides `half` (Kay and Kajiya, *Ray tracing complex scenes*, 1986)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        near, far = ((side * np.array(half) - origins) / directions for side in (-1, 1))
    entry = np.nanmax(np.minimum(near, far), axis=1)
    leave = np.nanmin(np.maximum(near, far), axis=1)
    missed = entry >= leave
    return np.where(missed, np.nan, entry), np.where(missed, np.nan, leave)


def torus_interval(
    origins: Floats, directions: Floats, ring: float = TORUS_RADII[0], tube: float = TORUS_RADII[1]
) -> Interval:
    """A torus around the z axis: the two nearest real roots of the quartic in the distance along the ray."""
    middle = -(origins * directions).sum(axis=1)
    nearest = origins + middle[:, None] * directions  # from here the cubic term vanishes
    k = (nearest**2).sum(axis=1) + ring**2 - tube**2
    a, b, c = (
        4 * ring**2 * (left[:, :2] * right[:, :2]).sum(axis=1)
        for left, right in ((directions, directions), (nearest, directions), (nearest, nearest))
    )
    companion = np.zeros((len(origins), 4, 4))
    companion[:, [1, 2, 3], [0, 1, 2]] = 1
    companion[:, :3, 3] = -np.stack([k * k - c, -2 * b, 2 * k - a], axis=1)
    roots = np.linalg.eigvals(companion)
    real = np.sort(np.where(np.abs(roots.imag) < 1e-7, roots.real, np.inf), axis=1)
    entry, leave = np.where(np.isinf(real[:, :2]), np.nan, real[:, :2]).T
    return middle + entry, middle + leave


def spherical_shell(faces: int, outer: float = 1.0, inner: float = 0.8) -> Mesh:
    """Two concentric spheres of `faces` triangles in all, the inner one facing inwards, radii relative to `outer`."""
    positions, normals, triangles = sphere(faces // 2)
    return mesh_from_surface(
        np.concatenate([outer * positions, inner * positions]),
        np.concatenate([normals, -normals]),
        np.concatenate([triangles, triangles[:, ::-1] + len(positions)]),
    )
