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
        near = self._near(index, largest_reach=np.inf)
        holds = (self._low[near] <= self._low[index]) & (self._high[near] >= self._high[index])
        return near[holds.all(axis=1) & (near != index)]

    def within(self, index: int) -> Indices:
        """The boxes that box `index` holds, itself among them."""
        near = self._near(index, largest_reach=self._reach[index])
        held = (self._low[near] >= self._low[index]) & (self._high[near] <= self._high[index])
        return near[held.all(axis=1)]

    def _near(self, index: int, largest_reach: float) -> Indices:
        """Boxes whose centres are near enough: within their own reach, and within `largest_reach`."""
        found = [np.zeros(0, np.int64)]
        for same, tree, reach in self._sizes:
            radius = min(reach, largest_reach) * ROOM
            found.append(same[tree.query_ball_point(self._centre[index], radius, p=np.inf)])
        return np.concatenate(found)
