"""Path-traced pictures that come with the program, as they take long to make.

Each is a PNG with a record beside it (`templates/<template>/<name>.json`): what exactly it shows, how it was made, and
its hash. It is taken where a study asks for exactly that scene and those settings, and for nothing else.
`python -m stimuli.rebuild_offline` makes them.
"""

import json
import math
import os
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from fakesss.offline.settings import OPAQUE, PathTracing
from fakesss.problem import BadInput
from fakesss.scene import Scene
from stimuli.manifest import sha256

SHELF = Path(__file__).with_name("templates")
SEEN = {"object", "size", "background", "exposure", "camera", "light", "lights"}  # what of a scene a path can meet
GLOSS = {"specular", "shininess", "specular_contribution"}  # what of its material the shader's highlights need
LAMBERTIAN: Any = {"material": {"diffuse"}}  # what of its material an opaque object shows
HIGHLIGHTS: Any = {"material": GLOSS, "shadow": True, "supersampling": True, "style": True}


@dataclass(frozen=True)
class Shipped:
    """A picture that comes with the program and the record beside it."""

    path: Path
    record: dict[str, Any]

    @property
    def name(self) -> str:
        """template/file"""
        return f"{self.path.parent.name}/{self.path.name}"

    def png(self) -> bytes:
        """The file's bytes; `BadInput` if they are not what the record says."""
        content = self.path.read_bytes()
        if sha256(content) != self.record["sha256"]:
            raise BadInput(f"{self.path}: is not the picture of its record; install fakesss again")
        return content


def shown(scene: Scene, settings: PathTracing) -> dict[str, Any]:
    """Everything in study.toml that the picture depends on, as JSON."""
    seen = scene.model_dump(mode="json", include=SEEN)
    drawn = scene.model_dump(mode="json", include=HIGHLIGHTS) if settings.highlights else {}
    if settings.medium == OPAQUE:
        lambertian = scene.model_dump(mode="json", include=LAMBERTIAN)["material"]
        drawn = {**drawn, "material": {**drawn.get("material", {}), **lambertian}}
    return {"scene": {**seen, **drawn}, "settings": settings.model_dump(mode="json")}


@cache
def shelf() -> tuple[Shipped, ...]:
    """Every shipped picture."""
    records = [(path.with_suffix(".png"), path.read_text(encoding="utf-8")) for path in sorted(SHELF.glob("*/*.json"))]
    return tuple(Shipped(path, json.loads(record)) for path, record in records)


def shipped(scene: Scene, settings: PathTracing) -> Shipped | None:
    """The picture of exactly this scene with exactly these settings; None: it has to be traced."""
    asked = shown(scene, settings)
    return next((each for each in shelf() if each.record["shows"] == asked), None)


def expected_minutes(scene: Scene, settings: PathTracing) -> float:
    """About how long tracing takes on this machine's cores, by the slowest and the noisiest of the shipped pictures.

    A medium in which light goes on for longer takes longer than any of them.
    """
    known = [(each.record["provenance"], math.prod(each.record["shows"]["scene"]["size"])) for each in shelf()]
    effort = max(made["seconds"] * made["cores"] / (made["samples"] * pixels) for made, pixels in known)  # core-seconds
    spread = max(made["noise"] * made["samples"] ** 0.5 for made, _ in known)  # of one sample, relative
    samples = settings.samples if settings.noise is None else min(settings.samples, (spread / settings.noise) ** 2)
    return float(effort * math.prod(scene.size) * samples / (os.cpu_count() or 1) / 60)
