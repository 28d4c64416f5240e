import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fakesss.nested_boxes import NestedBoxes


@given(st.integers(1, 60), st.integers(0, 2**32 - 1))
def test_the_same_boxes_as_by_comparing_each_with_each(number: int, seed: int) -> None:
    """On a coarse grid of very different sizes, so that equal sides, equal boxes and boxes without extent occur."""
    rng = np.random.default_rng(seed)
    scale = 10.0 ** rng.integers(-6, 3, (number, 1))
    corners = rng.integers(-3, 4, (2, number, 3)) * scale
    low, high = corners.min(axis=0), corners.max(axis=0)
    boxes = NestedBoxes(low, high)
    for index in range(number):
        around = (low <= low[index]).all(axis=1) & (high >= high[index]).all(axis=1)
        within = (low >= low[index]).all(axis=1) & (high <= high[index]).all(axis=1)
        assert set(boxes.around(index)) == set(np.flatnonzero(around)) - {index}
        assert set(boxes.within(index)) == set(np.flatnonzero(within))
