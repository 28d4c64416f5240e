"""The network goes away between two answers and comes back: the page says so, keeps the answer, and saves it once."""

import time
from pathlib import Path

import pytest
from playwright.sync_api import BrowserContext, Page, Route, expect
from steps import answerable, rate, ratings_by_trial, to_trials
from trial_pages import saved

from study_server.serve import served

pytestmark = pytest.mark.browser


def test_offline_for_a_while(page: Page, context: BrowserContext, url: str, study: Path) -> None:
    to_trials(page, url)
    context.set_offline(True)
    rate(page, "35")
    answerable(page, "2 of 3")  # one goes on meanwhile
    expect(page.locator("#saved")).to_contain_text("Not saved yet")
    page.wait_for_timeout(1000)
    context.set_offline(False)
    saved(page)
    assert ratings_by_trial(study)[1] == ("3", "5")


def test_the_reply_is_lost_but_not_the_answer(page: Page, url: str, study: Path) -> None:
    to_trials(page, url)
    lost = []

    def lose_reply(route: Route) -> None:
        if len(lost) < 2:
            lost.append(route.fetch())  # the server stores it; the browser hears nothing
            route.abort()
        else:
            route.continue_()

    page.route("**/ratings", lose_reply)
    rate(page, "62")
    saved(page)
    assert len(lost) == 2
    assert ratings_by_trial(study) == {1: ("6", "2"), 2: ("", ""), 3: ("", "")}


def test_the_server_restarts_in_the_middle(page: Page, study: Path) -> None:
    with served(study) as url:
        port = int(url.rsplit(":", 1)[1])
        to_trials(page, url)
    rate(page, "17")
    expect(page.locator("#saved")).to_contain_text("Not saved yet")
    time.sleep(0.5)
    with served(study, port=port):
        saved(page)
        assert ratings_by_trial(study)[1] == ("1", "7")


def test_a_slow_server_is_waited_for_and_impatience_does_no_harm(page: Page, url: str, study: Path) -> None:
    to_trials(page, url)

    def late(route: Route) -> None:
        time.sleep(0.7)
        route.continue_()

    page.route("**/ratings", late)
    for keys, count in (("11", "2 of 3"), ("22", "3 of 3")):
        for key in keys:
            page.keyboard.press(key)
        for _ in range(5):
            page.keyboard.press("Enter")
        answerable(page, count)
    saved(page)
    assert ratings_by_trial(study) == {1: ("1", "1"), 2: ("2", "2"), 3: ("", "")}
