"""The dense softening: against its integral done by quadrature, against the 5x5 table, and against what is drawn."""

import numpy as np
import pytest
from scipy.integrate import quad

from fakesss.accuracy.exact import Truth, exact_thickness
from fakesss.accuracy.exact_blur import CELLS, HALF_WIDTH, dense, finer, kernel
from fakesss.camera import View
from fakesss.renderer import Renderer
from fakesss.scene import Scene

STEP = 16  # cells
RANGE = 0.2  # sphere radii


def test_a_tap_for_each_step_is_the_published_table() -> None:
    """1 4 7 4 1 / 4 16 26 16 4 / 7 26 41 26 7 / ...: whole numbers, so half a unit of each is rounding."""
    weights = dense(STEP, STEP, RANGE).weights
    table = np.outer(weights, weights)
    published = np.array([[41, 26, 7], [26, 16, 4], [7, 4, 1]])
    np.testing.assert_allclose(41 * table[2:, 2:] / table[2, 2], published, atol=0.6)
    assert dense(STEP, STEP, RANGE).margin == 2 * STEP


@pytest.mark.parametrize("stride", [1, 2, 4])
def test_weights_are_the_gaussians_over_the_square(stride: int) -> None:
    filtering = dense(STEP, stride, RANGE)
    inside = quad(lambda u: np.exp(-u * u / 2) / np.sqrt(2 * np.pi), -HALF_WIDTH, HALF_WIDTH)[0]
    assert filtering.weights.sum() == pytest.approx(inside)
    assert filtering.weights == pytest.approx(filtering.weights[::-1])
    assert abs(filtering.margin - HALF_WIDTH * STEP) <= stride


def softened_by_quadrature(ridge: float, wavelength: float) -> float:
    """What the integral makes of depths `ridge` cos(2 pi u / wavelength) at u = 0; u in steps, depths in radii."""

    def off(u: float) -> float:
        return ridge * (np.cos(2 * np.pi * u / wavelength) - 1)

    def weight(u: float) -> float:
        return float(np.exp(-u * u / 2) * max(1 - abs(off(u)) / RANGE, 0))

    ends = (-HALF_WIDTH, HALF_WIDTH)
    above = quad(lambda u: weight(u) * off(u), *ends, limit=200)[0]
    return float(ridge + above / quad(weight, *ends, limit=200)[0])


@pytest.mark.parametrize("ridge", [0.01, 0.08, 0.3])
@pytest.mark.parametrize("wavelength", [2.0, 5.0])
def test_a_ridge_is_softened_as_the_integral_says(ridge: float, wavelength: float) -> None:
    """To the cells' width; the last ridge is so high that most of its slope is out of range."""
    expected = softened_by_quadrature(ridge, wavelength)
    errors = []
    for stride in (4, 2, 1):
        filtering = dense(STEP, stride, RANGE)
        x = np.arange(2 * filtering.margin + 1) - filtering.margin
        depths = np.tile(ridge * np.cos(2 * np.pi * x / STEP / wavelength), (len(x), 1))
        errors.append(abs(filtering(depths)[0, 0] - expected))
    assert errors[0] < 0.02 * ridge and errors[2] < 2e-3 * ridge


def test_planes_and_far_parts_and_holes_change_nothing() -> None:
    filtering = dense(STEP, 4, RANGE)
    side = 2 * filtering.margin + 9
    x = np.arange(side) - side // 2
    plane = np.tile(x / 400.0, (side, 1))
    middle = plane[filtering.margin : -filtering.margin, filtering.margin : -filtering.margin]
    np.testing.assert_allclose(filtering(plane), middle, atol=1e-6)
    step = np.where(np.tile(x, (side, 1)) > 2, 0.5, 0.1)  # farther apart than the range
    assert np.unique(filtering(step)).tolist() == pytest.approx([0.1, 0.5])
    holed = np.where(np.tile(x, (side, 1)) > 2, np.nan, 0.1)
    np.testing.assert_array_equal(np.isnan(filtering(holed))[0], x[filtering.margin : -filtering.margin] > 2)
    assert np.nanmax(np.abs(filtering(holed) - 0.1)) < 1e-6


def test_only_the_samples_asked_for_are_softened() -> None:
    filtering = dense(STEP, 4, RANGE)
    depths = np.random.default_rng(2).random((2 * filtering.margin + 15, 2 * filtering.margin + 10)) / 10
    np.testing.assert_array_equal(filtering(depths, 5), filtering(depths)[2::5, 2::5])


@pytest.mark.parametrize("width", [16, 100, 512, 4096])
def test_cells_are_fine_enough_whatever_the_resolution(width: int) -> None:
    scene = Scene(size=(width, width))
    view = View.of(scene.camera, scene.size)
    times = finer(scene, view, width)
    found = kernel(scene, view, (width * times, width * times))
    assert times % 2 == 1 and len(found.weights) >= 5 * CELLS
    step = view.in_picture(2 * scene.blur.step)[0] * width * times
    assert found.margin == pytest.approx(HALF_WIDTH * step, abs=found.stride)


def test_finer_depths_leave_the_samples_where_they_were() -> None:
    """In a picture so small that steps are far below a sample, what is seen is still seen through its centre."""
    truth, part = Truth(Scene(object="torus:1000", size=(20, 14)), 1), (slice(2, 12), slice(3, 18))
    sharp, soft = truth.seen(part, softened=False), truth.seen(part, softened=True)
    np.testing.assert_array_equal(sharp.hit, soft.hit)
    np.testing.assert_allclose(sharp.front, soft.front, atol=1e-7)
    np.testing.assert_allclose(sharp.points, soft.points, atol=1e-7)


@pytest.mark.gl
def test_drawn_softening_comes_nearer_the_integral_with_more_taps(renderer: Renderer) -> None:
    """On the same thickness, 4 x 4 samples a pixel: each kernel by half or more, from no blur to 9 x 9 taps."""
    scene = Scene(object="figure:4000", size=(96, 96)).replace({"blur.step": 1 / 128})
    exact, sharp = exact_thickness(scene, 4, softened=True), exact_thickness(scene, 4)
    covered, before = exact > 0, np.abs(sharp - exact)[exact > 0].mean()
    for taps in ("3x3", "5x5", "9x9"):
        drawing = scene.replace({"blur.kernel": taps})
        drawn = renderer.data(drawing, ("blurred_thickness",), samples=4)["blurred_thickness"]
        error = np.abs(drawn - exact)[covered].mean()
        assert error < 0.5 * before
        before = error
    assert before < 2e-4
