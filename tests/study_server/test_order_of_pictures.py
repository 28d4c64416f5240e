"""The order rows: balanced for position and carry-over, the same for the same seed."""

from collections import Counter
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from study_server.assignment import order_rows, practice_stimuli

ks = st.integers(1, 16)
seeds = st.integers(0, 2**32)


def names(k: int) -> list[str]:
    return [f"img{i:02d}" for i in range(k)]


@given(ks, seeds)
def test_every_k_rows_show_each_picture_in_each_position_once(k: int, seed: int) -> None:
    rows = order_rows(names(k), "latin-square", seed)
    assert len(rows) == (k if k % 2 == 0 or k == 1 else 2 * k)
    for first in range(0, len(rows), k):
        square = rows[first : first + k]
        for position in range(k):
            assert sorted(row[position] for row in square) == names(k)
        assert all(sorted(row) == names(k) for row in square)


@given(ks, seeds)
def test_every_picture_follows_every_other_equally_often(k: int, seed: int) -> None:
    rows = order_rows(names(k), "latin-square", seed)
    follows = Counter(pair for row in rows for pair in pairwise(row))
    assert len(follows) == k * (k - 1)
    assert set(follows.values()) <= {1 if k % 2 == 0 else 2}


@given(ks, seeds, st.sampled_from(["latin-square", "random"]))
def test_the_seed_decides(k: int, seed: int, order: str) -> None:
    rows = order_rows(names(k), order, seed)  # type: ignore[arg-type]
    assert rows == order_rows(names(k), order, seed)  # type: ignore[arg-type]
    assert all(sorted(row) == names(k) for row in rows)


def test_another_seed_gives_other_rows() -> None:
    assert order_rows(names(9), "latin-square", 1) != order_rows(names(9), "latin-square", 2)


@given(ks, st.integers(0, 20))
def test_practice_spans_the_design(k: int, n: int) -> None:
    shown = practice_stimuli(names(k), n)
    assert len(shown) == n
    if n >= 2:
        assert (shown[0], shown[-1]) == (names(k)[0], names(k)[-1])
