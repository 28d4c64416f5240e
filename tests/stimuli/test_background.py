"""Work on threads: bounded, in order, nothing lost, errors told once."""

import threading
import time

import pytest

from stimuli.background import MEMORY, WAITING, Background

SIZE = (64, 64)


def test_everything_given_is_done_on_leaving() -> None:
    done: list[int] = []
    with Background(SIZE) as background:
        for number in range(50):
            background.submit(lambda number=number: done.append(number))
    assert sorted(done) == list(range(50))


def test_the_giver_goes_on_meanwhile_until_so_many_wait() -> None:
    gate, given = threading.Event(), []

    def give() -> None:
        with Background(SIZE) as background:
            for number in range(WAITING + 5):
                background.submit(lambda: gate.wait() and None)
                given.append(number)

    giver = threading.Thread(target=give)
    giver.start()
    for _ in range(500):
        if len(given) == WAITING:  # the next one is given, and its giver waits
            break
        time.sleep(0.01)
    time.sleep(0.05)
    reached = len(given)
    gate.set()
    giver.join()
    assert (reached, len(given)) == (WAITING, WAITING + 5)


@pytest.mark.parametrize(
    ("size", "limit"), [((1, 1), WAITING), ((512, 512), WAITING), ((4096, 4096), 1), ((16384, 16384), 1)]
)
def test_huge_pictures_wait_alone(size: tuple[int, int], limit: int) -> None:
    assert Background(size).limit == limit
    assert limit == 1 or limit * size[0] * size[1] * 16 <= MEMORY


def refuse() -> None:
    raise OSError("disk full")


def test_an_error_ends_the_block_and_what_was_given_before_is_done() -> None:
    done: list[int] = []
    given: list[int] = []
    with pytest.raises(OSError, match="disk full"), Background(SIZE) as background:
        background.submit(lambda: time.sleep(0.1) or refuse())
        for number in range(100):
            given.append(number)
            background.submit(lambda number=number: done.append(number))
    assert sorted(done) == given
    assert len(given) < 100


def test_the_last_piece_can_fail_too() -> None:
    with pytest.raises(OSError, match="disk full"), Background(SIZE) as background:
        background.submit(refuse)


def test_an_interruption_waits_for_what_was_given_and_stays_the_interruption() -> None:
    done: list[int] = []
    with pytest.raises(KeyboardInterrupt), Background(SIZE) as background:
        background.submit(lambda: time.sleep(0.1) or done.append(1))
        background.submit(refuse)
        raise KeyboardInterrupt
    assert done == [1]
