"""Pictures made elsewhere, to be rated beside ours: read only if what their numbers mean is sure."""

import io
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageCms, UnidentifiedImageError

from fakesss.problem import BadInput

SRGB_GAMMA = (0.45454, 0.45455, 0.45456)  # how encoders round 1/2.2 in a gAMA chunk beside or instead of sRGB
PNG_BIT_DEPTH = 24  # offset of the byte in the header
MOST_PIXELS = 16384 * 16384


def read_picture(path: str | Path) -> tuple[NDArray[np.uint8], tuple[str, ...]]:
    """8-bit sRGB pixels (H, W, 3), top row first, and warnings; `BadInput` for anything else.

    Accepted: 8-bit RGB, RGBA without transparency, and grey; tagged as sRGB (chunk, EXIF or profile), or untagged with
    a warning. Refused: 16-bit, palette, CMYK, transparent, animated, other profiles, other gammas.
    """
    path = Path(path)
    data = content(path)
    picture = opened(path, data)
    if getattr(picture, "n_frames", 1) != 1:
        raise BadInput(f"{path}: is an animation; save one frame of it as PNG")
    if picture.mode not in ("RGB", "RGBA", "L"):
        raise BadInput(f"{path}: has pixels of kind {picture.mode}; save it as 8-bit RGB in sRGB")
    if picture.format == "PNG" and data[PNG_BIT_DEPTH] != 8:  # Pillow reads 16-bit RGB as 8-bit without a word
        raise BadInput(f"{path}: has {data[PNG_BIT_DEPTH]} bits a channel; save it as 8-bit RGB in sRGB")
    if picture.mode == "RGBA" and np.asarray(picture)[..., 3].min() != 255:
        raise BadInput(f"{path}: is partly transparent; flatten it onto its background and save it as RGB")
    warnings = check_colour_space(path, picture)
    return np.asarray(picture.convert("RGB")), warnings


def content(path: Path) -> bytes:
    """The file's bytes, or `BadInput`."""
    try:
        return path.read_bytes()
    except FileNotFoundError:
        raise BadInput(f"{path}: no such picture; check the path") from None
    except OSError as error:
        raise BadInput(f"{path}: cannot be read ({error.strerror}); it must be a readable file") from None


def opened(path: Path, data: bytes) -> Image.Image:
    """The decoded picture, or `BadInput`."""
    try:
        picture = Image.open(io.BytesIO(data))
        if picture.width * picture.height > MOST_PIXELS:
            raise BadInput(f"{path}: is {picture.width}x{picture.height} pixels; resize it to the study's pictures")
        picture.load()
    except (UnidentifiedImageError, OSError, SyntaxError, Image.DecompressionBombError) as error:
        raise BadInput(f"{path}: cannot be read as a picture ({error}); save it as PNG") from None
    return picture


def check_colour_space(path: Path, picture: Image.Image) -> tuple[str, ...]:
    """Warnings about the picture's colour space, or `BadInput` if it is known not to be sRGB."""
    if profile := picture.info.get("icc_profile"):
        name = profile_name(profile)
        if "srgb" not in name.lower():
            raise BadInput(f'{path}: has the colour profile "{name}"; convert it to sRGB')
        return ()
    if "srgb" in picture.info or picture.getexif().get_ifd(0x8769).get(0xA001) == 1:
        return ()
    gamma = picture.info.get("gamma")
    if gamma is not None and all(abs(gamma - known) > 1e-4 for known in SRGB_GAMMA):
        raise BadInput(f"{path}: states a gamma of {gamma}, which is not sRGB's; convert it to sRGB")
    return (f"{path.name}: states no colour space; taken as sRGB",)


def profile_name(profile: bytes) -> str:
    """What an ICC profile calls itself."""
    try:
        return str(ImageCms.getProfileDescription(ImageCms.ImageCmsProfile(io.BytesIO(profile)))).strip()
    except (ImageCms.PyCMSError, OSError) as error:
        return f"unreadable: {error}"
