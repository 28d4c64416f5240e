"""Where the second showing of a picture stands in a row: far from the first, and evenly spread over the session."""

from collections.abc import Mapping, Sequence
from random import Random

DRAWS_IN_PARTS, DRAWS = 30, 100
"""Draws of one place in each part of the row, and in all: then places anywhere, for rows whose repeated pictures stand
so close together that no even spread is far enough from all of them."""


def least_between(trials: int) -> int:
    """Trials that at least lie between two showings of one picture in a block of `trials`: a third, rounded down.

    Far enough that the first answer is not simply remembered, and so few that a place is always found (`at_the_ends`).
    From 3 trials on it is at least 1: the two are never neighbours.
    """
    return trials // 3


def insert_repeats(
    row: Sequence[str],
    repeats: Mapping[str, str],
    used: list[int],
    random: Random,
    before: str | None = None,
    after: str | None = None,
) -> list[str]:
    """`row` with every repeat in it; without them it is `row` again. The repeat may come before its original.

    The block is cut into as many equal parts as there are repeats, and each part gets one of them, at a place by lot
    among those which earlier rows `used` least (showings at each place; the ones given out here are added). Which
    repeat comes into which part is drawn by lot among the ways that keep `least_between`. Where `DRAWS_IN_PARTS` draws
    find none, places are drawn anywhere; where `DRAWS` find none, the repeats are put `at_the_ends`. The block neither
    begins with the picture `before` nor ends with `after`, its neighbours in other blocks, if a draw allows.
    """
    if not repeats:
        return list(row)
    for draw in range(DRAWS):
        if draw < DRAWS_IN_PARTS:
            places = evenly_drawn(len(repeats), used, random, freedom=1 + draw / 5)
        else:
            places = random.sample(range(len(used)), len(repeats))
        order = arranged(row, repeats, places, random)
        if order and before != repeats.get(order[0], order[0]) and after != repeats.get(order[-1], order[-1]):
            break
    else:
        order = at_the_ends(row, repeats)
    for place, name in enumerate(order):
        used[place] += name in repeats
    return order


def evenly_drawn(n: int, used: Sequence[int], random: Random, freedom: float) -> list[int]:
    """One place in each of n equal parts of the block, the least `used` one.

    Places that differ by less than `freedom` uses may change ranks by lot; 1: only equally used ones.
    """
    parts = [range(i * len(used) // n, (i + 1) * len(used) // n) for i in range(n)]
    return [min(part, key=lambda place: used[place] + freedom * random.random()) for part in parts]


def arranged(row: Sequence[str], repeats: Mapping[str, str], places: Sequence[int], random: Random) -> list[str] | None:
    """`row` with the repeats at `places`, dealt by lot so that all are far from their originals; None: no way does."""
    trials = len(row) + len(places)
    taken = set(places)
    free = (place for place in range(trials) if place not in taken)
    stands = dict(zip(row, free, strict=True))
    apart = least_between(trials)
    lots = random.sample(places, len(places))
    allowed = {
        repeat: [place for place in lots if abs(place - stands[original]) > apart]
        for repeat, original in random.sample(sorted(repeats.items()), len(repeats))
    }
    dealt = matched(allowed)
    if dealt is None:
        return None
    here = {place: name for name, place in stands.items()} | dealt
    return [here[place] for place in range(trials)]


def matched(allowed: Mapping[str, Sequence[int]]) -> dict[int, str] | None:
    """A name for each place such that every name has one of its allowed places; None if there is no such way.

    Kuhn (1955), The Hungarian method for the assignment problem, its step for a bipartite graph without weights:
    names come one by one, and move others on where they must.
    """
    holder: dict[int, str] = {}

    def settle(name: str, tried: set[int]) -> bool:
        """Whether `name` has a place now, its own or one whose holder could move."""
        for place in allowed[name]:
            if place not in holder:
                holder[place] = name
                return True
        for place in allowed[name]:
            if place not in tried:
                tried.add(place)
                if settle(holder[place], tried):
                    holder[place] = name
                    return True
        return False

    return holder if all(settle(name, set()) for name in allowed) else None


def at_the_ends(row: Sequence[str], repeats: Mapping[str, str]) -> list[str]:
    """`row` with the repeats of its second half before it and those of its first half after it, in its order.

    Always far enough. Let k pictures be in the row and r <= k of them be repeated, so that a block has T = k + r
    trials. Between the showings of a picture lie all from there to the far end of the row, at least k // 2; and one
    showing of each of the r - 1 other repeated pictures. If 2r <= k, T // 3 <= k // 2; otherwise T < 3r, so that
    T // 3 <= r - 1.
    """
    again = {original: repeat for repeat, original in repeats.items()}
    half = (len(row) + 1) // 2
    return [*(again[p] for p in row[half:] if p in again), *row, *(again[p] for p in row[:half] if p in again)]
