"""Every intermediate of a picture as something to look at while the scene is changed: docs/views.md, one at a time.

The picture's own size and place, nothing drawn over the data: what colours mean is said in words and handed over as a
legend, which the page draws beside it.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple, TypedDict

import numpy as np
from matplotlib import colormaps
from numpy.typing import NDArray
from PIL import Image

from fakesss.contact_sheet import EXACT, MARK, OTHER, SOFTENED, Colour, Panel, Plot, Size
from fakesss.scene import Scene
from fakesss.views import KINDS, landscape, profile, view

Bytes = NDArray[np.uint8]

PICTURE = "picture"
LOOKS: Mapping[str, str] = {PICTURE: "picture", **{name: kind.title for name, kind in KINDS.items() if name != PICTURE}}
"""Titles of all that can be looked at, by name: the picture first."""

DRAWINGS = frozenset(name for name, kind in KINDS.items() if kind.make in (landscape, profile))
"""Those that are not seen through the scene's camera: nothing of the scene can be laid over them."""

ONE_SAMPLE = frozenset(name for name, kind in KINDS.items() if kind.reads)
"""Those with one sample a pixel, however many the picture has."""

LETTERED = {"profile": 400}
"""Pixels of the shorter side that a drawing's letters need: they are as large while it moves as when it rests."""

STOPS = 33  # of a legend's colour scale; with straight lines between them colours are right to 6/255
ENDS = {  # of a colour map, in words
    "cividis_r": ("yellow", "dark blue"),
    "magma_r": ("pale", "black"),
    "gray_r": ("white", "black"),
    "gray": ("black", "white"),
    "viridis": ("violet", "yellow"),
    "berlin": ("light blue", "pink"),
}
NAMED: Mapping[Colour, str] = {MARK: "red", OTHER: "cyan", EXACT: "white", SOFTENED: "orange"}
CURVES = ((EXACT, "exact"), (SOFTENED, "softened"), (MARK, "hard edge"))  # of the profile


class Scale(TypedDict):
    """A colour scale: `colours` at equal steps from `low` to `high`."""

    colours: list[str]  # "#rrggbb"
    low: str
    high: str


class Key(TypedDict):
    """What one colour stands for."""

    colour: str
    label: str


class Legend(TypedDict):
    """What the colours of a look mean."""

    title: str
    scale: Scale | None
    marks: list[Key]


class Look(NamedTuple):
    """What is shown: 8-bit sRGB, a sentence that says all that the legend shows, and the legend."""

    pixels: Bytes  # (H, W, 3)
    note: str
    legend: Legend


def look(scene: Scene, name: str) -> Look:
    """The view called `name` at the scene's size.

    Draws with this thread's `shared_renderer`. Raises `BadInput` for what a user can mend.
    """
    seen = view(scene.replace({"alpha": False}) if scene.alpha else scene, name)
    if isinstance(seen, Plot):
        return Look(drawing(seen, scene.size, LETTERED.get(name, 1)), *plot_words(name, seen))
    return Look(seen.pixels(), panel_words(seen), legend(seen))


def drawing(plot: Plot, size: Size, least: int) -> Bytes:
    """A plot at `size`, made smaller from one whose shorter side has `least` pixels."""
    factor = max(1.0, least / min(size))
    drawn = plot.draw((round(size[0] * factor), round(size[1] * factor)))
    return drawn if factor == 1 else np.asarray(Image.fromarray(drawn).resize(size, Image.Resampling.BOX))


def plot_words(name: str, plot: Plot) -> tuple[str, Legend]:
    """Of a plot its note and its legend."""
    if name == "relief":
        return f"{plot.title}, {plot.note}", {"title": plot.title, "scale": None, "marks": []}
    marks: list[Key] = [{"colour": web(colour), "label": label} for colour, label in CURVES]
    named = ", ".join(f"{NAMED[colour]}: {label}" for colour, label in CURVES)
    note = f"{plot.title} along the picture's middle row; {named}"
    return note, {"title": plot.title, "scale": None, "marks": marks}


def panel_words(panel: Panel) -> str:
    """A panel's title, its note and what its colours stand for: all that the legend shows, for who cannot see it."""
    words = f"{panel.title}: {panel.note}"
    if panel.colours:
        low, high = ends(panel)
        at_low, at_high = ENDS[panel.colours]
        words += f"; {low} is {at_low}, {high} {at_high}"
    return "; ".join([words, *(f"{NAMED[mark.colour]}: {mark.label}" for mark in panel.marks)])


def legend(panel: Panel) -> Legend:
    """The colours of a panel."""
    scale: Scale | None = None
    if panel.colours:
        low, high = ends(panel)
        colours = colormaps[panel.colours](np.linspace(0, 1, STOPS), bytes=True)
        scale = {"colours": [web(colour) for colour in colours], "low": low, "high": high}
    marks: list[Key] = [{"colour": web(mark.colour), "label": mark.label} for mark in panel.marks]
    return {"title": f"{panel.title}: {panel.note}", "scale": scale, "marks": marks}


def ends(panel: Panel) -> tuple[str, str]:
    """The values at the ends of a panel's colours, with as many digits as tell them apart."""
    low, high = panel.range()
    digits = 2 if high - low >= 0.1 else 4
    return f"{low:.{digits}f}", f"{high:.{digits}f}"


def web(colour: Any) -> str:
    """`#rrggbb` of the first three numbers 0..255."""
    return "#" + "".join(f"{int(channel):02x}" for channel in colour[:3])
