"""How every figure looks, and how it becomes SVG and PNG: one style, no dates inside, letters looked after."""

import base64
import io
import re
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import font_manager
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.offsetbox import AnnotationBbox, OffsetImage
from PIL import Image

# Okabe & Ito (2008): told apart with every kind of colour vision, and in grey
COLOURS = ("#0072B2", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#E69F00")
INK, FAINT = "#1d1d1f", "#8a8f98"
THUMBNAIL = 112
# DejaVu comes with matplotlib; of the others those that are installed fill its gaps (asking for more makes it complain)
CJK = ("Noto Sans CJK SC", "Noto Sans CJK JP", "Noto Sans SC", "Source Han Sans SC", "WenQuanYi Zen Hei", "PingFang SC",
       "Hiragino Sans", "Apple SD Gothic Neo", "Microsoft YaHei", "Yu Gothic", "Malgun Gothic", "Unifont")  # fmt: skip
INSTALLED = {font.name for font in font_manager.fontManager.ttflist}
STYLE: dict[Any, Any] = {
    "font.family": ["DejaVu Sans", *(name for name in CJK if name in INSTALLED)],
    "text.parse_math": False,  # a dollar in a name is a dollar
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.titlesize": 10,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "svg.hashsalt": "fakesss",
    "svg.fonttype": "path",
}
NO_DATE = {"Date": None, "Creator": None, "Format": None, "Type": None}


@dataclass(frozen=True)
class Drawing:
    """A figure as SVG text and PNG bytes, with its file stem, what it shows in words, and letters no font here has."""

    stem: str
    svg: str
    png: bytes
    caption: str
    missing: str = ""

    @property
    def inline(self) -> str:
        """The SVG to stand in a page with others: no prolog, ids no other figure has, a name for screen readers."""
        body = self.svg[self.svg.index("<svg") :]
        body = re.sub(r' id="image[^"]*"', "", body)  # named by content: one picture in two places would share it
        body = re.sub(r'(\bid="|url\(#|href="#)', rf"\1{self.stem}-", body)
        return re.sub(r"<svg\b", f'<svg role="img" aria-labelledby="caption-{self.stem}"', body, count=1)


def place_thumbnail(axes: Axes, place: float, file: Path) -> None:
    """The picture itself below its place on the axis."""
    box = OffsetImage(np.asarray(thumbnail(file)), zoom=36 / THUMBNAIL)
    axes.add_artist(
        AnnotationBbox(
            box,
            (place, 0),
            xybox=(0, -4),
            xycoords=("data", "axes fraction"),
            boxcoords="offset points",
            box_alignment=(0.5, 1),
            frameon=False,
            pad=0,
            annotation_clip=False,
        )
    )


def thumbnail(file: Path, side: int = THUMBNAIL) -> Image.Image:
    """The picture cut square about its centre and reduced to `side` pixels."""
    with Image.open(file) as picture:
        colour = picture.convert("RGB")
    edge = min(colour.size)
    left, top = (colour.width - edge) // 2, (colour.height - edge) // 2
    return colour.crop((left, top, left + edge, top + edge)).resize((side, side), Image.Resampling.LANCZOS)


def thumbnail_uri(file: Path) -> str:
    """The reduced picture as a `data:` address, so that the page needs no other file."""
    stream = io.BytesIO()
    thumbnail(file, 192).save(stream, "PNG", optimize=True)
    return "data:image/png;base64," + base64.b64encode(stream.getvalue()).decode()


def folded(text: str, width: int = 14) -> str:
    """Words on lines of about `width` letters."""
    lines = [""]
    for word in text.split():
        if lines[-1] and len(lines[-1]) + len(word) + 1 > width:
            lines.append(word)
        else:
            lines[-1] = f"{lines[-1]} {word}".strip()
    return "\n".join(lines)


def drawn(figure: Figure, stem: str, caption: str) -> Drawing:
    """The figure in both formats; no dates inside, so equal data give equal bytes."""
    svg, png = io.StringIO(), io.BytesIO()
    with warnings.catch_warnings(record=True) as caught:
        warnings.filterwarnings("always", message=r"Glyph \d+")
        figure.savefig(svg, format="svg", metadata=NO_DATE)
        FigureCanvasAgg(figure).print_figure(png, format="png", dpi=200, metadata={"Software": None})
    codes = {int(code) for each in caught for code in re.findall(r"^Glyph (\d+)", str(each.message))}
    return Drawing(stem, svg.getvalue(), png.getvalue(), caption, "".join(map(chr, sorted(codes))))


def letters_missing(drawings: Sequence[Drawing]) -> list[str]:
    """The sentence on letters that stand as boxes in the figures, if there are any."""
    letters = "".join(dict.fromkeys("".join(drawing.missing for drawing in drawings)))
    mend = "install one that does (Noto Sans CJK for Chinese, Japanese and Korean) and report again"
    return [f"No font on this machine has the letters {letters} of the figures: {mend}."] if letters else []
