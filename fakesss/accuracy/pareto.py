"""Which of several things nothing else beats: Pareto's front, and how far a point lies before or behind it."""

import math
from collections.abc import Callable, Sequence

Costs = Sequence[float]  # each the less the better


def dominates(one: Costs, other: Costs) -> bool:
    """Whether `one` is nowhere worse than `other`, and somewhere better."""
    pairs = list(zip(one, other, strict=True))
    return all(a <= b for a, b in pairs) and any(a < b for a, b in pairs)


def non_dominated(points: Sequence[Costs]) -> list[int]:
    """Places of the points that no other dominates, by rising first cost. Of equal points all are kept."""
    kept = [place for place, point in enumerate(points) if not any(dominates(other, point) for other in points)]
    return sorted(kept, key=lambda place: tuple(points[place]))


def unbeaten(errors: Sequence[Costs], faster: Callable[[int, int], bool]) -> list[int]:
    """Places of what no other beats: as good in every error and not slower, in something better.

    `faster(one, other)` says whether one place can be told to take less time than another; neither: alike.
    """

    def beats(one: int, other: int) -> bool:
        if faster(other, one) or any(a > b for a, b in zip(errors[one], errors[other], strict=True)):
            return False
        return faster(one, other) or tuple(errors[one]) != tuple(errors[other])

    places = range(len(errors))
    return [place for place in places if not any(beats(other, place) for other in places)]


def gain(point: Costs, front: Sequence[Costs]) -> float:
    """By how many e-folds `point` beats the front: the least, over the front, of its best cost's advantage.

    Positive: no point of the front is as good in everything. Negative: one of them is better in everything by that
    much. Costs are >= 0, and one of 0 counts as 1e-12.
    """
    return min((max(map(advantage, point, other)) for other in front), default=math.inf)


def advantage(cost: float, other: float) -> float:
    """e-folds by which a cost is less than another."""
    return math.log(max(other, 1e-12) / max(cost, 1e-12))
