"""Seconds of the shader's picture and of path tracing, in turn, so that a machine's moods cancel in the ratio."""

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from fakesss.media import Medium
from fakesss.offline.fit_model import matte
from fakesss.offline.settings import ROUND
from fakesss.offline.tracer import Tracer
from fakesss.renderer import shared_renderer
from fakesss.scene import Scene
from fakesss.shapes import load_object

TURNS = 3
DRAWN = 7  # warm draws in a turn


@dataclass(frozen=True)
class Times:
    """Medians of the turns."""

    shader: float  # seconds of one picture, read back
    sample: float  # seconds of path tracing, for one sample in every pixel
    ratio: float  # of the second to the first, within a turn


def measured(scene: Scene, medium: Medium, size_mm: float) -> Times:
    """Of `scene` without highlights; path tracing of rounds that no picture keeps."""
    renderer, plain = shared_renderer(), matte(scene)
    tracer = Tracer(scene, load_object(scene.object), medium, size_mm, seed=0)
    renderer.render(plain)
    turns = []
    for number in range(TURNS):
        traced = seconds(partial(tracer, number)) / ROUND
        drawn = statistics.median(seconds(partial(renderer.render, plain)) for _ in range(DRAWN))
        turns.append((drawn, traced, traced / drawn))
    return Times(*(statistics.median(column) for column in zip(*turns, strict=True)))


def seconds(work: Callable[[], object]) -> float:
    """That `work` takes."""
    began = time.perf_counter()
    work()
    return time.perf_counter() - began
