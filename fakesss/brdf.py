"""Lighting equation 3.6 term by term: the numpy reference of `glsl/common_brdf.glsl`.

Gascons, *Fast simulation of translucent objects*, 2011. The backlight is an empirical term: it is not a radiometric
quantity, conserves no energy and knows nothing of scattering; it brightens what is thin.
Arrays broadcast; cosines and thicknesses are pure numbers.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def power(base: ArrayLike, exponent: ArrayLike) -> Array:
    """`base ** exponent` for base >= 0 and exponent >= 0, with 0 ** 0 = 1: GLSL leaves that undefined."""
    b, e = np.broadcast_arrays(np.asarray(base, float), np.asarray(exponent, float))
    return np.where(e == 0, 1.0, np.where(b <= 0, 0.0, np.power(np.maximum(b, np.finfo(float).tiny), e)))


def lambert(n_dot_l: ArrayLike) -> Array:
    """max(N.L, 0), eq. 3.8; the thesis leaves out 1/pi, so a white diffuser under unit light shows 1."""
    return np.asarray(np.maximum(n_dot_l, 0.0), float)


def blinn_phong(n_dot_l: ArrayLike, n_dot_h: ArrayLike, shininess: ArrayLike) -> Array:
    """max(N.H, 0)^n where the light is above the surface, else 0. Blinn 1977; eq. 3.9. Not normalised."""
    lit = np.asarray(n_dot_l, float) > 0
    return np.where(lit, power(np.maximum(np.asarray(n_dot_h, float), 0.0), shininess), 0.0)


def backlight(thickness: ArrayLike, exponent: ArrayLike) -> Array:
    """(1 - t)^r, eq. 3.10, with t held to 0..1."""
    return power(1.0 - np.clip(np.asarray(thickness, float), 0.0, 1.0), exponent)
