"""Linear light and sRGB code values. IEC 61966-2-1:1999, the piecewise curves; nothing is gamma 2.2 here."""

from typing import Any

import numpy as np
from numpy.typing import NDArray


def encode_srgb(linear: NDArray[Any]) -> NDArray[np.float64]:
    """Code values 0..1 of linear light; light outside 0..1 is clipped, since a display shows no more."""
    light = np.clip(np.asarray(linear, np.float64), 0.0, 1.0)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.power(light, 1 / 2.4) - 0.055)


def decode_srgb(code: NDArray[Any]) -> NDArray[np.float64]:
    """Linear light of code values 0..1."""
    value = np.clip(np.asarray(code, np.float64), 0.0, 1.0)
    return np.where(value <= 0.04045, value / 12.92, np.power((value + 0.055) / 1.055, 2.4))


def to_8bit(linear: NDArray[Any]) -> NDArray[np.uint8]:
    """Linear light as 8-bit sRGB, rounded half up, without dither: equal pictures stay equal."""
    return np.floor(encode_srgb(linear) * 255.0 + 0.5).astype(np.uint8)


def luminance(linear: NDArray[Any]) -> NDArray[np.float64]:
    """Relative luminance (...) of linear RGB (..., 3) with sRGB primaries."""
    rgb = np.asarray(linear, np.float64)
    return np.asarray(0.2126 * rgb[..., 0] + 0.7152 * rgb[..., 1] + 0.0722 * rgb[..., 2])
