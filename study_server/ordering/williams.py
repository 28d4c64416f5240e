"""Williams designs: rows in which every treatment stands in every position, and follows every other, equally often.

E. J. Williams (1949), Experimental designs balanced for the estimation of residual effects of treatments, Australian
Journal of Scientific Research A 2, 149-168. R's `crossdes::williams` builds the same designs.
"""

from random import Random


def williams_rows(k: int) -> int:
    """Rows of the design of k treatments: one Latin square if k is even, two if it is odd; 1 for k = 1."""
    return k if k % 2 == 0 or k == 1 else 2 * k


def williams_row(k: int, square: int, shift: int) -> list[int]:
    """Row `shift` (modulo k) of square 0 or 1: a permutation of 0 .. k-1.

    Square 0: 0, 1, k-1, 2, k-2, ... with `shift` added modulo k. Its steps from one to the next are +1, -2, +3, -4,
    ...: all different modulo k if k is even, so that over the k shifts each ordered pair is met once. If k is odd
    each step occurs twice or never; square 1 is square 0 read backwards, which has the missing ones.
    """
    zigzag = [(i + 1) // 2 if i % 2 else (k - i // 2) % k for i in range(k)]
    return [(number + shift) % k for number in (zigzag[::-1] if square else zigzag)]


def shuffled_rows(k: int, random: Random) -> list[tuple[int, int]]:
    """(square, shift) of every row of the design, squares one after the other, the shifts of each by lot.

    By lot, so that people who come one after the other do not get rows that resemble one another.
    """
    return [(square, shift) for square in range(williams_rows(k) // k) for shift in random.sample(range(k), k)]
