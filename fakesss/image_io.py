"""Pictures to and from files: PNG (8-bit sRGB) and EXR (32-bit linear light), chosen by the file's suffix."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss import png
from fakesss.colour import to_8bit
from fakesss.picture_reading import read_picture
from fakesss.problem import BadInput

__all__ = ["check_output", "encode_png", "encode_png8", "read_picture", "write_image"]

SUFFIXES = (".png", ".exr")
BLOCK = 1 << 14  # pixels encoded at once: what the encoder makes of them stays in the processor's cache


def check_output(path: str | Path) -> Path:
    """`path` if a picture can be written there, else `BadInput`; called before the work, not after it."""
    path = Path(path)
    if path.suffix.lower() not in SUFFIXES:
        raise BadInput(f'{path}: "{path.suffix}" is no picture format written here; name it .png or .exr')
    if not path.parent.is_dir():
        raise BadInput(f"{path}: the folder {path.parent} does not exist; make it first")
    return path


def write_image(path: str | Path, linear: NDArray[Any]) -> Path:
    """Write linear RGB (H, W, 3) or RGB and coverage (H, W, 4); PNG drops coverage, since RGB is the whole picture."""
    path = check_output(path)
    try:
        if path.suffix.lower() == ".png":
            path.write_bytes(encode_png(linear))
        else:
            write_exr(path, linear)
    except (OSError, RuntimeError) as error:
        raise BadInput(f"{path}: cannot be written ({reason(error)}); choose a folder you may write to") from None
    return path


def reason(error: Exception) -> str:
    """The operating system's own words where there are any."""
    return (error.strerror if isinstance(error, OSError) else None) or str(error).splitlines()[0]


def encode_png(linear: NDArray[Any]) -> bytes:
    """PNG bytes of linear RGB (H, W, 3 or 4): encoded to sRGB once, composited already, coverage left out.

    Beside the file itself it takes a few megabytes, whatever the picture's size.
    """
    height, width = linear.shape[:2]
    return png.encode((width, height), (to_8bit(rows[..., :3]) for rows in blocks(linear)))


def encode_png8(pixels: NDArray[np.uint8]) -> bytes:
    """PNG bytes of 8-bit sRGB (H, W, 3)."""
    height, width = pixels.shape[:2]
    return png.encode((width, height), blocks(pixels))


def blocks(picture: NDArray[Any]) -> Iterator[NDArray[Any]]:
    """The picture's rows from the top, a few at a time."""
    rows = max(1, BLOCK // picture.shape[1])
    return (picture[start : start + rows] for start in range(0, len(picture), rows))


def write_exr(path: Path, linear: NDArray[Any]) -> None:
    """OpenEXR, 32-bit float, ZIP. RGB is the picture over its background; A, where there is one, is coverage."""
    import OpenEXR  # only for those who ask for it: it loads a large library

    channels = {"RGBA" if linear.shape[2] == 4 else "RGB": np.ascontiguousarray(linear, dtype=np.float32)}
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, channels) as file:
        file.write(str(path))
