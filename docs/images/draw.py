"""Draws the pictures of the documentation again: `python docs/images/draw.py`."""

import subprocess
import tempfile
from pathlib import Path
from typing import Any

from PIL import Image, ImageDraw, ImageFont

from analysis.pdf import sandbox
from fakesss.browser import find_browser
from fakesss.cli_analysis import report_folder
from fakesss.colour import to_8bit
from fakesss.graph_drawing import draw_graph
from fakesss.inspect import compiled, contact_sheet
from fakesss.renderer import render
from fakesss.scene import Scene
from fakesss.shapes import names
from stimuli.build import build
from stimuli.template import write_template
from study_server.app import admin_secret
from study_server.manifest import load_study
from study_server.serve import served
from study_server.simulation.simulate import simulate

HERE = Path(__file__).parent
INK, PAPER = (40, 40, 40), (255, 255, 255)
GAP, CAPTION = 8, 30


def sheet(pictures: list[tuple[str, Image.Image]], columns: int) -> Image.Image:
    """Captioned pictures of one size in rows."""
    width, height = pictures[0][1].size
    rows = -(-len(pictures) // columns)
    page = Image.new("RGB", (columns * (width + GAP) - GAP, rows * (height + CAPTION + GAP) - GAP), PAPER)
    pen, font = ImageDraw.Draw(page), ImageFont.load_default(15)
    for place, (caption, picture) in enumerate(pictures):
        x, y = place % columns * (width + GAP), place // columns * (height + CAPTION + GAP)
        page.paste(picture, (x, y))
        pen.text((x + 2, y + height + 5), caption, INK, font)
    return page


def thesis_stimuli(edge: int = 256) -> Image.Image:
    """The fifteen pictures of the thesis template: a row for each factor, beside it a medium under two lights."""
    with tempfile.TemporaryDirectory() as folder:
        write_template(Path(folder), "thesis")
        entries = build(Path(folder))["stimuli"]
        shown = []
        for entry in entries:
            picture = Image.open(Path(folder) / "stimuli" / entry["file"]).convert("RGB")
            same = f"  (= {entry['same_picture_as']})" if entry["same_picture_as"] else ""
            caption = f"{entry['id']}  {entry['label'].removesuffix(', denoised')}{same}"
            shown.append((caption, picture.resize((edge, edge), Image.Resampling.LANCZOS)))
    own, offline = shown[:9], shown[9:]
    rows = [[*own[3 * row : 3 * row + 3], *offline[2 * row : 2 * row + 2]] for row in range(3)]
    return sheet([picture for row in rows for picture in row], 5)


def objects(edge: int = 300) -> Image.Image:
    """Every built-in object in the default scene."""
    drawn = [(name, render(Scene(object=name, size=(edge, edge)))) for name in names()]
    return sheet([(name, Image.fromarray(to_8bit(image[..., :3]))) for name, image in drawn], 3)


def views(width: int = 1290) -> Image.Image:
    """The contact sheet of the shell, whose inner wall shows as hard edges."""
    drawn = Image.fromarray(to_8bit(contact_sheet(Scene(object="shell"))))
    return drawn.resize((width, round(width * drawn.height / drawn.width)), Image.Resampling.LANCZOS)


SHADOWS = {
    "material.diffuse_contribution": 0.7,
    "material.backlight": 0.6,
    "light.azimuth": -50.0,
    "light.elevation": 30.0,
    "light.shadows": True,
}
SOFT = {"shadow.filter": "disc", "shadow.radius": 0.008, "shadow.samples": 16}
FURTHER: list[dict[str, Any]] = [
    {"azimuth": 60.0, "elevation": 20.0, "diffuse": (0.1, 0.25, 0.8), "ambient": (0, 0, 0), "shadows": True},
    {"kind": "spot", "azimuth": 0.0, "elevation": 70.0, "cutoff": 12.0, "diffuse": (0.5, 0.9, 0.6), "shadows": True},
]
LIGHTS: dict[str, dict[str, Any]] = {
    "directional, pcf": {},
    "spot, pcf": {"light.kind": "spot", "light.cutoff": 10.0, "light.azimuth": -35.0, "light.elevation": 45.0},
    "near point, disc": {"light.kind": "point", "light.distance": 1.1, "light.attenuation": (0.2, 0, 0.8), **SOFT},
    "three lights, disc": {
        "material.diffuse": (0.7, 0.6, 0.5),
        "material.backlight": 0.25,
        "light.diffuse": (1.0, 0.5, 0.2),
        "lights": FURTHER,
        **SOFT,
    },
}


def lights(edge: int = 260) -> Image.Image:
    """Kinds of lights and filters of shadows on the default object."""
    base = Scene(size=(edge, edge)).replace(SHADOWS)
    drawn = [(name, render(base.replace(changes))) for name, changes in LIGHTS.items()]
    return sheet([(name, Image.fromarray(to_8bit(image[..., :3]))) for name, image in drawn], 4)


def report() -> Image.Image:
    """The first screen of the report on 38 simulated raters of the thesis's study, and two of its figures beside it."""
    with tempfile.TemporaryDirectory() as name:
        study = Path(name) / "study"
        write_template(study, "thesis")
        build(study)
        with served(study, mode="simulated") as url:
            simulate(url, load_study(study), admin_secret(study), started=44, completed=38, seed=2011, progress=False)
        folder = report_folder(study, None, "simulated")
        left = screenshot(folder / "index.html", (1180, 1300))
        sheet = Image.new("RGB", (left.width + 1000, left.height), PAPER)
        sheet.paste(left, (0, 0))
        top = 20
        for stem in ("figure-answers", "figure-people"):
            figure = Image.open(folder / "figures" / f"{stem}.png").convert("RGB")
            figure = figure.resize((960, 960 * figure.height // figure.width), Image.Resampling.LANCZOS)
            sheet.paste(figure, (left.width + 20, top))
            top += figure.height + 40
        return sheet.resize((sheet.width * 3 // 4, sheet.height * 3 // 4), Image.Resampling.LANCZOS).quantize(256)


def screenshot(page: Path, size: tuple[int, int]) -> Image.Image:
    """The top of the page in a window of `size` CSS pixels."""
    shot = page.with_name("screenshot.png")
    switches = ["--headless", "--disable-gpu", "--hide-scrollbars", f"--window-size={size[0]},{size[1]}"]
    command = [find_browser(), *switches, *sandbox(), f"--screenshot={shot}", page.as_uri()]
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL, timeout=120)
    return Image.open(shot).convert("RGB")


if __name__ == "__main__":
    for name, page in (
        ("thesis-stimuli", thesis_stimuli()),
        ("objects", objects()),
        ("views", views()),
        ("lights", lights()),
        ("report", report()),
    ):
        page.save(HERE / f"{name}.png", optimize=True)
    draw_graph(compiled(Scene().replace({"light.ambient": (0, 0, 0)})), HERE / "graph.svg")
