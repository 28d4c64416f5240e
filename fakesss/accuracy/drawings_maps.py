"""Thumbnails for a page, as `data:` addresses: a picture, its signed difference from a reference, its FLIP map."""

import base64
import io
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib import colormaps
from numpy.typing import NDArray
from PIL import Image

from fakesss.colour import luminance, to_8bit

SIDE = 120
"""Pixels of a thumbnail's longer side, at most; a smaller picture keeps its own size."""
MARGIN = 0.04
"""Of the object's extent, around it: what lies farther off is background and is cut away."""
STEPS = 24
"""Colours from zero to the end of a scale: fewer bytes than 256, and no eye tells more apart in a thumbnail."""
SIGNED, FLIP = "RdBu_r", "magma"
"""Colour maps: blue darker and red brighter than the reference, zero near white; FLIP's own from black to yellow."""
NEARLY_ALL = 99.0
"""Percentile that ends a scale: one pixel on a silhouette shall not make all others invisible."""
CODES = 256

Frame = tuple[slice, slice]


@dataclass(frozen=True)
class Thumbnail:
    """A picture to stand in the page itself: `data:` address, size in pixels."""

    uri: str
    width: int
    height: int


def frame_of(picture: NDArray[Any]) -> Frame:
    """Rows and columns that hold what (H, W, 4) covers, and a margin; all of it where it covers nothing."""
    height, width = picture.shape[:2]
    covered = picture[..., 3] > 0
    if not covered.any():
        return slice(0, height), slice(0, width)
    return extent(np.any(covered, axis=1)), extent(np.any(covered, axis=0))


def extent(covered: Any) -> slice:
    """The places from the first to the last that is covered, and a margin."""
    places = np.flatnonzero(covered)
    room = int(np.ceil(MARGIN * (places[-1] - places[0] + 1)))
    return slice(max(0, int(places[0]) - room), min(len(covered), int(places[-1]) + 1 + room))


def picture_thumbnail(picture: NDArray[Any], frame: Frame) -> Thumbnail:
    """Linear RGB (H, W, 3 or more) as a display shows it, in the 256 colours that suit it best."""
    shown = to_8bit(reduced(picture[frame][..., :3]))
    kind = Image.Quantize.MEDIANCUT
    return thumbnail(Image.fromarray(shown).quantize(CODES, method=kind, dither=Image.Dither.NONE))


def difference_thumbnail(picture: NDArray[Any], reference: NDArray[Any], frame: Frame) -> tuple[Thumbnail, int | None]:
    """`picture` less `reference` in linear luminance, and the power of two it is magnified by.

    That is the largest, and at least 0, by which nearly all of the thumbnail stays within -1 and 1, beyond which the
    colour does not change; None where the two do not differ.
    """
    signed = reduced(luminance_difference(picture, reference)[frame])
    size = np.abs(signed)
    largest = float(np.percentile(size, NEARLY_ALL)) or float(size.max())
    if largest == 0:
        return mapped(signed, SIGNED, -1.0), None
    gain = max(0, int(np.floor(-np.log2(largest))))
    return mapped(signed * 2.0**gain, SIGNED, -1.0), gain


def flip_thumbnail(values: NDArray[Any], most: float, frame: Frame) -> Thumbnail:
    """A FLIP map (H, W) from 0 to `most`."""
    return mapped(reduced(values[frame]) / most, FLIP, 0.0)


def luminance_difference(picture: NDArray[Any], reference: NDArray[Any]) -> NDArray[np.float64]:
    """(H, W), signed: positive where `picture` is the brighter one."""
    return luminance(picture[..., :3]) - luminance(reference[..., :3])


def scale_end(values: float) -> float:
    """The power of two at or above `values`, at most 1: where a scale of FLIP ends."""
    return float(min(1.0, 2.0 ** np.ceil(np.log2(values)))) if values > 0 else 1.0


def mapped(values: NDArray[Any], colours: str, low: float) -> Thumbnail:
    """Values from `low` to 1 through a colour map; zero has a colour of its own."""
    first = round(low * STEPS)
    indices = np.rint(np.clip(values, low, 1.0) * STEPS).astype(int) - first
    count = STEPS - first + 1
    image = Image.fromarray(indices.astype(np.uint8)).convert("P")
    image.putpalette(colormaps[colours](np.linspace(0, 1, count), bytes=True)[:, :3].tobytes())
    return thumbnail(image)


def reduced(values: NDArray[Any]) -> NDArray[np.float64]:
    """(H, W) or (H, W, 3) averaged down to SIDE pixels at most, in the light's own linear numbers."""
    height, width = values.shape[:2]
    scale = min(1.0, SIDE / max(height, width))
    size = max(1, round(width * scale)), max(1, round(height * scale))
    planes = values[..., None] if values.ndim == 2 else values
    made = [
        np.asarray(Image.fromarray(np.ascontiguousarray(planes[..., k], np.float32)).resize(size, Image.Resampling.BOX))
        for k in range(planes.shape[-1])
    ]
    return np.asarray(np.stack(made, axis=-1).reshape(size[1], size[0], *values.shape[2:]), np.float64)


def thumbnail(image: Image.Image) -> Thumbnail:
    """As PNG, without a date."""
    stream = io.BytesIO()
    image.save(stream, "PNG", optimize=True)
    address = "data:image/png;base64," + base64.b64encode(stream.getvalue()).decode()
    return Thumbnail(address, *image.size)
