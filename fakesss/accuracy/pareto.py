"""Which of several things nothing else beats: Pareto's front, and how far a point lies before or behind it."""

import math
from collections.abc import Sequence

Costs = Sequence[float]  # each the less the better


def dominates(one: Costs, other: Costs) -> bool:
    """Whether `one` is nowhere worse than `other`, and somewhere better."""
    pairs = list(zip(one, other, strict=True))
    return all(a <= b for a, b in pairs) and any(a < b for a, b in pairs)


def non_dominated(points: Sequence[Costs]) -> list[int]:
    """Places of the points that no other dominates, by rising first cost. Of equal points all are kept."""
    kept = [place for place, point in enumerate(points) if not any(dominates(other, point) for other in points)]
    return sorted(kept, key=lambda place: tuple(points[place]))


def gain(point: Costs, front: Sequence[Costs]) -> float:
    """By how many e-folds `point` beats the front: the least, over the front, of its best cost's advantage.

    Positive: no point of the front is as good in everything. Negative: one of them is better in everything by that
    much. Costs are >= 0, and one of 0 counts as 1e-12.
    """
    return min((max(map(advantage, point, other)) for other in front), default=math.inf)


def advantage(cost: float, other: float) -> float:
    """e-folds by which a cost is less than another."""
    return math.log(max(other, 1e-12) / max(cost, 1e-12))
