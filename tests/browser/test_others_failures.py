"""What others' participants lived through in the middle of a study, replayed with real sockets and a real browser.

What is in test_network_cut.py, test_outbox.py and test_pictures_fetched.py is not here once more.
"""

import contextlib
from collections.abc import Iterator
from pathlib import Path

import pytest
from faulty_network import FaultyNetwork, faulty_network
from playwright.sync_api import Page, expect
from steps import rate
from trial_pages import begun, saved, short_study
from whole_sessions import all_is_stored, answer, answered, due, keys_of, to_code

from study_server.serve import served

pytestmark = pytest.mark.browser

TRIALS = 6
ABORT_BY_THE_CLOCK = """AbortSignal.timeout = (ms) => {
    const abort = new AbortController();
    setTimeout(() => abort.abort(), ms);
    return abort.signal;
};"""
"""Playwright's clock leads setTimeout and not this; so this is made of that."""

CUTS = [
    ("reset", 1, "true time", 0),
    ("swallowed", 1, "the page's clock", 3),
    ("reset", 30, "the page's clock", 3),
    ("swallowed", 30, "the page's clock", 3),
    ("reset", 300, "the page's clock", 0),
    ("swallowed", 300, "the page's clock", 3),
    *(
        pytest.param(manner, seconds, "true time", ahead, marks=[pytest.mark.long, pytest.mark.timeout(1800)])
        for manner in ("reset", "swallowed")
        for seconds, ahead in ((1, 0), (1, 3), (30, 0), (30, 3), (300, 3))
    ),
]


def fetched_pictures(page: Page) -> set[str]:
    """Addresses of the pictures that have come whole, which grow as they come."""
    fetched: set[str] = set()
    page.on("requestfinished", lambda request: fetched.add(request.url) if "/picture/" in request.url else None)
    return fetched


def wait_for_pictures(page: Page, fetched: set[str], number: int) -> None:
    """Until so many have come."""
    while len(fetched) < number:
        page.wait_for_timeout(20)


@pytest.mark.parametrize(("manner", "seconds", "measured_by", "ahead"), CUTS)
def test_network_away_at_every_trial(
    page: Page, tmp_path: Path, manner: str, seconds: int, measured_by: str, ahead: int
) -> None:
    """JATOS#304, #306: 10 to 20 % of people were stuck after their network was away for a moment.

    With `ahead` = 0 the network is away at each of the six trials; otherwise people answer on until they are to wait.
    """
    study = short_study(tmp_path, TRIALS, unsaved_ahead=ahead)
    with served(study) as url, faulty_network(url) as network:
        is_pretended = measured_by == "the page's clock"
        if is_pretended:
            page.add_init_script(ABORT_BY_THE_CLOCK)
            page.clock.install()
        fetched = fetched_pictures(page)
        page.goto(network.url + begun(url).removeprefix(url))
        for first in range(1, TRIALS + 1, ahead + 1):
            due(page, first)
            wait_for_pictures(page, fetched, min(first + max(ahead, 1), TRIALS))  # that may be looked at meanwhile
            network.cut() if manner == "reset" else network.swallow()
            last = min(first + ahead, TRIALS)
            for trial in range(first, last + 1):
                answer(page, trial)
            expect(page.locator("#saved")).to_contain_text("It goes on" if manner == "swallowed" else "it goes on")
            pretend(page, manner, seconds) if is_pretended else page.wait_for_timeout(1000 * seconds)
            expect(page.locator("#count")).to_have_text(f"{last} of {TRIALS}")  # waits, and says so
            network.heal()
            while is_pretended and not goes_on(page, last):
                page.clock.fast_forward(31_000)  # an attempt over a connection that went silent is given up ...
                page.clock.fast_forward(13_000)  # ... and made again, over another
        code = to_code(page)
    all_is_stored(study, code)
    if seconds >= 30:
        waited = [stored_at - shown_at for _, stored_at, shown_at in answered(study)]
        assert seconds <= waited[0] < seconds + 600


def goes_on(page: Page, after: int) -> bool:
    """Whether the page soon shows something else than this trial."""
    with contextlib.suppress(AssertionError):
        expect(page.locator(f"#count:text-is('{after} of {TRIALS}')")).to_have_count(0, timeout=1000)
        return True
    return False


def pretend(page: Page, manner: str, seconds: int) -> None:
    """Let so much time pass for the page's clock. Attempts that fall into it are really made, and fail."""
    for _ in range(0, seconds, 13 if manner == "reset" else 44):
        with page.expect_event("requestfailed"):
            page.clock.fast_forward(13_000 if manner == "reset" else 31_000)
        if manner == "swallowed":
            with page.expect_request("**/ratings"):
                page.clock.fast_forward(13_000)


@pytest.mark.parametrize(
    ("practice", "trials", "latency_s"),
    [(0, 6, 0.4), pytest.param(11, 9, 3.0, marks=[pytest.mark.long, pytest.mark.timeout(900)])],
)
def test_answers_against_latency(page: Page, tmp_path: Path, practice: int, trials: int, latency_s: float) -> None:
    """osweb#160: who answered faster than the server saved lost trials. Long: 20 answers against 3 s."""
    study = short_study(tmp_path, trials, practice=practice)
    with served(study) as url, faulty_network(url) as network:
        page.goto(network.url + begun(url, ready=False).removeprefix(url))
        page.wait_for_selector("#stage img")
        network.latency(response=latency_s)
        for trial in range(1, practice + 1):
            expect(page.locator("#count")).to_have_text(f"Practice {trial} of {practice}", timeout=90_000)
            expect(page.locator(".question input").first).to_be_enabled(timeout=90_000)
            rate(page, keys_of(trial))
        if practice:
            page.wait_for_selector("body.ready", timeout=90_000)
            page.locator("main button").press("Enter")
        for trial in range(1, trials + 1):
            answer(page, trial)
        code = to_code(page)
    all_is_stored(study, code, trials)


def test_refresh_at_every_trial(page: Page, tmp_path: Path) -> None:
    """psiTurk PR 51: who reloaded began anew, or skipped a trial. Here before, in and right after each answer."""
    study = short_study(tmp_path, TRIALS)
    with served(study) as url, faulty_network(url) as network:
        page.goto(network.url + begun(url).removeprefix(url))
        for trial in range(1, TRIALS + 1):
            due(page, trial)
            page.reload()
            due(page, trial)
            page.keyboard.press("1")
            page.reload()
            due(page, trial)
            expect(page.locator("input:checked")).to_have_count(0)
            if trial % 2:
                network.latency(request=0.5, where="POST ")
                rate(page, keys_of(trial))  # on its way while the page goes
            else:
                rate(page, keys_of(trial))
                saved(page) if trial < TRIALS else page.wait_for_selector("body.comments")
            page.reload()
            network.latency()
        page.wait_for_selector("body.comments")
        page.go_back()
        page.go_forward()
        code = to_code(page)
        page.reload()
        assert page.locator("#code").inner_text() == code
    all_is_stored(study, code)


@pytest.fixture
def slow_pictures(page: Page, tmp_path: Path) -> Iterator[tuple[Path, FaultyNetwork]]:
    """The page at the first trial, whose picture and all others are late."""
    study = short_study(tmp_path, TRIALS)
    with served(study) as url, faulty_network(url) as network:
        network.latency(response=0.7, where="GET /picture/")
        page.goto(network.url + begun(url).removeprefix(url))
        yield study, network


def test_impatient_fingers_skip_nothing(page: Page, slow_pictures: tuple[Path, FaultyNetwork]) -> None:
    """Keys before the picture is there, keys held until they repeat, double clicks: each trial is answered once."""
    study, network = slow_pictures
    for trial in range(1, TRIALS + 1):
        if trial == 1:
            network.wait_for_request("GET /picture/")
            rate(page, "77")  # nothing to be seen yet
        due(page, trial)
        expect(page.locator("input:checked")).to_have_count(0)
        first, second = keys_of(trial)
        hold(page, first)
        expect(page.locator("input:checked")).to_have_count(1)  # the second question is not answered by the first's key
        page.keyboard.press(second)
        if trial % 2:
            page.locator("#next").dblclick()
        else:
            hold(page, "Enter")
    code = to_code(page)
    all_is_stored(study, code)


def hold(page: Page, key: str) -> None:
    """A key held so long that the keyboard repeats it."""
    for _ in range(12):
        page.keyboard.down(key)
    page.keyboard.up(key)


@pytest.mark.parametrize("hours", [1, -1])
def test_the_clock_is_set_while_an_answer_waits(page: Page, tmp_path: Path, hours: int) -> None:
    """A computer that asks a time server. Set back it changes nothing.

    Set forward it cannot be told from a computer that slept so long: the picture then seems to have been shown by that
    much too early, and never too late.
    """
    study = short_study(tmp_path, TRIALS)
    with served(study) as url, faulty_network(url) as network:
        page.clock.install()
        fetched = fetched_pictures(page)
        page.goto(network.url + begun(url).removeprefix(url))
        due(page, 1)
        wait_for_pictures(page, fetched, 2)
        network.cut()
        answer(page, 1)
        due(page, 2)
        page.clock.set_system_time(page.evaluate("Date.now()") / 1000 + 3600 * hours)
        network.heal()
        saved(page)
    [(_, stored_at, shown_at)] = answered(study)
    assert 0 <= stored_at - shown_at - max(3600 * hours, 0) < 60
