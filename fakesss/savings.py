"""What leaving out an effect saves, measured against the same picture with the effect forced on at weight zero."""

import os
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from fakesss.calls import EFFECTS
from fakesss.frame_graph import Bake, Plan
from fakesss.memory import peak_bytes
from fakesss.renderer import Renderer, shared_renderer
from fakesss.scene import Scene

REPEATS = 7  # of each of the two pictures, in turn
NONE: frozenset[str] = frozenset()


def in_vain(scene: Scene) -> dict[frozenset[str], str]:
    """The effects that `scene` leaves out because they weigh nothing, and why; those of one weight together.

    An effect that is switched off is none of them: with it the picture would be another.
    """
    groups: dict[Callable[[Scene], str], list[str]] = {}
    for name, effect in EFFECTS.items():
        if effect.weightless(scene) and not effect.off(scene):
            groups.setdefault(effect.weightless, []).append(name)
    return {frozenset(names): reason(scene) for reason, names in groups.items()}


def measured(scene: Scene, plan_with: Callable[[frozenset[str]], Plan], repeats: int = REPEATS) -> list[dict[str, Any]]:
    """One row for every group of `in_vain`; `plan_with` compiles the picture with effects forced on.

    Milliseconds are of the whole picture, from the call to its pixels, both kinds drawn in turn, the first of each not
    counted: `forced_ms` and `saved_ms` are the medians of the forced ones and of the differences in a turn, `noise_ms`
    is the median distance of those differences from their median. Bytes are of textures. `bake_seconds` is what only
    the forced picture bakes, without any cache.
    """
    renderer = shared_renderer()
    plan = plan_with(NONE)
    rows = []
    for effects, because in in_vain(scene).items():
        forced = plan_with(effects)
        rows.append(
            {
                "effects": sorted(effects),
                "because": because,
                "bytes": peak_bytes(plan),
                "forced_bytes": peak_bytes(forced),
                "bake_seconds": baking_seconds(renderer, scene, only_in(forced, plan)),
                **compared(renderer, scene, effects, repeats),
            }
        )
    return rows


def only_in(forced: Plan, plan: Plan) -> list[Bake]:
    """What is baked for `forced` and not for `plan`."""
    names = {node.name for node in plan.kept}
    return [node for node in forced.kept if isinstance(node, Bake) and node.name not in names]


def baking_seconds(renderer: Renderer, scene: Scene, nodes: list[Bake]) -> float:
    """How long it takes to make `nodes` when nothing is cached."""
    seconds = 0.0
    for node in nodes:
        inputs = renderer.data(scene, node.reads)
        with without_cache():
            start = time.perf_counter()
            node.make(inputs)
            seconds += time.perf_counter() - start
    return seconds


@contextmanager
def without_cache() -> Iterator[None]:
    """An empty cache that is thrown away afterwards."""
    before = os.environ.get("FAKESSS_CACHE")
    with tempfile.TemporaryDirectory() as empty:
        os.environ["FAKESSS_CACHE"] = empty
        try:
            yield
        finally:
            os.environ.pop("FAKESSS_CACHE")
            os.environ.update({"FAKESSS_CACHE": before} if before is not None else {})


def compared(renderer: Renderer, scene: Scene, effects: frozenset[str], repeats: int) -> dict[str, Any]:
    """Times with and without `effects`, and whether the two pictures have the same bytes."""
    without, forced = renderer.render(scene), renderer.render(scene, forced=effects)
    times: dict[frozenset[str], list[float]] = {NONE: [], effects: []}
    for _ in range(repeats):
        for kind, taken in times.items():
            start = time.perf_counter()
            renderer.render(scene, forced=kind)
            taken.append(1e3 * (time.perf_counter() - start))
    saved = [slow - fast for fast, slow in zip(times[NONE], times[effects], strict=True)]
    return {
        "forced_ms": statistics.median(times[effects]),
        "saved_ms": statistics.median(saved),
        "noise_ms": statistics.median(abs(one - statistics.median(saved)) for one in saved),
        "same_bytes": without.image.tobytes() == forced.image.tobytes(),
    }
