"""The dense softening: against its integral done by quadrature, against the 5x5 table, and against what is drawn."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.stats import truncnorm

from fakesss.accuracy.exact import Truth, exact_thickness
from fakesss.accuracy.exact_blur import CELLS, HALF_WIDTH, Kernel, dense, finer, kernel
from fakesss.camera import View
from fakesss.problem import BadInput
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.softening import VARIANCE

STEP = 16  # cells
RANGE = 0.2  # sphere radii


def inner(filtering: Kernel, depths: NDArray[Any]) -> NDArray[Any]:
    """All that can be softened of a grid of depths."""
    height, width = (side - 2 * filtering.margin for side in depths.shape)
    rows, columns = (side.ravel() + filtering.margin for side in np.mgrid[:height, :width])
    return filtering(depths, rows, columns).reshape(height, width)


def test_a_tap_for_each_step_is_the_published_table() -> None:
    """1 4 7 4 1 / 4 16 26 16 4 / 7 26 41 26 7 / ...: whole numbers, so half a unit of each is rounding."""
    weights = dense(STEP, STEP, RANGE).weights
    table = np.outer(weights, weights)
    published = np.array([[41, 26, 7], [26, 16, 4], [7, 4, 1]])
    np.testing.assert_allclose(41 * table[2:, 2:] / table[2, 2], published, atol=0.6)
    assert dense(STEP, STEP, RANGE).margin == 2 * STEP


@pytest.mark.parametrize("stride", [1, 2, 4, STEP])
def test_it_is_as_wide_as_every_kernel(stride: int) -> None:
    """The knob's kernels and the exact picture tend to one limit: their taps have one variance."""
    filtering = dense(STEP, stride, RANGE)
    places = (np.arange(len(filtering.weights)) - len(filtering.weights) // 2) * stride / STEP
    found = (filtering.weights * places**2).sum() / filtering.weights.sum()
    assert found == pytest.approx(VARIANCE, rel=1e-9)
    assert filtering.weights == pytest.approx(filtering.weights[::-1])
    assert abs(filtering.margin - HALF_WIDTH * STEP) <= stride


def cut_gaussian() -> float:
    """Deviation of the Gaussian that has the kernels' variance when cut at `HALF_WIDTH`, by scipy's own moments."""
    found = brentq(lambda d: truncnorm(-HALF_WIDTH / d, HALF_WIDTH / d, scale=d).var() - VARIANCE, 0.8, 2)
    return float(found)


def softened_by_quadrature(ridge: float, wavelength: float) -> float:
    """What the integral makes of depths `ridge` cos(2 pi u / wavelength) at u = 0; u in steps, depths in radii."""
    deviation = cut_gaussian()

    def off(u: float) -> float:
        return ridge * (np.cos(2 * np.pi * u / wavelength) - 1)

    def weight(u: float) -> float:
        return float(np.exp(-((u / deviation) ** 2) / 2) * max(1 - abs(off(u)) / RANGE, 0))

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
        errors.append(abs(inner(filtering, depths)[0, 0] - expected))
    assert errors[0] < 0.02 * ridge and errors[2] < 2e-3 * ridge


def test_planes_and_far_parts_and_holes_change_nothing() -> None:
    filtering = dense(STEP, 4, RANGE)
    side = 2 * filtering.margin + 9
    x = np.arange(side) - side // 2
    plane = np.tile(x / 400.0, (side, 1))
    middle = plane[filtering.margin : -filtering.margin, filtering.margin : -filtering.margin]
    np.testing.assert_allclose(inner(filtering, plane), middle, atol=1e-6)
    step = np.where(np.tile(x, (side, 1)) > 2, 0.5, 0.1)  # farther apart than the range
    assert np.unique(inner(filtering, step)).tolist() == pytest.approx([0.1, 0.5])
    holed = np.where(np.tile(x, (side, 1)) > 2, np.nan, 0.1)
    np.testing.assert_array_equal(np.isnan(inner(filtering, holed))[0], x[filtering.margin : -filtering.margin] > 2)
    assert np.nanmax(np.abs(inner(filtering, holed) - 0.1)) < 1e-6


def test_only_the_cells_asked_for_are_softened() -> None:
    filtering = dense(STEP, 4, RANGE)
    depths = np.random.default_rng(2).random((2 * filtering.margin + 15, 2 * filtering.margin + 10)) / 10
    places = np.array([3, 11, 0]), np.array([9, 0, 4])
    some = filtering(depths, *(place + filtering.margin for place in places))
    np.testing.assert_array_equal(some, inner(filtering, depths)[places])


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


@pytest.mark.parametrize("changes", [{"blur.step": 1e-6}, {"camera.distance": 9000.0}], ids=str)
def test_a_step_far_below_a_pixel_softens_nothing(changes: dict[str, float]) -> None:
    """Rather than asking for terabytes of cells."""
    scene = Scene(object="figure:2000", size=(32, 32)).replace(changes)
    part = slice(0, 32), slice(0, 32)
    truth = Truth(scene, 8)
    soft, sharp = truth.seen(part, softened=True), truth.seen(part, softened=False)
    np.testing.assert_array_equal(soft.second, sharp.second)


def test_a_step_too_wide_to_look_at_is_one_sentence() -> None:
    scene = Scene(object="torus:1000", size=(2048, 2048)).replace({"blur.step": 0.25})
    middle = slice(1000, 1002)
    with pytest.raises(BadInput, match=r"^blur.step: 0.25 sphere diameters take \d+ x \d+ rays .* smaller step or a"):
        Truth(scene, 8).seen((middle, slice(1500, 1502)), softened=True)


@pytest.mark.gl
def test_drawn_softening_comes_nearer_the_integral_with_more_taps(renderer: Renderer) -> None:
    """On the same thickness, 4 x 4 samples a pixel: each kernel by 2/5 or more, from no blur to 9 x 9."""
    scene = Scene(object="figure:4000", size=(96, 96)).replace({"blur.step": 1 / 128})
    exact, sharp = exact_thickness(scene, 4, softened=True), exact_thickness(scene, 4)
    covered, before = exact > 0, np.abs(sharp - exact)[exact > 0].mean()
    for taps in ("3x3", "5x5", "9x9"):
        drawing = scene.replace({"blur.kernel": taps})
        drawn = renderer.data(drawing, ("blurred_thickness",), samples=4)["blurred_thickness"]
        error = np.abs(drawn - exact)[covered].mean()
        print(taps, error)
        assert error < 0.6 * before
        before = error
    assert before < 2e-4
