"""How every figure looks, and how it becomes SVG and PNG: one style, no dates inside, letters looked after."""

import base64
import hashlib
import io
import re
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
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
THUMBNAIL_IN_SVG = re.compile(
    r'(?P<head><g id="thumbnail-(?P<place>\d+)">\s*)<image [^>]*?'
    r'transform="scale\(1 -1\) translate\(0 (?P<moved>[-\d.]+)\)" x="(?P<x>[-\d.]+)" y="(?P<y>[-\d.]+)" '
    r'width="(?P<width>[\d.]+)" height="(?P<height>[\d.]+)"/>'
)
NO_DATE = {"Date": None, "Creator": None, "Format": None, "Type": None}


@dataclass(frozen=True)
class Drawing:
    """A figure as SVG text and PNG bytes, with its file stem, what it shows in words, letters no font here has, and
    the pictures of stimuli in it: key -> `data:` address."""

    stem: str
    svg: str
    png: bytes
    caption: str
    missing: str = ""
    pictures: Mapping[str, str] = field(default_factory=dict)

    @property
    def inline(self) -> str:
        """The SVG to stand in a page with others, which keeps the stimuli's pictures once for all of them: no prolog,
        ids no other figure has, a name for screen readers."""
        body = self.svg[self.svg.index("<svg") :]
        body = re.sub(r'<image id="picture-[^>]*>', "", body)
        body = re.sub(r'(\bid="|url\(#|href="#(?!picture-))', rf"\1{self.stem}-", body)
        return re.sub(r"<svg\b", f'<svg role="img" aria-labelledby="caption-{self.stem}"', body, count=1)


def place_thumbnail(axes: Axes, place: float, file: Path, side: float = 36, beside: bool = False) -> None:
    """The picture itself, `side` points wide, below its place on the horizontal axis, or beside it on the vertical."""
    box = OffsetImage(np.asarray(thumbnail(file)), zoom=side / THUMBNAIL)
    where = AnnotationBbox(
        box,
        (0, place) if beside else (place, 0),
        xybox=(-4, 0) if beside else (0, -4),
        xycoords=("axes fraction", "data") if beside else ("data", "axes fraction"),
        boxcoords="offset points",
        box_alignment=(1, 0.5) if beside else (0.5, 1),
        frameon=False,
        pad=0,
        annotation_clip=False,
    )
    axes.add_artist(where)


def thumbnail(file: Path, side: int = THUMBNAIL) -> Image.Image:
    """The picture cut square about its centre and reduced to `side` pixels; decoded once, until its file changes."""
    found = file.stat()
    return reduced(file, side, found.st_mtime_ns, found.st_size)


@lru_cache(maxsize=256)
def reduced(file: Path, side: int, changed: int, size: int) -> Image.Image:
    """The thumbnail of a file that `changed` (nanoseconds) and `size` (bytes) tell from what stood there before."""
    with Image.open(file) as picture:
        colour = picture.convert("RGB")
    edge = min(colour.size)
    left, top = (colour.width - edge) // 2, (colour.height - edge) // 2
    return colour.crop((left, top, left + edge, top + edge)).resize((side, side), Image.Resampling.LANCZOS)


def data_uri(picture: Image.Image) -> str:
    """The picture as a `data:` address, so that the page needs no other file."""
    stream = io.BytesIO()
    picture.save(stream, "JPEG", quality=88, optimize=True)
    return "data:image/jpeg;base64," + base64.b64encode(stream.getvalue()).decode()


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
    keys, pictures = named_pictures(figure)
    svg, png = io.StringIO(), io.BytesIO()
    with warnings.catch_warnings(record=True) as caught:
        warnings.filterwarnings("always", message=r"Glyph \d+")
        lay_out(figure)
        figure.savefig(svg, format="svg", metadata=NO_DATE)
        FigureCanvasAgg(figure).print_figure(png, format="png", dpi=200, metadata={"Software": None})
    codes = {int(code) for each in caught for code in re.findall(r"^Glyph (\d+)", str(each.message))}
    text = with_pictures_once(svg.getvalue(), keys, pictures)
    return Drawing(stem, text, png.getvalue(), caption, "".join(map(chr, sorted(codes))), pictures)


def lay_out(figure: Figure) -> None:
    """Places what is in the figure for good: matplotlib would do so again, and draw all twice, for each format."""
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine(None)


def named_pictures(figure: Figure) -> tuple[list[str], dict[str, str]]:
    """Marks every thumbnail placed in `figure`; the key of each in turn, and key -> `data:` address."""
    keys: list[str] = []
    pictures: dict[str, str] = {}
    placed = (artist for axes in figure.axes for artist in axes.artists if isinstance(artist, AnnotationBbox))
    for place, box in enumerate(placed):
        assert isinstance(box.offsetbox, OffsetImage)
        pixels = np.asarray(box.offsetbox.get_data())
        key = hashlib.sha256(pixels.tobytes()).hexdigest()[:12]
        box.set_gid(f"thumbnail-{place}")
        keys.append(key)
        if key not in pictures:
            pictures[key] = data_uri(Image.fromarray(pixels))
    return keys, pictures


def with_pictures_once(svg: str, keys: Sequence[str], pictures: Mapping[str, str]) -> str:
    """matplotlib writes each thumbnail anew and at 72 pixels an inch; here each is kept once, and sharp."""

    def use(found: re.Match[str]) -> str:
        x, y, width, height, moved = (float(found[name]) for name in ("x", "y", "width", "height", "moved"))
        top = -(y + moved + height)  # it stands upside down there, and is mirrored
        where = f"translate({x:g} {top:g}) scale({width:g} {height:g})"
        return f'{found["head"]}<use xlink:href="#picture-{keys[int(found["place"])]}" transform="{where}"/>'

    text = THUMBNAIL_IN_SVG.sub(use, svg)
    kept = "".join(
        f'<image id="picture-{key}" width="1" height="1" xlink:href="{uri}"/>' for key, uri in pictures.items()
    )
    return text.replace("<defs>", f"<defs>{kept}", 1) if kept else text


def letters_missing(drawings: Sequence[Drawing]) -> list[str]:
    """The sentence on letters that stand as boxes in the figures, if there are any."""
    letters = "".join(dict.fromkeys("".join(drawing.missing for drawing in drawings)))
    mend = "install one that does (Noto Sans CJK for Chinese, Japanese and Korean) and report again"
    return [f"No font on this machine has the letters {letters} of the figures: {mend}."] if letters else []
