import numpy as np
import pytest

from fakesss.contact_sheet import EMPTY, GAP, GROUND, INK, MARK, PLOT, SIDE, Mark, Panel, Plot, layered

HERE = np.ones((8, 10), bool)


def panel(side: int, **further: object) -> Panel:
    covered = np.ones((side, side), bool)
    return Panel("title", np.zeros((side, side)), covered, "note", "gray", (0.0, 1.0), **further)  # type: ignore[arg-type]


@pytest.mark.parametrize("side", [1, 40, SIDE, 1000, 4096])
def test_a_marked_line_one_pixel_wide_is_seen_at_any_size(side: int) -> None:
    column = np.zeros((side, side), bool)
    column[:, side // 2] = True
    picture = np.asarray(panel(side, marks=(Mark(column, MARK, "here"),)).picture())
    assert picture.shape == (SIDE, SIDE, 3)
    assert np.abs(picture.astype(int) - MARK).max(axis=2).min(axis=1).max() < 100


def test_colours_follow_the_limits_and_what_is_not_covered_is_empty() -> None:
    values = np.tile([0.0, 1.0, 3.0, 2.0], (4, 1))
    shown = Panel("t", values, values < 3, "n", "gray", (0.0, 2.0)).picture()
    row = np.asarray(shown)[SIDE // 2, SIDE // 8 :: SIDE // 4]
    assert row[[0, 3]].tolist() == [[0, 0, 0], [255, 255, 255]] and row[2].tolist() == list(EMPTY)
    assert abs(int(row[1, 0]) - 128) < 2
    assert Panel("t", values, values < 3, "n", "gray").range() == (0.0, 2.0)
    assert Panel("t", values, values > 9, "n", "gray").range() == (0.0, 1.0)


def test_the_marked_row_is_dashed() -> None:
    picture = np.asarray(panel(32, line=16).picture())
    assert (picture == INK).all(axis=2).sum(axis=1).nonzero()[0].tolist() == [round(16.5 * SIDE / 32)]


def test_plots_get_the_room_of_their_columns() -> None:
    asked = []

    def draw(size: tuple[int, int]) -> np.ndarray:
        asked.append(size)
        return np.full((size[1], size[0], 3), 7, np.uint8)

    flat = Panel("t", np.zeros((8, 10)), HERE, "n", "gray")
    sheet = np.asarray(layered([{"a": flat, "b": flat, "c": flat}, {"d": flat, "e": Plot("p", draw, "n")}]))
    assert asked == [(2 * SIDE + GAP, PLOT)]
    assert sheet.shape[1] == GAP + 3 * (SIDE + GAP)
    assert (sheet == 7).all(axis=2).sum() == asked[0][0] * asked[0][1]
    assert sheet[0, 0].tolist() == list(GROUND)
