"""A small document of `fakesss fit`, from a real fit of few pixels to a path-traced picture of few samples."""

import json
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss import Scene
from fakesss.offline.fit_report import Named, fit_medium
from fakesss.offline.settings import PathTracing

SCENE = Scene.from_dict({"object": "figure:1000", "size": [32, 32], "supersampling": 1}, "test")
NAMED = Named("figure:1000", "fakesss fit figure:1000 --to medium.skimmilk -o out")


@cache
def small_fit() -> tuple[dict[str, Any], dict[str, NDArray[np.float32]]]:
    """The document, as JSON gives it back, and its pictures."""
    report = fit_medium(SCENE, PathTracing(medium="skimmilk", samples=16), 2, 0, NAMED, quiet=True)
    return json.loads(json.dumps(report.document)), report.pictures
