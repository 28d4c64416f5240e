"""When two pictures that should be one are: equal but for rounding."""

from typing import Any

import numpy as np
from edges import off_edges

LAYERS = ("front", "second", "surface", "thickness", "image")
# Off the edges: thickness in sphere diameters, linear light. The worst found are 1.2e-6 and 1.7e-5; their means 1.1e-6.
LARGEST, MEAN = {"thickness": 1e-5, "image": 1e-4}, 2e-6
OUTLINE = 1e-3  # share of the picture that may be covered in one and not in the other; found: none


def differences(one: dict[str, Any], other: dict[str, Any]) -> dict[str, Any]:
    """Absolute differences of thickness and linear light at the pixels off the edges of both."""
    smooth = off_edges(one) & off_edges(other)
    return {name: np.abs(one[name].astype(np.float64) - other[name])[smooth] for name in LARGEST}


def assert_same(one: dict[str, Any], other: dict[str, Any]) -> None:
    """Equal but for rounding, off the edges and on the whole."""
    assert ((one["front"] > 0) != (other["front"] > 0)).mean() <= OUTLINE
    for name, difference in differences(one, other).items():
        assert difference.max(initial=0) <= LARGEST[name], name
        assert difference.mean() <= MEAN if difference.size else True, name
