"""Draws every hard case: `python tests/hard_cases/draw.py FOLDER` writes one PNG each.

Without FOLDER only the sheet of all of them is drawn again, docs/images/hard-cases.png.
"""

import sys
import tempfile
from pathlib import Path

from catalogue import GROUPS
from hard_case import Case
from PIL import Image, ImageDraw, ImageFont
from tqdm import tqdm

from fakesss.colour import to_8bit
from fakesss.renderer import shared_renderer

SHEET = Path(__file__).parents[2] / "docs" / "images" / "hard-cases.png"
TILE, GAP, CAPTION, COLUMNS = 112, 8, 17, 9
PAPER, INK, EMPTY = (255, 255, 255), (40, 40, 40), (225, 225, 225)


def picture(case: Case, folder: Path) -> Image.Image:
    """The case as the renderer's PNG shows it."""
    return Image.fromarray(to_8bit(shared_renderer().render(case.scene(folder)).image[..., :3]))


def tile(drawn: Image.Image) -> Image.Image:
    """The picture as large as a tile allows, none of its pixels lost to nothing, on grey."""
    scale = TILE / max(drawn.size)
    size = [max(1, round(side * scale)) for side in drawn.size]
    kind = Image.Resampling.LANCZOS if scale < 1 else Image.Resampling.NEAREST
    page = Image.new("RGB", (TILE, TILE), EMPTY)
    page.paste(drawn.resize((size[0], size[1]), kind), ((TILE - size[0]) // 2, (TILE - size[1]) // 2))
    return page


def sheet(groups: dict[str, dict[str, Image.Image]]) -> Image.Image:
    """Tiles over their names, each group under its title."""
    rows = sum(-(-len(pictures) // COLUMNS) for pictures in groups.values())
    height = rows * (TILE + CAPTION + GAP) + len(groups) * (CAPTION + 2 * GAP)
    page = Image.new("RGB", (COLUMNS * (TILE + GAP) + GAP, height + GAP), PAPER)
    pen, title, small = ImageDraw.Draw(page), ImageFont.load_default(16), ImageFont.load_default(10)
    y = GAP
    for name, pictures in groups.items():
        pen.text((GAP, y), name, INK, title)
        y += CAPTION + GAP
        for place, (caption, drawn) in enumerate(pictures.items()):
            x = GAP + place % COLUMNS * (TILE + GAP)
            page.paste(tile(drawn), (x, y))
            pen.text((x, y + TILE + 2), caption, INK, small)
            if place % COLUMNS == COLUMNS - 1 or place == len(pictures) - 1:
                y += TILE + CAPTION + GAP
        y += GAP
    return page


def main() -> None:
    groups: dict[str, dict[str, Image.Image]] = {}
    with tempfile.TemporaryDirectory() as meshes:
        for title, cases in tqdm(GROUPS.items(), disable=None):
            drawn = {case.name: picture(case, Path(meshes)) for case in cases if not case.refused}
            groups |= {title: drawn} if drawn else {}
    if len(sys.argv) == 1:
        sheet(groups).quantize(255, dither=Image.Dither.NONE).save(SHEET, optimize=True)
        return
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, image in [pair for pictures in groups.values() for pair in pictures.items()]:
        image.save(folder / f"{name}.png")


if __name__ == "__main__":
    main()
