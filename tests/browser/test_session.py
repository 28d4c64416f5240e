"""A whole session through a real browser: by keyboard, interrupted in every ordinary way, and every row there once."""

from pathlib import Path

import pytest
from playwright.sync_api import BrowserContext, Page, expect
from steps import answerable, rate, ratings_by_trial, rows, to_practice, to_trials
from study_fixture import write_study
from survey_client import ABOUT, Participant
from trial_pages import begun, saved

from study_server.serve import served

pytestmark = pytest.mark.browser


def test_a_session_by_keyboard_with_refresh_back_double_click_and_second_tab(
    page: Page, context: BrowserContext, url: str, study: Path
) -> None:
    to_trials(page, url)
    rate(page, "26")
    answerable(page, "2 of 3")

    page.keyboard.press("3")
    page.reload()  # half-answered: the same picture again, nothing stored of it
    answerable(page, "2 of 3")
    page.go_back()
    page.go_forward()
    answerable(page, "2 of 3")
    page.keyboard.press("3")
    page.keyboard.press("5")
    page.locator("#next").dblclick()  # the second click must not answer or skip picture 3
    answerable(page, "3 of 3")
    expect(page.locator("input:checked")).to_have_count(0)

    second = context.new_page()
    second.goto(page.url)
    answerable(second, "3 of 3")
    rate(second, "71")
    second.wait_for_selector("body.comments")
    rate(page, "71")  # the first tab sends the same answers and follows
    page.wait_for_selector("body.comments")
    page.locator("main button").focus()
    page.keyboard.press("Enter")
    code = page.locator("#code").inner_text()
    assert len(code) == 8
    second.reload()
    assert second.locator("#code").inner_text() == code

    assert ratings_by_trial(study) == {1: ("2", "6"), 2: ("3", "5"), 3: ("7", "1")}
    assert {row["revision"] for row in rows(study)} == {"0"}


def test_a_second_tab_with_another_answer_is_a_revision(
    page: Page, context: BrowserContext, url: str, study: Path
) -> None:
    to_trials(page, url)
    second = context.new_page()
    second.goto(page.url)
    answerable(second, "1 of 3")
    rate(page, "22")
    saved(page)
    rate(second, "55")
    saved(second)
    answerable(second, "2 of 3")  # the stale tab is brought to where the participant is
    answered = [(row["rating"], row["revision"]) for row in rows(study) if row["rating"]]
    assert answered == [("5", "1"), ("5", "1")]


def test_what_is_recorded_of_the_screen(page: Page, url: str, study: Path) -> None:
    to_trials(page, url)
    page.wait_for_timeout(300)
    rate(page, "44")
    saved(page)
    row = rows(study)[0]
    assert float(row["rt_ms"]) >= 300
    assert (row["device_pixel_ratio"], row["zoom"], row["drawn_width_px"]) == ("1", "1", "200")
    assert (row["window_width_px"], row["window_height_px"]) == ("1280", "800")
    assert row["focus_lost_ms"] == "0"
    assert row["shown_at"] < row["answered_at"]


def test_each_trial_brings_its_own_questions(page: Page, tmp_path: Path) -> None:
    questions = [
        {"name": "glossy", "text": "It shines.", "scale": 5, "low": "not at all", "high": "like a mirror"},
        {"name": "heavy", "text": "It is <b>heavy</b>.", "scale": 10},
    ]
    survey = {"about": [], "screen_check": [], "practice": 0, "blocks": "by-question", "checks": 1}
    study = write_study(tmp_path / "by-question", question=questions, survey=survey)
    with served(study) as address:
        page.goto(begun(address))
        seen = []
        for trial in range(1, 7):
            answerable(page, f"{trial} of 6")
            asked = page.get_by_role("group")
            seen.append([(legend, asked.nth(i).get_by_role("radio").count()) for i, legend in enumerate(legends(page))])
            expect(page.get_by_role("radio").first).to_be_focused()
            for _, steps in seen[-1]:
                page.keyboard.press("0" if steps == 10 else str(steps))
            page.keyboard.press("Enter")
        page.wait_for_selector("body.comments")
    first, last = (name for name, _ in (seen[0][0], seen[-1][0]))
    assert {first, last} == {"It shines.", "It is <b>heavy</b>."}
    assert [each[0] for each in seen] == [(first, STEPS[first])] * 3 + [(last, STEPS[last])] * 3
    checks = [each[1] for each in seen if len(each) == 2]
    assert len(checks) == 1 and checks[0][0].startswith("This is to see that you are reading") and checks[0][1] == 5
    exported = rows(study)
    assert [row["rating"] for row in exported if row["question"] == "heavy"] == ["10"] * 3
    assert [row["check_passed"] != "" for row in exported].count(True) == 1


STEPS = {"It shines.": 5, "It is <b>heavy</b>.": 10}


def legends(page: Page) -> list[str]:
    """What is asked, as a screen reader names the groups."""
    return [legend.inner_text() for legend in page.locator("legend").all()]


def test_screen_readers_hear_question_step_and_what_the_ends_mean(page: Page, url: str) -> None:
    to_practice(page, url)
    group = page.get_by_role("group", name="The object looks translucent.", exact=True)
    expect(group.get_by_role("radio")).to_have_count(7)
    for name in ("1, completely disagree", "2", "6", "7, completely agree"):
        expect(group.get_by_role("radio", name=name, exact=True)).to_have_count(1)
    expect(page.get_by_role("status")).to_have_count(1)


def test_the_focus_walks_through_the_questions(page: Page, url: str) -> None:
    to_practice(page, url)
    focused = "document.activeElement.name || document.activeElement.id"
    assert page.evaluate(focused) == "question-0"
    expect(page.locator("#next")).to_have_attribute("aria-disabled", "true")
    page.keyboard.press("3")
    assert page.evaluate(focused) == "question-1"
    page.keyboard.press("9")  # no such step
    page.keyboard.press("Enter")  # not everything is answered
    expect(page.locator("#saved")).to_have_text("Please answer every question.")
    page.keyboard.press("7")
    assert page.evaluate(focused) == "next"
    expect(page.locator("#next")).to_have_attribute("aria-disabled", "false")
    assert page.evaluate("[...document.querySelectorAll('input:checked')].map(i => i.value).join()") == "3,7"


def test_opening_the_link_again_offers_the_way_back(page: Page, context: BrowserContext, url: str) -> None:
    to_trials(page, url)
    again = context.new_page()
    again.goto(url)
    again.locator("#resume a").click()
    answerable(again, "1 of 3")
    assert again.url == page.url


def test_pages_that_need_javascript_say_so_without_it(url: str) -> None:
    person = Participant(url)
    person.consent()
    person.post("about", **ABOUT)
    person.post("screen")
    for step in ("instructions", "practice"):
        assert person.state["step"] == step
        page = person.client.get(person.here, headers={"Accept": "text/html"}).text
        assert "needs JavaScript" in page[page.index("<noscript>") : page.index("</noscript>")]
        person.post(step) if step == "instructions" else None
    assert "<noscript>" in Participant(url).client.get("/", headers={"Accept": "text/html"}).text
