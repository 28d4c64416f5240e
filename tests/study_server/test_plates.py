"""The colour plates: a reader with three kinds of cones finds the numbers, one who lacks a kind does not."""

from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from study_server.screen.plates import (
    DIGITS,
    LMS_FROM_RGB,
    NOISE,
    PLATES,
    RADIUS,
    STROKE,
    XYZ_FROM_RGB,
    colours,
    distance_to_number,
    dots,
    packed,
    srgb_bytes,
    svg,
)

Array = NDArray[np.float64]

# Machado, Oliveira and Fernandes 2009, "A physiologically-based model for simulation of color vision deficiency",
# IEEE TVCG 15 (6): linear RGB as seen without L or M cones (severity 1.0). Not the model that the plates are made by.
MACHADO = {
    0: np.array([[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]),
    1: np.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]),
}
HIDDEN = [index for index, plate in enumerate(PLATES, 1) if plate.cone is not None]


def shown(index: int) -> Array:
    """The dots' linear sRGB (n, 3) as the 8-bit picture has them."""
    code = srgb_bytes(dots(index).rgb) / 255
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def lab(rgb: Array) -> Array:
    """CIELAB (n, 3) of linear sRGB (n, 3), white point D65."""
    t = rgb @ XYZ_FROM_RGB.T / XYZ_FROM_RGB.sum(axis=1)
    f = np.where(t > 216 / 24389, np.cbrt(t), (24389 / 27 * t + 16) / 116)
    return np.stack([116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], axis=1)


def distinctness(signals: Array, figure: NDArray[np.bool_]) -> float:
    """The largest d' (difference of means over pooled sd) among the columns of `signals` (n, k)."""
    a, b = signals[figure], signals[~figure]
    return float(np.max(np.abs(a.mean(0) - b.mean(0)) / np.sqrt((a.var(0) + b.var(0)) / 2)))


def read(index: int, signals: Array) -> tuple[str, float]:
    """The two-digit number whose strokes part the dots best, and how well (d')."""
    centres = dots(index).centres
    scores = {
        a + b: distinctness(signals, distance_to_number(a + b, centres) < STROKE) for a, b in product(DIGITS, DIGITS)
    }
    best = max(scores, key=lambda number: scores[number])
    return best, scores[best]


def without(cone: int, rgb: Array) -> Array:
    """What is left to a dichromat: brightness and the hue of the two other cones, (n, 2)."""
    lms = rgb @ LMS_FROM_RGB.T
    left, blue = lms[:, 1 - cone], lms[:, 2]
    return np.log(np.stack([left, blue / left], axis=1))


@pytest.mark.parametrize("index", range(1, len(PLATES) + 1))
def test_who_sees_all_colours_reads_every_number(index: int) -> None:
    number, clear = read(index, lab(shown(index))[:, 1:])
    assert number == PLATES[index - 1].number
    assert clear > 5


@pytest.mark.parametrize("index", HIDDEN)
def test_who_lacks_the_cone_has_nothing_to_read_by(index: int) -> None:
    cone = PLATES[index - 1].cone
    assert cone is not None
    assert distinctness(without(cone, shown(index)), dots(index).figure) < 0.3
    figure, ground = colours(cone)
    lms = LMS_FROM_RGB @ np.stack([figure, ground], axis=1)
    others = [kind for kind in range(3) if kind != cone]
    np.testing.assert_allclose(lms[others, 0], lms[others, 1], rtol=1e-12)


@pytest.mark.parametrize("index", HIDDEN)
def test_figure_and_ground_are_alike_by_another_model_of_a_dichromat(index: int) -> None:
    cone = PLATES[index - 1].cone
    assert cone is not None
    pair = np.stack(colours(cone))
    normal = float(np.linalg.norm(np.subtract(*lab(pair))))
    simulated = float(np.linalg.norm(np.subtract(*lab(pair @ MACHADO[cone].T))))
    assert normal > 25
    assert simulated < 2


def test_everybody_reads_the_first_plate() -> None:
    rgb = shown(1)
    for signals in (without(0, rgb), without(1, rgb), (rgb @ XYZ_FROM_RGB[1])[:, None]):
        number, clear = read(1, signals)
        assert (number, clear > 2) == (PLATES[0].number, True)


@pytest.mark.parametrize("index", HIDDEN)
def test_neither_brightness_nor_texture_gives_the_number_away(index: int) -> None:
    drawn = dots(index)
    luminance = shown(index) @ XYZ_FROM_RGB[1]
    brighter = np.mean(luminance[drawn.figure][:, None] > luminance[~drawn.figure])
    assert 0.3 < brighter < 0.7  # 0.5: a dot of the figure is as often the brighter one as the darker one
    assert distinctness(drawn.radii[:, None], drawn.figure) < 0.35
    centres, radii = packed(np.random.default_rng([1917, index]))
    np.testing.assert_array_equal(centres, drawn.centres)  # placed before anything is known of the number
    np.testing.assert_array_equal(radii, drawn.radii)


@pytest.mark.parametrize("index", range(1, len(PLATES) + 1))
def test_dots_lie_within_the_disc_apart_and_within_what_screens_show(index: int) -> None:
    drawn = dots(index)
    apart = np.hypot(*(drawn.centres[:, None] - drawn.centres).transpose(2, 0, 1)) - drawn.radii[:, None] - drawn.radii
    assert np.min(apart[~np.eye(len(apart), dtype=bool)]) > 0
    assert np.max(np.hypot(*drawn.centres.T) + drawn.radii) < RADIUS
    assert np.sum(drawn.figure) > 60
    if PLATES[index - 1].cone is not None:
        assert drawn.rgb.max() < 1  # nothing clipped: a clipped dot leaves its confusion line
    assert NOISE[0] > 0


def test_a_plate_is_the_same_at_every_call() -> None:
    assert svg.__wrapped__(2) == svg(2)
    np.testing.assert_array_equal(dots.__wrapped__(2).rgb, dots(2).rgb)
