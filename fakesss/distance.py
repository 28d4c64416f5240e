"""Distance fields: bodies and tubes joined by smooth unions, evaluated only where they matter.

A field is a function from (N, 3) float64 points to (N,) distances, negative inside. Distances are right to first order
near the surface, which is all that the mesher needs; they are not exact far away.
Forms after Quilez, *Distance functions* (2008-2024): ellipsoid, quadratic Bézier, polynomial smooth minimum.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Distance = Callable[[Floats], Floats]

FAR = 0.6  # distances beyond this are not told apart; larger than any blend radius


def smooth_min(a: Floats, b: Floats, radius: float) -> Floats:
    """Cubic polynomial minimum: curvature stays continuous, nothing changes where |a - b| > `radius`."""
    near = np.maximum(radius - np.abs(a - b), 0) / radius
    return np.minimum(a, b) - near**3 * (radius / 6)


def smooth_max(a: Floats, b: Floats, radius: float) -> Floats:
    return -smooth_min(-a, -b, radius)


class Part(Protocol):
    """A form with a box around it, outside which its distance is at least the distance to the box."""

    @property
    def box(self) -> tuple[Floats, Floats]: ...

    def distance(self, points: Floats) -> Floats: ...


@dataclass(frozen=True)
class Joined:
    """Parts united in order, each with its blend radius; a negative radius carves the part out instead."""

    parts: Sequence[tuple[Part, float]]

    def __call__(self, points: Floats) -> Floats:
        total = np.full(len(points), FAR)
        for part, radius in self.parts:
            low, high = part.box
            outside = np.maximum(np.maximum(low - points, points - high), 0)
            # squared, to spare the root: farther than this, the part changes nothing
            reach = np.maximum(total, 0) + abs(radius) if radius > 0 else np.maximum(-total, 0) + abs(radius)
            near = np.flatnonzero((outside**2).sum(axis=1) <= reach**2)
            distance = part.distance(points[near])
            before = total[near]
            total[near] = smooth_min(before, distance, radius) if radius > 0 else smooth_max(before, -distance, -radius)
        return total


@dataclass(frozen=True)
class Ellipsoid:
    """Centre, radii along its own axes, and the rotation (3, 3) whose columns are those axes."""

    centre: tuple[float, float, float]
    radii: tuple[float, float, float]
    axes: Floats | None = None

    @cached_property
    def box(self) -> tuple[Floats, Floats]:
        centre, radii = np.array(self.centre), np.array(self.radii)
        axes = np.eye(3) if self.axes is None else self.axes
        half = np.sqrt(((axes * radii) ** 2).sum(axis=1))
        return centre - half, centre + half

    def distance(self, points: Floats) -> Floats:
        local = points - np.array(self.centre)
        if self.axes is not None:
            local = np.einsum("ij,jk->ik", local, self.axes)
        scaled = local / np.array(self.radii)
        size = np.sqrt((scaled**2).sum(axis=1))
        slope = np.sqrt(((scaled / np.array(self.radii)) ** 2).sum(axis=1))
        inner = -min(self.radii) * np.ones_like(size)
        distance: Floats = np.divide(size * (size - 1), slope, out=inner, where=slope > 1e-9)
        return distance


@dataclass(frozen=True)
class Tube:
    """A round limb along a smooth curve: (n, 4) control points x, y, z, radius of a quadratic B-spline, n >= 3."""

    points: Sequence[tuple[float, float, float, float]]

    @cached_property
    def pieces(self) -> list[tuple[Floats, Floats, Floats]]:
        control = np.array(self.points, float)
        middle = (control[1:] + control[:-1]) / 2
        middle[0], middle[-1] = control[0], control[-1]
        return [bent(middle[i - 1], control[i], middle[i]) for i in range(1, len(control) - 1)]

    @cached_property
    def box(self) -> tuple[Floats, Floats]:
        control = np.array(self.points, float)
        return (control[:, :3] - control[:, 3:]).min(axis=0), (control[:, :3] + control[:, 3:]).max(axis=0)

    def distance(self, points: Floats) -> Floats:
        nearest = np.full(len(points), np.inf)
        for a, b, c in self.pieces:
            np.minimum(nearest, bezier_distance(points, a, b, c), out=nearest)
        return nearest


def bent(a: Floats, b: Floats, c: Floats) -> tuple[Floats, Floats, Floats]:
    """A quadratic piece nudged off a straight line, on which the cubic of `bezier_distance` has no solution."""
    curvature = a[:3] - 2 * b[:3] + c[:3]
    length = np.sqrt(((c - a)[:3] ** 2).sum())
    if np.sqrt((curvature**2).sum()) > 1e-2 * length:
        return a, b, c
    direction = (c - a)[:3]
    aside = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
    nudged = b.copy()
    nudged[:3] += 1e-2 * aside / np.sqrt((aside**2).sum()) * length
    return a, nudged, c


def bezier_distance(points: Floats, a: Floats, b: Floats, c: Floats) -> Floats:
    """Distance to a quadratic Bézier curve less its radius there; a, b, c are x, y, z, radius."""
    side, bend, offset = (b - a)[:3], (a - 2 * b + c)[:3], a[:3] - points
    scale = 1 / (bend @ bend)
    kx = scale * (side @ bend)
    ky = scale * (2 * (side @ side) + offset @ bend) / 3
    kz = scale * (offset @ side)
    p, q = ky - kx * kx, kx * (2 * kx * kx - 3 * ky) + kz
    discriminant = q * q + 4 * p**3
    root = np.sqrt(np.maximum(discriminant, 0))
    single = np.cbrt((root - q) / 2) + np.cbrt((-root - q) / 2) - kx
    z = np.sqrt(np.maximum(-p, 1e-30))
    angle = np.arccos(np.clip(-q / (2 * z**3), -1, 1)) / 3
    cosine, sine = np.cos(angle), np.sin(angle) * np.sqrt(3)
    three = discriminant < 0
    first = np.where(three, 2 * cosine * z - kx, single)
    second = np.where(three, (-sine - cosine) * z - kx, single)
    return np.minimum(*(to_curve(offset, side, bend, a, b, c, np.clip(t, 0, 1)) for t in (first, second)))


def to_curve(offset: Floats, side: Floats, bend: Floats, a: Floats, b: Floats, c: Floats, t: Floats) -> Floats:
    """Distance from the points behind `offset` to the surface of the tube's ball at curve parameter `t`."""
    away = offset + (2 * t)[:, None] * side + (t * t)[:, None] * bend
    radius = a[3] + 2 * t * (b - a)[3] + t * t * (a - 2 * b + c)[3]
    distance: Floats = np.sqrt((away**2).sum(axis=1)) - radius
    return distance


@dataclass(frozen=True)
class Custom:
    """A form given by its own function and a box (low, high) around it."""

    function: Distance
    low: tuple[float, float, float]
    high: tuple[float, float, float]

    @cached_property
    def box(self) -> tuple[Floats, Floats]:
        return np.array(self.low), np.array(self.high)

    def distance(self, points: Floats) -> Floats:
        return self.function(points)


def turned(x: float = 0, y: float = 0, z: float = 0) -> Floats:
    """The rotation (3, 3) by degrees about x, then y, then z."""
    matrix = np.eye(3)
    for axis, degrees in enumerate((x, y, z)):
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        step = np.eye(3)
        i, j = (axis + 1) % 3, (axis + 2) % 3
        step[i, i], step[i, j], step[j, i], step[j, j] = c, -s, s, c
        matrix = step @ matrix
    return matrix
