"""The experiments of the calibration study: who rates what, and which claims are judged on it."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from analysis.statistics.undefined import Floats
from benchmarks import calibration_batches as batches
from benchmarks import calibration_cases as cases
from benchmarks.calibration_cases import UNEQUAL, Crowd, Gallery

MIDDLE, CEILING = 4.0, 6.3
APART = (3.7, 4.0, 4.6)
KINDS = (("normal", MIDDLE, False), ("7 steps", MIDDLE, True), ("7 steps, ceiling", CEILING, True))
QUICK, MANY, FEW = 200_000, 4000, 600
AT_ONCE = 1000

Says = Mapping[str, bool | Floats]


@dataclass(frozen=True)
class Experiment:
    """`name`: a heading of its own, if any, then ": " and the ratings as the table names them.

    `draw` makes `at_once` studies, `judge` says of each whether each claim held (one study: a bool; more: 0.0, 1.0, or
    NaN where there was no value). `studies`: how many a full run has, a multiple of `at_once`.
    """

    name: str
    draw: Callable[[np.random.Generator], Any]
    judge: Callable[[Any], Says]
    studies: int
    at_once: int = 1


def batch(crowd: Crowd, judge: Callable[[Floats], Says], studies: int = QUICK, at_once: int = AT_ONCE) -> Experiment:
    """Thousands of studies, many at once."""
    return Experiment(crowd.name, partial(crowd.answers, studies=at_once), judge, studies, at_once)


def experiments() -> list[Experiment]:
    """All of them, in the order of the table."""
    return [*between(), *within(), *models(), *pairs(), *chance(), *intervals(), *raters()]


def between() -> Iterator[Experiment]:
    """Samples of different people, nothing differs."""
    for name, mean, steps in KINDS:
        crowd = Crowd(f"{name}, 3 x 20 people", 20, (mean,) * 3, steps, independent=True)
        yield batch(crowd, partial(batches.no_effect_between, truth=crowd.truth))


def within() -> Iterator[Experiment]:
    """The same people, nothing differs in the mean."""
    crowds = (
        Crowd("normal, spherical, 20 people x 4", 20, (MIDDLE,) * 4),
        Crowd("normal, sphericity broken, 20 people x 4", 20, (MIDDLE,) * 4, noises=UNEQUAL),
        Crowd("7 steps, 20 people x 4", 20, (MIDDLE,) * 4, steps=True),
        Crowd("7 steps, ceiling, 20 people x 4", 20, (CEILING,) * 4, steps=True),
        Crowd("7 steps, sphericity broken, 20 people x 4", 20, (MIDDLE,) * 4, steps=True, noises=UNEQUAL),
        Crowd("7 steps, 8 people x 4", 8, (MIDDLE,) * 4, steps=True),
    )
    for crowd in crowds:
        yield batch(crowd, batches.no_effect_within)


def models() -> Iterator[Experiment]:
    """The same people: interactions, and regressions instead of analyses of variance."""
    for name, steps in (("normal", False), ("7 steps", True)):
        yield batch(Crowd(f"crossed: {name}, 20 people x 6", 20, (MIDDLE,) * 6, steps), batches.crossed)
    crowds = (
        Crowd("models: 7 steps, 44 people x 4", 44, (MIDDLE,) * 4, steps=True),
        Crowd("models: 7 steps, 20 people x 4", 20, (MIDDLE,) * 4, steps=True),
        Crowd("models: 7 steps, 8 people x 4", 8, (MIDDLE,) * 4, steps=True),
        Crowd("models: 7 steps, ceiling, 20 people x 4", 20, (CEILING,) * 4, steps=True),
        Crowd("models: 7 steps, sphericity broken, 20 people x 4", 20, (MIDDLE,) * 4, steps=True, noises=UNEQUAL),
    )
    for crowd in crowds:
        yield Experiment(crowd.name, crowd.frame, cases.models, FEW)
    for pictures in (3, 6):
        name = f"pictures: 7 steps, 20 people x 3 levels of {pictures} random pictures"
        draw = partial(cases.random_pictures, people=20, pictures=pictures, spread=0.5)
        yield Experiment(name, draw, cases.picture_models, FEW // 2)


def pairs() -> Iterator[Experiment]:
    """Two pictures: of one mean, and exactly one margin apart."""
    for name, mean, steps in KINDS:
        alike = Crowd(f"{name}, 44 people x 2", 44, (mean,) * 2, steps)
        yield Experiment(alike.name, alike.frame, cases.two_alike, MANY)
        apart = Crowd(f"{name}, 44 people x 2, 0.8 apart", 44, (mean, mean + 0.8), steps)
        yield batch(apart, partial(batches.at_the_margin, truth=apart.truth, independent=False))
        others = Crowd(f"{name}, 2 x 44 people, 0.8 apart", 44, (mean, mean + 0.8), steps, independent=True)
        yield batch(others, partial(batches.at_the_margin, truth=others.truth, independent=True))


def chance() -> Iterator[Experiment]:
    """What is picked because it stands out, or lines up, in these very ratings."""
    for own, studies, at_once in ((2, QUICK, AT_ONCE), (9, QUICK, AT_ONCE), (100, QUICK // 10, 100)):
        crowd = Crowd(f"7 steps, 20 people, best of {own}", 20, (MIDDLE,) * (own + 1), steps=True)
        yield batch(crowd, batches.picked, studies, at_once)
    for pictures in (9, 30):
        draw = partial(cases.random_cues, people=20, pictures=pictures)
        name = f"7 steps, 20 people x {pictures} random pictures, three cues"
        yield Experiment(name, draw, cases.cues_of_chance, 2 * FEW)


def intervals() -> Iterator[Experiment]:
    """Pictures of unlike means."""
    for name, steps in (("normal", False), ("7 steps", True)):
        crowd = Crowd(f"{name}, unlike means, 3 x 20 people", 20, APART, steps, independent=True)
        yield batch(crowd, partial(batches.effect_between, truth=crowd.truth))
        if not steps:
            yield sizes(crowd, partial(cases.effect_size_between, crowd=crowd))
        crowd = Crowd(f"{name}, unlike means, 20 people x 3", 20, APART, steps)
        yield batch(crowd, partial(batches.effect_within, truth=crowd.truth))
        if not steps:
            yield sizes(crowd, partial(cases.effect_sizes_within, crowd=crowd))
    crowd = Crowd("normal, unlike means, sphericity broken, 20 people x 4", 20, (*APART, 4.0), noises=UNEQUAL)
    yield batch(crowd, partial(batches.effect_within, truth=crowd.truth))
    yield sizes(crowd, partial(cases.effect_sizes_within, crowd=crowd))


def sizes(crowd: Crowd, judge: Callable[[Any], Says]) -> Experiment:
    """Intervals of effect sizes, which take the public objects."""
    return Experiment(f"effect sizes: {crowd.name}", crowd.frame, judge, 2 * FEW)


def raters() -> Iterator[Experiment]:
    """Pictures drawn at random, rated by people drawn at random."""
    for name, pictures, steps in (("normal", 15, False), ("7 steps", 15, True), ("7 steps", 60, True)):
        gallery = Gallery(f"{name}, 20 people x {pictures} random pictures", 20, pictures, steps)
        yield Experiment(gallery.name, gallery.frame, partial(cases.agreement, gallery=gallery), FEW // 2)
