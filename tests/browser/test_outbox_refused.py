"""What the outbox does with replies: refusals, a busy server, strangers' pages, a study closed or a server set back."""

import sqlite3
import time
from pathlib import Path

import pytest
from outbox_pages import reachable, stored, unreachable, until_none_is_kept
from playwright.sync_api import Page, Route, expect
from steps import answerable, rate, ratings_by_trial
from survey_client import Participant
from trial_pages import open_trials, short_study

pytestmark = pytest.mark.browser


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Six pictures, two questions, and nothing before the first trial but the instructions."""
    return short_study(tmp_path)


def test_a_refused_answer_is_told_and_the_later_ones_are_kept(page: Page, url: str, study: Path) -> None:
    open_trials(page, url)
    unreachable(page)
    for n in (1, 2):
        rate(page, "26")
        answerable(page, f"{n + 1} of 6")
    page.unroute("**/ratings")
    page.route("**/ratings", forge_first)
    page.evaluate("dispatchEvent(new Event('online'))")
    expect(page.locator("#saved")).to_contain_text("not the one that belongs here")
    rate(page, "33")
    answerable(page, "1 of 6")  # once more, since it counts
    rate(page, "44")
    answerable(page, "4 of 6")
    expect(page.locator("#saved")).to_have_text("Saved")
    assert [ratings_by_trial(study)[n] for n in (1, 2, 3)] == [("4", "4"), ("2", "6"), ("3", "3")]
    assert len({row["submission"] for row in stored(study)}) == 3


def forge_first(route: Route) -> None:
    """Of the first trial's first attempt: say that another picture was on the screen."""
    body = route.request.post_data_json
    if body["place"] == 0 and body["answers"][0]["rating"] == 2:
        body["stimulus_sha256"] = "0" * 64
    route.continue_(post_data=body)


def test_withdrawn_elsewhere_leaves_nothing_on_this_computer(page: Page, url: str, study: Path) -> None:
    address = open_trials(page, url)
    unreachable(page)
    rate(page, "26")
    answerable(page, "2 of 6")
    person = Participant(url)
    person.here = address.removeprefix(url)
    person.post("withdraw", sure="yes")
    reachable(page)
    page.wait_for_selector("body.withdrawn")
    until_none_is_kept(page)
    assert stored(study) == []


def test_a_busy_server_is_left_alone_for_as_long_as_it_asks(page: Page, url: str) -> None:
    open_trials(page, url)
    tried: list[float] = []

    def busy(route: Route) -> None:
        tried.append(time.monotonic())
        if len(tried) == 1:
            route.fulfill(status=429, headers={"Retry-After": "3"}, json={"error": "Later."})
        else:
            route.continue_()

    page.route("**/ratings", busy)
    rate(page, "26")
    expect(page.locator("#saved")).to_contain_text("Not saved yet")
    page.evaluate("dispatchEvent(new Event('online'))")
    expect(page.locator("#saved")).to_have_text("Saved")
    assert len(tried) == 2 and tried[1] - tried[0] > 2.9


STRANGE = {
    "a hotel's login page": {"status": 200, "body": "<h1>Welcome</h1>", "content_type": "text/html"},
    "a firewall": {"status": 403, "body": "<h1>No</h1>", "content_type": "text/html"},
    "half a reply": {"status": 200, "body": '{"saved": [', "content_type": "application/json"},
    "somebody else's JSON": {"status": 200, "body": "{}", "content_type": "application/json"},
    "a proxy without its server": {"status": 502, "body": "Bad gateway"},
    "a slow proxy": {"status": 408, "body": ""},
}


def test_what_is_no_answer_of_ours_is_tried_again(page: Page, url: str, study: Path) -> None:
    open_trials(page, url)
    replies = iter(STRANGE.values())

    def strange(route: Route) -> None:
        reply = next(replies, None)
        route.fulfill(**reply) if reply else route.continue_()

    page.route("**/ratings", strange)
    rate(page, "26")
    answerable(page, "2 of 6")
    expect(page.locator("#saved")).to_contain_text("Not saved yet")
    while page.locator("#saved").inner_text() != "Saved":
        page.evaluate("dispatchEvent(new Event('online'))")  # lest every attempt waits longer than the one before
        page.wait_for_timeout(20)
    assert next(replies, None) is None
    assert ratings_by_trial(study)[1] == ("2", "6")


def test_answers_to_a_study_that_was_closed_meanwhile_still_arrive(page: Page, url: str, study: Path) -> None:
    address = open_trials(page, url)
    unreachable(page)
    rate(page, "26")
    answerable(page, "2 of 6")
    database = sqlite3.connect(study / "ratings.sqlite")
    (identity,) = database.execute("select identity from studies").fetchone()
    database.execute("insert into gates (study, mode, at, state) values (?, 'live', 0, 'closed')", [identity])
    database.commit()
    database.close()
    page.unroute("**/ratings")
    page.goto(address)
    page.wait_for_selector("body.closed")
    until_none_is_kept(page)
    assert ratings_by_trial(study)[1] == ("2", "6")


def test_a_server_restored_from_a_backup_gets_what_is_due_first(
    page: Page, url: str, study: Path, tmp_path: Path
) -> None:
    address = open_trials(page, url)
    rate(page, "11")
    answerable(page, "2 of 6")
    expect(page.locator("#saved")).to_have_text("Saved")
    unreachable(page)
    rate(page, "22")
    answerable(page, "3 of 6")
    database = sqlite3.connect(study / "ratings.sqlite")
    database.execute("delete from ratings")
    database.execute("update presentations set answered_at = null")
    database.commit()
    database.close()
    page.unroute("**/ratings")
    page.goto(address)
    answerable(page, "1 of 6")
    rate(page, "33")
    answerable(page, "3 of 6")
    expect(page.locator("#saved")).to_have_text("Saved")
    assert [ratings_by_trial(study)[n] for n in (1, 2)] == [("3", "3"), ("2", "2")]
