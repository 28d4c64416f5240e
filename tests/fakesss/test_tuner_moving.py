"""How large a picture is drawn while something moves: large enough to see, small enough to keep up."""

import pytest

from fakesss.tuner.moving import BUDGET_MS, Pace

FULL = 512 * 512


def drawn(pace: Pace, fixed: float, each: float, frames: int = 6, still: int = 9) -> list[int]:
    """The scales of some frames of a machine that takes `fixed` ms and `each` ms a sample at full size."""
    scales = []
    pace.note(False, still * FULL, fixed + each * still)
    for _ in range(frames):
        scales.append(pace.scale(FULL))
        samples = FULL // scales[-1] ** 2
        pace.note(True, samples, fixed + each * samples / FULL)
    return scales


def test_at_first_nothing_is_known() -> None:
    assert Pace().scale(FULL) == 1


@pytest.mark.parametrize(
    ("fixed", "each", "scale"),
    [
        (5, 20, 1),  # quick
        (10, 100, 2),  # half the size takes 35 ms
        (10, 400, 4),
        (100, 400, 4),  # beyond the budget at any size, but a quarter comes soonest
        (200, 10, 1),  # the vertices take the time: a smaller picture would only look worse
        (BUDGET_MS, 40, 2),
    ],
)
def test_the_scale_that_keeps_up_or_helps(fixed: float, each: float, scale: int) -> None:
    pace = Pace()
    assert drawn(pace, fixed, each)[-1] == scale
    assert drawn(pace, fixed, each) == [scale] * 6  # and stays


def test_a_machine_that_was_slow_for_a_while() -> None:
    pace = Pace()
    assert drawn(pace, 10, 400)[-1] == 4
    assert drawn(pace, 5, 20)[-1] == 1
    assert drawn(pace, 10, 400)[-1] == 4


def test_a_still_picture_as_small_as_a_moving_one() -> None:
    """With one sample a pixel, and when the size was changed in between."""
    for still in (1, 0.25):
        pace = Pace()
        pace.note(False, int(still * FULL), 40)
        pace.note(True, FULL, 40)
        assert pace.scale(FULL) == 1
        pace.note(True, FULL, 400)
        assert pace.best(FULL) > 1


def test_one_picture_that_was_held_up_changes_nothing() -> None:
    pace = Pace()
    assert drawn(pace, 5, 20)[-1] == 1
    scales = []
    for ms in (25, 300, 25, 25, 300, 300, 300):
        pace.note(True, FULL, ms)
        scales.append(pace.scale(FULL))
    assert scales[:5] == [1] * 5 and scales[-1] > 1
