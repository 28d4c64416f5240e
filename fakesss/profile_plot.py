"""Thickness along one row of the picture, drawn as curves."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from fakesss.contact_sheet import EMPTY, EXACT, FAINT, INK, MARK, SOFTENED

Float = NDArray[np.float64]
DPI = 100
SMALLEST = 120  # pixels a side that margins and labels are made for
TYPE = {"fontsize": 8, "color": "#{:02x}{:02x}{:02x}".format(*FAINT)}


@dataclass(frozen=True, eq=False)
class Profile:
    """Thickness along a row: all (W,), lengths in sphere diameters, NaN where nothing is covered."""

    across: Float  # position from the picture's middle, as seen at the sphere's centre
    exact: Float
    softened: Float
    edges: Sequence[float]  # positions of hard edges


def profile_plot(profile: Profile, size: tuple[int, int]) -> NDArray[np.uint8]:
    """8-bit RGB (height, width, 3) of `size` (width, height): both thicknesses, and where the exact one jumps."""
    figure = Figure(figsize=(size[0] / DPI, size[1] / DPI), dpi=DPI, facecolor=rgb(EMPTY))
    canvas: Any = FigureCanvasAgg(figure)  # matplotlib leaves its methods untyped
    across, down = (min(1 / side, 1 / SMALLEST) for side in size)  # of a pixel; margins of a small plot shrink with it
    axes = figure.add_axes((52 * across, 42 * down, 1 - 66 * across, 1 - 56 * down), facecolor=rgb(EMPTY))
    for edge in profile.edges:
        axes.axvline(edge, color=rgb(MARK), linewidth=1, alpha=0.8)
    axes.fill_between(profile.across, profile.exact, color=rgb(EXACT), alpha=0.16, linewidth=0)
    axes.plot(profile.across, profile.softened, color=rgb(SOFTENED), linewidth=2.4, alpha=0.9, label="softened")
    axes.plot(profile.across, profile.exact, color=rgb(EXACT), linewidth=1.1, label="exact")
    fit(axes, profile)
    styled(axes)
    pixels, (width, height) = canvas.print_to_buffer()
    return np.frombuffer(pixels, np.uint8).reshape(height, width, 4)[..., :3]


def fit(axes: Any, profile: Profile) -> None:
    """Limits around what is covered; a note where nothing is."""
    covered = np.isfinite(profile.exact)
    if not covered.any():
        axes.set(xlim=(-0.5, 0.5), ylim=(0, 1))
        axes.text(0.5, 0.5, "nothing on this line", transform=axes.transAxes, ha="center", **TYPE)
        return
    inside = profile.across[covered]
    margin = max(0.03 * np.ptp(inside), 1e-3)
    axes.set_xlim(inside.min() - margin, inside.max() + margin)
    axes.set_ylim(0, max(1.2 * float(np.nanmax([profile.exact, profile.softened])), 1e-3))


def styled(axes: Any) -> None:
    """The sheet's look: no frame, faint grid, small labels with units."""
    axes.spines[:].set_visible(False)
    axes.grid(color=rgb(INK), alpha=0.09, linewidth=0.8)
    axes.tick_params(colors=rgb(FAINT), labelsize=8, length=0)
    axes.set_xlabel("across the picture, sphere diameters", **TYPE)
    axes.set_ylabel("sphere diameters", **TYPE)
    key = axes.legend(loc="upper right", ncols=2, labelcolor=rgb(INK), fontsize=8, handlelength=1.4)
    key.get_frame().set(facecolor=rgb(EMPTY), edgecolor="none")


def rgb(colour: tuple[int, int, int]) -> tuple[float, float, float]:
    """A sheet's 8-bit colour as matplotlib takes it."""
    return (colour[0] / 255, colour[1] / 255, colour[2] / 255)
