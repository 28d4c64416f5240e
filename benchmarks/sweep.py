"""What a build spends its time on: `python benchmarks/sweep.py`.

Builds the thesis's study with as many levels as asked for, four ways in turn, and prints the median of each:

- drawing alone: every picture drawn and dropped; no build can be faster
- the build: encoded, hashed and written while the next picture is drawn
- one after the other: the same work without the overlap
- zlib level 6: one after the other, PNG by the usual encoder

Two shares are told. `in drawing` is the wall time during which a picture was being drawn. `drawing alone` divides the
wall time of drawing alone by that of the build: where the processor itself draws, it cannot be had by overlapping.
Many short rounds say more than a long one on a machine that others use too.
"""

import contextlib
import io
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from unittest.mock import patch

import click
import numpy as np
from PIL import Image

from fakesss.colour import to_8bit
from stimuli import build as building
from stimuli import picture
from stimuli.design import stimuli_of
from stimuli.store import Store
from stimuli.study import Study
from stimuli.template import write_template

WAYS = ("drawing alone", "the build", "one after the other", "zlib level 6")


@dataclass
class Clock:
    """Seconds in each kind of work, on whichever thread."""

    seconds: dict[str, float] = field(default_factory=dict)

    def timed(self, name: str, work: Callable[..., Any]) -> Callable[..., Any]:
        """`work`, its time added up under `name`."""

        def timing(*args: Any, **kwargs: Any) -> Any:
            start = time.perf_counter()
            try:
                return work(*args, **kwargs)
            finally:
                self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start

        return timing


class AtOnce:
    """In place of `Background`: does each piece when it is given."""

    def __init__(self, size: tuple[int, int]) -> None:
        pass

    def __enter__(self) -> "AtOnce":
        return self

    def __exit__(self, *error: object) -> None:
        pass

    def submit(self, work: Callable[[], None]) -> None:
        work()


def zlib_level_6(linear: np.ndarray[Any, Any]) -> bytes:
    """The usual encoder with its usual setting, the whole picture at once."""
    file = io.BytesIO()
    Image.fromarray(to_8bit(linear[..., :3])).save(file, format="PNG", compress_level=6)
    return file.getvalue()


def draw_alone(folder: Path) -> None:
    """Every picture of the study, kept nowhere."""
    study = Study.load(folder)
    for stimulus in stimuli_of(study):
        building.draw(stimulus, size=study.scene.size, folder=folder)


@contextlib.contextmanager
def study_of(pictures: int, size: int, object_name: str) -> Iterator[Path]:
    """The thesis's study in a temporary folder, with `pictures` thickness exponents instead of its three factors.

    Without its path-traced pictures: they are of one size, and nothing is drawn for them.
    """
    with tempfile.TemporaryDirectory(prefix="fakesss-sweep-") as name:
        folder = Path(name)
        text = write_template(folder, "thesis").read_text(encoding="utf-8")
        text = text.replace("size = [512, 512]", f"size = [{size}, {size}]")
        text = text.replace('object = "figure"', f'object = "{object_name}"')
        levels = ", ".join(f"{5 + 30 * number / pictures:.6f}" for number in range(pictures))
        factor = f'[[factor]]\nname = "r"\npath = "material.thickness_exponent"\nlevels = [{levels}]\n\n'
        text = text[: text.index("[[compare]]")] + text[text.index("[[question]]") :]
        start, end = text.index("[[factor]]"), text.index("[design]")
        (folder / "study.toml").write_text(text[:start] + factor + text[end:], encoding="utf-8")
        yield folder


def run(way: str, pictures: int, size: int, object_name: str) -> tuple[float, dict[str, float]]:
    """Wall seconds of one way, and those of each kind of work."""
    clock = Clock()
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(study_of(pictures, size, object_name))
        stack.enter_context(patch.object(building, "draw", clock.timed("drawing", building.draw)))
        stack.enter_context(patch.object(picture, "encoded", clock.timed("encoding", picture.encoded)))
        stack.enter_context(patch.object(Store, "put", clock.timed("writing", Store.put)))
        if way in WAYS[2:]:
            stack.enter_context(patch.object(building, "Background", AtOnce))
        if way == WAYS[3]:
            stack.enter_context(patch("fakesss.image_io.encode_png", zlib_level_6))
        start = time.perf_counter()
        draw_alone(folder) if way == WAYS[0] else building.build(folder, quiet=True)
        return time.perf_counter() - start, clock.seconds


def told(way: str, runs: list[tuple[float, dict[str, float]]], alone: float, pictures: int) -> str:
    """One line of the table: medians over the rounds."""
    wall = statistics.median(seconds for seconds, _ in runs)
    work = {
        kind: statistics.median(parts.get(kind, 0.0) for _, parts in runs)
        for kind in ("drawing", "encoding", "writing")
    }
    share = statistics.median(parts["drawing"] / seconds for seconds, parts in runs)
    times = "".join(f"{seconds:9.2f}" for seconds in (wall, *work.values()))
    return f"{way:20}{times}{share:11.1%}{alone / wall:15.1%}{pictures / wall:12.1f}"


@click.command()
@click.option("--pictures", default=20, show_default=True, type=click.IntRange(2))
@click.option("--size", default=512, show_default=True, type=click.IntRange(1), help="Pixels a side.")
@click.option("--object", "object_name", default="figure", show_default=True)
@click.option("--rounds", default=9, show_default=True, type=click.IntRange(1), help="Repeats; the median is told.")
def main(pictures: int, size: int, object_name: str, rounds: int) -> None:
    """Prints seconds of each way to build, interleaved in one process."""
    run(WAYS[1], 2, size, object_name)  # context, programs, mesh and occlusion are there from now on
    runs: dict[str, list[tuple[float, dict[str, float]]]] = {way: [] for way in WAYS}
    for _ in range(rounds):
        for way in WAYS:
            runs[way].append(run(way, pictures, size, object_name))
    alone = statistics.median(seconds for seconds, _ in runs[WAYS[0]])
    click.echo(f"{pictures} pictures of {size}x{size}, {object_name}, median of {rounds}; seconds")
    click.echo(f"{'':20}     wall  drawing encoding  writing in drawing  drawing alone  pictures/s")
    for way in WAYS:
        click.echo(told(way, runs[way], alone, pictures))


if __name__ == "__main__":
    main()
