import io
import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest
from numpy.typing import NDArray
from PIL import Image, ImageCms

from fakesss.colour import decode_srgb, to_8bit
from fakesss.image_io import encode_png, encode_png8, read_picture, write_image
from fakesss.problem import BadInput


@pytest.fixture
def pixels() -> NDArray[np.uint8]:
    return np.random.default_rng(4).integers(0, 256, (11, 17, 3), dtype=np.uint8)


def test_png_holds_the_code_values_and_says_srgb(tmp_path: Path, pixels: NDArray[np.uint8]) -> None:
    path = write_image(tmp_path / "a.png", decode_srgb(pixels / 255))
    read, warnings = read_picture(path)
    np.testing.assert_array_equal(read, pixels)
    assert warnings == ()
    assert b"sRGB" in path.read_bytes() and b"tIME" not in path.read_bytes()


def test_png_bytes_are_the_same_every_time_and_leave_coverage_out(pixels: NDArray[np.uint8]) -> None:
    linear = decode_srgb(pixels / 255)
    with_coverage = np.concatenate([linear, np.zeros((11, 17, 1))], axis=2)
    assert encode_png(linear) == encode_png(with_coverage) == encode_png8(pixels)


@pytest.mark.parametrize(("height", "width"), [(5000, 5000), (1, 16384), (16384, 1), (4096, 4095)])
def test_a_huge_picture_takes_little_beside_its_file(height: int, width: int) -> None:
    row = np.linspace(0, 1, width * 4, dtype=np.float32).reshape(1, width, 4)
    linear = np.broadcast_to(row, (height, width, 4))
    tracemalloc.start()
    try:
        file = encode_png(linear)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 2 * len(file) + 16e6  # the picture itself, were it copied once, is 400 MB
    shown = read_huge(file)
    assert shown.shape == (height, width, 3)
    np.testing.assert_array_equal(shown[[0, height // 2, -1]], np.broadcast_to(to_8bit(row[..., :3]), (3, width, 3)))


def read_huge(file: bytes) -> NDArray[np.uint8]:
    with Image.open(io.BytesIO(file)) as picture:
        return np.asarray(picture)


@pytest.mark.parametrize("channels", [3, 4])
def test_exr_keeps_linear_floats_beyond_white(tmp_path: Path, channels: int) -> None:
    linear = np.random.default_rng(1).uniform(-1, 9, (5, 7, channels)).astype(np.float32)
    path = write_image(tmp_path / "a.exr", linear)
    with OpenEXR.File(str(path)) as file:
        read = {name: channel.pixels for name, channel in file.channels().items()}
    assert set(read) == (
        {"RGB", "coverage"} if channels == 4 else {"RGB"}
    )  # "A" would say that RGB is multiplied by it
    np.testing.assert_array_equal(np.dstack(list(read.values())), linear)


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("a.jpg", '".jpg" is no format of pictures; name it .png or .exr'),
        ("a", "name it .png or .exr"),
        ("no/such/a.png", "does not exist"),
    ],
)
def test_a_place_that_cannot_be_written_is_one_sentence(tmp_path: Path, name: str, sentence: str) -> None:
    with pytest.raises(BadInput, match=sentence):
        write_image(tmp_path / name, np.zeros((1, 1, 3)))


@pytest.mark.parametrize("suffix", [".png", ".exr"])
def test_a_name_taken_by_a_folder_is_one_sentence(tmp_path: Path, suffix: str) -> None:
    (tmp_path / f"taken{suffix}").mkdir()
    with pytest.raises(BadInput, match="cannot be written"):
        write_image(tmp_path / f"taken{suffix}", np.zeros((1, 1, 3)))


def saved(path: Path, picture: Image.Image, **options: Any) -> Path:
    picture.save(path, **options)
    return path


def srgb_profile() -> bytes:
    return ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()


def lab_profile() -> bytes:
    return ImageCms.ImageCmsProfile(ImageCms.createProfile("LAB")).tobytes()


def test_what_is_accepted_from_elsewhere(tmp_path: Path, pixels: NDArray[np.uint8]) -> None:
    picture = Image.fromarray(pixels)
    tagged = read_picture(saved(tmp_path / "profile.png", picture, icc_profile=srgb_profile()))
    untagged = read_picture(saved(tmp_path / "plain.png", picture))
    opaque = read_picture(saved(tmp_path / "rgba.png", picture.convert("RGBA"), icc_profile=srgb_profile()))
    grey = read_picture(saved(tmp_path / "grey.png", picture.convert("L")))
    for read, _ in (tagged, untagged, opaque):
        np.testing.assert_array_equal(read, pixels)
    assert grey[0].shape == pixels.shape
    assert tagged[1] == opaque[1] == ()
    assert untagged[1] == ("plain.png: states no colour space; taken as sRGB",)


def png_with(pixels: NDArray[np.uint8], kind: bytes, content: bytes) -> bytes:
    from PIL import PngImagePlugin

    chunks, file = PngImagePlugin.PngInfo(), io.BytesIO()
    chunks.add(kind, content)
    Image.fromarray(pixels).save(file, "PNG", pnginfo=chunks)
    return file.getvalue()


ADOBE_RGB = (31270, 32900, 64000, 33000, 21000, 71000, 15000, 6000)
SRGB = (31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000)


def chromaticities(values: tuple[int, ...]) -> bytes:
    return b"".join(value.to_bytes(4, "big") for value in values)


def test_statements_of_srgb_in_other_words_are_accepted(tmp_path: Path, pixels: NDArray[np.uint8]) -> None:
    path = tmp_path / "picture.png"
    path.write_bytes(png_with(pixels, b"cHRM", chromaticities(SRGB)))
    assert len(read_picture(path)[1]) == 1  # primaries alone leave the curve open
    path.write_bytes(png_with(pixels, b"cICP", bytes([1, 13, 0, 1])))
    assert read_picture(path)[1] == ()
    exif = Image.Exif()
    exif[0x0112] = 1
    np.testing.assert_array_equal(read_picture(saved(path, Image.fromarray(pixels), exif=exif))[0], pixels)


def refused(folder: Path, kind: str, pixels: NDArray[np.uint8]) -> Path:
    picture = Image.fromarray(pixels)
    path = folder / "picture.png"
    if kind == "lab profile":
        return saved(path, picture, icc_profile=lab_profile())
    if kind == "gamma":
        path.write_bytes(png_with(pixels, b"gAMA", (100_000).to_bytes(4, "big")))
    elif kind == "primaries":
        path.write_bytes(png_with(pixels, b"cHRM", chromaticities(ADOBE_RGB)))
    elif kind == "cicp":
        path.write_bytes(png_with(pixels, b"cICP", bytes([9, 16, 0, 1])))
    elif kind == "a transparent colour":
        return saved(path, picture, transparency=tuple(int(value) for value in pixels[3, 3]))
    elif kind == "to be turned":
        turned = Image.Exif()
        turned[0x0112] = 6
        return saved(path, picture, exif=turned)
    elif kind == "16 bit grey":
        return saved(path, Image.fromarray(pixels[..., 0].astype(np.uint16) * 257))
    elif kind == "palette":
        return saved(path, picture.convert("P"))
    elif kind == "transparent":
        return saved(path, Image.fromarray(np.dstack([pixels, pixels[..., 0]])))
    elif kind == "animated":
        return saved(path, picture, save_all=True, append_images=[Image.fromarray(255 - pixels)])
    elif kind == "16 bit rgb":
        path.write_bytes(rgb16())
    elif kind == "not a picture":
        path.write_text("hello")
    elif kind == "cut off":
        path.write_bytes(encode_png8(pixels)[:200])
    return path


def rgb16() -> bytes:
    """A 1x1 PNG of 16-bit RGB, which Pillow cannot write."""
    import struct
    import zlib

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", 1, 1, 16, 2, 0, 0, 0)
    body = zlib.compress(b"\0" + b"\x12\x34" * 3)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


@pytest.mark.parametrize(
    ("kind", "sentence"),
    [
        ("lab profile", "convert it to sRGB"),
        ("gamma", "states a gamma of 1.0"),
        ("primaries", "states primaries that are not sRGB's"),
        ("cicp", "cICP 9-16-0-1"),
        ("a transparent colour", "partly transparent"),
        ("to be turned", "rotate and save it"),
        ("16 bit grey", "8-bit RGB"),
        ("16 bit rgb", "16 bits a channel"),
        ("palette", "pixels of kind P"),
        ("transparent", "partly transparent"),
        ("animated", "animation"),
        ("not a picture", "cannot be read as a picture; save it as PNG"),
        ("cut off", "cannot be read as a picture"),
        ("missing", "no such picture"),
    ],
)
def test_what_is_refused_from_elsewhere(tmp_path: Path, pixels: NDArray[np.uint8], kind: str, sentence: str) -> None:
    with pytest.raises(BadInput, match=sentence):
        read_picture(refused(tmp_path, kind, pixels))
