"""PNG against Pillow's reader and against the filter written out byte by byte."""

import io
import zlib
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray
from PIL import Image

from fakesss.png import encode, filtered

SHAPES = st.tuples(st.integers(1, 9), st.integers(1, 9), st.just(3))


def in_blocks(pixels: NDArray[np.uint8], rows: int) -> Iterator[NDArray[np.uint8]]:
    return (pixels[start : start + rows] for start in range(0, len(pixels), rows))


@given(pixels=arrays(np.uint8, SHAPES), rows=st.integers(1, 10))
def test_what_is_read_is_what_was_written(pixels: NDArray[np.uint8], rows: int) -> None:
    height, width = pixels.shape[:2]
    with Image.open(io.BytesIO(encode((width, height), in_blocks(pixels, rows)))) as picture:
        assert (picture.mode, picture.size) == ("RGB", (width, height))
        np.testing.assert_array_equal(np.asarray(picture), pixels)


def paeth_predictor(a: int, b: int, c: int) -> int:
    """The specification's own pseudo-code (9.4)."""
    p = a + b - c
    pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
    if pa <= pb and pa <= pc:
        return a
    return b if pb <= pc else c


@given(arrays(np.uint8, SHAPES))
def test_the_filter_is_the_specifications(pixels: NDArray[np.uint8]) -> None:
    rows = pixels.reshape(len(pixels), -1).astype(int)
    result = filtered(rows.astype(np.uint8), np.zeros(rows.shape[1], np.uint8))
    for y, row in enumerate(rows):
        above = rows[y - 1] if y else np.zeros_like(row)
        expected = [4]
        for x, value in enumerate(row):
            a, c = (row[x - 3], above[x - 3]) if x >= 3 else (0, 0)
            expected.append((int(value) - paeth_predictor(int(a), int(above[x]), int(c))) % 256)
        assert result[y].tolist() == expected


def chunks(file: bytes) -> list[tuple[bytes, bytes]]:
    found, at = [], 8
    while at < len(file):
        length = int.from_bytes(file[at : at + 4], "big")
        kind, content = file[at + 4 : at + 8], file[at + 8 : at + 8 + length]
        assert int.from_bytes(file[at + 8 + length : at + 12 + length], "big") == zlib.crc32(kind + content)
        found.append((kind, content))
        at += 12 + length
    return found


@pytest.mark.parametrize("size", [(1, 1), (700, 300)])
def test_chunks_are_in_order_and_state_srgb_but_no_time(size: tuple[int, int]) -> None:
    pixels = np.random.default_rng(0).integers(0, 256, (size[1], size[0], 3), np.uint8)
    kinds = [kind for kind, _ in chunks(encode(size, in_blocks(pixels, 16)))]
    assert list(dict.fromkeys(kinds)) == [b"IHDR", b"sRGB", b"IDAT", b"IEND"]


def test_a_plain_background_costs_next_to_nothing() -> None:
    pixels = np.full((512, 512, 3), 40, np.uint8)
    assert len(encode((512, 512), [pixels])) < 2000
