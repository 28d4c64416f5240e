"""Combinations of knob levels, measured in one or several scenes; of several, the worst counts.

A combination's time is quoted as any other (`measuring`), its errors are against the exact picture of each scene, and
`from_reference` against the picture with every knob at its reference: what the knobs do, without what no knob mends.
What is baked costs no time in a picture, so baked knobs are not searched: they stay at their recommended levels. Of
levels that draw the same picture in every scene, one is searched.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.accuracy.errors import JUST_NOTICEABLE, errors
from fakesss.accuracy.measuring import Timing, Way, drawn, faster, in_rounds, timing
from fakesss.accuracy.measuring_knobs import ERRORS, Curve, Rig, error_facts
from fakesss.accuracy.tradeoff_search import Costs, Effects, Setting, below, front, pareto_local_search
from fakesss.knob import Knob, Value
from fakesss.scene import Scene

LOOKS = 3  # rounds of a combination while searching; what is kept is measured again with more


@dataclass(frozen=True)
class Combination:
    """One level of every knob, measured in each of the scenes."""

    values: Mapping[str, Value]  # by knob
    settings: Mapping[str, Any]  # by scene path
    timings: tuple[Timing, ...]
    errors: tuple[Mapping[str, float], ...]  # against the exact picture
    from_reference: tuple[Mapping[str, float], ...]  # against the picture with every knob at its reference

    @property
    def worst(self) -> Timing:
        """Of the scene in which it takes longest."""
        return max(self.timings, key=lambda one: one.ms)

    def faster(self, other: "Combination") -> bool:
        """Whether it can be told to take less time, in the scene where each takes longest in a round."""
        return faster(self.worst_ms, other.worst_ms)

    @property
    def worst_ms(self) -> list[float]:
        """Of each round, in the scene in which it took longest."""
        return [max(round_) for round_ in zip(*(timing.each_ms for timing in self.timings), strict=True)]

    def error(self, name: str) -> float:
        """The largest of any scene."""
        return max(found[name] for found in self.errors)

    @property
    def noticed(self) -> float:
        """FLIP from the reference that 99.9% of the pixels do not exceed, in the scene where it is largest."""
        return max(found["flip_everywhere"] for found in self.from_reference)

    @property
    def costs(self) -> Costs:
        """Milliseconds, mean FLIP from the exact picture, FLIP from the reference almost everywhere."""
        return self.worst.ms, self.error("flip"), self.noticed

    def facts(self) -> dict[str, Any]:
        """An entry of the document's `combinations`."""
        worst = {name: self.error(name) for name in ERRORS}
        each = [{**one.facts(), **found} for one, found in zip(self.timings, self.errors, strict=True)]
        several = {"scenes": each} if len(each) > 1 else {}
        return {
            "values": dict(self.values),
            "settings": dict(self.settings),
            **self.worst.facts(),
            **worst,
            "from_reference": {name: max(found[name] for found in self.from_reference) for name in ERRORS},
            **several,
        }


@dataclass(frozen=True)
class Place:
    """A scene whose knobs were measured one by one."""

    rig: Rig
    curves: Mapping[str, Curve]  # by knob's name, of the knobs that the scene uses

    @cached_property
    def baseline(self) -> Way:
        return drawn(self.rig.renderer, self.rig.scene)

    @cached_property
    def baseline_ms(self) -> float:
        """Of the picture beside which knobs were measured, over all of that (`on_one_baseline`)."""
        return next(iter(self.curves.values())).levels[0].timing.baseline_ms

    @cached_property
    def reference(self) -> NDArray[np.float32]:
        """The picture with every knob at its reference."""
        references = [curve.knob.reference.changes for curve in self.curves.values()]
        return self.rig.picture({path: value for changes in references for path, value in changes.items()})

    def scene(self, settings: Mapping[str, Any]) -> Scene:
        """With what of `settings` is of its knobs."""
        own = {path for curve in self.curves.values() for path in curve.knob.paths}
        return self.rig.scene.replace({path: value for path, value in settings.items() if path in own})


@dataclass(frozen=True)
class Combinations:
    """The search over the knobs of some scenes."""

    places: Sequence[Place]
    knobs: tuple[Knob, ...]  # used by one of the scenes

    @property
    def searched(self) -> tuple[Knob, ...]:
        return tuple(knob for knob in self.knobs if not knob.baked)

    def curves(self, knob: Knob) -> list[Curve]:
        """In every scene that uses it."""
        return [place.curves[knob.name] for place in self.places if knob.name in place.curves]

    @property
    def effects(self) -> Effects:
        """What each level does alone: milliseconds and errors in the scene where they are worst."""
        return [[self.effect(knob, number) for number in self.distinct[knob.name]] for knob in self.searched]

    @cached_property
    def distinct(self) -> dict[str, list[int]]:
        """Places of each searched knob's levels that draw a picture of their own in one of the scenes."""
        return {knob.name: distinct(self.curves(knob)) for knob in self.searched}

    @property
    def best(self) -> Setting:
        """The most exact level of every searched knob."""
        return tuple(
            next(rank for rank, place in enumerate(self.distinct[knob.name]) if same(self.curves(knob), place, best))
            for knob, best in ((knob, knob.best_place) for knob in self.searched)
        )

    def effect(self, knob: Knob, number: int) -> Costs:
        """Of one level of one knob."""
        idle = [place.baseline_ms for place in self.places if knob.name not in place.curves]
        levels = [curve.levels[number] for curve in self.curves(knob)]
        worst = [max(getattr(level.errors, name) for level in levels) for name in ("flip", "flip_everywhere")]
        return (max([*idle, *(level.timing.ms for level in levels)]), *worst)

    def recommended(self, knob: Knob) -> Value:
        """The level recommended in every scene: the most exact of them."""
        values = [level.value for level in knob.levels]
        return max((curve.recommended.value for curve in self.curves(knob)), key=values.index)

    def values(self, setting: Setting) -> dict[str, Value]:
        """The level of every knob."""
        places = dict(zip((knob.name for knob in self.searched), setting, strict=True))

        def value(knob: Knob) -> Value:
            if knob.name not in places:
                return self.recommended(knob)
            return knob.levels[self.distinct[knob.name][places[knob.name]]].value

        return {knob.name: value(knob) for knob in self.knobs}

    def settings(self, values: Mapping[str, Value]) -> dict[str, Any]:
        """The scene fields that these levels are."""
        levels = [knob.level(values[knob.name]) for knob in self.knobs]
        return {path: value for level in levels for path, value in level.changes.items()}

    def search(self, budget: int, step: Callable[[], object]) -> list[dict[str, Value]]:
        """The values worth measuring well: what nothing else beats, of at most `budget` that were looked at.

        Beyond the budget, what is cheaper than the cheapest that is not noticeably off, one step of one knob away.
        """

        def look(setting: Setting) -> Costs:
            found = self.measured([self.values(setting)], LOOKS)[0]
            step()
            return found.costs

        found = pareto_local_search(self.effects, self.best, look, budget)
        below(found, self.effects, look, lambda costs: costs[2] < JUST_NOTICEABLE)
        return [self.values(setting) for setting in front(found)]

    def measured(self, all_values: Sequence[Mapping[str, Value]], rounds: int) -> list[Combination]:
        """These combinations, in turn with one another and the baseline, scene after scene."""
        settings = [self.settings(values) for values in all_values]
        by_scene = [kept(place, settings, rounds) for place in self.places]
        times, exact, from_reference = zip(*by_scene, strict=True)

        def of(number: int, found: Sequence[Sequence[Any]]) -> tuple[Any, ...]:
            return tuple(each[number] for each in found)

        return [
            Combination(values, chosen, of(number, times), of(number, exact), of(number, from_reference))
            for number, (values, chosen) in enumerate(zip(all_values, settings, strict=True))
        ]


def distinct(curves: Sequence[Curve]) -> list[int]:
    """Places of the levels of one knob, one of those that draw the same in all scenes."""
    groups: list[list[int]] = []
    for place in range(len(curves[0].levels)):
        alike = next((group for group in groups if same(curves, place, group[0])), None)
        if alike is None:
            groups.append([place])
        else:
            alike.append(place)
    return [plainest(curves, group) for group in groups]


def plainest(curves: Sequence[Curve], group: Sequence[int]) -> int:
    """Of levels that draw the same the cheapest; the best of all, unless that can be told to be slower."""
    cheapest = min(group, key=lambda place: sum(curve.levels[place].timing.ms for curve in curves))
    best = curves[0].knob.best_place
    slower = any(curve.levels[cheapest].faster(curve.levels[best]) for curve in curves)
    return best if best in group and not slower else cheapest


def same(curves: Sequence[Curve], one: int, other: int) -> bool:
    """Whether two levels draw the same pictures."""
    return all(np.array_equal(curve.levels[one].picture, curve.levels[other].picture) for curve in curves)


def kept(
    place: Place, settings: Sequence[Mapping[str, Any]], rounds: int
) -> tuple[list[Timing], list[dict[str, float]], list[dict[str, float]]]:
    """Times and both kinds of errors of each of `settings` in one scene: of now, or of the run that was interrupted."""
    scenes = [place.scene(one) for one in settings]

    def make() -> dict[str, NDArray[Any]]:
        """Errors (N, 2, facts) to the exact picture and to the best, and seconds of N and of the baseline, in turn."""
        pictures = [place.rig.renderer.render(scene).image for scene in scenes]
        found = [[errors(picture, truth) for truth in (place.rig.exact, place.reference)] for picture in pictures]
        ways = {number: drawn(place.rig.renderer, scene) for number, scene in enumerate(scenes)}
        pairs = in_rounds(ways, place.baseline, rounds)
        numbers = [[list(error_facts(one).values()) for one in both] for both in found]
        return {"times": np.array([pairs[number] for number in ways]), "errors": np.array(numbers)}

    what = {"scenes": [scene.model_dump(mode="json") for scene in scenes], "rounds": rounds}
    shapes = {"times": (len(scenes), rounds, 2), "errors": (len(scenes), 2, len(ERRORS))}
    arrays, _ = place.rig.kept(what, shapes, make)
    times = [timing([(one, base) for one, base in each], place.baseline_ms) for each in arrays["times"]]
    exact, from_reference = (
        [dict(zip(ERRORS, map(float, row), strict=True)) for row in arrays["errors"][:, which]] for which in (0, 1)
    )
    return times, exact, from_reference
