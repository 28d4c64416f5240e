"""Repeats stand far from their originals and all over the session; instructed items are spread, drawn and varied."""

import json
from collections import Counter
from dataclasses import asdict, replace
from itertools import combinations, groupby, pairwise, permutations
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from study_server.ordering.assignment import Design, Trial, most_checks, with_checks
from study_server.ordering.repeats import at_the_ends, insert_repeats, least_between, matched

seeds = st.integers(0, 2**32)


def names(k: int) -> tuple[str, ...]:
    return tuple(f"img{i:02d}" for i in range(k))


def again(originals: list[str]) -> dict[str, str]:
    return {f"{name}r": name for name in originals}


@st.composite
def designs(draw: st.DrawFn) -> Design:
    """Any small study: 1 to 12 pictures, any of them repeated, 1 to 3 questions, either order and kind of blocks."""
    stimuli = names(draw(st.integers(1, 12)))
    repeated = draw(st.lists(st.sampled_from(stimuli), unique=True))
    questions = tuple(f"q{i}" for i in range(draw(st.integers(1, 3))))
    order = draw(st.sampled_from(["latin-square"] * 5 + ["random"]))
    blocks = draw(st.sampled_from(["together", "by-question"]))
    steps = tuple(draw(st.integers(2, 11)) for _ in questions)
    design = Design(stimuli, again(repeated), questions, steps, order, blocks, seed=draw(seeds))
    return replace(design, checks=draw(st.integers(0, most_checks(design.trials))))


def shown_in_blocks(row: list[Trial]) -> list[list[str]]:
    return [[trial.stimulus for trial in block] for _, block in groupby(row, key=lambda trial: trial.questions)]


def fewest_between(block: list[str], repeats: dict[str, str]) -> int:
    return min(abs(block.index(repeat) - block.index(original)) - 1 for repeat, original in repeats.items())


@given(designs())
def test_repeats_are_far_from_their_originals_and_leave_the_order_as_it_was(design: Design) -> None:
    plain = replace(design, repeats={}, checks=0).rows()
    rows = design.rows()
    assert len(rows) == len(plain)
    for row, without in zip(rows, plain, strict=True):
        assert [(trial.stimulus, trial.questions) for trial in row if trial.stimulus not in design.repeats] == [
            (trial.stimulus, trial.questions) for trial in without
        ]
        for block in shown_in_blocks(row):
            assert sorted(block) == sorted([*design.stimuli, *design.repeats])
            if design.repeats:
                assert fewest_between(block, dict(design.repeats)) >= len(block) // 3
            if len(block) >= 3:
                pictures = [design.repeats.get(name, name) for name in block]
                assert all(a != b for a, b in pairwise(pictures))


@pytest.mark.parametrize("k", range(1, 11))
def test_the_ends_of_the_row_are_always_far_enough(k: int) -> None:
    """The comment's proof, for every choice of repeated pictures: so a row can always be made."""
    for r in range(1, k + 1):
        for chosen in combinations(names(k), r):
            row = at_the_ends(names(k), again(list(chosen)))
            assert [name for name in row if name in names(k)] == list(names(k))
            assert fewest_between(row, again(list(chosen))) >= least_between(len(row))


@pytest.mark.parametrize("repeated", [1, 2, 3, 4, 6, 9])
def test_over_the_rows_repeats_stand_everywhere_and_apart(repeated: int) -> None:
    """The thesis's nine pictures: not missing from the middle, where few originals are far enough, nor in a clump."""
    used: Counter[int] = Counter()
    longest = []
    for seed in range(10):
        for row in Design(names(9), again(list(names(9)[:repeated])), ("q",), (7,), seed=seed).rows():
            is_repeat = [trial.stimulus.endswith("r") for trial in row]
            used.update(i for i, yes in enumerate(is_repeat) if yes)
            longest.append(max(len(list(run)) for yes, run in groupby(is_repeat) if yes))
    trials = 9 + repeated
    for third in range(3):
        places = range(third * trials // 3, (third + 1) * trials // 3)
        even = used.total() * len(places) / trials
        assert 0.7 * even <= sum(used[place] for place in places) <= 1.3 * even
    assert set(used) == set(range(trials))
    assert sum(longest) / len(longest) < 2


@given(st.dictionaries(st.sampled_from("abcde"), st.lists(st.integers(0, 4), unique=True), max_size=5))
def test_a_matching_is_found_exactly_if_there_is_one(allowed: dict[str, list[int]]) -> None:
    found = matched(allowed)
    possible = any(
        all(place in allowed[name] for name, place in zip(allowed, places, strict=True))
        for places in permutations(range(5), len(allowed))
    )
    assert (found is not None) == possible
    if found is not None:
        assert sorted(found.values()) == sorted(allowed)
        assert all(place in allowed[name] for place, name in found.items())


def test_repeats_avoid_the_pictures_of_the_blocks_beside_them() -> None:
    for seed in range(200):
        row, repeats = list(names(9)), again(["img00", "img07", "img08"])
        block = insert_repeats(row, repeats, [0] * 12, Random(seed), before="img08", after="img00")
        assert repeats.get(block[0], block[0]) != "img08"
        assert repeats.get(block[-1], block[-1]) != "img00"


def part_of(place: int, trials: int, parts: int) -> int:
    return next(i for i in range(parts) if i * trials // parts <= place < (i + 1) * trials // parts)


@given(designs())
def test_checks_are_one_in_each_part_and_never_first_or_last(design: Design) -> None:
    for row in design.rows():
        assert len(row) == design.trials
        places = [i for i, trial in enumerate(row) if trial.check is not None]
        assert [part_of(place, len(row), design.checks) for place in places] == list(range(design.checks))
        if len(row) >= 3:
            assert not {0, len(row) - 1} & set(places)
        scales = dict(zip(design.questions, design.steps, strict=True))
        answers = [trial.check for trial in row if trial.check is not None]
        steps = [scales[trial.questions[-1]] for trial in row if trial.check is not None]
        assert all(1 <= a <= top and 2 * a != top + 1 for a, top in zip(answers, steps, strict=True))
        assert all(a != b for a, b in pairwise(answers))


@given(st.integers(1, 60), seeds)
def test_most_checks_is_what_fits_and_no_more(trials: int, seed: int) -> None:
    row = [Trial(f"img{i}", ("q",)) for i in range(trials)]
    checked = with_checks(row, most_checks(trials), {"q": 7}, Random(seed))
    assert sum(trial.check is not None for trial in checked) == most_checks(trials)
    if trials >= 3:
        with pytest.raises(IndexError):  # the first part is the first trial alone, or empty
            with_checks(row, most_checks(trials) + 1, {"q": 7}, Random(seed))


@pytest.mark.parametrize("steps", [2, 3, 4, 7, 11])
def test_checks_differ_between_rows_and_no_place_or_answer_is_favoured(steps: int) -> None:
    design = Design(names(9), {}, ("q1", "q2"), (steps, steps), order="random", checks=2)
    rows = [[(i, trial.check) for i, trial in enumerate(row) if trial.check is not None] for row in design.rows()]
    places = Counter(place for row in rows for place, _ in row)
    answers = Counter(answer for row in rows for _, answer in row)
    assert set(places) == set(range(1, 8))
    assert set(answers) == {step for step in range(1, steps + 1) if 2 * step != steps + 1}
    # Binomial: within 5 standard deviations. A part of the trials has 3 or 4 places, and 400 rows.
    assert all(400 / 4 - 5 * 8.7 <= count <= 400 / 3 + 5 * 9.5 for count in places.values())
    mean = 800 / len(answers)
    assert all(abs(count - mean) <= 5 * mean**0.5 for count in answers.values())
    assert len({tuple(row) for row in rows}) > 12


@given(designs())
def test_rows_depend_on_nothing_but_the_design_and_can_be_stored_as_json(design: Design) -> None:
    backwards = replace(design, repeats=dict(reversed(design.repeats.items())))
    rows = design.rows()
    assert rows == backwards.rows()
    stored = json.loads(json.dumps([[asdict(trial) for trial in row] for row in rows]))
    assert [[Trial(t["stimulus"], tuple(t["questions"]), t["check"]) for t in row] for row in stored] == rows


def test_instructed_items_leave_the_order_as_it_was() -> None:
    design = Design(names(9), again(["img03", "img05"]), ("q1", "q2"), (7, 7), seed=3)
    checked = replace(design, checks=3)
    assert [[replace(trial, check=None) for trial in row] for row in checked.rows()] == design.rows()


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"stimuli": ()}, "a design needs a picture and a question"),
        ({"questions": (), "steps": ()}, "a design needs a picture and a question"),
        ({"repeats": {"a": "img00", "b": "img00"}}, "each repeat shows another stimulus"),
        ({"repeats": {"a": "img99"}}, "each repeat shows another stimulus"),
        ({"checks": 2}, "2 checks in 3 trials: at most 1"),
    ],
)
def test_an_impossible_design_is_refused(wrong: dict[str, object], says: str) -> None:
    with pytest.raises(ValueError, match=says):
        replace(Design(names(3), {}, ("q",), (7,)), **wrong)  # type: ignore[arg-type]
