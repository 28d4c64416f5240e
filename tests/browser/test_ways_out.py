"""The ways out of a session and back into it: withdrawing from every page, and the offer to go on."""

from pathlib import Path

import httpx
import pytest
from playwright.sync_api import Page, expect
from steps import answerable, press_the_button
from survey_client import Participant
from trial_pages import begun, open_trials, short_study

from study_server.app import admin_secret

pytestmark = pytest.mark.browser

REMEMBERED = "localStorage.getItem('fakesss-session')"


def set_gate(url: str, study: Path, state: str) -> None:
    """As the researcher does it."""
    headers = {"Authorization": f"Bearer {admin_secret(study)}", "Accept": "application/json"}
    httpx.post(f"{url}/admin/gate", headers=headers, data={"state": state, "sure": "yes"}).raise_for_status()


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Six pictures; it begins with its instructions."""
    return short_study(tmp_path)


def test_withdrawing_is_offered_under_a_picture_and_after_closing(page: Page, url: str, study: Path) -> None:
    address = open_trials(page, url)
    for key in "44":
        page.keyboard.press(key)
    expect(page.locator("#next")).to_be_focused()  # not between the questions and Next
    page.keyboard.press("Tab")
    expect(page.get_by_role("link", name="Withdraw my answers")).to_be_focused()
    set_gate(url, study, "closed")
    page.goto(address)
    page.wait_for_selector("body.closed")
    expect(page.locator("main")).to_contain_text("What you have answered is kept.")
    page.get_by_role("link", name="Withdraw my answers").click()
    press_the_button(page, "withdraw")
    page.wait_for_selector("body.withdrawn")
    page.goto(url)  # as a newcomer to a closed study
    page.wait_for_selector("body.closed")
    expect(page.locator("main")).not_to_contain_text("What you have answered")
    expect(page.get_by_role("link", name="Withdraw my answers")).to_have_count(0)


def test_paused_who_is_under_way_is_offered_the_way_back(page: Page, url: str, study: Path) -> None:
    page.goto(url)
    press_the_button(page, "consent")
    page.wait_for_selector("body.instructions")
    set_gate(url, study, "paused")
    page.goto(url)
    page.wait_for_selector("body.paused")
    page.locator("#resume a").click()
    page.wait_for_selector("body.instructions")


def test_nobody_from_prolific_is_led_into_anothers_session(page: Page, url: str, study: Path) -> None:
    """Their link leads to their own session; an offer could only be another person's."""
    page.goto(f"{url}/?PROLIFIC_PID=A&STUDY_ID=S")
    press_the_button(page, "consent")
    page.wait_for_selector("body.instructions")
    assert page.evaluate(REMEMBERED) is None
    page.goto(url)
    press_the_button(page, "consent")  # somebody without a name
    page.wait_for_selector("body.instructions")
    nameless = page.evaluate(REMEMBERED)
    assert nameless
    for state, step in (("open", "consent"), ("paused", "paused")):
        set_gate(url, study, state)
        with page.expect_response("**/remember.js"):
            page.goto(f"{url}/?PROLIFIC_PID=B&STUDY_ID=S")
        page.wait_for_selector(f"body.{step}")
        page.wait_for_load_state("networkidle")
        expect(page.locator("#resume")).to_be_hidden()


def test_no_secret_address_stays_behind_when_the_session_is_over(page: Page, url: str) -> None:
    page.goto(url)
    press_the_button(page, "consent")
    page.wait_for_selector("body.instructions")
    assert page.evaluate(REMEMBERED)
    page.locator("main button").click()
    answerable(page, "1 of 6")
    page.reload()
    answerable(page, "1 of 6")
    page.get_by_role("link", name="Withdraw my answers").click()
    press_the_button(page, "withdraw")
    page.wait_for_selector("body.withdrawn")
    page.wait_for_function("() => localStorage.length === 0")


def test_a_session_elsewhere_is_not_forgotten_by_anothers_end(page: Page, url: str) -> None:
    other = begun(url)
    person = Participant(url).consent()
    person.post("withdraw", sure="yes")
    page.goto(other)
    page.evaluate("here => localStorage.setItem('fakesss-session', here)", other.removeprefix(url))
    page.goto(url + person.here)
    page.wait_for_load_state("networkidle")
    assert page.evaluate(REMEMBERED) == other.removeprefix(url)
