"""Pictures to and from files: PNG (8-bit sRGB) and EXR (32-bit linear light), chosen by the file's suffix."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss import png
from fakesss.colour import to_8bit
from fakesss.output import check_output, replacing
from fakesss.picture_reading import read_picture

__all__ = ["check_picture", "encode_png", "encode_png8", "read_picture", "write_image"]

SUFFIXES = (".png", ".exr")
BLOCK = 1 << 14  # pixels encoded at once: what the encoder makes of them stays in the processor's cache


def check_picture(path: str | Path) -> Path:
    """`path` if a picture can be written there, else `BadInput`; called before the work, not after it."""
    return check_output(path, SUFFIXES, "pictures")


def write_image(path: str | Path, linear: NDArray[Any], alpha: bool = False, comment: str = "") -> Path:
    """Write linear RGB (H, W, 3), or RGB and coverage (H, W, 4).

    RGB is the whole picture, so a PNG leaves coverage out; with `alpha` it is the picture times its coverage, and the
    file keeps that as its alpha. The file is there whole, or what stood there before still is (`BadInput`).
    `comment`, ASCII, stands in the file: PNG's text "Comment", OpenEXR's attribute "comments".
    """
    path = check_picture(path)
    with replacing(path) as waiting:
        if path.suffix.lower() == ".png":
            waiting.write_bytes(png.commented(encode_png(linear, alpha), comment))
        else:
            write_exr(waiting, linear, alpha, comment)
    return path


def encode_png(linear: NDArray[Any], alpha: bool = False) -> bytes:
    """PNG bytes of linear RGB (H, W, 3 or 4): encoded to sRGB once, composited already, coverage left out.

    With `alpha` of RGB times coverage, and coverage (H, W, 4): see `straight`.

    Beside the file itself it takes a few megabytes, whatever the picture's size.
    """
    height, width = linear.shape[:2]
    if alpha:
        return png.encode((width, height), (straight(rows) for rows in blocks(linear)), channels=4)
    return png.encode((width, height), (to_8bit(rows[..., :3]) for rows in blocks(linear)))


def straight(premultiplied: NDArray[Any]) -> NDArray[np.uint8]:
    """8-bit colour and alpha (H, W, 4) as PNG wants them: colour no longer multiplied by alpha, 0 where that is 0.

    Alpha is a share and stays linear. Who composites has to decode the colour first: blended as code values, the
    object's edges come out too dark or too light.
    """
    coverage = premultiplied[..., 3:]
    colour = np.divide(premultiplied[..., :3], coverage, out=np.zeros_like(premultiplied[..., :3]), where=coverage > 0)
    return np.concatenate([to_8bit(colour), np.floor(255 * coverage + 0.5).astype(np.uint8)], axis=2)


def encode_png8(pixels: NDArray[np.uint8]) -> bytes:
    """PNG bytes of 8-bit sRGB (H, W, 3)."""
    height, width = pixels.shape[:2]
    return png.encode((width, height), blocks(pixels))


def blocks(picture: NDArray[Any]) -> Iterator[NDArray[Any]]:
    """The picture's rows from the top, a few at a time."""
    rows = max(1, BLOCK // picture.shape[1])
    return (picture[start : start + rows] for start in range(0, len(picture), rows))


def write_exr(path: Path, linear: NDArray[Any], alpha: bool, comment: str = "") -> None:
    """OpenEXR, 32-bit float, ZIP.

    Its readers take RGB for multiplied by A. Only with `alpha` is it; else RGB is the picture over its background, and
    coverage stands in a channel of that name.
    """
    import OpenEXR  # only for those who ask for it: it loads a large library

    picture = np.ascontiguousarray(linear, dtype=np.float32)
    channels = {"RGBA": picture} if alpha else {"RGB": np.ascontiguousarray(picture[..., :3])}
    if picture.shape[2] == 4 and not alpha:
        channels["coverage"] = np.ascontiguousarray(picture[..., 3])
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    if comment:
        header["comments"] = comment
    with OpenEXR.File(header, channels) as file:
        try:
            file.write(str(path))
        except RuntimeError as error:  # a full disk, for one
            raise OSError(str(error)) from None
