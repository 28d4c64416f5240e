"""Times of pictures that are compared with one another, drawn in turn within one run.

A machine's speed drifts by more than two settings differ. So a round draws every picture and a fixed *baseline* once,
and what is quoted is the ratio of the two within a round: the median over rounds, with the band in which the true
median lies with 95% confidence, from order statistics (no distribution assumed). Milliseconds are that ratio times
the median of the baseline over the whole run. A picture counts from the call until OpenGL has finished it, on
processor and GPU; it is not read back. Before each, the same is drawn once without counting, since buffers of another
size or mesh were just in use. Shadow maps are drawn anew, as they are when light, camera or object move.
"""

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

CONFIDENCE = 0.95
SLOW = 2.0  # seconds of a picture
BAKES_KEPT = 64  # every level of a few baked knobs, so that no picture waits for the disk
Key = TypeVar("Key", bound=Hashable)
Way = Callable[[], object]


@dataclass(frozen=True)
class Timing:
    """A time beside the baseline's: ratios and milliseconds, with their 95% band."""

    ratio: float
    ratio_low: float
    ratio_high: float
    baseline_ms: float

    @property
    def ms(self) -> float:
        return self.ratio * self.baseline_ms

    def facts(self) -> dict[str, float]:
        """The keys of a point in the `tradeoff` document."""
        return {
            "ms": self.ms,
            "ms_low": self.ratio_low * self.baseline_ms,
            "ms_high": self.ratio_high * self.baseline_ms,
            "ratio": self.ratio,
            "ratio_low": self.ratio_low,
            "ratio_high": self.ratio_high,
        }


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
    """(milliseconds, the baseline's in the same round) of each way, `rounds` of them; `step` is told of each."""
    taken: dict[Key, list[tuple[float, float]]] = {key: [] for key in ways}
    for _ in range(rounds):
        before = 1e3 * seconds(baseline)
        for key, way in ways.items():
            taken[key].append((1e3 * seconds(way), before))
            step()
    return taken


def timing(pairs: Sequence[tuple[float, float]], baseline_ms: float) -> Timing:
    """The median ratio of `pairs` (time, the baseline's) and its band."""
    ratios = [one / base for one, base in pairs]
    return Timing(statistics.median(ratios), *median_band(ratios), baseline_ms)


def median_band(values: Sequence[float]) -> tuple[float, float]:
    """Between which two of `values` the true median lies with 95% confidence; all of them where they are too few.

    The number of values below the median is binomial with p = 1/2 (e.g. Conover, *Practical Nonparametric
    Statistics*, 3rd ed. 1999, section 3.2).
    """
    ordered = sorted(values)
    outside = int(binom.ppf((1 - CONFIDENCE) / 2, len(ordered), 0.5))
    first = max(0, outside - 1)
    return ordered[first], ordered[-1 - first]
