"""The material whose picture is nearest to a wanted one: separable least squares by variable projection.

Golub and Pereyra, *The differentiation of pseudo-inverses and nonlinear least squares problems whose variables
separate*, 1973, with Kaufman's shorter derivative (1975). For an exponent r and a colour k, Kd up to its scale, the
picture is linear in four numbers not below 0: ka, wd, and the two parts u and v of the backlight with

    wb = u + v,    wb Kb = v max(k) - u min(k),

which holds Kb between -min(k), where one channel of the backlight is black, and max(k). They are solved for at once
(non-negative least squares, Lawson and Hanson 1974), so what is searched has three dimensions: ln r and the logarithms
of two ratios of k.

Pictures do not tell apart Kd, ka, wd, wb, Kb and s Kd, ka / s, wd / s, wb / s, s Kb: the largest channel of Kd is held
at a given value. Nor do they tell Kb from wb where Kd is nearly grey: then Kb can be held too (`tint`).
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.optimize import least_squares, nnls

from fakesss.offline.fit_model import Basis, Floats
from fakesss.scene import Material

EXPONENTS = (0.1, 1000.0)  # of r: at the ends the backlight is even, or at 1/e 0.1% of the diameter deep
RATIOS = (1e-4, 1e4)  # of one channel of Kd to another
TOLERANCE = 1e-12  # relative, of the sum of squares, the step and the gradient
CHANNELS = 3


@dataclass(frozen=True)
class Linear:
    """The best factors at one point of the search."""

    factors: Floats  # (3 or 4,): ka, wd and the backlight's parts, for k as it was searched
    residual: Floats  # (P, 3): model less wanted
    span: Floats  # (3 P, up to 4), orthonormal: of the columns whose factor is above 0


@dataclass(frozen=True)
class Problem:
    """`wanted` (P, 3) is what the object itself sends in the wanted picture.

    `tint`: Kb / max(Kd), if that is held; None to search it.
    """

    basis: Basis
    wanted: Floats
    tint: float | None = None

    @cached_property
    def anchor(self) -> int:
        """The channel of most light, to whose Kd the others are related."""
        return int((self.wanted**2).sum(axis=0).argmax())

    def colour(self, point: Floats) -> Floats:
        """k (3,), 1 in the anchor's channel, of a `point` (ln r, two logarithms of ratios)."""
        return np.insert(np.exp(point[1:]), self.anchor, 1.0)

    def tints(self, k: Floats) -> Floats:
        """(1 or 2, 3): rows of which the products with k are what Kb is, or what it lies between."""
        most = np.eye(CHANNELS)[k.argmax()]
        return np.stack([-np.eye(CHANNELS)[k.argmin()], most]) if self.tint is None else self.tint * most[None]

    def columns(self, point: Floats) -> Floats:
        """(P, 3, 3 or 4): pictures, of which the factors are ka, wd and the backlight's parts."""
        k = self.colour(point)
        through = self.basis.backlight(float(np.exp(point[0])))[0][:, None]
        glows = (through * (k + tint) for tint in self.tints(k) @ k)
        return np.stack([k * self.basis.ambient, k * self.basis.diffuse, *glows], axis=2)

    def linear(self, point: Floats) -> Linear:
        """The factors that fit best at `point`."""
        columns = self.columns(point)
        flat = columns.reshape(-1, columns.shape[2])
        q, r = np.linalg.qr(flat)
        factors = nnls(r, q.T @ self.wanted.ravel())[0]
        return Linear(factors, columns @ factors - self.wanted, np.linalg.qr(flat[:, factors > 0])[0])

    def residual(self, point: Floats) -> Floats:
        """(3 P,), with the best factors."""
        return self.linear(point).residual.ravel()

    def jacobian(self, point: Floats) -> Floats:
        """(3 P, 3): Kaufman's, the derivative at fixed factors less what other factors would make up for."""
        solved, k = self.linear(point), self.colour(point)
        (ka, wd), glows = solved.factors[:2], solved.factors[2:]
        through, by_exponent = (each[:, None] for each in self.basis.backlight(float(np.exp(point[0]))))
        slopes = [by_exponent * (glows @ (k + (self.tints(k) @ k)[:, None]))]
        own = ka * self.basis.ambient + wd * self.basis.diffuse + glows.sum() * through
        for channel in np.delete(np.arange(CHANNELS), self.anchor):
            slope = np.repeat(glows @ self.tints(k)[:, channel] * through, CHANNELS, axis=1)
            slope[:, channel] += own[:, channel]
            slopes.append(k[channel] * slope)
        flat = np.stack([slope.ravel() for slope in slopes], axis=1)
        return np.asarray(flat - solved.span @ (solved.span.T @ flat))


@dataclass(frozen=True)
class Ended:
    """Where one start ended."""

    point: Floats
    rmse: float  # over pixels and channels
    evaluations: int
    converged: bool


def search(problem: Problem, start: Floats) -> Ended:
    """From `start` to the nearest minimum within the bounds, by a trust region (Branch, Coleman and Li 1999)."""
    low, high = bounds()
    inside = np.clip(start, low + 1e-6, high - 1e-6)  # the method starts strictly within
    found = least_squares(
        problem.residual, inside, problem.jacobian, (low, high), "trf", ftol=TOLERANCE, xtol=TOLERANCE, gtol=TOLERANCE
    )
    rmse = float(np.sqrt(2 * found.cost / problem.wanted.size))
    return Ended(found.x, rmse, int(found.nfev), bool(found.success))


def bounds() -> tuple[Floats, Floats]:
    """Lowest and highest point of the search."""
    low, high = np.log(np.array([EXPONENTS, RATIOS, RATIOS])).T
    return low, high


def point_of(problem: Problem, material: Material) -> Floats:
    """Where the search stands at a material's exponent and colour."""
    colour = np.maximum(np.array(material.diffuse), 1e-9)
    ratios = np.delete(colour / colour[problem.anchor], problem.anchor)
    return np.clip(np.log([max(material.thickness_exponent, 1e-9), *ratios]), *bounds())


def fitted(problem: Problem, point: Floats, start: Material) -> Material:
    """The material at a point of the search, the largest channel of Kd that of `start` (1 if that is black).

    What the picture does not depend on stays as in `start`: r and Kb where there is no backlight, ka or wd unlit.
    """
    top, k = max(start.diffuse) or 1.0, problem.colour(point)
    scale = top / k.max()
    ka, wd, *glows = problem.linear(point).factors / scale
    backlight = float(sum(glows))
    changes: dict[str, Any] = {"diffuse": tuple(map(float, np.minimum(k * scale, 1.0))), "backlight": backlight}
    if backlight:
        weight = float(scale * np.average(problem.tints(k) @ k, weights=glows))
        changes |= {"thickness_exponent": float(np.exp(point[0])), "diffuse_weight": weight}
    if problem.basis.ambient.any():
        changes["ambient"] = float(ka)
    if problem.basis.diffuse.any():
        changes["diffuse_contribution"] = float(wd)
    return start.model_copy(update=changes)
