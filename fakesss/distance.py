"""Distance fields: bodies and tubes joined by smooth unions, evaluated only where they matter.

A field is a function from (N, 3) float64 points to (N,) distances, negative inside. Distances are right to first order
near the surface, which is all that the mesher needs; they are not exact far away.
Forms after Quilez, *Distance functions* (2008-2024): ellipsoid, polynomial smooth minimum.
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
SAMPLES = 2  # on each piece of a curve, where the search for its nearest point starts
NEWTON_STEPS = 3


def dot(a: Floats, b: Floats) -> Floats:
    """Scalar products (N,) of the rows of two (N, 3) arrays."""
    products: Floats = np.einsum("ij,ij->i", a, b)
    return products


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
            # farther than this, the part changes nothing; half as far again, since distances are first-order only
            reach = 1.5 * (np.maximum(total if radius > 0 else -total, 0) + abs(radius))
            near = np.flatnonzero(dot(outside, outside) <= reach**2)
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
        """To first order (its value over the length of its gradient), which is exact on the surface: (N,)."""
        local = points - np.array(self.centre)
        if self.axes is not None:
            local = np.einsum("ij,jk->ik", local, self.axes)
        scaled = local / np.array(self.radii)
        size = np.sqrt(dot(scaled, scaled))
        steep = scaled / np.array(self.radii)
        slope = np.sqrt(dot(steep, steep))
        inner = -min(self.radii) * np.ones_like(size)
        distance: Floats = np.divide(size * (size - 1), slope, out=inner, where=slope > 1e-9)
        return distance


@dataclass(frozen=True)
class Tube:
    """A round limb along a smooth curve: (n, 4) control points x, y, z, radius of a uniform cubic B-spline, n >= 2.

    The curve runs from the first to the last point. It is cubic because with a jump in curvature, as between
    quadratic pieces, a limb of varying radius has a visible crease.
    """

    points: Sequence[tuple[float, float, float, float]]

    @cached_property
    def pieces(self) -> Floats:
        """Coefficients (piece, power, component) of the polynomials in 0..1."""
        control = np.array(self.points, float)
        ends = 2 * control[[0, -1]] - control[[1, -2]]
        control = np.concatenate([ends[:1], control, ends[1:]])
        basis = np.array([[1, 4, 1, 0], [-3, 0, 3, 0], [3, -6, 3, 0], [-1, 3, -3, 1]]) / 6
        return np.stack([np.einsum("ij,jk->ik", basis, control[i : i + 4]) for i in range(len(control) - 3)])

    @cached_property
    def box(self) -> tuple[Floats, Floats]:
        control = np.array(self.points, float)
        return (control[:, :3] - control[:, 3:]).min(axis=0), (control[:, :3] + control[:, 3:]).max(axis=0)

    def distance(self, points: Floats) -> Floats:
        """To the nearest point of the curve, less the radius there, by Newton's method: (N,)."""
        place = self.nearest_sample(points)
        for _ in range(NEWTON_STEPS):
            curve, speed, bend = self.at(place)
            away = curve[:, :3] - points
            speed_squared = dot(speed[:, :3], speed[:, :3])
            # far from the curve the second derivative of the squared distance may vanish
            slope = np.maximum(speed_squared + dot(away, bend[:, :3]), 0.25 * speed_squared)
            step = dot(away, speed[:, :3]) / slope
            place = np.clip(place - np.clip(step, -0.5, 0.5), 0, len(self.pieces))
        curve, _, _ = self.at(place)
        away = curve[:, :3] - points
        distance: Floats = np.sqrt(dot(away, away)) - curve[:, 3]
        return distance

    def nearest_sample(self, points: Floats) -> Floats:
        """The curve parameter (N,) of the nearest of a few points on the curve."""
        samples = (np.arange(SAMPLES * len(self.pieces)) + 0.5) / SAMPLES
        least, place = np.full(len(points), np.inf), np.zeros(len(points))
        x, y, z = np.ascontiguousarray(points.T)
        for parameter, (cx, cy, cz, _) in zip(samples, self.at(samples)[0], strict=True):
            squared = (x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2
            nearer = squared < least
            np.copyto(least, squared, where=nearer)
            np.copyto(place, parameter, where=nearer)
        return place

    def at(self, place: Floats) -> tuple[Floats, Floats, Floats]:
        """The curve (N, 4) and its first two derivatives at parameters (N,) in 0..number of pieces."""
        piece = np.minimum(place.astype(int), len(self.pieces) - 1)
        u = (place - piece)[:, None]
        a, b, c, d = (np.take(self.pieces[:, power], piece, axis=0) for power in range(4))
        return a + u * (b + u * (c + u * d)), b + u * (2 * c + 3 * u * d), 2 * c + 6 * u * d


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
