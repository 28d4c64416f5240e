"""What baking costs beside bare ray casting: the second half of `fakesss bench`.

Bare are the very rays that baking casts, in the order it casts them, prepared before the clock starts, on all cores.
"""

import os
import statistics
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from fakesss.hemisphere import BLOCK, even_directions, mean_over_hemisphere
from fakesss.mesh import Mesh
from fakesss.occlusion import ray_origins
from fakesss.ray_casting import Caster
from fakesss.space_order import along_curve

BATCHES = 20  # given to a thread at once

Floats32 = NDArray[np.float32]
Rays = tuple[Floats32, Floats32, Floats32]  # origins (N, 3), their one direction (1, 3), reaches (N,)


def bake_times(mesh: Mesh, rays: int, repeats: int) -> dict[str, float]:
    """Hierarchy (ms), a whole bake (s), million rays a second of baking and of bare Embree, cast in turn; medians.

    `ao_share_of_work`: bare Embree's processor time over baking's, 0..1; beside the rates, which go by the clock, it
    does not depend on what else the machine does. `ao_cores_busy`: processor time over wall time.
    """
    hierarchy = statistics.median(Caster(mesh).build_seconds for _ in range(repeats))
    caster, ready = Caster(mesh), prepared(mesh, rays)
    number = sum(len(origins) for origins, _, _ in ready)

    def baking() -> None:
        mean_over_hemisphere(ray_origins(mesh), mesh.normals, rays, "cosine", caster.clear, "occlusion")

    runs = np.array([[clocked(lambda: cast_barely(caster, ready)), clocked(baking)] for _ in range(repeats)])
    (bare, ours), (bare_work, our_work) = np.moveaxis(runs, 0, 2).transpose(1, 0, 2)
    return {
        "bvh_ms": 1e3 * hierarchy,
        "ao_seconds": hierarchy + float(np.median(ours)),
        "ao_mrays_per_s": number / 1e6 / float(np.median(ours)),
        "ao_cores_busy": float(np.median(our_work / ours)),
        "ao_share_of_work": float(np.median(bare_work / our_work)),
        "embree_mrays_per_s": number / 1e6 / float(np.median(bare)),
        "embree_cores_busy": float(np.median(bare_work / bare)),
    }


def prepared(mesh: Mesh, rays: int) -> list[Rays]:
    """The rays that baking casts for `mesh`, and no others; 16 bytes each."""
    origins = ray_origins(mesh)
    order = along_curve(origins)
    directions = even_directions(2 * rays).astype(np.float32)[:, None]
    ready = []
    for start in range(0, len(order), BLOCK):
        block = order[start : start + BLOCK]
        for direction in directions:
            above = block[(mesh.normals[block] * direction).sum(axis=1) > 0]
            ready.append((origins[above], direction, np.full(len(above), np.inf, np.float32)))
    return ready


def cast_barely(caster: Caster, ready: list[Rays]) -> None:
    """Every ray once, on all cores, the answers dropped."""

    def some(part: list[Rays]) -> None:
        for batch in part:
            caster.clear(*batch)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(some, (ready[start : start + BATCHES] for start in range(0, len(ready), BATCHES))))


def clocked(task: Callable[[], None]) -> tuple[float, float]:
    """Wall time and processor time, seconds."""
    wall, work = time.perf_counter(), time.process_time()
    task()
    return time.perf_counter() - wall, time.process_time() - work
