"""Screen-space ambient occlusion beside rays from every pixel: `python benchmarks/screen_occlusion.py`.

For 16 to 256 samples: the time of the two passes by OpenGL's timer, of as many Embree rays from each covered pixel, and
how far both are from 1,024 rays a pixel (mean absolute difference of [a]). Medians of interleaved repeats of one run,
512 x 512, one sample a pixel. The cost of the hierarchy and of the front layer is counted in neither.
"""

import statistics
import time
from collections.abc import Callable

import click
import numpy as np
from numpy.typing import NDArray

from fakesss.camera import View
from fakesss.hemisphere import mean_over_hemisphere
from fakesss.occlusion import CLEARANCE
from fakesss.ray_casting import Caster
from fakesss.renderer import shared_renderer
from fakesss.scene import Scene
from fakesss.screen_occlusion import unprojected

SAMPLES = (16, 32, 64, 128, 256)
TRUTH = 1024  # rays a pixel
PASSES = ("sample_occlusion", "screen_occlusion")


def rays_from_pixels(scene: Scene) -> tuple[Callable[[int], NDArray[np.float64]], NDArray[np.bool_]]:
    """The ray-traced [a] of every covered pixel as a function of the number of rays, and which pixels those are."""
    data = shared_renderer().data(scene, ("front", "surface", "mesh"))
    front, view = data["front"][::-1], View.of(scene.camera, scene.size)
    y, x = np.nonzero(front > 0)
    eye = unprojected(x, y, front, view)
    normals = (data["surface"][::-1][y, x, :3].astype(np.float64) @ view.rotation).astype(np.float32)
    origins = (eye @ view.rotation + CLEARANCE * normals).astype(np.float32)
    caster = Caster(data["mesh"])

    def traced(rays: int) -> NDArray[np.float64]:
        return mean_over_hemisphere(origins, normals, rays, "cosine", caster.clear, "")[0]

    return traced, front > 0


def drawn(scene: Scene, samples: int) -> tuple[NDArray[np.float32], float]:
    """The screen-space [a], bottom row first, and the milliseconds of its passes."""
    scene = scene.replace({"occlusion.samples": samples})
    times = {entry["name"]: entry["gpu_ms"] for entry in shared_renderer().render(scene, timed=True).passes}
    share = shared_renderer().data(scene, ("screen_occlusion",))["screen_occlusion"]
    return share[::-1], sum(times[name] for name in PASSES)


@click.command()
@click.option("--object", "name", default="figure:60000", show_default=True)
@click.option("--repeats", default=9, show_default=True)
def main(name: str, repeats: int) -> None:
    """Print time and error of screen-space samples and of as many rays from every covered pixel."""
    scene = Scene(object=name, supersampling=1).replace({"occlusion.method": "screen-space"})
    traced, covered = rays_from_pixels(scene)
    truth = traced(TRUTH)
    screen: dict[int, list[float]] = {samples: [] for samples in SAMPLES}
    embree: dict[int, list[float]] = {samples: [] for samples in SAMPLES}
    errors = {}
    for _ in range(repeats):
        for samples in SAMPLES:
            share, milliseconds = drawn(scene, samples)
            screen[samples].append(milliseconds)
            started = time.perf_counter()
            rays = traced(samples)
            embree[samples].append(1000 * (time.perf_counter() - started))
            errors[samples] = (np.abs(share[covered] - truth).mean(), np.abs(rays - truth).mean())
    print(f"{name}, {covered.sum()} covered pixels, {shared_renderer().gpu.renderer}")
    print("samples  screen-space ms  rays ms  ratio  error of screen-space  of rays")
    for samples in SAMPLES:
        ours, theirs = statistics.median(screen[samples]), statistics.median(embree[samples])
        print(f"{samples:7}  {ours:15.1f}  {theirs:7.0f}  {theirs / ours:5.1f}", end="")
        print(f"  {errors[samples][0]:21.4f}  {errors[samples][1]:7.4f}")


if __name__ == "__main__":
    main()
