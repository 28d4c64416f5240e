"""Logarithmic axes in plain numbers, zeros at their edge, and labels of points that do not lie on one another."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullLocator
from numpy.typing import NDArray

from fakesss.accuracy.drawings import FAINT, GRID, INK
from fakesss.accuracy.errors import JUST_NOTICEABLE
from fakesss.accuracy.page_numbers import rounded

Float = NDArray[np.float64]
Box = tuple[float, float, float, float]  # left, bottom, right, top in points

MARGIN = 1.6
"""Room beyond the outermost values, as a ratio."""
LEAST_SPAN = 6.0
"""An axis covers at least this ratio: less has no two round numbers to be labelled."""
DECADES = 2
"""An axis longer than this is labelled at powers of ten only, a shorter one at 1, 2 and 5."""
EDGE = 4.0
"""Zero stands this factor below the least number that is not."""
NO_NUMBER = 1e-6
"""Where zero stands if there is nothing else."""
SIZE = 7.5  # points, of a label
LETTER, LINE = 0.62, 1.3  # of a label's width and height, in sizes of its font
STRAY = 20.0
"""Square points of overlap that a label rather has than a place where it seems to be another point's."""
AROUND = ((5, 4), (-5, 4), (5, -4), (-5, -4), (0, 7), (0, -7), (8, 0), (-8, 0), (9, 12), (-9, 12), (9, -12), (-9, -12))
"""Where a label may stand, in points from its point."""


def on_scale(values: Sequence[float]) -> tuple[Float, float | None]:
    """`values` (>= 0) as places on a logarithmic axis, and where zero stands on it if one of them is zero."""
    places = np.array(values, np.float64)
    positive = places[places > 0]
    if len(positive) == len(places):
        return places, None
    edge = float(positive.min()) / EDGE if len(positive) else NO_NUMBER
    places[places <= 0] = edge
    return places, edge


def logarithmic(axes: Axes, which: str, places: Float, zero: float | None) -> None:
    """A logarithmic axis ("x" or "y") that holds `places`; a dotted line marks where zero was put."""
    low, high = float(places.min()) / MARGIN, float(places.max()) * MARGIN
    spread = max(1.0, LEAST_SPAN * low / high) ** 0.5
    low, high = low / spread, high * spread
    axis = axes.xaxis if which == "x" else axes.yaxis
    axes.set(**{f"{which}scale": "log", f"{which}lim": (low, high)})
    steps = LogLocator(subs=(1.0,) if high / low > 10**DECADES else (1.0, 2.0, 5.0)).tick_values(low, high)
    # a number at or below zero's own place would be read as that number
    ticks = list(steps) if zero is None else [zero, *(step for step in steps if step > 2 * zero)]
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_major_formatter(FuncFormatter(lambda value, _: "0" if value == zero else rounded(value)))
    axis.set_minor_locator(NullLocator())
    axis.grid(color=GRID, linewidth=0.8, zorder=0)
    axes.set_axisbelow(True)
    axes.tick_params(which="both", length=0)
    if zero is not None:
        line = axes.axvline if which == "x" else axes.axhline
        line(zero, color=FAINT, linewidth=0.9, linestyle=(0, (1, 2)), zorder=1)


def just_noticeable(axes: Axes) -> None:
    """The level below which a difference of lightness is not noticed."""
    axes.axhline(JUST_NOTICEABLE, color=FAINT, linewidth=1, linestyle=(0, (5, 3)), zorder=1)
    axes.text(
        0.99, JUST_NOTICEABLE, "just noticeable", transform=axes.get_yaxis_transform(), ha="right", va="bottom",
        fontsize=SIZE,
    )  # fmt: skip


def label_points(axes: Axes, x: Float, y: Float, texts: Sequence[str], bold: Sequence[bool]) -> None:
    """Each text beside its point, where it hides the least of the other labels and points; points beyond the texts
    have none, and are only not to be hidden.

    The axes' limits and its place in the figure must be final: places are compared in points.
    """
    dpi = axes.figure.dpi
    points = axes.transData.transform(np.column_stack([x, y])) * 72 / dpi
    corners = axes.get_window_extent()
    left, bottom, right, top = (each * 72 / dpi for each in corners.extents)
    frame = left, bottom, right, top
    taken: list[Box] = [(px - 3, py - 3, px + 3, py + 3) for px, py in points]
    for number, text in enumerate(texts):
        own = points[number]
        choices = [(dx, dy, box_of(own, dx, dy, text)) for dx, dy in AROUND]
        others = [box for place, box in enumerate(taken) if place != number]
        far = np.delete(points, number, axis=0)
        costs = [hidden(box, others, frame) + STRAY * strays(box, own, far) for _, _, box in choices]
        dx, dy, box = choices[int(np.argmin(costs))]
        taken.append(box)
        axes.annotate(
            text, (x[number], y[number]), xytext=(dx, dy), textcoords="offset points", fontsize=SIZE, color=INK,
            ha="left" if dx > 0 else "right" if dx < 0 else "center",
            va="bottom" if dy > 0 else "top" if dy < 0 else "center",
            fontweight="bold" if bold[number] else "normal", annotation_clip=False, zorder=6,
        )  # fmt: skip


def box_of(point: Float, dx: float, dy: float, text: str) -> Box:
    """What a label covers, in points."""
    width, height = LETTER * SIZE * len(text), LINE * SIZE
    left = point[0] + dx - (0 if dx > 0 else width if dx < 0 else width / 2)
    bottom = point[1] + dy - (0 if dy > 0 else height if dy < 0 else height / 2)
    return left, bottom, left + width, bottom + height


def hidden(box: Box, others: Sequence[Box], frame: Box) -> float:
    """Square points of `others` that lie under `box`, and what of it lies outside the axes."""
    outside = (box[2] - box[0]) * (box[3] - box[1]) - overlap(box, frame)
    return outside + sum(overlap(box, other) for other in others)


def strays(box: Box, own: Float, far: Float) -> bool:
    """Whether a label's middle is nearer to one of the points `far` (N, 2) than to its own."""
    middle = np.array([box[0] + box[2], box[1] + box[3]]) / 2
    return bool((np.linalg.norm(far - middle, axis=1) < np.linalg.norm(own - middle)).any())


def overlap(a: Box, b: Box) -> float:
    """Square points that two boxes share."""
    width, height = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
    return max(0.0, width) * max(0.0, height)
