"""Times of pictures that are compared with one another, drawn in turn within one run.

A machine's speed drifts by more than two settings differ, within a round too. So every picture stands between two of
a fixed *baseline*, in an order that is shuffled for each round, and what is quoted is its ratio to their mean: the
median over rounds, with the band that order statistics give it (no distribution assumed) and how often that band holds
the true median. Two pictures are told apart by the ratios of their ratios, round by round. Milliseconds are the ratio
times the median of the baseline, one for a scene. A picture counts from the call until OpenGL has finished it, on
processor and GPU; it is not read back. Before each, the same is drawn once without counting, since buffers of another
size or mesh were just in use. Shadow maps are drawn anew, as they are when light, camera or object move.
"""

import os
import random
import statistics
import time
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

from scipy.stats import binom

from fakesss.bench import finished
from fakesss.pipeline import build, samples_of
from fakesss.recent import Recent
from fakesss.renderer import PICTURE, Renderer, shared_renderer
from fakesss.scene import Scene
from fakesss.solidity import is_solid

CONFIDENCE = 0.95  # at least, of a band of six rounds or more
SEED = 1  # of the orders of rounds
SLOW = 2.0  # seconds of a picture
BAKES_KEPT = 64  # every level of a few baked knobs, so that no picture waits for the disk
Key = TypeVar("Key", bound=Hashable)
Way = Callable[[], object]


@dataclass(frozen=True)
class Timing:
    """A time beside the baseline's: its ratio in each round, and milliseconds."""

    ratios: tuple[float, ...]
    baseline_ms: float

    @property
    def ratio(self) -> float:
        """The median over rounds."""
        return statistics.median(self.ratios)

    @property
    def band(self) -> tuple[float, float]:
        """Within which the true ratio lies as often as `coverage` says."""
        return median_band(self.ratios)

    @property
    def ms(self) -> float:
        return self.ratio * self.baseline_ms

    @property
    def each_ms(self) -> tuple[float, ...]:
        """Milliseconds round by round."""
        return tuple(ratio * self.baseline_ms for ratio in self.ratios)

    def facts(self) -> dict[str, float]:
        """The keys of a point in the `tradeoff` document."""
        low, high = self.band
        return {
            "ms": self.ms,
            "ms_low": low * self.baseline_ms,
            "ms_high": high * self.baseline_ms,
            "ratio": self.ratio,
            "ratio_low": low,
            "ratio_high": high,
            "coverage": coverage(len(self.ratios)),
        }


def load_now() -> float | None:
    """What else the machine does: processes that run or wait, mean of a minute; None where it does not tell."""
    return round(os.getloadavg()[0], 1) if hasattr(os, "getloadavg") else None


def measuring_renderer() -> Renderer:
    """A renderer on this thread's context that keeps more bakes than pictures one after another need."""
    renderer = Renderer(shared_renderer().gpu)
    renderer.bakes = Recent(BAKES_KEPT)
    return renderer


def drawn(renderer: Renderer, scene: Scene) -> Way:
    """Draws the picture of `scene` and waits for it; what it bakes is baked now, its plan compiled."""
    renderer.render(scene)
    mesh = renderer.data(scene, ("mesh",))["mesh"]
    plan = build(scene, samples_of(scene), is_solid(mesh)).compile((PICTURE,))

    def draw() -> None:
        renderer.gpu.drawn.clear()
        finished(renderer, plan)

    return draw


def seconds(way: Way) -> float:
    """Of the second of two calls; of the first where it takes so long that waking buffers does not matter."""
    taken = timed(way)
    return taken if taken > SLOW else timed(way)


def timed(way: Way) -> float:
    """Seconds of one call."""
    start = time.perf_counter()
    way()
    return time.perf_counter() - start


def in_rounds(
    ways: Mapping[Key, Way], baseline: Way, rounds: int, step: Callable[[], object] = lambda: None
) -> dict[Key, list[tuple[float, float]]]:
    """(milliseconds, mean of the baseline's right before and after) of each way, `rounds` of them.

    Each round has an order of its own, the same in every run. `step` is told of each picture.
    """
    taken: dict[Key, list[tuple[float, float]]] = {key: [] for key in ways}
    shuffled, order = random.Random(SEED), list(ways)
    for _ in range(rounds):
        shuffled.shuffle(order)
        before = 1e3 * seconds(baseline)
        for key in order:
            one = 1e3 * seconds(ways[key])
            after = 1e3 * seconds(baseline)
            taken[key].append((one, (before + after) / 2))
            before = after
            step()
    return taken


def timing(pairs: Sequence[tuple[float, float]], baseline_ms: float) -> Timing:
    """Of `pairs` (time, the baseline's), round by round."""
    return Timing(tuple(one / base for one, base in pairs), baseline_ms)


def faster(one: Sequence[float], other: Sequence[float]) -> bool:
    """Whether `one` takes less than `other`, told by the band of their ratios in the same rounds."""
    return median_band([a / b for a, b in zip(one, other, strict=True)])[1] < 1


def median_band(values: Sequence[float]) -> tuple[float, float]:
    """Between which two of `values` the true median lies with `coverage`; all of them where they are too few."""
    ordered = sorted(values)
    first = outside(len(ordered))
    return ordered[first], ordered[-1 - first]


def coverage(rounds: int) -> float:
    """How often the band of so many rounds holds the true median: 0.5 of two, 0.969 of six, 0.965 of fifteen."""
    return float(1 - 2 * binom.cdf(outside(rounds), rounds, 0.5))


def outside(rounds: int) -> int:
    """How many values at each end the narrowest band of `CONFIDENCE` leaves out; none where all do not reach it.

    The number of values below the median is binomial with p = 1/2 (e.g. Conover, *Practical Nonparametric
    Statistics*, 3rd ed. 1999, section 3.2).
    """
    return max(0, int(binom.ppf((1 - CONFIDENCE) / 2, rounds, 0.5)) - 1)
