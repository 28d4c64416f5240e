"""What both pages are made of: templates, tables, scales of colour, and the files that a page comes with."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape

from fakesss.accuracy.drawings import Drawing
from fakesss.accuracy.drawings_maps import FLIP, SIGNED, Thumbnail, mapped
from fakesss.accuracy.page_numbers import rounded
from fakesss.output import make_folder, write_atomically

TEMPLATES = Environment(
    loader=PackageLoader("fakesss.accuracy"), autoescape=select_autoescape(), undefined=StrictUndefined,
    trim_blocks=True, lstrip_blocks=True,
)  # fmt: skip
RAMP = 96, 8  # pixels of a scale of colour
DATA = (".csv", ".json", ".toml")


@dataclass(frozen=True)
class Table:
    """A table of the page: cells as text; the first `text_columns` are words; `chosen` is the row that stands out."""

    anchor: str
    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    text_columns: int = 1
    chosen: int | None = None
    note: str = ""


@dataclass(frozen=True)
class Scale:
    """What the colours of a map mean: their ramp, and the values at its ends."""

    name: str
    image: Thumbnail
    low: str
    high: str
    note: str


def signed_scale(reference: str) -> Scale:
    """Of the maps of differences from `reference`, whose magnification is said with each of them."""
    image = mapped(np.tile(np.linspace(-1, 1, RAMP[0]), (RAMP[1], 1)), SIGNED, -1.0)
    return Scale(
        "Difference", image, "darker", "brighter",
        f"than the {reference}, in linear luminance; the ends of the scale are −1 and 1 divided by the magnification",
    )  # fmt: skip


def flip_scale(most: float) -> Scale:
    """Of FLIP maps from 0 to `most`."""
    image = mapped(np.tile(np.linspace(0, 1, RAMP[0]), (RAMP[1], 1)), FLIP, 0.0)
    return Scale("FLIP", image, "0", rounded(most), "what an eye may see that changes between the two by turns")


def write_files(folder: Path, template: str, drawings: Sequence[Drawing], context: Mapping[str, Any]) -> Path:
    """`folder`/index.html from a template, and every drawing as figures/*.svg and *.png; the page's path.

    The page links to the data files that stand in the folder already. Raises `BadInput` where it cannot be written.
    """
    make_folder(folder / "figures")
    for drawing in drawings:
        write_atomically(folder / "figures" / f"{drawing.stem}.svg", drawing.svg.encode())
        write_atomically(folder / "figures" / f"{drawing.stem}.png", drawing.png)
    files = sorted(path.name for path in folder.iterdir() if path.suffix in DATA)
    page = folder / "index.html"
    write_atomically(page, TEMPLATES.get_template(template).render(files=files, **context).encode())
    return page
