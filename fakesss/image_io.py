"""Pictures to and from files: PNG (8-bit sRGB) and EXR (32-bit linear light), chosen by the file's suffix."""

import io
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, PngImagePlugin

from fakesss.colour import to_8bit
from fakesss.picture_reading import read_picture
from fakesss.problem import BadInput

__all__ = ["check_output", "encode_png", "encode_png8", "read_picture", "write_image"]

SUFFIXES = (".png", ".exr")
COMPRESSION = 6  # zlib level, fixed so that equal pictures are equal files
PERCEPTUAL = b"\0"  # rendering intent in the sRGB chunk


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
    """PNG bytes of linear RGB (H, W, 3 or 4): encoded to sRGB once, composited already, coverage left out."""
    return encode_png8(to_8bit(linear[..., :3]))


def encode_png8(pixels: NDArray[np.uint8]) -> bytes:
    """PNG bytes of 8-bit sRGB (H, W, 3), with an sRGB chunk and no time stamp: equal pixels give equal bytes."""
    chunks = PngImagePlugin.PngInfo()
    chunks.add(b"sRGB", PERCEPTUAL)
    file = io.BytesIO()
    picture = Image.fromarray(np.ascontiguousarray(pixels))
    picture.save(file, format="PNG", pnginfo=chunks, compress_level=COMPRESSION)
    return file.getvalue()


def write_exr(path: Path, linear: NDArray[Any]) -> None:
    """OpenEXR, 32-bit float, ZIP. RGB is the picture over its background; A, where there is one, is coverage."""
    import OpenEXR  # only for those who ask for it: it loads a large library

    channels = {"RGBA" if linear.shape[2] == 4 else "RGB": np.ascontiguousarray(linear, dtype=np.float32)}
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, channels) as file:
        file.write(str(path))
