"""The pictures' orders: balanced for position and carry-over, within each question too; the same for the same seed."""

from collections import Counter, defaultdict
from dataclasses import asdict, replace
from itertools import pairwise
from json import dumps
from time import process_time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from study_server.ordering.assignment import MOST_ROWS, Design, Order, Trial

ks = st.integers(1, 16)
seeds = st.integers(0, 2**32)
orders = st.sampled_from(["latin-square", "random"])


def design(pictures: int, questions: int = 2, seed: int = 0, order: Order = "latin-square", repeats: int = 0) -> Design:
    """A study of img00, img01, ..., the first ones repeated, each question in a block of its own."""
    stimuli = tuple(f"img{i:02d}" for i in range(pictures))
    again = {f"{name}r": name for name in stimuli[:repeats]}
    asked = tuple(f"q{i}" for i in range(questions))
    return Design(stimuli, again, asked, (7,) * questions, order=order, blocks="by-question", seed=seed)


def together(pictures: int, seed: int = 0, order: Order = "latin-square") -> Design:
    """The same with all questions under each picture."""
    return replace(design(pictures, seed=seed, order=order), blocks="together")


def shown(row: list[Trial]) -> list[str]:
    return [trial.stimulus for trial in row]


def blocks(row: list[Trial]) -> list[tuple[str, list[str]]]:
    """(question, pictures in their order) for each block of the row."""
    found: dict[str, list[str]] = {}
    for trial in row:
        [question] = trial.questions
        found.setdefault(question, []).append(trial.stimulus)
    assert [trial.questions[0] for trial in row] == [q for q, pictures in found.items() for _ in pictures]
    return list(found.items())


def assert_balanced(rows: list[list[str]], names: tuple[str, ...]) -> None:
    """Every name in every position, and every name directly after every other, equally often over `rows`."""
    assert all(sorted(row) == sorted(names) for row in rows)
    times, rest = divmod(len(rows), len(names))
    assert rest == 0
    for position in range(len(names)):
        assert Counter(row[position] for row in rows) == dict.fromkeys(names, times)
    others = {(a, b) for a in names for b in names if a != b}
    assert Counter(pair for row in rows for pair in pairwise(row)) == dict.fromkeys(others, times)


@given(ks, seeds)
def test_together_every_picture_in_every_position_and_after_every_other_equally_often(k: int, seed: int) -> None:
    rows = together(k, seed).rows()
    assert len(rows) == (k if k % 2 == 0 or k == 1 else 2 * k)
    assert {trial.questions for row in rows for trial in row} == {("q0", "q1")}
    assert_balanced([shown(row) for row in rows], together(k).stimuli)
    for first in range(0, len(rows), k):  # each Latin square by itself
        for position in range(k):
            assert len({row[position].stimulus for row in rows[first : first + k]}) == k


@given(st.integers(1, 12), st.integers(1, 5), seeds)
def test_by_question_the_pictures_are_balanced_within_each_question(k: int, n: int, seed: int) -> None:
    study = design(k, n, seed)
    rows = study.rows()
    period = len(together(k).rows())
    assert len(rows) % period == 0
    for first in range(0, len(rows), period):
        by_question = defaultdict(list)
        for row in rows[first : first + period]:
            for question, pictures in blocks(row):
                by_question[question].append(pictures)
        assert sorted(by_question) == sorted(study.questions)
        for orders_of_one in by_question.values():
            assert_balanced(orders_of_one, study.stimuli)


@given(st.integers(1, 12), st.integers(1, 5), seeds)
def test_by_question_the_questions_are_balanced_and_crossed_with_the_pictures(k: int, n: int, seed: int) -> None:
    study = design(k, n, seed)
    rows = [blocks(row) for row in study.rows()]
    assert len(rows) == len(together(k).rows()) * len(together(n).rows()) <= MOST_ROWS
    assert_balanced([[question for question, _ in row] for row in rows], study.questions)
    for place in range(n):
        for question in study.questions:
            assert_balanced([row[place][1] for row in rows if row[place][0] == question], study.stimuli)


@given(st.integers(2, 16), st.integers(1, 6), seeds, orders)
def test_no_block_begins_with_the_picture_before_it_and_a_persons_blocks_differ(
    k: int, n: int, seed: int, order: Order
) -> None:
    for row in design(k, n, seed, order).rows():
        assert all(a != b for a, b in pairwise(shown(row)))
        if n <= k // 2 and order == "latin-square":
            assert len({tuple(pictures) for _, pictures in blocks(row)}) == n


@pytest.mark.parametrize(
    ("k", "n", "expected"),
    [
        (9, 1, 18),
        (9, 2, 36),  # 18 x 2, crossed
        (9, 3, 108),  # 18 x 6
        (25, 3, 300),  # 50 x 6
        (100, 3, 300),  # 600 are too many: one turn, the least common multiple of 100 and 6
        (101, 5, 404),  # a turn of 1010 is too much: twice the 202 rows
        (401, 1, 802),  # one block is never cut
    ],
)
def test_large_designs_stop_at_whole_designs_over_the_pictures(k: int, n: int, expected: int) -> None:
    study = design(k, n)
    rows = study.rows()
    assert len(rows) == expected
    if k <= 101:
        for question in study.questions:
            assert_balanced([dict(blocks(row))[question] for row in rows], study.stimuli)
        turns = Counter(tuple(question for question, _ in blocks(row)) for row in rows)
        assert max(turns.values()) - min(turns.values()) == (1 if expected == 404 else 0)


@given(ks, st.integers(1, 4), seeds, orders)
def test_the_same_design_gives_the_same_rows_and_all_of_them_hold_everything(
    k: int, n: int, seed: int, order: Order
) -> None:
    study = design(k, n, seed, order)
    rows = study.rows()
    assert rows == design(k, n, seed, order).rows()
    for row in rows:
        assert sorted((trial.stimulus, *trial.questions) for trial in row) == sorted(
            (stimulus, question) for stimulus in study.stimuli for question in study.questions
        )
    if order == "random":
        assert len(rows) == MOST_ROWS


def test_another_seed_gives_other_rows() -> None:
    assert together(9, 1).rows() != together(9, 2).rows()


def test_random_rows_are_all_different_and_no_position_is_favoured() -> None:
    rows = [shown(row) for row in together(9, order="random").rows()]
    assert len({tuple(row) for row in rows}) == MOST_ROWS
    for position in range(9):  # binomial(400, 1/9): mean 44.4, standard deviation 6.3; here within 5 of them
        assert all(13 <= count <= 76 for count in Counter(row[position] for row in rows).values())


@given(ks, st.integers(0, 20))
def test_practice_spans_the_design_without_repeats_and_asks_as_later_on(k: int, n: int) -> None:
    study = replace(design(k, repeats=k), practice=n)
    practice = study.practice_trials()
    assert len(practice) == n
    assert [(trial.questions, trial.check) for trial in practice] == [((f"q{i % 2}",), None) for i in range(n)]
    assert {trial.questions for trial in replace(study, blocks="together").practice_trials()} <= {("q0", "q1")}
    counts = Counter(shown(practice))
    assert set(counts) <= set(study.stimuli)
    assert len(counts) == min(k, n)
    if n == 1:
        assert practice[0].stimulus == study.stimuli[k // 2]
    elif n <= k and n:
        assert (practice[0].stimulus, practice[-1].stimulus) == (study.stimuli[0], study.stimuli[-1])
        places = [study.stimuli.index(trial.stimulus) for trial in practice]
        gaps = [b - a for a, b in pairwise(places)]
        assert max(gaps) - min(gaps) <= 1
    if k > 1:
        assert all(a != b for a, b in pairwise(shown(practice)))


def test_a_large_study_takes_less_than_two_seconds() -> None:
    start = process_time()
    rows = design(100, 3, repeats=20).rows()
    dumps([[asdict(trial) for trial in row] for row in rows])
    assert process_time() - start < 6  # 0.6 s for the rows on a quiet machine, 1 s for JSON; this allows for a busy one
