"""Who sees the pictures in which order: rows of a seeded design. Pure functions; nothing is stored here."""

from collections.abc import Sequence
from random import Random
from typing import Literal

Order = Literal["latin-square", "random"]

RANDOM_ROWS = 400
"""Rows of `random`: one each for the largest study this is made for; then they are given a second time."""


def order_rows(stimuli: Sequence[str], order: Order, seed: int) -> list[list[str]]:
    """The rows of the design, each a permutation of `stimuli`. The same arguments give the same rows.

    `latin-square`: the rows of `williams_square`, with the stimuli dealt to its numbers at random; in every k rows
    (k stimuli) each stimulus stands in each position once. `random`: independent shuffles.
    """
    random = Random(f"order {seed}")
    if order == "random":
        return [random.sample(list(stimuli), len(stimuli)) for _ in range(RANDOM_ROWS)]
    dealt = random.sample(list(stimuli), len(stimuli))
    return [[dealt[number] for number in row] for square in williams_square(len(stimuli), random) for row in square]


def williams_square(k: int, random: Random) -> list[list[list[int]]]:
    """Latin squares of order k, balanced for first-order carry-over: one if k is even, two if it is odd.

    Williams (1949), Experimental designs balanced for the estimation of residual effects of treatments. The first
    row runs 0, 1, k-1, 2, k-2, ...; the others add 1 to it modulo k. For odd k the second square is the first one
    read backwards. The rows of each square come in random order, so that neighbours in time are not neighbours in
    the design.
    """
    first = [0 if i == 0 else (i + 1) // 2 if i % 2 else k - i // 2 for i in range(k)]
    square = [[(number + shift) % k for number in first] for shift in range(k)]
    squares = [square] if k % 2 == 0 or k == 1 else [square, [row[::-1] for row in square]]
    return [random.sample(rows, len(rows)) for rows in squares]


def practice_stimuli(stimuli: Sequence[str], n: int) -> list[str]:
    """`n` stimuli spread evenly over the design, the same for everybody, so that practice shows its range."""
    if n == 1:
        return [stimuli[0]]
    return [stimuli[round(i * (len(stimuli) - 1) / (n - 1))] for i in range(n)]
