"""Combinations of all knobs: time against error, the front that nothing beats, and the presets on it."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from fakesss.accuracy.drawings import BLUE, VERMILION, Drawing, drawn, panel_row, styled
from fakesss.accuracy.drawings_axes import just_noticeable, label_points, logarithmic, on_scale
from fakesss.accuracy.errors import JUST_NOTICEABLE
from fakesss.accuracy.page_curves import Point, band_name

PANEL = 3.6, 2.9  # inches
METRICS = {"flip": "FLIP, mean", "flip_everywhere": "FLIP in 99.9 % of the pixels"}


def front_drawing(points: Sequence[Point], best: Sequence[int]) -> Drawing:
    """Mean FLIP and FLIP nearly everywhere against time; `best` are the places of what nothing beats."""
    metrics = [name for name in METRICS if all(getattr(point, name) is not None for point in points)]
    with styled():
        figure, panels = panel_row(len(metrics), PANEL)
        for axes, metric in zip(panels, metrics, strict=True):
            front_panel(axes, points, best, metric)
            axes.set(xlabel="time of a picture, ms", ylabel=METRICS[metric])
        return drawn(figure, "figure-combinations", caption_of(points, metrics))


def front_panel(axes: Axes, points: Sequence[Point], best: Sequence[int], metric: str) -> None:
    """One error against time: a step line along the front, presets as named diamonds."""
    x, no_time = on_scale([point.cost for point in points])
    y, no_error = on_scale([getattr(point, metric) for point in points])
    bands = [edge for point in points for edge in (point.low, point.high) if edge]
    logarithmic(axes, "x", np.append(x, bands), no_time)
    has_level = metric == "flip_everywhere"
    logarithmic(axes, "y", np.append(y, [JUST_NOTICEABLE] if has_level else []), no_error)
    if has_level:
        just_noticeable(axes)
    lowest = list(np.minimum.accumulate(y[list(best)]))
    axes.step(x[list(best)], lowest, where="post", color=BLUE, linewidth=1.3, zorder=3)
    for point, px, py in zip(points, x, y, strict=True):
        colour = VERMILION if point.text else BLUE
        if point.low and point.high:
            axes.plot([point.low, point.high], [py, py], color=colour, linewidth=1, alpha=0.6, zorder=3)
        axes.plot(px, py, "D" if point.text else "o", color=colour, markersize=7 if point.text else 4, zorder=5)
    label_points(axes, x, y, [point.text for point in points], [True] * len(points))


def caption_of(points: Sequence[Point], metrics: Sequence[str]) -> str:
    """What is drawn, in words."""
    named = [point.text for point in points if point.text]
    sentences = [
        "Combinations of all knobs: FLIP against the exact picture, over the time of a picture, both axes logarithmic; "
        f"horizontal bars are each time’s {band_name(points)}. The line steps along what nothing measured beats in "
        "time and mean FLIP."
    ]
    if named:
        sentences.append(f"Diamonds are the presets: {', '.join(named)}.")
    if "flip_everywhere" in metrics:
        sentences.append(
            "On the right the line goes along the same combinations, at the least that any of them reached so far. The "
            f"dashed line is a just noticeable difference of lightness, {JUST_NOTICEABLE:.3f}; the preset survey keeps "
            "below it from the preset reference’s picture, not from the exact one that is plotted here."
        )
    if any(getattr(point, metric) == 0 for point in points for metric in metrics):
        sentences.append("What has no error at all stands on the dotted line: a logarithmic axis has no zero.")
    return " ".join(sentences)
