"""Errors between pictures: in linear radiance by hand, FLIP by what its paper says of even fields."""

import sys

import numpy as np
import pytest
from numpy.typing import NDArray

from fakesss.accuracy.errors import JUST_NOTICEABLE, MAHY, errors, flip_map
from fakesss.colour import luminance
from fakesss.problem import BadInput


def picture(level: float, size: int = 32) -> NDArray[np.float32]:
    """An even grey square (size, size, 4) whose left half is covered."""
    image = np.full((size, size, 4), level, np.float32)
    image[..., 3] = np.arange(size) < size / 2
    return image


def test_what_is_equal_has_no_error() -> None:
    same = errors(picture(0.3), picture(0.3))
    assert (same.rmse, same.max_abs, same.flip, same.flip_everywhere) == (0, 0, 0, 0)
    assert same.flip_map.shape == (32, 32) and same.flip_map.dtype == np.float32


def test_radiance_is_compared_over_covered_pixels_only() -> None:
    other = picture(0.3)
    other[0, 0, 0] += 0.25  # covered
    other[0, 31, 1] += 0.5  # background, of which nobody asked
    found = errors(other, picture(0.3))
    assert found.max_abs == pytest.approx(0.25, rel=1e-6)
    assert found.rmse == pytest.approx(0.25 / np.sqrt(3 * 32 * 16), rel=1e-6)


def test_what_either_picture_covers_counts() -> None:
    wider, narrow = picture(0.3), picture(0.3)
    wider[:, 20] += (0.5, 0.5, 0.5, 1)
    for one, other in ((wider, narrow), (narrow, wider)):
        assert errors(one, other).max_abs == pytest.approx(0.5)


def lightness(level: float) -> float:
    """CIELAB L* of a grey."""
    return float(116 * np.cbrt(luminance(np.full(3, level))) - 16)


@pytest.mark.parametrize("level", [0.05, 0.2, 0.6])
def test_a_just_noticeable_step_between_even_fields_has_the_flip_stated(level: float) -> None:
    """`JUST_NOTICEABLE` is the FLIP of 2.3 lightness units, whatever they are added to; 8-bit steps spread it a bit."""
    brighter = ((lightness(level) + MAHY + 16) / 116) ** 3
    found = errors(picture(brighter), picture(level))
    assert found.flip == pytest.approx(JUST_NOTICEABLE, rel=0.12)
    assert found.flip_everywhere == pytest.approx(found.flip, rel=1e-3)


def test_an_edge_that_moves_is_worse_than_an_even_step() -> None:
    dark, light = picture(0.1), picture(0.1)
    light[:, :8, :3] = dark[:, :9, :3] = 0.4
    assert errors(dark, light).flip_everywhere > JUST_NOTICEABLE


def test_one_pixel_of_many_is_not_everywhere() -> None:
    """A single wrong pixel in 32,768 covered ones shows in the map but not in the statistic; a spot of 64 does."""
    right = picture(0.2, 256)
    pixel, spot = right.copy(), right.copy()
    pixel[100, 50, :3] = spot[100:108, 50:58, :3] = 1
    assert errors(pixel, right).flip_map.max() > JUST_NOTICEABLE > errors(pixel, right).flip_everywhere
    assert errors(spot, right).flip_everywhere > JUST_NOTICEABLE


def test_differences_that_no_display_shows_are_not_seen() -> None:
    """Half an 8-bit step, and light above 1."""
    assert flip_map(picture(0.5), picture(0.5001)).max() == 0
    assert flip_map(picture(1.5), picture(2.5)).max() == 0
    assert errors(picture(1.5), picture(2.5)).rmse == pytest.approx(1)


def test_pictures_that_cannot_be_compared_are_named() -> None:
    with pytest.raises(BadInput, match=r"picture: its shape \(32, 32, 4\) is not the reference's \(16, 16, 4\)"):
        errors(picture(0.1), picture(0.1, 16))
    with pytest.raises(BadInput, match="nothing of the object is seen"):
        errors(np.zeros((4, 4, 4)), np.zeros((4, 4, 4)))


def test_a_missing_package_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "flip_evaluator", None)
    with pytest.raises(BadInput, match=r"pip install 'fakesss\[offline\]'"):
        errors(picture(0.1), picture(0.2))
