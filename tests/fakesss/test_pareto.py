"""Pareto's front against its definition, and a search that finds it without trying everything."""

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fakesss.accuracy.pareto import dominates, gain, non_dominated, unbeaten
from fakesss.accuracy.tradeoff_search import (
    Costs,
    Setting,
    below,
    cheaper,
    downhill,
    front,
    pareto_local_search,
    predicted,
    spread,
)  # fmt: skip

POINTS = st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)), max_size=30)


@given(POINTS)
def test_the_front_is_what_nothing_dominates(points: list[tuple[int, int]]) -> None:
    kept = {points[place] for place in non_dominated(points)}
    assert kept == {one for one in points if not any(dominates(other, one) for other in points)}
    assert bool(kept) == bool(points)


@given(POINTS)
def test_everything_else_is_dominated_by_something_on_the_front(points: list[tuple[int, int]]) -> None:
    places = non_dominated(points)
    rest = [one for place, one in enumerate(points) if place not in places]
    assert all(any(dominates(points[place], one) for place in places) for one in rest)


@given(POINTS)
def test_the_front_falls_as_it_goes_on(points: list[tuple[int, int]]) -> None:
    kept = [points[place] for place in non_dominated(points)]
    assert kept == sorted(kept)
    assert [second for _, second in kept] == sorted((second for _, second in kept), reverse=True)


@given(POINTS, st.permutations(range(30)))
def test_the_order_of_points_does_not_matter(points: list[tuple[int, int]], order: list[int]) -> None:
    shuffled = [points[place] for place in order if place < len(points)]
    assert [shuffled[p] for p in non_dominated(shuffled)] == [points[p] for p in non_dominated(points)]


@given(st.tuples(st.integers(1, 9), st.integers(1, 9)), POINTS.filter(bool))
def test_gain_is_positive_where_nothing_is_as_good(point: tuple[int, int], points: list[tuple[int, int]]) -> None:
    as_good = any(a <= point[0] and b <= point[1] for a, b in points)
    assert (gain(point, points) > 0) == (not as_good)


def test_gain_is_measured_in_e_folds() -> None:
    assert gain((1.0, 1.0), [(math.e, 1.0)]) == pytest.approx(1)
    assert gain((2.0, 2.0), [(1.0, 1.0)]) == pytest.approx(-math.log(2))
    assert gain((2.0, 2.0), []) == math.inf


# knobs whose times multiply and whose errors add, so that prediction from single steps is exact
ALONE = (
    ((1.0, 0.5, 0.5), (1.5, 0.2, 0.2), (3.0, 0.0, 0.0)),
    ((1.0, 0.3, 0.3), (1.1, 0.0, 0.0)),
    ((1.0, 0.1, 0.1), (2.5, 0.01, 0.01), (6.0, 0.0, 0.0)),
    ((1.0, 0.0, 0.0), (1.4, 0.0, 0.0)),  # costs time for nothing: never on the front but at its lowest
)
BEST = (2, 1, 2, 0)


def separable(setting: Setting) -> Costs:
    levels = [knob[place] for knob, place in zip(ALONE, setting, strict=True)]
    return (math.prod(level[0] for level in levels), *(sum(level[e] for level in levels) for e in (1, 2)))


EVERYTHING = {setting: separable(setting) for setting in itertools.product(range(3), range(2), range(3), range(2))}


def test_the_search_finds_the_whole_front_without_trying_everything() -> None:
    looked: list[Setting] = []

    def look(setting: Setting) -> Costs:
        looked.append(setting)
        return separable(setting)

    found = pareto_local_search(ALONE, BEST, look, budget=10)
    assert set(front(found)) == set(front(EVERYTHING))
    assert len(looked) == len(set(looked)) < len(EVERYTHING)


@pytest.mark.parametrize("budget", [2, 5, 9])
def test_the_search_keeps_to_its_budget_and_looks_at_both_ends(budget: int) -> None:
    found = pareto_local_search(ALONE, BEST, separable, budget)
    assert len(found) <= budget
    assert {BEST, (0, 0, 0, 0)} <= set(found)


def test_times_that_are_nearly_equal_do_not_save() -> None:
    """What costs error for less than 3% of time is neither on the way down nor on the front."""
    effects = (((0.98, 0.5), (1.0, 0.0)), ((0.5, 0.1), (1.0, 0.0)))
    assert downhill(effects, (1, 1)) == [(1, 1), (1, 0)]
    assert front({(1, 1): (1.0, 0.0), (0, 1): (0.98, 0.5), (1, 0): (0.5, 0.1)}) == [(1, 0), (1, 1)]


def test_what_no_step_of_a_level_reaches_is_reached_past_it() -> None:
    """A level that saves nothing, between two that do, is no wall."""
    effects = (((1.0, 0.5), (2.1, 0.2), (2.0, 0.1), (3.0, 0.0)),)
    assert downhill(effects, (3,)) == [(3,), (2,), (0,)]


def test_before_the_end_what_is_cheaper_than_the_chosen_is_looked_at() -> None:
    found = {BEST: separable(BEST)}
    looked: list[Setting] = []

    def look(setting: Setting) -> Costs:
        looked.append(setting)
        return separable(setting)

    below(found, ALONE, look, lambda costs: costs[2] < 0.35)
    allowed = [costs for costs in EVERYTHING.values() if costs[2] < 0.35]
    here = min((setting for setting in found if found[setting][2] < 0.35), key=lambda setting: found[setting])
    assert all(found[other][2] >= 0.35 for other in cheaper(here, ALONE))
    assert found[here][0] < 1.2 * min(allowed)[0]
    assert len(looked) == len(set(looked)) < len(EVERYTHING)


def test_where_nothing_is_fine_nothing_more_is_looked_at() -> None:
    found = {BEST: separable(BEST)}
    below(found, ALONE, separable, lambda costs: False)
    assert set(found) == {BEST}


TIMED = st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6), st.integers(0, 6)), max_size=20)


@given(TIMED)
def test_unbeaten_is_the_front_where_all_times_can_be_told(points: list[tuple[int, int, int]]) -> None:
    kept = unbeaten([point[1:] for point in points], lambda a, b: points[a][0] < points[b][0])
    assert sorted(kept) == sorted(non_dominated(points))


@given(TIMED)
def test_where_no_times_can_be_told_the_errors_decide(points: list[tuple[int, int, int]]) -> None:
    kept = unbeaten([point[1:] for point in points], lambda a, b: False)
    assert sorted(kept) == sorted(non_dominated([point[1:] for point in points]))


def test_the_way_down_takes_first_what_costs_least_error_for_its_time() -> None:
    path = downhill(ALONE, BEST)
    assert path[0] == BEST
    assert path[1] == (2, 1, 1, 0)  # 0.01 for a factor of 2.4
    assert path[-1] == (0, 0, 0, 0)
    assert all(sum(a) == sum(b) + 1 for a, b in itertools.pairwise(path))


def test_a_path_is_thinned_with_its_ends() -> None:
    path = downhill(ALONE, BEST)
    thin = spread(path, 3)
    assert (len(thin), thin[0], thin[-1]) == (3, path[0], path[-1])
    assert spread(path, 99) == path


def test_prediction_is_exact_where_times_multiply_and_errors_add() -> None:
    here, there = (2, 1, 1, 0), (1, 1, 1, 0)
    assert predicted(separable(here), here, there, ALONE) == pytest.approx(separable(there))
