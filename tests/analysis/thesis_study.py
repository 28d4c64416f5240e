"""The thesis's study as a manifest with small pictures, for the tests of the analysis."""

import json
from pathlib import Path
from typing import Any

from PIL import Image

FACTORS = {"thickness exponent": [25, 18, 30], "backlight": [1.2, 0.8, 1.6], "diffuse weight": [0.2, 0.0, 0.5]}
BASE = {"thickness exponent": 25, "backlight": 1.2, "diffuse weight": 0.2}
QUESTIONS = ("translucent", "realistic", "varnished")
COMPARISON = {
    "name": "offline images vs ours",
    "question": "translucent",
    "stimuli": ["best", "img10", "img11", "img12"],
}


def stimulus(number: int, **facts: Any) -> dict[str, Any]:
    """A manifest entry with what every stimulus has."""
    name = f"img{number:02d}"
    return {"id": name, "file": f"{name}.png", "factors": {}, "rows": [], "same_picture_as": None, **facts}


def thesis_stimuli() -> list[dict[str, Any]]:
    """Table 4.3's nine pictures (1, 4 and 7 alike) and six of other origin."""
    own = [
        stimulus(
            3 * row + column + 1,
            role="factor",
            rows=[name],
            factors={**BASE, name: level},
            label=f"{name} {level:g}",
            same_picture_as="img01" if row and not column else None,
        )
        for row, (name, levels) in enumerate(FACTORS.items())
        for column, level in enumerate(levels)
    ]
    return own + [stimulus(number, role="compare", label=f"offline {number - 9}") for number in range(10, 16)]


def write_manifest(folder: Path, stimuli: list[dict[str, Any]], analysis: dict[str, Any]) -> Path:
    """`stimuli/manifest.json` with a picture for each entry; returns its path."""
    place = folder / "stimuli"
    place.mkdir(parents=True)
    for index, entry in enumerate(stimuli):
        Image.new("RGB", (64, 48), (10 * index % 256, 120, 60)).save(place / entry["file"])
    study = {
        "title": "Perceived <translucency> & more",
        "seed": 2011,
        "sha256": "ab" * 32,
        "design": {"kind": "one-at-a-time"},
        "factors": [{"name": name, "path": "material.x", "levels": levels} for name, levels in FACTORS.items()],
        "question": [
            {"name": name, "text": f"It looks {name}.", "scale": 7, "low": "no", "high": "yes"} for name in QUESTIONS
        ],
        "analysis": analysis,
    }
    path = place / "manifest.json"
    path.write_text(json.dumps({"format": 1, "study": study, "stimuli": stimuli}), encoding="utf-8")
    return path
