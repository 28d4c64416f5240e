"""What a trial's page does when replies are late, missing or of another release, or storage is not understood."""

import contextlib
import itertools
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from outbox_pages import reachable, unreachable
from playwright.sync_api import APIResponse, BrowserContext, Error, Page, Route, expect
from steps import answerable, rate, rows
from survey_client import Participant
from trial_pages import begun, open_trials, saved, short_study
from whole_sessions import to_code

pytestmark = pytest.mark.browser

LAST = 6


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Six pictures; it begins with its instructions."""
    return short_study(tmp_path)


def is_page(route: Route) -> bool:
    """Whether a whole page is asked for."""
    return route.request.resource_type == "document"


def test_between_two_pages_a_server_that_is_away_is_waited_for(page: Page, url: str) -> None:
    """A restart behind a proxy at the last answer: 502 stayed on the screen, and the code was never seen."""
    open_trials(page, url)
    for trial in range(1, LAST):
        rate(page, "44")
        answerable(page, f"{trial + 1} of {LAST}")
    failures: list[str] = []

    def away(route: Route) -> None:
        if len(failures) < 3:
            failures.append(route.request.resource_type)
            route.fulfill(status=502, body="<h1>502 Bad Gateway</h1>", content_type="text/html")
        else:
            route.continue_()

    saved(page)
    page.route("**/s/*", away)
    rate(page, "44")
    expect(page.locator("#saved")).to_contain_text("No connection")
    assert len(to_code(page)) == 8
    assert failures == ["fetch"] * 3  # no page was lost to an error page


def test_closed_while_a_picture_loads(page: Page, url: str, study: Path) -> None:
    """The fixture fails the test if a script fails."""
    held: list[Route] = []
    is_first = iter([True])
    page.route("**/picture/*", lambda route: route.continue_() if next(is_first, False) else held.append(route))
    address = open_trials(page, url)
    page.route("**/ratings", lambda route: reply_with(route, {"step": "closed"}))
    page.route("**/s/*", lambda route: route.fulfill(status=204) if is_page(route) else route.continue_())
    with page.expect_response("**/ratings"):
        rate(page, "44")
    expect(page.locator("#count")).to_have_text("2 of 6")
    for route in held:
        route.continue_()
    expect(page.locator("#stage img")).to_be_visible()
    expect(page.locator(".question input").first).to_be_enabled()
    assert page.url == address


def reply_with(route: Route, changes: dict[str, Any]) -> None:
    """The server's reply to saved answers, with another next page."""
    response = route.fetch()
    reply = response.json()
    route.fulfill(response=response, json={**reply, "next": changes})


def test_a_late_reply_does_not_show_again_what_another_tab_answered(
    page: Page, context: BrowserContext, url: str, study: Path
) -> None:
    address = open_trials(page, url)
    second = context.new_page()
    late: list[tuple[Route, APIResponse]] = []

    def hold(route: Route) -> None:
        if is_page(route) or late:
            route.continue_()
        else:
            late.append((route, route.fetch()))

    second.route("**/s/*", hold)
    with second.expect_request(lambda request: request.resource_type == "fetch" and "/s/" in request.url):
        second.goto(address)
    while not late:
        second.wait_for_timeout(10)
    rate(page, "44")
    answerable(page, "2 of 6")
    saved(page)
    second.evaluate("null")
    route, response = late[0]
    route.fulfill(response=response)
    answerable(second, "2 of 6")
    assert [row["revision"] for row in rows(study) if row["rating"]] == ["0", "0"]


def test_an_old_picture_does_not_stand_under_a_new_number(page: Page, url: str) -> None:
    held: list[Route] = []
    open_for = iter([True])
    page.route("**/picture/*", lambda route: route.continue_() if next(open_for, False) else held.append(route))
    open_trials(page, url)
    rate(page, "44")
    expect(page.locator("#count")).to_have_text("2 of 6")
    expect(page.locator("#stage")).to_have_text("Loading the picture …")
    expect(page.locator("#stage img")).to_have_count(0)
    open_for = itertools.repeat(True)
    for route in held:
        route.continue_()
    answerable(page, "2 of 6")
    expect(page.locator("#waiting")).to_have_count(0)


def test_an_answer_that_only_memory_holds_keeps_nobody_on_a_dead_page(page: Page, url: str) -> None:
    dialogs: list[str] = []
    page.on("dialog", lambda dialog: (dialogs.append(dialog.type), dialog.dismiss()))
    page.add_init_script("Storage.prototype.setItem = () => { throw new DOMException('', 'QuotaExceededError'); }")
    address = open_trials(page, url)
    unreachable(page)
    rate(page, "44")
    expect(page.locator("#saved")).to_contain_text("Not saved yet")
    person = Participant(url)
    person.here = address.removeprefix(url)
    person.post("withdraw", sure="yes")
    reachable(page)
    page.wait_for_selector("body.withdrawn")
    assert dialogs == []


def test_two_releases_behind_one_address_do_not_load_pages_for_ever(page: Page, url: str) -> None:
    loads: list[str] = []

    def other(route: Route) -> None:
        if is_page(route):
            loads.append(route.request.url)
            route.continue_()
        else:
            with contextlib.suppress(Error):  # the page that asked is gone
                response = route.fetch()
                route.fulfill(response=response, json={**response.json(), "release": "another"})

    page.route("**/s/*", other)
    page.goto(begun(url))
    page.wait_for_function("() => history.state?.renewedFor?.length === 1")
    answerable(page, "1 of 6")
    rate(page, "44")
    answerable(page, "2 of 6")
    assert len(loads) == 2


STRANGE: dict[str, Callable[[str], tuple[str, object]]] = {
    "another's key": lambda here: (f"fakesss-outbox {here} 0 abcdefgh", {"answer": {"place": 0}, "page": "x"}),
    "a number": lambda here: (f"fakesss-outbox {here} 0 abcdefgh", 7),
    "a showing": lambda here: (f"fakesss-shown {here}", {"trial": 0, "shownAt": None}),
}


@pytest.mark.parametrize("what", STRANGE)
def test_what_is_stored_and_not_understood_stops_nobody(page: Page, url: str, study: Path, what: str) -> None:
    address = begun(url)
    page.goto(f"{url}/health")
    name, entry = STRANGE[what](address.removeprefix(url))
    page.evaluate("([name, text]) => localStorage.setItem(name, text)", [name, json.dumps(entry)])
    page.goto(address)
    answerable(page, "1 of 6")
    rate(page, "44")
    saved(page)
    assert [row["rating"] for row in rows(study) if row["rating"]] == ["4", "4"]
