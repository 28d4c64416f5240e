"""`fakesss bench`: what the technique costs beside direct light, and what baking costs beside bare ray casting.

The two tables of the thesis (Gascons 2011, section 4.1) on this machine. Everything compared is drawn in turn within
one run, since the machine's speed drifts; a time is the median of `REPEATS` pictures, finished on the GPU, not read
back. The baseline is the fastest direct light we know (`fakesss.direct_light`), back faces culled.
"""

import contextlib
import os
import platform
import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from fakesss.bench_bake import bake_times
from fakesss.colour import to_8bit
from fakesss.direct_light import DirectLight
from fakesss.frame import Run
from fakesss.frame_graph import Plan
from fakesss.gpu import renderer_facts
from fakesss.mesh import Mesh
from fakesss.occlusion import bake_occlusion
from fakesss.pipeline import build
from fakesss.renderer import PICTURE, Renderer, shared_renderer
from fakesss.scene import Scene
from fakesss.solidity import is_solid

FACES = (4_000, 30_000, 60_000, 100_000, 120_000, 240_000)
SIZE = (512, 512)
REPEATS = 15
BAKES = 5  # of the hierarchy and of the occlusion
RAYS = 320
COARSE = 8_000  # faces of the approximate second layer

# The thesis's frame rates with the technique and with direct light only, as cost ratios; GeForce 9400M.
THESIS = {240_000: 3.6, 120_000: 4.6, 100_000: 6.2, 60_000: 5.9, 30_000: 5.0, 4_000: 2.4}

METHOD = (
    f"medians of {REPEATS} pictures in turn within one run, one sample a pixel, finished on the GPU and not read back; "
    "direct: one forward pass into 8-bit colour, back faces culled; technique: the exact picture of the default scene; "
    "what a picture's plan takes to compile (under 1 ms) is outside the clock; "
    f"approximate: its second layer from {COARSE} faces; unculled: to direct light with back faces drawn; "
    "own: to this renderer without backlight; "
    "difference: of 8-bit codes at most, to the peeled, unmerged float32 path; "
    f"bake: {RAYS} rays a vertex; bare Embree: the same rays, prepared before, on all cores, in turn; "
    "share of work: bare Embree's processor time over the bake's"
)


def bench(name: str, faces: Sequence[int], size: tuple[int, int] = SIZE, repeats: int = REPEATS) -> dict[str, Any]:
    """The contract's `bench` document for the built-in object `name` at each number of faces."""
    renderer = shared_renderer()
    bar = tqdm(faces, unit="size", disable=None)
    rows = [row(renderer, Scene(object=f"{name}:{count}", size=size, supersampling=1), repeats) for count in bar]
    return {"machine": machine(), "rows": rows, "method": METHOD}


def machine() -> dict[str, Any]:
    """What the figures are of."""
    return {
        **renderer_facts(),
        "processor": processor(),
        "cores": os.cpu_count(),
        "python": platform.python_version(),
    }


def processor() -> str:
    """Its model, where the system tells; else its kind."""
    with contextlib.suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def row(renderer: Renderer, scene: Scene, repeats: int) -> dict[str, Any]:
    """Every figure of one object."""
    mesh: Mesh = renderer.data(scene, ("mesh",))["mesh"]
    drawn = picture_times(renderer, scene, mesh, repeats)
    return {
        "object": scene.object,
        "faces": len(mesh.faces),
        **{f"{name}_ms": ms for name, ms in drawn.items()},
        **{f"{name}ratio": drawn[f"{name}technique"] / drawn["direct"] for name in ("", "peeled_", "approximate_")},
        "unculled_ratio": drawn["technique"] / drawn["direct_unculled"],
        "own_ratio": drawn["technique"] / drawn["own_direct"],
        "largest_difference": largest_difference(renderer, scene, mesh),
        **bake_times(mesh, RAYS, min(BAKES, repeats)),
    }


def picture_times(renderer: Renderer, scene: Scene, mesh: Mesh, repeats: int) -> dict[str, float]:
    """Median milliseconds of each way to draw the scene, all drawn in turn."""
    direct = DirectLight(renderer.gpu, scene, mesh, bake_occlusion(mesh).values)

    def technique(**changes: Any) -> Callable[[], None]:
        changed = scene.replace({path.replace("__", "."): value for path, value in changes.items()})
        plan = build(changed, 1, is_solid(mesh)).compile((PICTURE,))
        return lambda: finished(renderer, plan)

    ways: Mapping[str, Callable[[], None]] = {
        "direct": direct,
        "direct_unculled": lambda: direct(cull=False),
        "own_direct": technique(material__backlight=0.0),
        "technique": technique(),
        "peeled_technique": technique(layers__method="peel"),
        "approximate_technique": technique(layers__faces=COARSE),
    }
    return in_turn(ways, repeats)


def in_turn(ways: Mapping[str, Callable[[], object]], repeats: int) -> dict[str, float]:
    """Median milliseconds of each; the first two rounds, which compile and upload, do not count."""
    taken: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(repeats + 2):
        for name, way in ways.items():
            start = time.perf_counter()
            way()
            taken[name].append(1e3 * (time.perf_counter() - start))
    return {name: statistics.median(times[2:]) for name, times in taken.items()}


def finished(renderer: Renderer, plan: Plan) -> None:
    """Draw what `plan` says and wait for it, without reading it back."""
    Run(plan, renderer.gpu, renderer.bakes)(read=False)
    renderer.gpu.context.finish()


def largest_difference(renderer: Renderer, scene: Scene, mesh: Mesh) -> int:
    """Of any 8-bit code value, between the exact technique as it is drawn and drawn without any short cut."""
    solid = is_solid(mesh)
    plain = build(scene.replace({"layers.method": "peel"}), 1, solid)
    plans = (
        build(scene, 1, solid).compile((PICTURE,)),
        plain.compile((PICTURE, "blurred_thickness", "surface")),  # asked for, so neither merged nor left uncleared
    )
    pictures = [Run(plan, renderer.gpu, renderer.bakes)().values[PICTURE] for plan in plans]
    codes = [to_8bit(picture[..., :3]).astype(int) for picture in pictures]
    return int(np.abs(codes[0] - codes[1]).max())
