"""Twelve measured media and the dipole's formulas: numbers to render by and to check pictures against.

Jensen, Marschner, Levoy and Hanrahan, *A practical model for subsurface light transport*, SIGGRAPH 2001. Coefficients
are per millimetre, one for each of linear R, G and B. Copies in circulation are wrong by factors of ten; the tests
recompute the reflectances that the paper prints. Only the reduced scattering was measured: nothing here knows the
phase function.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fakesss.problem import BadInput, nearest

Array = NDArray[np.float64]
RGB = tuple[float, float, float]

PREFIX = "medium."  # as commands name a medium beside other things: medium.marble


@dataclass(frozen=True)
class Medium:
    """What fills an object, as it was measured."""

    name: str
    sigma_s_prime: RGB  # reduced scattering coefficient, 1/mm
    sigma_a: RGB  # absorption coefficient, 1/mm
    eta: float  # index of refraction


TABLE = (  # figure 5 of the paper
    Medium("apple", (2.29, 2.39, 1.97), (0.0030, 0.0034, 0.046), 1.3),
    Medium("chicken1", (0.15, 0.21, 0.38), (0.015, 0.077, 0.19), 1.3),
    Medium("chicken2", (0.19, 0.25, 0.32), (0.018, 0.088, 0.20), 1.3),
    Medium("cream", (7.38, 5.47, 3.15), (0.0002, 0.0028, 0.0163), 1.3),
    Medium("ketchup", (0.18, 0.07, 0.03), (0.061, 0.97, 1.45), 1.3),
    Medium("marble", (2.19, 2.62, 3.00), (0.0021, 0.0041, 0.0071), 1.5),
    Medium("potato", (0.68, 0.70, 0.55), (0.0024, 0.0090, 0.12), 1.3),
    Medium("skimmilk", (0.70, 1.22, 1.90), (0.0014, 0.0025, 0.0142), 1.3),
    Medium("skin1", (0.74, 0.88, 1.01), (0.032, 0.17, 0.48), 1.3),
    Medium("skin2", (1.09, 1.59, 1.79), (0.013, 0.070, 0.145), 1.3),
    Medium("spectralon", (11.6, 20.4, 14.9), (0.0, 0.0, 0.0), 1.3),
    Medium("wholemilk", (2.55, 3.21, 3.77), (0.0011, 0.0024, 0.014), 1.3),
)
MEDIA: Mapping[str, Medium] = {medium.name: medium for medium in TABLE}


def medium_named(name: str, source: str) -> Medium:
    """The medium called "marble", "Marble" or "medium.marble"; `BadInput` names `source` and the nearest one."""
    medium = MEDIA.get(name.lower().removeprefix(PREFIX))
    if medium is None:
        raise BadInput(f'{source}: "{name}" is no measured medium; {nearest(name.lower().removeprefix(PREFIX), MEDIA)}')
    return medium


def sigma_t_prime(sigma_s_prime: ArrayLike, sigma_a: ArrayLike) -> Array:
    """Reduced extinction coefficient, section 2.1."""
    return np.asarray(np.add(sigma_s_prime, sigma_a), np.float64)


def alpha_prime(sigma_s_prime: ArrayLike, sigma_a: ArrayLike) -> Array:
    """Reduced albedo, section 2.1: the share of an interaction that scatters."""
    return np.asarray(np.divide(sigma_s_prime, sigma_t_prime(sigma_s_prime, sigma_a)), np.float64)


def D_diffusion(sigma_s_prime: ArrayLike, sigma_a: ArrayLike) -> Array:
    """Diffusion constant, section 2.1."""
    return 1 / (3 * sigma_t_prime(sigma_s_prime, sigma_a))


def sigma_tr(sigma_s_prime: ArrayLike, sigma_a: ArrayLike) -> Array:
    """Effective transport coefficient, section 2.1: fluence deep inside falls as exp(-sigma_tr r)."""
    return np.sqrt(3 * np.asarray(sigma_a, np.float64) * sigma_t_prime(sigma_s_prime, sigma_a))


def F_dr(eta: ArrayLike) -> Array:
    """Diffuse Fresnel reflectance from inside, the rational fit of section 2.1 for eta >= 1; 0 to .002 at eta = 1."""
    n = np.asarray(eta, np.float64)
    return np.asarray(-1.440 / n**2 + 0.710 / n + 0.668 + 0.0636 * n)


def A_boundary(eta: ArrayLike) -> Array:
    """How far inside reflection at the boundary moves the dipole's mirror plane, section 2.1; 1 without a boundary."""
    return np.asarray((1 + F_dr(eta)) / (1 - F_dr(eta)))


def total_diffuse_reflectance(sigma_s_prime: ArrayLike, sigma_a: ArrayLike, eta: ArrayLike) -> Array:
    """R_d of a half-space by the dipole, equation 15: 0..1, light that enters counted only.

    The diffusion approximation: without a boundary, light falling straight in, it is .03 too dark from alpha' = .6 to
    .9, and right to .001 at .999 (Chandrasekhar's H function, tests/fakesss/test_path_tracing_truth.py).
    """
    albedo = alpha_prime(sigma_s_prime, sigma_a)
    root = np.sqrt(3 * (1 - albedo))
    return np.asarray(albedo / 2 * (1 + np.exp(-4 / 3 * A_boundary(eta) * root)) * np.exp(-root))
