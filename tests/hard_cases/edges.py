"""Where a picture cannot be continuous: at outlines, where a layer jumps to another part, at creases."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter, minimum_filter

JUMP = 0.3  # sphere radii from a pixel to the next
TURN = 0.4  # of any component of the unit normal from a pixel to the next

LAYERS = ("front", "second", "surface")


def off_edges(layers: dict[str, NDArray[Any]], margin: int = 1) -> NDArray[np.bool_]:
    """Pixels (H, W) that are covered, with all within `margin`, and no jump of any of the layers given among them."""
    side = 2 * margin + 1
    values = [(layers["front"], JUMP), (layers["second"], JUMP)]
    values += [(layers["surface"][..., axis], TURN) for axis in range(3) if "surface" in layers]
    inside = minimum_filter(layers["front"], side, mode="constant", cval=0) > 0
    for value, most in values:
        inside &= maximum_filter(value, side) - minimum_filter(value, side) < most * margin
    result: NDArray[np.bool_] = inside
    return result
