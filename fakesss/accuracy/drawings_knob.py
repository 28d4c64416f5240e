"""The curve of one knob: error against time, and error against the knob's own number with the fitted order."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, FuncFormatter

from fakesss.accuracy.drawings import BLUE, GREEN, INK, VERMILION, Drawing, drawn, panel_row, styled
from fakesss.accuracy.drawings_axes import Float, just_noticeable, label_points, logarithmic, on_scale
from fakesss.accuracy.errors import JUST_NOTICEABLE
from fakesss.accuracy.page_curves import Curve, Point, band_name

PANEL = 2.55, 2.5  # inches
NUMBERS = 6
"""Labels that fit under a panel."""
METRICS = {"flip": "FLIP", "rmse": "RMSE, linear radiance"}
TIMES = {"ms": "time of a picture, ms", "s": "baking, s"}


def knob_drawing(curve: Curve, stem: str, order: Mapping[str, Any] | None) -> Drawing:
    """FLIP and RMSE against time; where an order was fitted, RMSE against the knob's number too."""
    panels = 3 if order and len(positive(curve)) > 1 else 2
    with styled():
        figure, axes = panel_row(panels, PANEL)
        for place, (metric, name) in zip(axes, METRICS.items(), strict=False):
            time_panel(place, curve, metric)
            place.set(title=name.split(",")[0], xlabel=TIMES[curve.unit], ylabel=name)
        if order and panels == 3:
            order_panel(axes[2], curve, float(order["fitted"]))
        return drawn(figure, stem, caption_of(curve, panels == 3))


def time_panel(axes: Axes, curve: Curve, metric: str) -> None:
    """One error against time; numbers joined by a line within its band, kinds for themselves."""
    points = curve.points
    also = everywhere(points) if metric == "flip" else []
    x, no_time = on_scale([point.cost for point in points])
    y, no_error = on_scale([*(getattr(point, metric) for point in points), *also])
    bands = [edge for point in points for edge in (point.low, point.high) if edge]
    logarithmic(axes, "x", np.append(x, bands), no_time)
    logarithmic(axes, "y", np.append(y, [JUST_NOTICEABLE] if also else []), no_error)
    join(axes, curve, metric)
    if also:
        just_noticeable(axes)
        axes.plot(x, y[len(points) :], "o", color=BLUE, markersize=4, markerfacecolor="white", zorder=4)
    for point, px, py in zip(points, x, y, strict=False):
        mark(axes, point, (px, py), point.text == curve.recommended)
    chosen = [point.text == curve.recommended for point in points]
    texts = [label_of(point, curve) for point in points]
    label_points(axes, np.resize(x, len(y)), y, texts, chosen)


def everywhere(points: Sequence[Point]) -> list[float]:
    """FLIP that nearly no pixel exceeds, of each point; nothing where it was not measured of all."""
    found = [point.flip_everywhere for point in points]
    return [value for value in found if value is not None] if None not in found else []


def join(axes: Axes, curve: Curve, metric: str) -> None:
    """The line through the numbered points, in the order of their numbers, and its band; none to a zero."""
    some = [point for point in curve.numbered if getattr(point, metric) > 0 and point.cost > 0]
    error = [getattr(point, metric) for point in some]
    axes.plot([point.cost for point in some], error, color=BLUE, linewidth=1.4, zorder=3)
    banded = [point for point in some if point.low and point.high]
    if len(banded) == len(some) > 1:
        across = [point.low for point in banded] + [point.high for point in reversed(banded)]
        axes.fill(across, error + error[::-1], color=BLUE, alpha=0.16, linewidth=0, zorder=2)


def mark(axes: Axes, point: Point, place: tuple[float, float], recommended: bool) -> None:
    """A point and its own band; a diamond for the recommended one, a square for a kind."""
    colour = VERMILION if recommended else BLUE if point.number is not None else GREEN
    if point.low and point.high:
        axes.plot([point.low, point.high], [place[1]] * 2, color=colour, linewidth=1, alpha=0.7, zorder=4)
    shape = "D" if recommended else "o" if point.number is not None else "s"
    axes.plot(*place, shape, color=colour, markersize=7 if recommended else 5, zorder=5)


def label_of(point: Point, curve: Curve) -> str:
    """Its value; whether it is the reference."""
    return f"{point.text} (reference)" if point.text == curve.reference else point.text


def positive(curve: Curve) -> list[Point]:
    """Numbered points that have an error."""
    return [point for point in curve.numbered if point.rmse > 0 and (point.number or 0) > 0]


def order_panel(axes: Axes, curve: Curve, fitted: float) -> None:
    """RMSE against the knob's number, with the line of the fitted order through the points' middle."""
    points = positive(curve)
    x: Float = np.array([point.number for point in points], float)
    y: Float = np.array([point.rmse for point in points])
    logarithmic(axes, "x", x, None)
    logarithmic(axes, "y", y, None)
    axes.xaxis.set_major_locator(FixedLocator(list(x[:: -(-len(x) // NUMBERS)])))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
    middle = np.exp(np.log(x).mean()), np.exp(np.log(y).mean())
    axes.plot(x, middle[1] * (x / middle[0]) ** -fitted, color=INK, linewidth=1.1, linestyle=(0, (5, 2)), zorder=2)
    axes.plot(x, y, "o", color=BLUE, markersize=5, zorder=4)
    axes.set(title="Convergence", xlabel=curve.name, ylabel=METRICS["rmse"])
    axes.text(0.97, 0.95, f"fitted order {fitted:.2f}", transform=axes.transAxes, ha="right", va="top", fontsize=8)


def caption_of(curve: Curve, has_order: bool) -> str:
    """What is drawn, in words."""
    errors = [value for point in curve.points for value in (point.flip, point.rmse)]
    sentences = [
        f"Error of {curve.name} against {'what baking it costs' if curve.baked else 'the time of a picture'}, both "
        "axes logarithmic; below and to the left is better."
    ]
    if any(point.low for point in curve.points):
        sentences.append(f"Shaded and barred is each time’s {band_name(curve.points)}.")
    if curve.recommended:
        sentences.append(f"The diamond is the recommended value, {curve.recommended}.")
    if everywhere(curve.points):
        sentences.append(
            "Filled: the mean of FLIP; hollow: what it does not exceed in 99.9 % of the pixels, to be held against the "
            f"dashed line of a just noticeable difference, {JUST_NOTICEABLE:.3f}."
        )
    if any(point.number is None for point in curve.points):
        sentences.append("Squares are kinds, which have no order, so no line joins them.")
    if 0 in errors:
        sentences.append(
            "A logarithmic axis has no zero: values without any error stand on the dotted line at its edge."
        )
    if has_order:
        sentences.append("On the right the dashed line falls with the fitted order.")
    return " ".join(sentences)
