"""What is recommended, lies on the front, and is searched, of made-up times and errors."""

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from fakesss.accuracy.errors import JUST_NOTICEABLE, Errors
from fakesss.accuracy.measuring import Timing
from fakesss.accuracy.measuring_combinations import Combinations, Place
from fakesss.accuracy.measuring_knobs import Curve, MeasuredLevel, on_one_baseline, order
from fakesss.accuracy.tradeoff_document import others_of
from fakesss.knob import Knob, Value, knobs, levels

ROUNDS = 8
NOISE = np.array([0.97, 1.04, 1.0, 0.95, 1.06, 1.02, 0.98, 1.01])  # of a round, up to 6%


def named(name: str) -> Knob:
    return next(knob for knob in knobs() if knob.name == name)


def level(
    value: Value, time: float, everywhere: float, *, seconds: float | None = None, seed: int = 0, shade: float = 0.0
) -> MeasuredLevel:
    """Measured as `time` baselines, with noise of its own, and off by `everywhere`."""
    ratios = time * np.roll(NOISE, seed)
    off = Errors(everywhere / 20, everywhere, everywhere / 10, np.zeros((2, 2), np.float32), everywhere)
    picture = np.full((2, 2, 4), shade or everywhere, np.float32)
    return MeasuredLevel(value, {}, Timing(tuple(map(float, ratios)), 10.0), off, off, seconds, picture)


def curve(knob: Knob, *made: MeasuredLevel) -> Curve:
    return Curve(knob, made, np.zeros((2, 2, 4), np.float32))


def sampled(*made: tuple[Value, float, float]) -> Curve:
    """Of supersampling, whose reference is 8: value, time, FLIP in 99.9% of the pixels."""
    return curve(named("supersampling"), *(level(*each, seed=number) for number, each in enumerate(made)))


def test_the_cheapest_below_the_limit_is_recommended() -> None:
    found = sampled((1, 1, 0.5), (2, 2, 0.2), (4, 4, JUST_NOTICEABLE - 0.001), (6, 6, 0.01), (8, 8, 0))
    assert found.recommended.value == 4
    assert found.because.startswith("the cheapest below a FLIP of 0.103")


def test_where_none_is_below_the_most_exact_is() -> None:
    found = sampled((1, 1, 0.5), (2, 2, 0.2), (4, 4, JUST_NOTICEABLE))
    assert found.recommended.value == 4
    assert found.because.startswith("the smallest error; none stays below")


def test_of_times_that_cannot_be_told_apart_the_smaller_error_counts() -> None:
    found = sampled((2, 2.0, 0.09), (4, 2.01, 0.02), (6, 6, 0.01))
    assert found.recommended.value == 4
    assert found.because.endswith("cannot be told to be slower than that, and is nearer to the reference")
    assert found.facts()["pareto"] == [4, 6]


def test_of_equal_pictures_the_references_own_is_recommended() -> None:
    method = named("layer method")
    found = curve(method, level("auto", 1.0, 0.0, seed=1), level("peel", 0.999, 0.0, seed=3))
    assert found.recommended.value == "auto"
    dear = curve(method, level("auto", 1.5, 0.0, seed=1), level("peel", 1.0, 0.0, seed=3))
    assert dear.recommended.value == "peel"


def test_what_is_baked_leaves_room_to_what_is_not_and_its_seconds_count() -> None:
    rays = named("occlusion rays")
    found = curve(
        rays,
        level(8, 1, JUST_NOTICEABLE / 2, seconds=0.1),
        level(64, 1, JUST_NOTICEABLE / 4, seconds=0.5),
        level(320, 1, 0.01, seconds=2.0),
    )
    assert found.limit == JUST_NOTICEABLE / 3
    assert found.recommended.value == 64
    assert found.facts()["pareto"] == [8, 64, 320]


def test_the_front_leaves_out_what_takes_longer_for_more_error() -> None:
    found = sampled((1, 1, 0.5), (2, 5, 0.3), (3, 3, 0.2), (8, 8, 0))
    assert found.facts()["pareto"] == [1, 3, 8]


def test_milliseconds_of_all_knobs_are_of_one_baseline() -> None:
    fast, slow = sampled((1, 1, 0.5)), sampled((1, 1, 0.5))
    slow = Curve(slow.knob, (level(1, 1, 0.5),), slow.reference)
    object.__setattr__(slow.levels[0].timing, "baseline_ms", 30.0)
    found = on_one_baseline({"fast": fast, "slow": slow})
    assert {each.levels[0].timing.baseline_ms for each in found.values()} == {20.0}


@pytest.mark.parametrize(("counts", "fitted"), [((1, 2, 3, 4, 6), True), ((1, 2, 4, 6), False)])
def test_half_of_the_reference_and_beyond_is_left_out_of_the_order(counts: Sequence[int], fitted: bool) -> None:
    made = [level(n, n, n**-1.5 if n < 4 else 0.001) for n in counts]
    found = order(named("supersampling"), made)
    assert (found is not None) == fitted
    if found:
        assert found["fitted"] == pytest.approx(1.5)
        assert found["expected"] == 1.5


def combinations(*scenes: Mapping[str, Curve]) -> Combinations:
    places = [SimpleNamespace(curves=curves, baseline_ms=10.0) for curves in scenes]
    used = tuple(knob for knob in knobs() if any(knob.name in curves for curves in scenes))
    return Combinations(cast(Sequence[Place], places), used)


FACES = named("second-layer faces")
FACE_LEVELS = (2_000, 4_000, 8_000, 16_000, "all")


def faces(*shades: float, times: Sequence[float] = (1.01, 0.99, 1.0, 0.98, 1.02)) -> Curve:
    """Equal shades are equal pictures."""
    made = zip(FACE_LEVELS, times, shades, strict=True)
    return curve(FACES, *(level(v, t, abs(1 - s), seed=n, shade=s) for n, (v, t, s) in enumerate(made)))


def test_of_levels_that_draw_the_same_one_is_searched() -> None:
    found = combinations({FACES.name: faces(1, 1, 1, 1, 1)})
    assert found.distinct == {FACES.name: [4]}
    assert found.values(found.best) == {FACES.name: "all"}
    some = combinations({FACES.name: faces(0.7, 0.8, 1, 1, 1)})
    assert some.distinct == {FACES.name: [0, 1, 4]}
    assert [some.values((place,))[FACES.name] for place in range(3)] == [2_000, 4_000, "all"]


def test_what_differs_in_one_scene_is_searched_and_counts_where_it_is_worst() -> None:
    found = combinations({FACES.name: faces(1, 1, 1, 1, 1)}, {FACES.name: faces(0.7, 0.8, 0.9, 1, 1)})
    assert found.distinct == {FACES.name: [0, 1, 2, 4]}
    assert found.effects[0][0][1:] == pytest.approx((0.03, 0.3))


def test_of_the_same_the_cheaper_is_searched_where_that_can_be_told() -> None:
    found = combinations({FACES.name: faces(0.7, 0.8, 0.9, 1, 1, times=(1, 1, 1, 1, 2))})
    assert found.distinct == {FACES.name: [0, 1, 2, 3]}
    assert found.values(found.best) == {FACES.name: 16_000}


def test_baked_knobs_are_not_searched_and_stay_at_the_most_exact_recommendation() -> None:
    rays = named("occlusion rays")
    rough = curve(rays, *(level(n, 1, e, seconds=n / 100) for n, e in ((8, 0.01), (64, 0.001))))
    fine = curve(rays, *(level(n, 1, e, seconds=n / 100) for n, e in ((8, 0.5), (64, 0.001))))
    found = combinations({rays.name: rough}, {rays.name: fine})
    assert found.searched == ()
    assert found.values(()) == {rays.name: 64}


def knob(name: str, beside: Value | None) -> Knob:
    made = levels("supersampling", (1, 3, 8))
    return Knob(name, made, made[-1], "edges", lambda scene: "", beside=beside)


@pytest.mark.parametrize(
    ("besides", "told"),
    [
        ([None], "references."),
        ([3, None], "references, except a (3)."),
        ([3, None, 1, 8], "references, except a (3), c (1) and d (8)."),
    ],
)
def test_the_method_says_which_knobs_stand_elsewhere(besides: Sequence[Any], told: str) -> None:
    made = [knob(name, beside) for name, beside in zip("abcd", besides, strict=False)]
    assert others_of(made) == f"While one knob is measured the others are at their {told}"
