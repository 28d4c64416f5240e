"""Baking occlusion beside bare Embree on the same rays: `python benchmarks/bake.py`.

"Bare" is Embree's occlusion query, through its binding, on all cores, over rays that lie ready in the best order
tried: along one direction at a time from neighbouring vertices. Baking starts from the mesh and its hierarchy. The two
take turns. `share` is of the rates by the clock, `share of work` of the processor time that a ray takes, which other
programs on the machine disturb less. `cores busy` is processor time over wall time.
"""

import os
import platform
import statistics
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import click
import embreex
import numpy as np
from numpy.typing import NDArray

from fakesss.hemisphere import BLOCK, even_directions, mean_over_hemisphere
from fakesss.mesh import Mesh
from fakesss.occlusion import ray_origins
from fakesss.ray_casting import Caster
from fakesss.shapes import load_object
from fakesss.space_order import along_curve

FACES = (4_000, 30_000, 60_000, 100_000, 120_000, 240_000)
BATCHES = 20  # given to a thread at once

Floats32 = NDArray[np.float32]
Rays = tuple[Floats32, Floats32, Floats32]  # origins (N, 3), their one direction (1, 3), reaches (N,)


@click.command()
@click.option("--object", "name", default="figure", show_default=True, help="Built-in object.")
@click.option("--rays", default=320, show_default=True, help="Rays per vertex.")
@click.option("--repeats", default=5, show_default=True, help="Of each, in turn.")
def main(name: str, rays: int, repeats: int) -> None:
    """Print million rays a second of bare Embree and of baking; medians."""
    print(f"{platform.machine()}, {os.cpu_count()} cores, Embree through embreex {embreex.__version__}")
    print(f"{name}, {rays} rays a vertex, medians of {repeats}")
    print("   faces  vertices  hierarchy ms  bare Mrays/s  ours Mrays/s  share  share of work  cores busy: bare  ours")
    for faces in FACES:
        print(row(load_object(f"{name}:{faces}"), rays, repeats), flush=True)


def row(mesh: Mesh, rays: int, repeats: int) -> str:
    """One line of the table."""
    hierarchy = statistics.median(Caster(mesh).build_seconds for _ in range(repeats))
    caster, ready = Caster(mesh), prepared(mesh, rays)
    number = sum(len(origins) for origins, _, _ in ready)

    def ours() -> None:
        mean_over_hemisphere(ray_origins(mesh), mesh.normals, rays, "cosine", caster.clear, "occlusion")

    runs = np.array([[clocked(lambda: cast_barely(caster, ready)), clocked(ours)] for _ in range(repeats)])
    wall, work = np.moveaxis(runs, 2, 0)  # (repeats, 2) each
    rates = number / 1e6 / np.median(wall, axis=0)
    shares = [np.median(times[:, 0] / times[:, 1]) for times in (wall, work)]
    cores = np.median(work / wall, axis=0)
    return (
        f"{len(mesh.faces):8}{len(mesh.positions):10}{1e3 * hierarchy:14.1f}{rates[0]:14.2f}{rates[1]:14.2f}"
        f"{shares[0]:7.1%}{shares[1]:15.1%}{cores[0]:18.2f}{cores[1]:6.2f}"
    )


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


if __name__ == "__main__":
    main()
