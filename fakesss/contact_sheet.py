"""A sheet of labelled pictures, for looking at what passes wrote."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib import colormaps
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont
from scipy import ndimage

Bytes = NDArray[np.uint8]
Colour = tuple[int, int, int]
Size = tuple[int, int]  # width, height in pixels

SIDE = 320  # pixels of a panel's longer side
GAP = 20
CAPTION = 48  # height of the text under a panel
LEAST, PLOT = 40, 300  # height of a row of pictures, of one with plots
GROUND, EMPTY, INK, FAINT = (26, 26, 28), (42, 42, 45), (236, 236, 232), (158, 158, 156)
EXACT, SOFTENED, MARK, OTHER = (240, 240, 236), (255, 158, 74), (255, 70, 96), (64, 208, 224)
BAR = (88, 6)  # width and height of a colour scale
SWATCH = 9


@dataclass(frozen=True, eq=False)
class Mark:
    """Pixels (H, W) that a panel points out in one colour."""

    pixels: NDArray[np.bool_]
    colour: Colour
    label: str


@dataclass(frozen=True, eq=False)
class Panel:
    """One picture: 8-bit RGB (H, W, 3) as it is, or values (H, W) through a colour map between `limits`."""

    title: str
    values: NDArray[Any]
    covered: NDArray[np.bool_]  # (H, W); elsewhere the sheet's empty grey is shown
    note: str
    colours: str = ""  # a matplotlib colour map, for values
    limits: tuple[float, float] | None = None  # None: the covered values' own range
    marks: tuple[Mark, ...] = ()
    line: int | None = None  # a row of `values` to be marked

    def range(self) -> tuple[float, float]:
        """The values at the two ends of the colour map."""
        if self.limits:
            return self.limits
        if not self.covered.any():
            return 0.0, 1.0
        inside = self.values[self.covered]
        return float(inside.min()), float(inside.max())

    def pixels(self, least: float = 1) -> Bytes:
        """8-bit RGB (H, W, 3), sample by sample; marks are lines at least `least` samples wide."""
        pixels = self.values
        if self.colours:
            low, high = self.range()
            pixels = colour_mapped((self.values - low) / max(high - low, 1e-12), self.colours)
        shown = np.where(self.covered[..., None], pixels, np.array(EMPTY)).astype(np.uint8)
        for mark in self.marks:
            shown[thickened(mark.pixels, least)] = mark.colour
        return shown

    def picture(self) -> Image.Image:
        """The panel's picture with its longer side SIDE, in 8-bit sRGB."""
        height, width = self.values.shape[:2]
        scale = SIDE / max(height, width)
        kind = Image.Resampling.LANCZOS if scale < 1 else Image.Resampling.NEAREST
        size = max(1, round(width * scale)), max(1, round(height * scale))
        image = Image.fromarray(self.pixels(1 / scale)).resize(size, kind)
        if self.line is not None:
            dashed(image, round((self.line + 0.5) * scale))
        return image


@dataclass(frozen=True, eq=False)
class Plot:
    """A drawing of any size: `draw((width, height))` gives 8-bit RGB (height, width, 3)."""

    title: str
    draw: Callable[[Size], Bytes]
    note: str
    columns: int = 2  # of the sheet


def colour_mapped(shares: NDArray[Any], colours: str) -> Bytes:
    """8-bit RGB of values 0..1 through a named colour map."""
    mapped: Bytes = colormaps[colours](np.clip(shares, 0, 1), bytes=True)
    return mapped[..., :3]


def thickened(pixels: NDArray[np.bool_], width: float) -> NDArray[np.bool_]:
    """`pixels` (H, W) as lines of at least `width`, so that they survive being made smaller."""
    thick: NDArray[np.bool_] = ndimage.maximum_filter(pixels, size=max(1, round(width)))
    return thick


def dashed(image: Image.Image, row: int) -> None:
    """A dashed line across the picture."""
    draw = ImageDraw.Draw(image)
    for start in range(0, image.width, 10):
        draw.line((start, row, start + 4, row), INK)


@cache
def font(size: int, bold: bool = False) -> ImageFont.FreeTypeFont:
    """The sans-serif that matplotlib brings with it, so that a sheet looks the same everywhere."""
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name), size)


def layered(rows: list[Mapping[str, Panel | Plot]]) -> Image.Image:
    """All rows of panels and plots, each over its title, note and scale."""
    columns = max(sum(span(cell) for cell in row.values()) for row in rows)
    strips = [strip(list(row.values()), GAP + columns * (SIDE + GAP)) for row in rows]
    sheet = Image.new("RGB", (strips[0].width, GAP + sum(drawn.height for drawn in strips)), GROUND)
    y = GAP
    for drawn in strips:
        sheet.paste(drawn, (0, y))
        y += drawn.height
    return sheet


def strip(row: list[Panel | Plot], width: int) -> Image.Image:
    """One row of the sheet, as high as its highest picture asks for."""
    pictures = {number: cell.picture() for number, cell in enumerate(row) if isinstance(cell, Panel)}
    least = PLOT if len(pictures) < len(row) else LEAST
    height = max(least, *(picture.height for picture in pictures.values()))
    sheet = Image.new("RGB", (width, height + CAPTION + GAP), GROUND)
    draw = ImageDraw.Draw(sheet)
    x = GAP
    for number, cell in enumerate(row):
        wide = span(cell) * (SIDE + GAP) - GAP
        draw.rectangle((x, 0, x + wide - 1, height - 1), EMPTY)
        picture = Image.fromarray(cell.draw((wide, height))) if isinstance(cell, Plot) else pictures[number]
        sheet.paste(picture, (x + (wide - picture.width) // 2, (height - picture.height) // 2))
        caption(sheet, draw, cell, (x, height), wide)
        x += wide + GAP
    return sheet


def span(cell: Panel | Plot) -> int:
    """Columns that a cell takes."""
    return cell.columns if isinstance(cell, Plot) else 1


def caption(sheet: Image.Image, draw: ImageDraw.ImageDraw, cell: Panel | Plot, corner: Size, width: int) -> None:
    """Title and note under a cell; a panel's marks behind the title, its scale flush with the right edge."""
    x, y = corner
    draw.text((x, y + 9), cell.title, INK, font(14, bold=True))
    draw.text((x, y + 30), cell.note, FAINT, font(12))
    if isinstance(cell, Panel):
        legend(draw, cell.marks, x + round(draw.textlength(cell.title, font(14, bold=True))), y + 9)
        if cell.colours:
            scale(sheet, draw, cell, x + width, y + 12)


def legend(draw: ImageDraw.ImageDraw, marks: tuple[Mark, ...], left: int, top: int) -> None:
    """A swatch and a label for each mark, behind the title."""
    for mark in marks:
        draw.rectangle((left + 12, top + 4, left + 11 + SWATCH, top + 3 + SWATCH), mark.colour)
        draw.text((left + 16 + SWATCH, top + 1), mark.label, FAINT, font(12))
        left += 16 + SWATCH + round(draw.textlength(mark.label, font(12)))


def scale(sheet: Image.Image, draw: ImageDraw.ImageDraw, panel: Panel, right: int, top: int) -> None:
    """The colour map with the values at its ends, flush with the panel's right edge."""
    low, high = panel.range()
    ramp = colour_mapped(np.tile(np.linspace(0, 1, BAR[0]), (BAR[1], 1)), panel.colours)
    sheet.paste(Image.fromarray(ramp), (right - BAR[0], top))
    digits = 2 if high - low >= 0.1 else 4
    draw.text((right - BAR[0], top + BAR[1] + 5), f"{low:.{digits}f}", FAINT, font(11))
    draw.text((right, top + BAR[1] + 5), f"{high:.{digits}f}", FAINT, font(11), anchor="ra")
