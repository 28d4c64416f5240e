"""A sheet of labelled pictures, for looking at what passes wrote."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib import colormaps
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

SIDE = 360  # pixels of a panel's longer side
GAP = 18
CAPTION = 46  # height of the text under a panel
COLUMNS = 4
GROUND, EMPTY, INK, FAINT = (30, 30, 32), (46, 46, 49), (236, 236, 232), (158, 158, 156)
BAR = (96, 7)  # width and height of a colour scale


@dataclass(frozen=True, eq=False)
class Panel:
    """One picture: 8-bit RGB (H, W, 3) as it is, or values (H, W) through a colour map between `limits`."""

    title: str
    values: NDArray[Any]
    covered: NDArray[np.bool_]  # (H, W); elsewhere the sheet's empty grey is shown
    note: str
    colours: str = ""  # a matplotlib colour map, for values
    limits: tuple[float, float] | None = None  # None: the covered values' own range

    def range(self) -> tuple[float, float]:
        """The values at the two ends of the colour map."""
        if self.limits:
            return self.limits
        if not self.covered.any():
            return 0.0, 1.0
        inside = self.values[self.covered]
        return float(inside.min()), float(inside.max())

    def picture(self) -> Image.Image:
        """The panel's picture, no larger than SIDE, in 8-bit sRGB."""
        pixels = self.values
        if self.colours:
            low, high = self.range()
            pixels = colour_mapped((self.values - low) / max(high - low, 1e-12), self.colours)
        shown = np.where(self.covered[..., None], pixels, np.array(EMPTY)).astype(np.uint8)
        image = Image.fromarray(shown)
        scale = SIDE / max(image.size)
        kind = Image.Resampling.LANCZOS if scale < 1 else Image.Resampling.NEAREST
        return image.resize((max(1, round(image.width * scale)), max(1, round(image.height * scale))), kind)


def colour_mapped(shares: NDArray[Any], colours: str) -> NDArray[np.uint8]:
    """8-bit RGB of values 0..1 through a named colour map."""
    mapped: NDArray[np.uint8] = colormaps[colours](np.clip(shares, 0, 1), bytes=True)
    return mapped[..., :3]


@cache
def font(size: int, bold: bool = False) -> ImageFont.FreeTypeFont:
    """The sans-serif that matplotlib brings with it, so that a sheet looks the same everywhere."""
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name), size)


def layered(panels: list[Panel]) -> Image.Image:
    """All panels in rows of COLUMNS, each over its title, note and scale."""
    pictures = [panel.picture() for panel in panels]
    width, height = max(p.width for p in pictures), max(p.height for p in pictures)
    rows = -(-len(panels) // COLUMNS)
    columns = min(COLUMNS, len(panels))
    sheet = Image.new("RGB", (GAP + columns * (width + GAP), GAP + rows * (height + CAPTION + GAP)), GROUND)
    draw = ImageDraw.Draw(sheet)
    for index, (panel, picture) in enumerate(zip(panels, pictures, strict=True)):
        x = GAP + index % COLUMNS * (width + GAP)
        y = GAP + index // COLUMNS * (height + CAPTION + GAP)
        sheet.paste(picture, (x + (width - picture.width) // 2, y + (height - picture.height) // 2))
        draw.text((x, y + height + 8), panel.title, INK, font(15, bold=True))
        draw.text((x, y + height + 29), panel.note, FAINT, font(12))
        if panel.colours:
            scale(sheet, draw, panel, x + width, y + height + 12)
    return sheet


def scale(sheet: Image.Image, draw: ImageDraw.ImageDraw, panel: Panel, right: int, top: int) -> None:
    """The colour map with the values at its ends, flush with the panel's right edge."""
    low, high = panel.range()
    ramp = colour_mapped(np.tile(np.linspace(0, 1, BAR[0]), (BAR[1], 1)), panel.colours)
    sheet.paste(Image.fromarray(ramp), (right - BAR[0], top))
    draw.text((right - BAR[0], top + BAR[1] + 4), f"{low:.2f}", FAINT, font(11))
    draw.text((right, top + BAR[1] + 4), f"{high:.2f}", FAINT, font(11), anchor="ra")
