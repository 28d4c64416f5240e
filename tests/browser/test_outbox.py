"""The ordered outbox: answers run a few trials ahead of what is saved, survive whatever happens to the page, and arrive
once, in order, with the time at which they were given."""

import contextlib
import json
from collections.abc import Callable
from pathlib import Path

import pytest
from outbox_pages import STOPPED, UNSAVED, kept, reachable, stored, unreachable
from playwright.sync_api import BrowserContext, Dialog, Error, Page, Request, expect
from steps import answerable, rate, ratings_by_trial
from trial_pages import open_trials, saved, short_study

pytestmark = pytest.mark.browser


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Six pictures, two questions, and nothing before the first trial but the instructions."""
    return short_study(tmp_path)


def test_a_participant_runs_ahead_until_the_limit_and_everything_arrives_in_order(
    page: Page, context: BrowserContext, url: str, study: Path
) -> None:
    open_trials(page, url)
    context.set_offline(True)
    for n in (1, 2, 3):
        rate(page, f"{n}{n + 1}")
        answerable(page, f"{n + 1} of 6")
        expect(page.locator("#saved")).to_have_text(UNSAVED.format(n))
    rate(page, "45")
    expect(page.locator("#saved")).to_contain_text(STOPPED.format(4))
    page.keyboard.press("7")  # what waits to be saved cannot be changed any more
    expect(page.locator("#count")).to_have_text("4 of 6")
    assert [entry["answer"]["place"] for entry in kept(page)] == [0, 1, 2, 3]
    assert not any(rating for ratings in ratings_by_trial(study).values() for rating in ratings)

    sent: list[int] = []
    page.on("request", lambda request: sent.append(request.post_data_json["place"]) if is_answer(request) else None)
    context.set_offline(False)
    answerable(page, "5 of 6")
    expect(page.locator("#saved")).to_have_text("Saved")
    assert kept(page) == []
    assert sent == sorted(sent) and set(sent) == {0, 1, 2, 3}
    assert [row["place"] for row in stored(study)] == [0, 0, 1, 1, 2, 2, 3, 3]
    rated = ratings_by_trial(study)
    assert [rated[n] for n in (1, 2, 3, 4)] == [("1", "2"), ("2", "3"), ("3", "4"), ("4", "5")]


def is_answer(request: Request) -> bool:
    """Whether this request brings answers."""
    return request.url.endswith("/ratings")


@pytest.mark.parametrize("happens", ["reload", "tab closed", "crash"])
def test_unsaved_answers_survive(page: Page, context: BrowserContext, url: str, study: Path, happens: str) -> None:
    address = open_trials(page, url)
    context.route("**/ratings", lambda route: route.abort())
    rate(page, "26")
    answerable(page, "2 of 6")
    rate(page, "71")
    answerable(page, "3 of 6")
    page.keyboard.press("5")  # half an answer is none
    names = [entry["answer"]["submission"] for entry in kept(page)]
    if happens == "reload":
        page.reload()
    else:
        old, page = page, context.new_page()
        if happens == "crash":
            crash(old)
        old.close()
        page.goto(address)
    expect(page.locator("#saved")).to_contain_text(STOPPED.format(2))
    context.unroute("**/ratings")
    answerable(page, "3 of 6")
    expect(page.locator("#saved")).to_have_text("Saved")
    assert ratings_by_trial(study) == {1: ("2", "6"), 2: ("7", "1"), **dict.fromkeys((3, 4, 5, 6), ("", ""))}
    assert [row["submission"] for row in stored(study)] == [names[0], names[0], names[1], names[1]]


def crash(page: Page) -> None:
    """The tab's process dies."""
    with page.expect_event("crash"), contextlib.suppress(Error):
        page.goto("chrome://crash")


@pytest.mark.parametrize(("waited_s", "expected_s"), [(3600, 3600), (-3600, 0), (40 * 86_400, 29 * 86_400)])
def test_the_time_is_right_after_waiting(page: Page, url: str, study: Path, waited_s: float, expected_s: float) -> None:
    open_trials(page, url)
    unreachable(page)
    rate(page, "26")
    answerable(page, "2 of 6")
    (entry,) = kept(page)
    entry["clock"] -= waited_s * 1000  # a clock that was set back looks like an answer from the future
    page.evaluate(
        "entry => localStorage.setItem(Object.keys(localStorage).find(k => k.startsWith('fakesss-outbox')), entry)",
        json.dumps(entry),
    )
    page.unroute("**/ratings")
    page.reload()
    answerable(page, "2 of 6")
    row = stored(study)[0]
    assert row["rt_ms"] < 20_000
    assert row["stored_at"] - row["shown_at"] == pytest.approx(expected_s, abs=30)


def fill_storage(page: Page) -> None:
    """Leave no room for an answer."""
    page.evaluate(
        """() => {
            for (let piece = 2 ** 22; piece >= 1; piece /= 2)
                try { for (let i = 0; ; i++) localStorage.setItem(`x${piece}-${i}`, "x".repeat(piece)); } catch {}
        }"""
    )


def test_full_storage_means_no_running_ahead(page: Page, url: str, study: Path) -> None:
    open_trials(page, url)
    fill_storage(page)
    one_answer_at_a_time(page, study)


def test_blocked_storage_means_no_running_ahead(
    launch_with: Callable[..., BrowserContext], url: str, study: Path
) -> None:
    page = launch_with({"profile": {"default_content_setting_values": {"cookies": 2}}}).new_page()
    open_trials(page, url)
    with pytest.raises(Error, match="SecurityError"):
        page.evaluate("localStorage.length")
    one_answer_at_a_time(page, study)


def one_answer_at_a_time(page: Page, study: Path) -> None:
    """Each answer is saved before the next picture, and leaving before that is warned of."""
    warnings: list[Dialog] = []
    page.on("dialog", lambda dialog: (warnings.append(dialog), dialog.dismiss()))
    unreachable(page)
    rate(page, "26")
    expect(page.locator("#saved")).to_contain_text(STOPPED.format(1))
    expect(page.locator("#count")).to_have_text("1 of 6")
    page.evaluate("setTimeout(() => location.reload())")  # page.reload would wait for a page that does not come
    warnings or page.wait_for_event("dialog")
    assert [dialog.type for dialog in warnings] == ["beforeunload"]
    reachable(page)
    answerable(page, "2 of 6")
    expect(page.locator("#saved")).to_have_text("Saved")
    assert ratings_by_trial(study)[1] == ("2", "6")
    page.reload()  # nothing is unsaved: no warning
    answerable(page, "2 of 6")
    assert len(warnings) == 1


def test_two_tabs_share_one_outbox(page: Page, context: BrowserContext, url: str, study: Path) -> None:
    address = open_trials(page, url)
    unreachable(page)
    rate(page, "26")
    answerable(page, "2 of 6")
    rate(page, "37")
    answerable(page, "3 of 6")
    other = context.new_page()
    other.goto(address)  # brings the first tab's answers to the server and goes on after them
    answerable(other, "3 of 6")
    expect(page.locator("#saved")).to_have_text("Saved")
    rate(other, "44")
    answerable(other, "4 of 6")
    saved(other)
    page.unroute("**/ratings")
    page.bring_to_front()
    rate(page, "55")  # the first tab still shows trial 3: another answer to it, and then where the other one is
    answerable(page, "4 of 6")
    saved(page)
    assert [(row["place"], row["rating"]) for row in stored(study)] == [
        *((0, 2), (0, 6), (1, 3), (1, 7), (2, 4), (2, 4), (2, 5), (2, 5))
    ]
