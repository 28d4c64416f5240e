"""A built study for `survey_load.py`, made without a renderer."""

import hashlib
import json
from pathlib import Path

import numpy as np
from PIL import Image

SETTINGS = {"about": [], "screen_check": [], "practice": 0, "order": "random"}
QUESTIONS = [{"name": name, "text": f"The object looks {name}."} for name in ("translucent", "realistic")]


def write_study(folder: Path, pictures: int, side: int = 512) -> Path:
    """A built study of pictures of noise and two questions; each PNG about 100 KB."""
    stimuli = folder / "stimuli"
    stimuli.mkdir(parents=True)
    random = np.random.default_rng(5)
    entries = []
    for number in range(pictures):
        path = stimuli / f"img{number:03d}.png"
        Image.fromarray(random.integers(0, 8, (side, side), dtype=np.uint8) * 32).save(path)
        sha = hashlib.sha256(path.read_bytes()).hexdigest()
        entries.append({"id": path.stem, "file": path.name, "sha256": sha, "width": side, "height": side,
                        "factors": {}, "rows": [], "same_picture_as": None, "role": "factor"})  # fmt: skip
    study = {"title": "Load", "seed": 1, "sha256": "0" * 64, "question": QUESTIONS, "survey": SETTINGS}
    manifest = {"format": 1, "study": study | {"factors": [], "design": {}}, "software": {}, "stimuli": entries}
    (stimuli / "manifest.json").write_text(json.dumps(manifest))
    return folder
