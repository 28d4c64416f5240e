"""Figures and thumbnails of the pages on accuracy: what is drawn where, said with numbers."""

import base64
import io
import re

import numpy as np
import pytest
from matplotlib.axes import Axes
from numpy.typing import NDArray
from PIL import Image
from tradeoff_document import small

from fakesss.accuracy.drawings import panel_row
from fakesss.accuracy.drawings_axes import box_of, label_points, logarithmic, on_scale, overlap, strays
from fakesss.accuracy.drawings_knob import knob_drawing, order_panel, time_panel
from fakesss.accuracy.drawings_maps import (
    SIDE,
    Thumbnail,
    difference_thumbnail,
    flip_thumbnail,
    frame_of,
    picture_thumbnail,
    scale_end,
)  # fmt: skip
from fakesss.accuracy.page_curves import Curve, curve_of
from fakesss.accuracy.page_numbers import duration, power_of_two, rounded
from fakesss.colour import to_8bit

pytestmark = pytest.mark.gl


@pytest.fixture(scope="module")
def curves() -> dict[str, Curve]:
    """One of numbers, one of kinds."""
    numbers, kinds = (curve_of(knob) for knob in small()[0]["knobs"])
    return {"numbers": numbers, "kinds": kinds}


def empty_axes() -> Axes:
    return panel_row(1, (2.5, 2.5))[1][0]


def pixels(thumbnail: Thumbnail) -> NDArray[np.uint8]:
    """(height, width, 3)."""
    content = base64.b64decode(thumbnail.uri.removeprefix("data:image/png;base64,"))
    with Image.open(io.BytesIO(content)) as image:
        assert image.size == (thumbnail.width, thumbnail.height)
        return np.asarray(image.convert("RGB"))


def even(*rgb: float, side: int = 8) -> NDArray[np.float32]:
    """A picture of one colour that covers everything."""
    return np.tile(np.array([*rgb, 1.0], np.float32), (side, side, 1))


@pytest.mark.parametrize(
    ("number", "text"),
    [(0, "0"), (0.012345, "0.0123"), (12.34, "12.3"), (1234.4, "1,230"), (-2.5, "−2.5"), (1e-5, "10⁻⁵"),
     (2.345e-4, "2.35 × 10⁻⁴"), (0.9996, "1"), (99999.9, "10⁵"), (3, "3")],
)  # fmt: skip
def test_numbers_have_three_digits(number: float, text: str) -> None:
    assert rounded(number) == text


@pytest.mark.parametrize(
    ("seconds", "text"), [(3.2e-6, "3.2 µs"), (0.0204, "20.4 ms"), (4.5, "4.5 s"), (2400, "40 min"), (9000, "2.5 h")]
)
def test_times_have_the_unit_a_person_takes(seconds: float, text: str) -> None:
    assert duration(seconds) == text


def test_a_power_of_two_is_written_out() -> None:
    assert [power_of_two(gain) for gain in (0, 5, 11)] == ["×1", "×32 (2⁵)", "×2,048 (2¹¹)"]


def test_zero_stands_at_the_edge_of_a_logarithmic_axis() -> None:
    places, zero = on_scale([0.5, 0.0, 2.0])
    assert zero == 0.125 and places.tolist() == [0.5, 0.125, 2.0]
    assert on_scale([0.5, 2.0])[1] is None
    axes = empty_axes()
    logarithmic(axes, "y", places, zero)
    low, high = axes.get_ylim()
    assert low < zero and high > 2
    ticks = sorted(axes.get_yticks())
    assert ticks[0] == zero and ticks[1] > 2 * zero, "a number beside the place of zero would be read as its value"
    axes.figure.draw_without_rendering()
    assert axes.get_yticklabels()[0].get_text() == "0"


def test_an_axis_of_nearly_equal_values_has_two_numbers() -> None:
    axes = empty_axes()
    logarithmic(axes, "x", np.array([10.0, 10.1]), None)
    low, high = axes.get_xlim()
    assert sum(low <= tick <= high for tick in axes.get_xticks()) >= 2


def test_labels_lie_on_no_other_and_on_no_point() -> None:
    x, y = np.array([1.0, 1.01, 1.02, 5.0]), np.array([1.0, 1.01, 0.99, 0.2])
    axes = empty_axes()
    logarithmic(axes, "x", x, None)
    logarithmic(axes, "y", y, None)
    label_points(axes, x, y, ["first", "second", "third", "far"], [False] * 4)
    points = axes.transData.transform(np.column_stack([x, y])) * 72 / axes.figure.dpi
    boxes = [box_of(points[k], *axes.texts[k].xyann, axes.texts[k].get_text()) for k in range(4)]
    pairs = [(one, other) for k, one in enumerate(boxes) for other in boxes[:k]]
    assert sum(overlap(*pair) for pair in pairs) == 0
    assert sum(overlap(box, (px - 3, py - 3, px + 3, py + 3)) for box in boxes for px, py in points) == 0


def test_a_label_is_nearest_to_its_own_point() -> None:
    x, y = np.array([1.0, 1.3]), np.array([1.0, 1.0])
    axes = empty_axes()
    logarithmic(axes, "x", x, None)
    logarithmic(axes, "y", y, None)
    label_points(axes, x, y, ["left", "right (reference)"], [False] * 2)
    points = axes.transData.transform(np.column_stack([x, y])) * 72 / axes.figure.dpi
    for number, text in enumerate(axes.texts):
        assert not strays(
            box_of(points[number], *text.xyann, text.get_text()), points[number], points[1 - number :][:1]
        )


def joined(axes: Axes) -> list[int]:
    """How many points each line of a panel joins, bands and single points left out."""
    return [len(line.get_xdata()) for line in axes.lines if line.get_linestyle() == "-" and line.get_marker() == "None"
            and line.get_linewidth() > 1]  # fmt: skip


def shapes(axes: Axes) -> list[str]:
    """The markers that are filled."""
    return [str(line.get_marker()) for line in axes.lines
            if line.get_marker() != "None" and line.get_markerfacecolor() != "white"]  # fmt: skip


@pytest.mark.parametrize("metric", ["flip", "rmse"])
def test_numbers_are_joined_within_their_band_and_kinds_are_not(metric: str, curves: dict[str, Curve]) -> None:
    axes = empty_axes()
    time_panel(axes, curves["numbers"], metric)
    assert joined(axes) == [4], "all but the reference, which has no error to be joined to"
    assert shapes(axes) == ["o", "o", "D", "o", "o"]
    (band,) = axes.patches
    assert {x for x, _ in band.get_path().vertices} >= {0.95 * 4.0, 1.06 * 4.0, 0.95 * 16.0, 1.06 * 16.0}
    axes = empty_axes()
    time_panel(axes, curves["kinds"], metric)
    assert joined(axes) in ([], [0]) and shapes(axes) == ["s", "D"] and len(axes.patches) == 0


def test_labels_are_values_and_name_the_reference(curves: dict[str, Curve]) -> None:
    axes = empty_axes()
    time_panel(axes, curves["numbers"], "rmse")
    said = [text.get_text() for text in axes.texts]
    assert said == ["1", "2", "3", "4", "8 (reference)"]
    assert [text.get_text() for text in axes.texts if text.get_fontweight() == "bold"] == ["3"]


def test_the_fitted_order_is_the_slope_of_the_dashed_line(curves: dict[str, Curve]) -> None:
    axes = empty_axes()
    order_panel(axes, curves["numbers"], 1.5)
    (dashed,) = (line for line in axes.lines if line.get_marker() == "None")
    x, y = np.log(np.array(dashed.get_data(), float))
    assert np.polyfit(x, y, 1)[0] == pytest.approx(-1.5)
    assert len(x) == 4


@pytest.mark.parametrize("kind", ["numbers", "kinds"])
def test_a_figure_is_the_same_bytes_each_time_and_has_no_date(kind: str, curves: dict[str, Curve]) -> None:
    order = {"fitted": 1.0} if kind == "numbers" else None
    first, second = (knob_drawing(curves[kind], "figure-one", order) for _ in range(2))
    assert first == second
    assert "<dc:date>" not in first.svg and b"Software" not in first.png
    assert "no zero" in first.caption and ("kinds" in first.caption) == (kind == "kinds")


def test_figures_in_one_page_share_no_id(curves: dict[str, Curve]) -> None:
    one, other = (knob_drawing(curves["numbers"], stem, None).inline for stem in ("figure-one", "figure-other"))
    found = [re.findall(r'\bid="([^"]+)"', text) for text in (one, other)]
    assert found[0] and not set(found[0]) & set(found[1])
    used = re.findall(r'(?:href="#|url\(#)([^")]+)', one)
    assert used and set(used) <= set(found[0])


def test_a_thumbnail_shows_the_object_and_little_else() -> None:
    picture = np.zeros((100, 200, 4), np.float32)
    picture[20:70, 110:160] = 1.0
    rows, columns = frame_of(picture)
    assert (rows.start, rows.stop, columns.start, columns.stop) == (18, 72, 108, 162)
    assert frame_of(np.zeros((4, 6, 4), np.float32)) == (slice(0, 4), slice(0, 6))


def test_a_thumbnail_is_small_and_means_light_not_code_values() -> None:
    stripes = np.zeros((2 * SIDE, 2 * SIDE, 4), np.float32)
    stripes[..., ::2, :] = 1.0
    shown = picture_thumbnail(stripes, frame_of(stripes))
    assert (shown.width, shown.height) == (SIDE, SIDE)
    assert set(np.unique(pixels(shown)[:, :-1])) == {int(to_8bit(np.array(0.5)))}
    small_one = even(0.2, 0.4, 0.8)
    shown = picture_thumbnail(small_one, frame_of(small_one))
    assert np.array_equal(pixels(shown), to_8bit(small_one[..., :3]))


def test_brighter_is_red_darker_is_blue_and_equal_is_neither() -> None:
    reference = even(0.5, 0.5, 0.5)
    picture = reference.copy()
    picture[:4] += 1 / 64
    picture[4:6] -= 1 / 64
    shown, gain = difference_thumbnail(picture, reference, frame_of(reference))
    assert gain == 6
    red, blue, neither = (pixels(shown)[row, 0].astype(int) for row in (0, 4, 7))
    assert red[0] > red[2] + 50 and blue[2] > blue[0] + 50 and np.ptp(neither) < 4
    shown, gain = difference_thumbnail(reference, reference, frame_of(reference))
    assert gain is None and len(np.unique(pixels(shown).reshape(-1, 3), axis=0)) == 1


def test_the_magnification_is_the_largest_that_nothing_exceeds() -> None:
    for size, gain in ((0.9, 0), (0.3, 1), (0.03, 5), (0.001, 9)):
        picture, reference = even(size, size, size), even(0, 0, 0)
        assert difference_thumbnail(picture, reference, frame_of(reference))[1] == gain
    assert difference_thumbnail(even(5, 5, 5), even(0, 0, 0), frame_of(even(0, 0, 0)))[1] == 0


def test_flip_maps_run_from_black_to_pale_on_a_power_of_two() -> None:
    assert [scale_end(value) for value in (0.0, 0.03, 0.25, 0.6, 1.0)] == [1.0, 0.03125, 0.25, 1.0, 1.0]
    values = np.array([[0.0, 0.25], [0.125, 0.5]], np.float32)
    shown = pixels(flip_thumbnail(values, 0.25, frame_of(even(1, 1, 1, side=2)))).astype(int).sum(axis=2)
    assert shown[0, 0] < 10 and shown[0, 0] < shown[1, 0] < shown[0, 1] == shown[1, 1]
