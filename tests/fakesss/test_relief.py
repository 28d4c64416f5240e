"""The relief against a painter's loop and against where a block must stand."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from matplotlib import colormaps

from fakesss.contact_sheet import EMPTY
from fakesss.relief import BOARD, LINE, floating_horizon, inside, placed, relief


@given(st.integers(0, 2**31), st.integers(1, 9), st.integers(1, 20))
def test_the_nearest_row_that_rises_is_seen(seed: int, rows: int, height: int) -> None:
    """Against painting rows from the back to the front, each from its crest to the picture's bottom."""
    random = np.random.default_rng(seed)
    crest = random.uniform(-3, height + 3, (rows, 4))
    crest[random.random(crest.shape) < 0.2] = np.inf
    painted = np.full((height, 4), -1)
    for row in reversed(range(rows)):
        for column in range(4):
            top = np.clip(np.ceil(crest[row, column]), 0, height) if crest[row, column] < np.inf else height
            painted[int(top) :, column] = row
    below = np.ceil(np.where(np.isinf(crest), -1, crest)).max(axis=0)  # crests under the picture keep its last row
    seen = floating_horizon(crest, height)
    rows_above = [slice(0, height if last < height else height - 1) for last in below]
    for column, above in enumerate(rows_above):
        assert (seen[above, column] == painted[above, column]).all()


def test_the_board_is_ruled_and_nothing_stands_on_it() -> None:
    drawn = relief(np.zeros((20, 30)), np.zeros((20, 30), bool), 0.05, (200, 120), "cividis", 0.25)
    assert drawn.shape == (120, 200, 3) and drawn.dtype == np.uint8
    colours = {tuple(colour) for colour in drawn.reshape(-1, 3)}
    assert {EMPTY, BOARD, LINE} <= colours
    assert tuple(drawn[60, 100]) in (BOARD, LINE) and tuple(drawn[0, 0]) == EMPTY


def test_a_plateau_stands_as_high_as_it_is() -> None:
    """To scale: the crest of a plateau is its height times the rise above its foot, in the colour of the highest."""
    heights = np.full((60, 60), 0.4)
    covered = np.ones((60, 60), bool)
    drawn = relief(heights, covered, 1 / 60, (300, 300), "cividis", 0.25).astype(float)
    top = np.array(colormaps["cividis"](1.0)[:3]) * 255
    rows, columns = np.nonzero(np.abs(drawn - top).max(axis=2) < 3)
    assert len(rows) > 300 * 300 / 8
    margin = np.pad(heights, round(0.07 * 60))
    place = placed(margin, 1 / 60, (600, 600))
    on_top = inside(place) & (np.abs(place.row - 33.5) < 25) & (np.abs(place.column - 33.5) < 25)
    crest = place.foot[:, None] - 0.4 * place.rise
    assert abs(rows.min() - np.broadcast_to(crest, on_top.shape)[on_top].min() / 2) < 25
    assert abs(columns.mean() - 150) < 3


def test_one_pixel_and_one_row() -> None:
    for shape in ((1, 1), (1, 50), (50, 1)):
        drawn = relief(np.ones(shape), np.ones(shape, bool), 0.1, (80, 60), "cividis", 0.1)
        assert drawn.shape == (60, 80, 3) and (drawn != EMPTY).any()
