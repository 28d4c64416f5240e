"""Pictures made elsewhere, to be rated beside ours: read only if what their numbers mean is sure."""

import io
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageCms, UnidentifiedImageError

from fakesss.problem import BadInput

SRGB_GAMMA = (0.45454, 0.45455, 0.45456)  # how encoders round 1/2.2 in a gAMA chunk beside or instead of sRGB
SRGB_PRIMARIES = (0.3127, 0.329, 0.64, 0.33, 0.3, 0.6, 0.15, 0.06)  # white, red, green, blue in x and y: PNG's cHRM
SRGB_CICP = bytes([1, 13, 0, 1])  # H.273: BT.709 primaries, sRGB's curve, RGB, full range
UPRIGHT = (0, 1)  # EXIF orientations that need no turning; 0 is written for "unknown"
ORIENTATION = 0x0112
PNG_BIT_DEPTH = 24  # offset of the byte in the header
MOST_PIXELS = 16384 * 16384


def read_picture(path: str | Path) -> tuple[NDArray[np.uint8], tuple[str, ...]]:
    """8-bit sRGB pixels (H, W, 3), top row first, and warnings; `BadInput` for anything else.

    Accepted: 8-bit RGB, RGBA without transparency, and grey; tagged as sRGB (chunk, EXIF or profile), or untagged with
    a warning. Refused: 16-bit, palette, CMYK, transparent, animated, to be turned, other profiles, primaries or gammas.
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
    if picture.has_transparency_data and np.asarray(picture.convert("RGBA"))[..., 3].min() != 255:
        raise BadInput(f"{path}: is partly transparent; flatten it onto its background and save it as RGB")
    if picture.getexif().get(ORIENTATION, 1) not in UPRIGHT:
        raise BadInput(f"{path}: is to be turned when shown (its EXIF orientation is not 1); rotate and save it")
    warnings = check_colour_space(path, picture, data)
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
    except UnidentifiedImageError:
        raise BadInput(f"{path}: cannot be read as a picture; save it as PNG") from None
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        if isinstance(error, BadInput):
            raise
        raise BadInput(f"{path}: cannot be read as a picture ({error}); save it as PNG") from None
    return picture


def check_colour_space(path: Path, picture: Image.Image, data: bytes) -> tuple[str, ...]:
    """Warnings about the picture's colour space, or `BadInput` if it is known not to be sRGB.

    In the order of precedence of PNG's third edition: cICP, iCCP, sRGB, then gAMA and cHRM.
    """
    if picture.format == "PNG" and (code := png_cicp(data)) is not None:
        if code != SRGB_CICP:
            raise BadInput(f"{path}: states another colour space (cICP {'-'.join(map(str, code))}); convert it to sRGB")
        return ()
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
    primaries = picture.info.get("chromaticity", SRGB_PRIMARIES)
    if not np.allclose(primaries, SRGB_PRIMARIES, rtol=0, atol=2e-3):
        raise BadInput(f"{path}: states primaries that are not sRGB's; convert it to sRGB")
    return (f"{path.name}: states no colour space; taken as sRGB",)


def png_cicp(data: bytes) -> bytes | None:
    """The coding-independent code points of a PNG, which Pillow passes over; None without them."""
    place = 8
    while place + 8 <= len(data):
        length, kind = int.from_bytes(data[place : place + 4], "big"), data[place + 4 : place + 8]
        if kind == b"cICP":
            return data[place + 8 : place + 8 + length]
        place += 12 + length
    return None


def profile_name(profile: bytes) -> str:
    """What an ICC profile calls itself."""
    try:
        return str(ImageCms.getProfileDescription(ImageCms.ImageCmsProfile(io.BytesIO(profile)))).strip()
    except (ImageCms.PyCMSError, OSError) as error:
        return f"unreadable: {error}"
