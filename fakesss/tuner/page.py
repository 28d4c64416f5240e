"""The tuner's page: its templates, filled with what this scene and this program have."""

from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from fakesss.media import MEDIA
from fakesss.mesh import EXTENSIONS
from fakesss.scene import Scene
from fakesss.shapes import DEFAULT_FACES, FACES, names
from fakesss.tuner.panel import EFFECTS, GROUPS

HERE = Path(__file__).parent
PANELS = {"lights": "Lights", "material": "Material", "camera": "Camera", "shader": "Shader", "sweep": "Sweep"}
LAYOUT = "tuner.css"  # before the sheets of single parts

environment = Environment(
    loader=FileSystemLoader(HERE / "templates"),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)


def page(base: Scene) -> str:
    """The page of a tuner that was started with `base`, as HTML; the values come with `start.json`."""
    return environment.get_template("tuner.html").render(
        base=base,
        panels=PANELS,
        sheets=[LAYOUT, *sorted({sheet.name for sheet in (HERE / "static").glob("*.css")} - {LAYOUT})],
        groups=GROUPS,
        effects=EFFECTS,
        objects=names(),
        faces=FACES,
        default_faces=DEFAULT_FACES,
        suffixes=[f".{kind}" for kind in EXTENSIONS],
        media=MEDIA,
    )
