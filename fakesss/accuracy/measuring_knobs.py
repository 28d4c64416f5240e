"""One knob at a time: what each level costs and is off by, all other knobs at their best.

A few knobs multiply every other cost, or are what pictures are drawn with: while another is measured they stay where
their modules say (`Knob.beside`), not at their references. A level's error is that of its picture against the picture
of the knob's reference, so it is this knob's own; `total` is against the exact picture, with what all the other knobs
are still off by.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.accuracy.convergence import fitted_order
from fakesss.accuracy.errors import JUST_NOTICEABLE, Errors, errors
from fakesss.accuracy.measuring import Timing, drawn, faster, in_rounds, measuring_renderer, timing
from fakesss.accuracy.pareto import unbeaten
from fakesss.accuracy.tradeoff_kept import Kept
from fakesss.frame_graph import Bake
from fakesss.inspect import compiled
from fakesss.knob import Knob, Value
from fakesss.renderer import Renderer
from fakesss.savings import baking_seconds
from fakesss.scene import Scene

Floats32 = NDArray[np.float32]
NEARER = ", or cannot be told to be slower than that, and is nearer to the reference"
FEWEST = 3  # points that an order is fitted to
ERRORS = ("rmse", "max_abs", "flip", "flip_everywhere")  # the document's names


@dataclass
class Rig:
    """A scene with every knob in its place beside the one that is measured, and what it is compared with."""

    scene: Scene
    exact: Floats32  # (H, W, 4), the exact picture
    rounds: int
    kept: Kept
    renderer: Renderer
    step: Callable[[], object]  # told of each picture that was timed

    @classmethod
    def of(
        cls, scene: Scene, knobs: Sequence[Knob], exact: Floats32, rounds: int, kept: Kept, step: Callable[[], object]
    ) -> "Rig":
        beside = {path: value for knob in knobs for path, value in knob.besides.changes.items()}
        return cls(scene.replace(beside), exact, rounds, kept, measuring_renderer(), step)

    def picture(self, changes: Mapping[str, Any]) -> Floats32:
        """With so much otherwise."""
        return self.renderer.render(self.scene.replace(changes)).image


@dataclass(frozen=True)
class MeasuredLevel:
    """One level of a knob, measured."""

    value: Value
    changes: Mapping[str, Any]
    timing: Timing
    errors: Errors  # against the knob's reference
    total: Errors  # against the exact picture
    bake_seconds: float | None
    picture: Floats32

    @property
    def cost(self) -> float:
        """Seconds of a bake, milliseconds of anything else."""
        return self.timing.ms if self.bake_seconds is None else self.bake_seconds

    @property
    def off(self) -> tuple[float, float]:
        """FLIP from the reference that 99.9% of the pixels do not exceed, and its mean."""
        return self.errors.flip_everywhere, self.errors.flip

    def faster(self, other: "MeasuredLevel") -> bool:
        """Whether it can be told to cost less. A bake is measured once: of two the lesser seconds count."""
        if self.bake_seconds is not None and other.bake_seconds is not None:
            return self.bake_seconds < other.bake_seconds
        return faster(self.timing.ratios, other.timing.ratios)

    def facts(self) -> dict[str, Any]:
        """A point of the `tradeoff` document."""
        baked = {} if self.bake_seconds is None else {"bake_seconds": self.bake_seconds}
        times = {"value": self.value, "settings": dict(self.changes), **self.timing.facts(), **baked}
        return {**times, **error_facts(self.errors), "total": error_facts(self.total)}


def error_facts(found: Errors) -> dict[str, float]:
    """Errors by the document's names."""
    return {name: float(getattr(found, name)) for name in ERRORS}


@dataclass(frozen=True)
class Curve:
    """A knob's levels, measured."""

    knob: Knob
    levels: tuple[MeasuredLevel, ...]
    reference: Floats32

    @property
    def limit(self) -> float:
        """FLIP that 99.9% of the pixels shall stay below.

        A third of just noticeable for what is baked: it costs a picture nothing, so it shall leave room to what does.
        """
        return float(JUST_NOTICEABLE / 3 if self.knob.baked else JUST_NOTICEABLE)

    @property
    def recommended(self) -> MeasuredLevel:
        """The cheapest whose difference from the reference stays below the limit; the best where none does.

        Of levels whose times cannot be told apart from the cheapest's, the most exact.
        """
        fine = [level for level in self.levels if level.errors.flip_everywhere < self.limit]
        return self.most_exact(self.alike(fine) if fine else self.levels)

    def alike(self, levels: Sequence[MeasuredLevel]) -> list[MeasuredLevel]:
        """The cheapest of them, and what cannot be told to be slower."""
        cheapest = min(levels, key=lambda level: level.cost)
        return [level for level in levels if not cheapest.faster(level)]

    def most_exact(self, levels: Sequence[MeasuredLevel]) -> MeasuredLevel:
        """Of equal pictures the reference's own, else the cheaper."""
        own = self.knob.reference.value
        return min(levels, key=lambda level: (*level.off, level.value != own, level.cost))

    def facts(self) -> dict[str, Any]:
        """An entry of the document's `knobs`."""
        levels = self.levels
        front = unbeaten([(level.errors.flip,) for level in levels], lambda a, b: levels[a].faster(levels[b]))
        return {
            "name": self.knob.name,
            "sets": list(self.knob.paths),
            "reference": self.knob.reference.value,
            "error": self.knob.error,
            "baked": bool(self.knob.baked),
            "order": order(self.knob, self.levels),
            "points": [level.facts() for level in self.levels],
            "pareto": [self.levels[place].value for place in front],
            "recommended": self.recommended.value,
            "because": self.because,
        }

    @property
    def because(self) -> str:
        """Why that level."""
        limit = f"a FLIP of {self.limit:.3f} in 99.9% of the pixels"
        if self.recommended.errors.flip_everywhere >= self.limit:
            return f"the smallest error; none stays below {limit}"
        cheapest = min((level for level in self.levels if level.off[0] < self.limit), key=lambda level: level.cost)
        return f"the cheapest below {limit}" + (NEARER if cheapest is not self.recommended else "")


def measured(rig: Rig, knob: Knob) -> Curve:
    """Every level of `knob`, in turn with the picture beside it."""
    reference = rig.picture(knob.reference.changes)
    times, seconds = kept_times(rig, knob)
    baseline_ms = float(np.median(times[..., 1]))
    made = []
    for place, level in enumerate(knob.levels):
        picture = rig.picture(level.changes)
        made.append(
            MeasuredLevel(
                level.value,
                level.changes,
                timing([(one, base) for one, base in times[place]], baseline_ms),
                errors(picture, reference),
                errors(picture, rig.exact),
                seconds[place] if knob.baked else None,
                picture,
            )
        )
    return Curve(knob, tuple(made), reference)


def kept_times(rig: Rig, knob: Knob) -> tuple[NDArray[np.float64], list[float]]:
    """(levels, rounds, 2) milliseconds of each level and of the picture beside it; seconds of each level's bake."""

    def make() -> dict[str, NDArray[Any]]:
        """The two lists, as arrays that can be kept."""
        # what is baked differently is drawn alike, so one level stands for all
        timed = knob.levels[:1] if knob.baked else knob.levels
        ways = {level.value: drawn(rig.renderer, rig.scene.replace(level.changes)) for level in timed}
        pairs = in_rounds(ways, drawn(rig.renderer, rig.scene), rig.rounds, rig.step)
        times = np.array([pairs.get(level.value, pairs[timed[0].value]) for level in knob.levels])
        return {"times": times, "seconds": np.array([bake(rig, knob, level.changes) for level in knob.levels])}

    shapes = {"times": (len(knob.levels), "rounds", 2), "seconds": (len(knob.levels),)}
    what = {"knob": knob.name, "levels": [str(level.value) for level in knob.levels], "rounds": rig.rounds}
    arrays, there = rig.kept({**what, "scene": rig.scene.model_dump(mode="json")}, shapes, make)
    if there:
        for _ in range(arrays["times"].shape[0] * arrays["times"].shape[1]):
            rig.step()
    return arrays["times"], [float(each) for each in arrays["seconds"]]


def bake(rig: Rig, knob: Knob, changes: Mapping[str, Any]) -> float:
    """Seconds of what `knob` bakes, without any cache; 0 where it bakes nothing."""
    if not knob.baked:
        return 0.0
    scene = rig.scene.replace(changes)
    nodes = [node for node in compiled(scene).kept if isinstance(node, Bake) and node.name == knob.baked]
    return baking_seconds(rig.renderer, scene, nodes)


def on_one_baseline(curves: Mapping[str, Curve]) -> dict[str, Curve]:
    """Milliseconds of all `curves` by the median of their baselines: that picture is the same for every knob."""
    baseline_ms = float(np.median([level.timing.baseline_ms for curve in curves.values() for level in curve.levels]))

    def timed(level: MeasuredLevel) -> MeasuredLevel:
        return replace(level, timing=replace(level.timing, baseline_ms=baseline_ms))

    return {name: replace(curve, levels=tuple(map(timed, curve.levels))) for name, curve in curves.items()}


def order(knob: Knob, levels: Sequence[MeasuredLevel]) -> dict[str, float] | None:
    """p of an RMSE that falls as value^-p, by least squares of the logarithms; None where the levels are no numbers.

    Half of the reference and what is beyond is left out: what the reference itself is off by shows there.
    """
    if knob.order is None:
        return None
    known = [(int(level.value), level.errors.rmse) for level in levels if level.errors.rmse > 0]
    points = [point for point in known if 2 * point[0] < int(knob.reference.value)]
    if len(points) < FEWEST:
        return None
    counts, left = zip(*points, strict=True)
    found = fitted_order(counts, left)
    return {"fitted": found.order, "low": found.ci_low, "high": found.ci_high, "expected": knob.order}
