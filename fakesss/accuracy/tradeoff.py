"""`fakesss tradeoff`: what accuracy costs in time, knob by knob and in combination, and the settings worth it.

1. The exact picture of the scene (`exact.exact_picture`): slow, kept by content.
2. Every knob that the scene uses, alone (`measuring_knobs`).
3. Pareto local search over combinations (`tradeoff_search`), and what was found good measured again.
4. Three presets among them (`presets`).

Several scenes are searched together: a combination then counts as it does where it is worst.
"""

from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass
from typing import Any

from tqdm import tqdm

from fakesss.accuracy.errors import check_flip
from fakesss.accuracy.exact import exact_picture
from fakesss.accuracy.measuring import load_now
from fakesss.accuracy.measuring_combinations import Combination, Combinations, Place
from fakesss.accuracy.measuring_knobs import Rig, measured, on_one_baseline
from fakesss.accuracy.presets import BUDGET_MS, Preset, chosen
from fakesss.accuracy.tradeoff_kept import Kept
from fakesss.gpu import renderer_facts
from fakesss.knob import Knob, knobs
from fakesss.problem import BadInput, nearest
from fakesss.scene import Scene


@dataclass(frozen=True)
class Effort:
    """How often pictures are timed, and how many combinations are looked at."""

    rounds: int  # of a knob's levels
    combinations: int
    again: int  # rounds of the combinations that are worth it


THOROUGH = Effort(rounds=15, combinations=60, again=9)
QUICK = Effort(rounds=6, combinations=16, again=6)


@dataclass(frozen=True)
class Found:
    """What one run measured."""

    scenes: tuple[Scene, ...]  # as they were asked for, without quality
    places: tuple[Place, ...]  # of each scene
    asked: tuple[Knob, ...]
    combinations: Combinations
    measured: tuple[Combination, ...]  # by rising time
    presets: dict[str, Preset]
    effort: Effort
    budget_ms: float
    load: float | None  # of the machine when it began
    kept: Kept  # to be forgotten once all is written


def tradeoff(
    scenes: Sequence[Scene],
    names: Sequence[str] = (),
    effort: Effort = THOROUGH,
    budget_ms: float = BUDGET_MS,
    quiet: bool | None = None,
) -> Found:
    """Measure the knobs `names` (all, where none is named) in `scenes`.

    An interrupted run continues, and so does one whose results were not written: what is measured stays until
    `kept.forget()` is called of what this returns.

    `quiet` hides the progress bar; None shows it on a terminal. Raises `BadInput` for an unknown knob, one that no
    scene uses, and a scene that shows nothing.
    """
    scenes = tuple(scene.replace({"quality": None}) for scene in scenes)
    asked = named(names)
    used = [tuple(knob for knob in asked if not knob.unused(scene)) for scene in scenes]
    check(scenes, asked, used)
    check_flip()
    truths = [exact_picture(scene) for scene in scenes]
    load = load_now()
    kept = Kept({**renderer_facts(), "knobs": names, "effort": astuple(effort)})
    with tqdm(total=steps(used, effort), desc="tradeoff", unit="picture", disable=True if quiet else None) as bar:
        places = []
        for scene, own, exact in zip(scenes, used, truths, strict=True):
            rig = Rig.of(scene, own, exact, effort.rounds, kept, bar.update)
            places.append(Place(rig, on_one_baseline({knob.name: measured(rig, knob) for knob in own})))
        found = Combinations(tuple(places), tuple(knob for knob in asked if any(knob in own for own in used)))
        good, reference = searched(found, effort, bar.update)
    presets = chosen(good, reference, budget_ms)
    return Found(scenes, tuple(places), asked, found, tuple(good), presets, effort, budget_ms, load, kept)


def named(names: Sequence[str]) -> tuple[Knob, ...]:
    """The knobs of these names, all of them where there are no names."""
    known = {knob.name: knob for knob in knobs()}
    for name in names:
        if name not in known:
            raise BadInput(f'--knob "{name}": is no knob; {nearest(name, known)}')
    return tuple(known[name] for name in names) or knobs()


def check(scenes: Sequence[Scene], asked: Sequence[Knob], used: Sequence[Sequence[Knob]]) -> None:
    """`BadInput` where there is nothing to measure."""
    for scene, own in zip(scenes, used, strict=True):
        if not own:
            reasons = "; ".join(f"{knob.name}: {knob.unused(scene)}" for knob in asked)
            raise BadInput(f"tradeoff: {scene.object}: uses none of the knobs ({reasons}); change the scene")


def steps(used: Sequence[Sequence[Knob]], effort: Effort) -> int:
    """Of the progress bar: pictures timed one knob at a time, and combinations looked at."""
    timed = sum(1 if knob.baked else len(knob.levels) for own in used for knob in own)
    return timed * effort.rounds + effort.combinations


def searched(found: Combinations, effort: Effort, step: Callable[[], object]) -> tuple[list[Combination], Combination]:
    """The combinations that are worth their time, measured well, and the best of every knob."""
    good = found.search(effort.combinations, step)
    best = {knob.name: knob.reference.value for knob in found.knobs}
    measured = found.measured([*(values for values in good if values != best), best], effort.again)
    reference = measured[-1]
    return sorted(measured, key=lambda one: one.worst.ms), reference


def pictures(place: Place) -> dict[tuple[str, str], Any]:
    """The picture of every level by knob and value, those of the knobs' references, and ("", "reference")."""
    made: dict[tuple[str, str], Any] = {("", "reference"): place.rig.exact}
    for name, curve in place.curves.items():
        made |= {(name, str(level.value)): level.picture for level in curve.levels}
        made[name, str(curve.knob.reference.value)] = curve.reference
    return made
