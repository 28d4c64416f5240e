"""What `blur.kernel`, `layers.resolution`, `layers.depth` and `layers.faces` save and change.

    python benchmarks/cheaper_layers.py [OBJECT:FACES ...]

The tables of docs/technique.md. Times are processor time on one thread (`LP_NUM_THREADS=0`), all ways drawn in turn
within one run, medians, not read back: other work on the machine does not count. At one sample a pixel they are told
beside direct light, at 3 x 3 beside the default. Errors: 8-bit code values of the covered pixels beside the default.
"""

import os

os.environ.setdefault("LP_NUM_THREADS", "0")

import statistics
import sys
import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from fakesss.bench import finished
from fakesss.colour import to_8bit
from fakesss.direct_light import DirectLight
from fakesss.occlusion import bake_occlusion
from fakesss.pipeline import build
from fakesss.renderer import PICTURE, shared_renderer
from fakesss.scene import Scene
from fakesss.solidity import is_solid

OBJECTS = ("figure:60000", "knot:60000", "head:60000", "figure:120000", "knot:120000")
REPEATS = {1: 15, 3: 5}  # by samples a side
EXACT: dict[str, Any] = {}
SURVEY = {"layers.faces": 8_000, "layers.resolution": 2, "blur.kernel": "3x3"}
WAYS: dict[str, dict[str, Any]] = {
    "without backlight": {"material.backlight": 0.0},
    "default": EXACT,
    "no softening": {"blur.enabled": False},
    **{kernel: {"blur.kernel": kernel} for kernel in ("3x3", "separable", "9x9")},
    "resolution 2": {"layers.resolution": 2},
    "resolution 4": {"layers.resolution": 4},
    "float16": {"layers.depth": "float16"},
    "8,000 faces": {"layers.faces": 8_000},
    "8,000, 2, 3x3": SURVEY,
    "8,000, 2, separable": {**SURVEY, "blur.kernel": "separable"},
    "8,000, 4, 3x3": {**SURVEY, "layers.resolution": 4},
}


def seconds_in_turn(ways: Mapping[str, Callable[[], object]], repeats: int) -> dict[str, float]:
    """Median processor time of each; the first two rounds, which compile and upload, do not count."""
    taken: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(repeats + 2):
        for name, way in ways.items():
            start = time.process_time()
            way()
            taken[name].append(time.process_time() - start)
    return {name: statistics.median(times[2:]) for name, times in taken.items()}


def ratios(name: str, samples: int) -> dict[str, float]:
    """Time of each way beside direct light, or beside the default where there are several samples a pixel."""
    renderer = shared_renderer()
    scene = Scene(object=name, supersampling=samples)
    mesh = renderer.data(scene, ("mesh",))["mesh"]

    def drawn(changes: dict[str, Any]) -> Callable[[], None]:
        plan = build(scene.replace(changes), samples, is_solid(mesh)).compile((PICTURE,))
        return lambda: finished(renderer, plan)

    ways: dict[str, Callable[[], object]] = {way: drawn(changes) for way, changes in WAYS.items()}
    if samples == 1:
        ways["direct"] = DirectLight(renderer.gpu, scene, mesh, bake_occlusion(mesh).values)
    times = seconds_in_turn(ways, REPEATS[samples])
    baseline = times["direct" if samples == 1 else "default"]
    return {way: times[way] / baseline for way in WAYS}


def errors(name: str, samples: int) -> dict[str, str]:
    """Share of the covered pixels off by more than 2 code values, 99th percentile, largest."""
    scene = Scene(object=name, supersampling=samples)
    exact = shared_renderer().render(scene).image
    told = {}
    for way, changes in WAYS.items():
        picture = shared_renderer().render(scene.replace(changes)).image
        codes = [to_8bit(image[..., :3]).astype(int) for image in (picture, exact)]
        off = np.abs(codes[0] - codes[1]).max(axis=2)[exact[..., 3] > 0]
        told[way] = f"{(off > 2).mean():.1%}, {np.percentile(off, 99):.0f}, {off.max()}"
    return told


def main() -> None:
    """Print a table for each object."""
    for name in sys.argv[1:] or OBJECTS:
        columns = {n: (ratios(name, n), errors(name, n)) for n in REPEATS}
        print(f"{name}: time and error at 1 x 1 samples, at 3 x 3")
        for way in WAYS:
            cells = (f"{times[way]:5.2f}  {wrong[way]:18}" for times, wrong in columns.values())
            print(f"  {way:20}", " | ".join(cells), flush=True)


if __name__ == "__main__":
    main()
