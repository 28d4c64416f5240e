"""The figures of `fakesss fit`: profiles of luminance, times beside the path tracer's, starts, what is left."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import PercentFormatter
from numpy.typing import NDArray

from fakesss.accuracy.drawings import (
    BLUE,
    FAINT,
    GREEN,
    GRID,
    INK,
    PURPLE,
    VERMILION,
    Drawing,
    drawn,
    panel_row,
    styled,
)
from fakesss.accuracy.drawings_axes import label_points, logarithmic, on_scale
from fakesss.accuracy.page_numbers import rounded
from fakesss.colour import luminance

CURVES: dict[str, dict[str, Any]] = {
    "target": {"color": INK, "linewidth": 2.2, "alpha": 0.85},
    "fitted": {"color": VERMILION, "linewidth": 1.4},
    "start": {"color": BLUE, "linewidth": 1.1, "linestyle": (0, (4, 2))},
}
KINDS = {"first-interval": BLUE, "bridged": GREEN, "total-path": VERMILION, "local": PURPLE}
ROW = 0.15  # inches of a start
STEPS = {"thickness": "thickness, sphere diameters", "n_dot_l": "N·L, cosine to the main light"}


def profile_drawing(pictures: Mapping[str, NDArray[Any]]) -> Drawing:
    """Luminance of target, fitted and starting picture along the row and the column that cross most of the object."""
    covered = pictures["target"][..., 3] > 0
    row, column = int(covered.sum(axis=1).argmax()), int(covered.sum(axis=0).argmax())
    shown = {name: luminance(picture[..., :3]) for name, picture in pictures.items()}
    with styled():
        figure, (across, down) = panel_row(2, (3.5, 2.5))
        for name, style in CURVES.items():
            across.plot(shown[name][row], label=name, **style)
            down.plot(shown[name][:, column], label=name, **style)
        across.set(title=f"Row {row + 1}", xlabel="column, pixels from the left", ylabel="luminance, linear")
        down.set(title=f"Column {column + 1}", xlabel="row, pixels from the top", ylabel="luminance, linear")
        for axes in (across, down):
            quiet(axes)
        across.legend(frameon=False, fontsize=8)
        caption = (
            f"Linear luminance along row {row + 1} of {covered.shape[0]} and column {column + 1} of "
            f"{covered.shape[1]}, those that cross most of the object. The target is as noisy as it was traced."
        )
        return drawn(figure, "figure-profiles", caption)


def quiet(axes: Axes) -> None:
    """A faint grid, an axis from 0."""
    axes.grid(color=GRID, linewidth=0.8, zorder=0)
    axes.set_axisbelow(True)
    axes.tick_params(length=0)
    axes.set_ylim(bottom=0)


def time_drawing(document: Mapping[str, Any]) -> Drawing:
    """FLIP from the target against time: path tracing with ever more samples, and the fitted shader."""
    curve = document["matched"]["curve"]
    seconds = [*(rung["seconds"] for rung in curve), document["seconds"]["shader"]]
    flip = [*(rung["flip"] for rung in curve), document["flip"]]
    noise = document["noise"]["flip"]
    with styled():
        figure, (axes,) = panel_row(1, (4.6, 2.7))
        x, y = on_scale(seconds)[0], on_scale(flip)[0]
        logarithmic(axes, "x", x, None)
        logarithmic(axes, "y", np.append(y, [noise] if noise > 0 else []), None)
        if noise > 0:
            axes.axhline(noise, color=FAINT, linewidth=1, linestyle=(0, (5, 3)))
            place = axes.get_yaxis_transform()
            axes.text(0.99, noise, "the target’s own noise", transform=place, ha="right", va="bottom", fontsize=7.5)
        axes.plot(x[:-1], y[:-1], "o-", color=BLUE, linewidth=1.4, markersize=5, zorder=4)
        axes.plot(x[-1], y[-1], "D", color=VERMILION, markersize=7, zorder=5)
        axes.set(xlabel="time of a picture, s", ylabel="FLIP from the target, mean")
        names = [*(f"{rung['samples']} samples" for rung in curve), "fitted shader"]
        label_points(axes, x, y, names, [False] * len(curve) + [True])
        caption = (
            "FLIP from the target over the time of a picture, both axes logarithmic: the fitted shader (diamond), and "
            "path tracing with other random numbers and so many samples a pixel (circles). Two path-traced pictures as "
            "noisy as the target lie at the dashed line."
        )
        return drawn(figure, "figure-times", caption)


def starts_drawing(starts: Sequence[Mapping[str, Any]]) -> Drawing:
    """From which exponent each start set out, where it ended, and how near to the target."""
    rows = np.arange(len(starts))[::-1]
    with styled():
        figure, (exponents, errors) = panel_row(2, (3.5, 0.5 + ROW * len(starts)))
        both = [[each[end]["thickness_exponent"] for each in starts] for end in ("start", "ended")]
        logarithmic(exponents, "x", np.array(both).ravel(), None)
        for row, each, before, after in zip(rows, starts, *both, strict=True):
            colour = KINDS[each["thickness"]]
            exponents.plot([before, after], [row, row], color=colour, linewidth=1, zorder=3)
            exponents.plot(before, row, "o", color=colour, markerfacecolor="white", markersize=4.5, zorder=4)
            exponents.plot(after, row, "o", color=colour, markersize=4.5, zorder=5)
            errors.plot(each["rmse"], row, "o" if each["converged"] else "x", color=colour, markersize=4.5)
        for axes in (exponents, errors):
            axes.set(yticks=[], ylim=(-1, len(starts)))
            axes.grid(axis="x", color=GRID, linewidth=0.8)
            axes.tick_params(length=0)
            axes.set_axisbelow(True)
        exponents.set(xlabel="exponent r, from hollow to filled")
        errors.set(xlabel="RMSE at the end, linear radiance")
        kinds = dict.fromkeys(each["thickness"] for each in starts)
        handles = [Line2D([], [], color=KINDS[kind], marker="o", linewidth=1, label=kind) for kind in kinds]
        figure.legend(handles=handles, frameon=False, fontsize=8, ncols=len(handles), loc="upper left")
        caption = (
            f"All {len(starts)} starts, a row each: the exponent r that it set out from (hollow) and came to (filled), "
            "and the error that was left. Starts of one kind of thickness that end at one place found the same minimum."
        )
        return drawn(figure, "figure-starts", caption)


def leftover_drawing(leftover: Mapping[str, Sequence[Mapping[str, Any]]]) -> Drawing:
    """Shares of the pixels and of the squared error by thickness and by how the surface faces the light."""
    with styled():
        figure, panels = panel_row(2, (3.5, 2.2))
        for axes, (name, bins) in zip(panels, leftover.items(), strict=True):
            places = np.arange(len(bins))
            axes.bar(places - 0.2, [each["pixels"] for each in bins], 0.4, color=FAINT, label="of the pixels")
            shares = [each["share"] or 0.0 for each in bins]
            axes.bar(places + 0.2, shares, 0.4, color=VERMILION, label="of the squared error")
            axes.set_xticks(places, [f"{rounded(each['from'])} to {rounded(each['to'])}" for each in bins], fontsize=8)
            axes.set(xlabel=STEPS[name], ylabel="share")
            axes.yaxis.set_major_formatter(PercentFormatter(1.0))
            axes.grid(axis="y", color=GRID, linewidth=0.8)
            axes.set_axisbelow(True)
            axes.tick_params(length=0)
        panels[0].legend(frameon=False, fontsize=8)
        caption = (
            "Where the fitted picture still differs: of the squared error beyond the target’s noise, the share in each "
            "stretch of thickness and of N·L (negative: turned away from the light), beside its share of the pixels."
        )
        return drawn(figure, "figure-leftover", caption)
