"""Which of many axis-aligned boxes lie in which, without comparing each with each."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

ROOM = 1 + 1e-9  # centres and reaches are rounded


class NestedBoxes:
    """Boxes (N,) between `low` and `high` (N, 3), sorted by size to powers of two, each size in a tree of centres.

    A box lies in another only if their centres are no farther apart than the larger reaches.
    """

    def __init__(self, low: Floats, high: Floats) -> None:
        self._low, self._high = low, high
        self._centre = (low + high) / 2
        self._reach = (high - low).max(axis=1) / 2
        size = np.frexp(self._reach)[1]
        members = [np.flatnonzero(size == one) for one in np.unique(size)]
        self._sizes = [(same, cKDTree(self._centre[same]), self._reach[same].max()) for same in members]

    def around(self, index: int) -> Indices:
        """The other boxes that hold box `index`."""
        near = self._near(index, [reach for _, _, reach in self._sizes])
        holds = (self._low[near] <= self._low[index]) & (self._high[near] >= self._high[index])
        others: Indices = near[holds.all(axis=1) & (near != index)]
        return others

    def within(self, index: int) -> Indices:
        """The boxes that box `index` holds, itself among them."""
        near = self._near(index, [self._reach[index]] * len(self._sizes))
        held = (self._low[near] >= self._low[index]) & (self._high[near] <= self._high[index])
        inside: Indices = near[held.all(axis=1)]
        return inside

    def _near(self, index: int, distances: list[float]) -> Indices:
        """Boxes whose centres are no farther from that of `index` than their size's distance."""
        found = [np.zeros(0, np.int64)]
        for (same, tree, _), distance in zip(self._sizes, distances, strict=True):
            found.append(same[tree.query_ball_point(self._centre[index], distance * ROOM, p=np.inf)])
        return np.concatenate(found)
