"""A small built study for the survey's tests: a manifest and real PNGs with real hashes, made without a renderer."""

import hashlib
import json
from pathlib import Path
from typing import Any

from PIL import Image, ImageDraw

QUESTIONS = [
    {"name": "translucent", "text": "The object looks translucent."},
    {"name": "realistic", "text": "The object looks realistic."},
]
FACTORS = [
    {"name": "thickness exponent", "path": "material.thickness_exponent", "levels": [25, 18, 30]},
    {"name": "backlight", "path": "material.backlight", "levels": [1.2, 0.8, 1.6]},
    {"name": "diffuse weight", "path": "material.diffuse_weight", "levels": [0.2, 0.0, 0.5]},
]


def write_study(folder: Path, pictures: int = 3, size: int = 96, **tables: Any) -> Path:
    """A built study in `folder`: `pictures` (up to 9, the thesis's levels) discs of `size` x `size` pixels.

    `tables` replace `question` or `survey` in the manifest's study.
    """
    stimuli = folder / "stimuli"
    stimuli.mkdir(parents=True, exist_ok=True)
    study = {
        "title": "Discs in grey",
        "seed": 7,
        "sha256": hashlib.sha256(repr((pictures, size, tables)).encode()).hexdigest(),
        "design": {"kind": "one-at-a-time"},
        "factors": FACTORS,
        "question": QUESTIONS,
        "survey": {},
        **tables,
    }
    entries = [entry(stimuli, number, size) for number in range(pictures)]
    manifest = {"format": 1, "study": study, "software": {}, "stimuli": entries}
    (stimuli / "manifest.json").write_text(json.dumps(manifest, indent=1), encoding="utf-8")
    return folder


def entry(stimuli: Path, number: int, size: int) -> dict[str, Any]:
    """One stimulus of the manifest and its PNG."""
    row, level = divmod(number, 3)
    factors = {factor["name"]: factor["levels"][level if index == row else 0] for index, factor in enumerate(FACTORS)}
    name = f"img{number + 1:02d}"
    path = stimuli / f"{name}.png"
    draw_disc(path, size, hue=number * 40)
    return {
        "id": name,
        "file": path.name,
        "sha256": hashlib.sha256(path.read_bytes()).hexdigest(),
        "width": size,
        "height": size,
        "scene": {},
        "factors": factors,
        "rows": [FACTORS[row]["name"]],
        "same_picture_as": None,
        "role": "factor",
        "label": f"disc {number + 1}",
        "passes": [],
        "gpu_ms": None,
        "warnings": [],
    }


def draw_disc(path: Path, size: int, hue: int) -> None:
    """A disc of one hue on black, with a lighter spot."""
    image = Image.new("HSV", (size, size), (0, 0, 0))
    draw = ImageDraw.Draw(image)
    draw.ellipse((size * 0.1, size * 0.1, size * 0.9, size * 0.9), fill=(hue % 256, 150, 170))
    draw.ellipse((size * 0.3, size * 0.25, size * 0.5, size * 0.45), fill=(hue % 256, 60, 240))
    image.convert("RGB").save(path)
