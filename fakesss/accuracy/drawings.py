"""How every figure of these pages looks, and how it becomes SVG and PNG: the look of the survey's report, no dates."""

import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

# Okabe & Ito (2008): told apart with every kind of colour vision, and in grey
BLUE, GREEN, VERMILION, PURPLE = "#0072B2", "#009E73", "#D55E00", "#CC79A7"
INK, FAINT, GRID = "#1d1d1f", "#8a8f98", "#eceef1"
STYLE: dict[Any, Any] = {
    "font.family": ["DejaVu Sans"],  # it comes with matplotlib, so that a figure looks the same everywhere
    "text.parse_math": False,  # a dollar in a name is a dollar
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.titlesize": 10,
    "axes.titleweight": "bold",
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "svg.hashsalt": "fakesss",
    "svg.fonttype": "path",
}
NO_DATE = {"Date": None, "Creator": None, "Format": None, "Type": None}
LEFT, RIGHT, BOTTOM, TOP, BETWEEN = 0.72, 0.12, 0.48, 0.34, 0.8  # inches around and between panels
WIDE = 8.0  # inches: a figure that a phone's screen cannot show whole


@dataclass(frozen=True)
class Drawing:
    """A figure as SVG text and PNG bytes, with its file stem, what it shows in words, and whether it is wide."""

    stem: str
    svg: str
    png: bytes
    caption: str
    wide: bool

    @property
    def inline(self) -> str:
        """The SVG to stand in a page with others: no prolog, ids no other figure has, a name for screen readers."""
        body = self.svg[self.svg.index("<svg") :]
        body = re.sub(r'(\bid="|url\(#|href="#)', rf"\1{self.stem}-", body)
        return re.sub(r"<svg\b", f'<svg role="img" aria-labelledby="caption-{self.stem}"', body, count=1)


@contextmanager
def styled() -> Iterator[None]:
    """The look, for the figures made inside."""
    with mpl.rc_context(STYLE):
        yield


def drawn(figure: Figure, stem: str, caption: str) -> Drawing:
    """The figure in both formats; call it inside `styled()`, which keeps ids inside the SVG the same."""
    svg, png = io.StringIO(), io.BytesIO()
    figure.savefig(svg, format="svg", metadata=NO_DATE)
    FigureCanvasAgg(figure).print_figure(png, format="png", dpi=200, metadata={"Software": None})
    return Drawing(stem, svg.getvalue(), png.getvalue(), caption, figure.get_figwidth() > WIDE)


def panel_row(count: int, panel: tuple[float, float]) -> tuple[Figure, list[Axes]]:
    """`count` panels of one size (inches) beside each other, in places that are final before anything is drawn."""
    width = LEFT + count * panel[0] + (count - 1) * BETWEEN + RIGHT
    height = BOTTOM + panel[1] + TOP
    figure = Figure(figsize=(width, height))
    lefts = [LEFT + number * (panel[0] + BETWEEN) for number in range(count)]
    shares = [(left / width, BOTTOM / height, panel[0] / width, panel[1] / height) for left in lefts]
    return figure, [figure.add_axes(share) for share in shares]
