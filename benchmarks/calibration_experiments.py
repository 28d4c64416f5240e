"""The experiments of the calibration study: who rates what, and which claims are judged on it."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from benchmarks import calibration_cases as cases
from benchmarks.calibration_cases import UNEQUAL, Crowd, Draw, Gallery, Judge

MIDDLE, CEILING = 4.0, 6.3
APART = (3.7, 4.0, 4.6)
KINDS = (("normal", MIDDLE, False), ("7 steps", MIDDLE, True), ("7 steps, ceiling", CEILING, True))


@dataclass(frozen=True)
class Experiment:
    """`name`: a heading of its own, if any, then ": " and the ratings as the table names them. `share`: of the
    simulations asked for; slow ones are run less often, quick ones more."""

    name: str
    draw: Draw
    judge: Judge
    share: float = 1.0


def experiments() -> list[Experiment]:
    """All of them, in the order of the table."""
    return [*between(), *within(), *models(), *pairs(), *intervals(), *raters()]


def between() -> Iterator[Experiment]:
    """Samples of different people, nothing differs."""
    for name, mean, steps in (
        ("normal", MIDDLE, False),
        ("7 steps", MIDDLE, True),
        ("7 steps, ceiling", CEILING, True),
    ):
        crowd = Crowd(f"{name}, 3 x 20 people", 20, (mean,) * 3, steps, independent=True)
        yield Experiment(crowd.name, crowd.frame, partial(cases.no_effect_between, crowd=crowd))


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
        yield Experiment(crowd.name, crowd.frame, cases.no_effect_within)


def models() -> Iterator[Experiment]:
    """The same people: interactions, and regressions instead of analyses of variance."""
    for name, steps in (("normal", False), ("7 steps", True)):
        crowd = Crowd(f"crossed: {name}, 20 people x 6", 20, (MIDDLE,) * 6, steps)
        yield Experiment(crowd.name, crowd.frame, cases.crossed)
    crowds = (
        Crowd("models: 7 steps, 44 people x 4", 44, (MIDDLE,) * 4, steps=True),
        Crowd("models: 7 steps, 20 people x 4", 20, (MIDDLE,) * 4, steps=True),
        Crowd("models: 7 steps, 8 people x 4", 8, (MIDDLE,) * 4, steps=True),
        Crowd("models: 7 steps, ceiling, 20 people x 4", 20, (CEILING,) * 4, steps=True),
        Crowd("models: 7 steps, sphericity broken, 20 people x 4", 20, (MIDDLE,) * 4, steps=True, noises=UNEQUAL),
    )
    for crowd in crowds:
        yield Experiment(crowd.name, crowd.frame, cases.models)
    for pictures, share in ((3, 1.0), (6, 0.3)):
        name = f"pictures: 7 steps, 20 people x 3 levels of {pictures} random pictures"
        draw = partial(cases.random_pictures, people=20, pictures=pictures, spread=0.5)
        yield Experiment(name, draw, cases.picture_models, share)


def pairs() -> Iterator[Experiment]:
    """Two pictures: of one mean, and exactly one margin apart."""
    for name, mean, steps in (
        ("normal", MIDDLE, False),
        ("7 steps", MIDDLE, True),
        ("7 steps, ceiling", CEILING, True),
    ):
        alike = Crowd(f"{name}, 44 people x 2", 44, (mean,) * 2, steps)
        yield Experiment(alike.name, alike.frame, cases.two_alike)
        apart = Crowd(f"{name}, 44 people x 2, 0.8 apart", 44, (mean, mean + 0.8), steps)
        yield Experiment(apart.name, apart.frame, partial(cases.at_the_margin, crowd=apart), share=4)
        others = Crowd(f"{name}, 2 x 44 people, 0.8 apart", 44, (mean, mean + 0.8), steps, independent=True)
        yield Experiment(others.name, others.frame, partial(cases.at_the_margin, crowd=others), share=4)


def intervals() -> Iterator[Experiment]:
    """Pictures of unlike means."""
    for name, steps in (("normal", False), ("7 steps", True)):
        crowd = Crowd(f"{name}, unlike means, 3 x 20 people", 20, APART, steps, independent=True)
        yield Experiment(crowd.name, crowd.frame, partial(cases.effect_between, crowd=crowd))
        crowd = Crowd(f"{name}, unlike means, 20 people x 3", 20, APART, steps)
        yield Experiment(crowd.name, crowd.frame, partial(cases.effect_within, crowd=crowd))
    crowd = Crowd("normal, unlike means, sphericity broken, 20 people x 4", 20, (*APART, 4.0), noises=UNEQUAL)
    yield Experiment(crowd.name, crowd.frame, partial(cases.effect_within, crowd=crowd))


def raters() -> Iterator[Experiment]:
    """Pictures drawn at random, rated by people drawn at random."""
    for name, pictures, steps in (("normal", 15, False), ("7 steps", 15, True), ("7 steps", 60, True)):
        gallery = Gallery(f"{name}, 20 people x {pictures} random pictures", 20, pictures, steps)
        yield Experiment(gallery.name, gallery.frame, partial(cases.agreement, gallery=gallery), share=0.5)
