"""Whether memory stays flat over thousands of pictures: `python benchmarks/memory.py --pictures 10000`.

Small pictures through the build's own path (drawn, encoded, hashed, written), in two sweeps: each picture with another
material, camera, size and object than the one before; and, at one size, with other lights, shadow maps and numbers of
samples, each a texture or a program of its own. What is kept from picture to picture has bounds (the last few meshes,
buffers and programs, bytes of textures): once these are reached nothing may grow any more.
"""

import random
import resource
import shutil
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import click
import numpy as np

from fakesss.scene import Scene
from stimuli.build import Task, draw_here
from stimuli.design import Stimulus

SHAPES = ("sphere", "torus", "knot", "box", "shell")
FACES = (1000, 1500, 2000, 3000)  # times five shapes: more meshes and buffers than are kept
SIZES = ((16, 16), (33, 20), (64, 48), (96, 96))
LARGEST = max(SIZES)
SETTLED = 0.1  # share of the pictures after which everything has been seen
MIB = 1 << 20


@dataclass(frozen=True)
class Course:
    """Resident memory over a sweep."""

    pictures: list[int]  # drawn so far, at each measurement
    mib: list[float]

    @property
    def settled(self) -> int:
        """Index of the first measurement that counts."""
        return int(np.searchsorted(self.pictures, SETTLED * self.pictures[-1]))

    @property
    def growth(self) -> float:
        """MiB between the settled state and the end, medians of a tenth of the measurements each: single ones jump."""
        counted = self.mib[self.settled :]
        few = max(1, len(counted) // 10)
        return float(np.median(counted[-few:]) - np.median(counted[:few]))

    @property
    def slope(self) -> float:
        """Bytes a picture from the settled state on, by least squares."""
        return float(np.polyfit(self.pictures[self.settled :], self.mib[self.settled :], 1)[0] * MIB)


def tasks(count: int, seed: int = 2011) -> Iterator[Task]:
    """`count` different pictures, in no order that a cache could profit from."""
    lot = random.Random(seed)
    for number in range(count):
        scene = Scene(size=lot.choice(SIZES), object=f"{lot.choice(SHAPES)}:{lot.choice(FACES)}").replace(
            {
                "supersampling": lot.randint(1, 3),
                "occlusion.rays": 8,
                "blur.enabled": lot.random() < 0.5,
                "camera.azimuth": lot.uniform(0, 360),
                "camera.distance": lot.uniform(1.5, 4),
                "light.elevation": lot.uniform(-90, 90),
                "light.kind": lot.choice(("directional", "point", "spot")),
                "light.shadows": lot.random() < 0.3,
                "material.thickness_exponent": lot.uniform(0, 40),
                "material.backlight": lot.choice((0.0, lot.uniform(0, 2))),
                "material.thickness": lot.choice(("first-interval", "total-path", "bridged")),
            }
        )
        yield f"{number:06d}", Stimulus(f"img{number}", "", "factor", scene)


def lit_tasks(count: int, seed: int = 2011) -> Iterator[Task]:
    """`count` pictures of one object and size, which differ in their lights, shadow maps and numbers of samples."""
    lot = random.Random(seed)
    for number in range(count):
        lights = [{"azimuth": lot.uniform(0, 360), "shadows": lot.random() < 0.7} for _ in range(lot.randint(0, 7))]
        scene = Scene(size=LARGEST, object="torus:1000", supersampling=1).replace(
            {
                "occlusion.method": lot.choice(("baked", "screen-space")),
                "occlusion.rays": 8,
                "occlusion.samples": 4 * lot.randint(1, 16),
                "light.kind": lot.choice(("directional", "point", "spot")),
                "light.distance": lot.uniform(0, 4),
                "light.shadows": lot.random() < 0.7,
                "lights": lights,
                "shadow.map_size": lot.randint(64, 512),
                "shadow.filter": lot.choice(("hard", "pcf", "disc")),
                "shadow.samples": lot.randint(1, 16),
            }
        )
        yield f"{number:06d}", Stimulus(f"img{number}", "", "factor", scene)


SWEEPS: dict[str, Callable[[int], Iterator[Task]]] = {"everything": tasks, "lights at one size": lit_tasks}


def resident() -> float:
    """MiB of this process in memory now (Linux)."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * resource.getpagesize() / MIB


def measure(pictures: Iterable[Task], every: int) -> Course:
    """Draws `pictures` into a temporary folder and looks at memory after each `every` of them."""
    folder = Path(tempfile.mkdtemp(prefix="fakesss-memory-"))
    course = Course([], [])
    drawn = 0

    def look() -> None:
        nonlocal drawn
        drawn += 1
        if drawn % every == 0:
            course.pictures.append(drawn)
            course.mib.append(resident())

    try:
        draw_here(pictures, LARGEST, folder, look)
    finally:
        shutil.rmtree(folder)
    return course


@click.command()
@click.option("--pictures", default=10_000, show_default=True, type=click.IntRange(100))
def main(pictures: int) -> None:
    """Prints resident memory over each sweep, its growth after the first tenth, and the slope."""
    for name, sweep in SWEEPS.items():
        start = time.perf_counter()
        course = measure(sweep(pictures), max(1, pictures // 100))
        click.echo(name)
        for drawn, mib in list(zip(course.pictures, course.mib, strict=True))[:: max(1, len(course.mib) // 20)]:
            click.echo(f"{drawn:7d} pictures  {mib:7.1f} MiB")
        click.echo(
            f"growth after the first {SETTLED:.0%}: {course.growth:+.1f} MiB, slope {course.slope:+.0f} bytes a picture"
        )
        click.echo(f"{(time.perf_counter() - start) / pictures * 1000:.1f} ms a picture")


if __name__ == "__main__":
    main()
