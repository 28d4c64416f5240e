"""How far the noise of the wanted picture leaves fitted parameters open, and whether the picture holds Kb at all.

Linearised at the fit, all parameters free at once but those at a bound and the largest channel of Kd, which only sets
the scale of the others. With J the derivatives of the picture, G the inverse of J'J and V the covariance of
the picture's noise, the standard errors are the square roots of the diagonal of G J' V J G (White 1980: right
whatever the weights). Pixels are independent, the channels of a pixel are not (`fit_noise`). They tell about what
another rendering of as many samples would change, not how wrong the model is; that it is wrong changes them too, by
the curvature of the picture times the misfit, which is left out.
"""

import numpy as np

from fakesss.offline.fit_model import Floats
from fakesss.offline.fit_solver import CHANNELS, EXPONENTS, Problem
from fakesss.scene import Material

SINGULAR = 1e-12  # relative eigenvalue of J'J below which a direction is not in the picture at all
CLOSE = 1e-6  # relative; a parameter that near to its bound is at it
WEIGHT = "diffuse_weight"


def standard_errors(problem: Problem, material: Material, noise: Floats, correlation: Floats) -> dict[str, float]:
    """By field of the material ("diffuse.0", ... for channels of Kd).

    From `noise` (P, 3), the standard errors of the target's pixels, and its `correlation` (3, 3) between channels.

    Not in it: what is held or at a bound. Infinite: what the picture does not depend on.
    """
    held = at_bounds(material) | (set() if problem.tint is None else {WEIGHT})
    names, flat = columns(problem, material, held)
    inverse, lost = inverted(flat)
    noisy = (noise.ravel()[:, None] * flat).reshape(-1, CHANNELS, flat.shape[1])
    together = np.tensordot(noisy, np.tensordot(noisy, correlation, (1, 0)), ((0, 1), (0, 2)))
    variance = np.maximum(np.diag(inverse @ together @ inverse), 0.0)
    return dict(zip(names, map(float, np.where(lost, np.inf, np.sqrt(variance))), strict=True))


def spread_of_weight(problem: Problem, material: Material, residual: Floats) -> float:
    """The standard error of Kb if the `residual` (P, 3) were noise; infinite if Kb is not in the picture."""
    if not material.backlight:
        return 0.0
    held = at_bounds(material) - {WEIGHT}
    names, flat = columns(problem, material, held)
    inverse, lost = inverted(flat)
    at = names.index(WEIGHT)
    return float("inf") if lost[at] else float(np.sqrt(max(inverse[at, at], 0.0) * (residual**2).mean()))


def inverted(flat: Floats) -> tuple[Floats, Floats]:
    """The pseudo-inverse of flat'flat for columns of any length, and which parameters it says nothing of."""
    length = np.linalg.norm(flat, axis=0)
    length[length == 0] = 1.0
    values, vectors = np.linalg.eigh((flat / length).T @ (flat / length))
    kept = values > SINGULAR * values[-1]
    inverse = (vectors[:, kept] / values[kept]) @ vectors[:, kept].T / np.outer(length, length)
    return inverse, (vectors[:, ~kept] ** 2).sum(axis=1) > CLOSE


def columns(problem: Problem, material: Material, held: set[str]) -> tuple[list[str], Floats]:
    """Names of the parameters that are not `held`, and the derivatives by them as columns (3 P, parameters)."""
    free = {name: slope.ravel() for name, slope in derivatives(problem, material).items() if name not in held}
    return list(free), np.stack(list(free.values()), axis=1)


def derivatives(problem: Problem, material: Material) -> dict[str, Floats]:
    """Of the object's picture (P, 3), by each parameter but the largest channel of Kd."""
    basis, colour = problem.basis, np.array(material.diffuse)
    through, by_log = (each[:, None] for each in basis.backlight(material.thickness_exponent))
    glow, ambient = colour + material.diffuse_weight, material.ambient * basis.ambient
    whole = ambient + material.diffuse_contribution * basis.diffuse + material.backlight * through
    channels = np.delete(np.arange(CHANNELS), colour.argmax())
    return {
        "thickness_exponent": material.backlight / material.thickness_exponent * by_log * glow,
        "backlight": through * glow,
        WEIGHT: np.repeat(material.backlight * through, CHANNELS, axis=1),
        "diffuse_contribution": colour * basis.diffuse,
        "ambient": colour * basis.ambient,
        **{f"diffuse.{channel}": whole * np.eye(CHANNELS)[channel] for channel in channels},
    }


def at_bounds(material: Material) -> set[str]:
    """The fields of a fitted material that only a bound keeps from going on, or that there is no backlight to show."""
    held = {name for name in ("backlight", "diffuse_contribution", "ambient") if not getattr(material, name)}
    if not material.backlight:
        return held | {"thickness_exponent", WEIGHT}
    if min(abs(material.thickness_exponent / end - 1) for end in EXPONENTS) < CLOSE:
        held.add("thickness_exponent")
    top, ends = max(material.diffuse), (-min(material.diffuse), max(material.diffuse))
    if min(abs(material.diffuse_weight - end) for end in ends) <= CLOSE * top:
        held.add(WEIGHT)
    return held
