"""Every page, for people who cannot see it, enlarge it, use the keyboard alone or have colours of their own."""

import io
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from accessible import cut_off, tab, tab_to, violations, with_axe
from every_page import whole_session
from PIL import Image, ImageStat
from playwright.sync_api import Browser, Locator, Page, expect
from survey_client import Participant
from translated_study import TEXTS, translated_study

from study_server.app import admin_secret
from study_server.serve import served

pytestmark = pytest.mark.browser

ALL_PARTS = ["card", "wedge", "plates"]
PROLIFIC = {"completed": "C1AAAAAA", "no_consent": "C2BBBBBB", "screened_out": "C3CCCCCC"}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A study in English and German in which left-handers are sent away."""
    own = TEXTS["en"]
    hand = {"name": "hand", "text": own["hand"], "choices": [own["left"], own["right"]], "required": True}
    about = [{**hand, "screen_out": [own["right"]]}, {"name": "job", "text": own["job"]}]
    return translated_study(
        tmp_path / "study", "en", "de", screen_check=ALL_PARTS, prolific=PROLIFIC, about=about, phones="refuse"
    )


@pytest.fixture
def url(folder: Path) -> Iterator[str]:
    """The study, served."""
    with served(folder) as address:
        yield address


@pytest.fixture
def german(browser: Browser) -> Iterator[Page]:
    """A tab with axe in a German browser: German words are the longest."""
    with with_axe(browser.new_context(locale="de-DE", viewport={"width": 1280, "height": 800})) as context:
        yield context.new_page()


def look(page: Page, name: str) -> None:
    """Everything that is measured of every page: axe; 200% zoom, a phone, and the narrowest window of WCAG 1.4.10."""
    assert violations(page) == [], name
    for width in (640, 390, 320):
        assert cut_off(page, width) == [], f"{name} at {width}"


def test_every_page_of_a_session(german: Page, url: str) -> None:
    seen = []

    def each(name: str) -> None:
        seen.append(name)
        look(german, name)

    whole_session(german, f"{url}/?STUDY_ID=s&PROLIFIC_PID=p", each)
    assert len(seen) >= 15


def test_the_ends_and_the_errors(german: Page, url: str, folder: Path) -> None:
    german.goto(f"{url}/?STUDY_ID=s&PROLIFIC_PID=p")
    german.locator("button.quiet").click()
    german.wait_for_selector("body.declined #return")
    look(german, "declined")
    german.goto(f"{url}/?STUDY_ID=s&PROLIFIC_PID=q")
    german.locator(".agree button").click()
    german.locator("input[name=hand]").last.check()
    german.locator("main button").click()
    german.wait_for_selector("body.screened_out #code")
    look(german, "screened out")
    german.goto(f"{url}/s/nobody")
    look(german, "no such participant")
    for state in ("paused", "closed"):
        bearer = {"Authorization": f"Bearer {admin_secret(folder)}"}
        httpx.post(f"{url}/admin/gate", headers=bearer, data={"state": state, "sure": "yes"})
        german.goto(url)
        german.wait_for_selector(f"body.{state}")
        look(german, state)


def test_the_researchers_pages(german: Page, url: str, folder: Path) -> None:
    german.goto(f"{url}/admin")
    look(german, "login")
    german.locator("#secret").fill(admin_secret(folder))
    german.locator("main button").click()
    german.wait_for_selector("body.admin")
    look(german, "admin of an empty study")
    person = Participant(url).consent()
    person.post("about", hand=TEXTS["en"]["left"])
    person.post("screen")
    person.post("instructions")
    person.rate()
    person.post("ready")
    person.rate()
    person.send(person.answers(9))
    german.goto(f"{url}/admin")
    expect(german.locator("[data-figure=ratings]")).to_have_text("2")
    look(german, "admin")


def test_a_whole_session_with_tab_enter_and_arrows_alone(german: Page, url: str) -> None:
    """No mouse, and none of the shortcuts: Tab leads to everything in order, and one always sees where one is."""
    page = german
    page.goto(f"{url}/?language=en")
    assert [tab(page) for _ in range(4)] == ["English", "Deutsch", "I agree to take part", "I do not want to take part"]
    page.keyboard.press("Shift+Tab")
    page.keyboard.press("Enter")
    page.wait_for_selector("body.about")
    tab_to(page, "hand")
    page.keyboard.press("Space")
    tab_to(page, "field-2")
    page.keyboard.type("weaver")
    tab_to(page, "Continue")
    page.keyboard.press("Enter")
    page.wait_for_selector("body.screen")
    tab_to(page, "It fits")
    page.keyboard.press("Enter")
    expect(page.locator(".check").nth(1)).to_be_visible()
    tab_to(page, "Next")
    page.keyboard.press("Enter")
    expect(page.locator(".check").nth(2)).to_be_visible()
    tab_to(page, "Next")
    page.keyboard.press("Enter")
    for plate in range(3, page.locator(".check").count()):
        expect(page.locator(".check").nth(plate)).to_be_visible()
        tab_to(page, "I see no number")
        page.keyboard.press("Enter")
    page.wait_for_selector("body.instructions")
    tab_to(page, "Try it out")
    page.keyboard.press("Enter")
    by_arrows(page, "Practice 1 of 1")
    page.wait_for_selector("body.ready")
    tab_to(page, "Begin")
    page.keyboard.press("Enter")
    for trial in (1, 2, 3):
        by_arrows(page, f"{trial} of 3")
    page.wait_for_selector("body.comments")
    tab_to(page, "comments")
    page.keyboard.type("Good.")
    tab_to(page, "Finish")
    page.keyboard.press("Enter")
    page.wait_for_selector("body.done")
    tab_to(page, "Withdraw my answers")


def by_arrows(page: Page, count: str) -> None:
    """One trial: Space and arrows choose, Tab goes on."""
    expect(page.locator("#count")).to_have_text(count)
    expect(page.locator(".question input").first).to_be_focused()
    page.keyboard.press("ArrowRight")
    assert tab(page) == "question-1"
    page.keyboard.press("Space")
    assert tab(page) == "next"
    chosen = "[...document.querySelectorAll('input:checked')].map(input => input.value).join()"
    assert page.evaluate(chosen) == "2,1"
    page.keyboard.press("Enter")


def to_first_trial(page: Page, url: str) -> None:
    """A session at its first trial, in English."""
    person = Participant(url).consent()
    person.post("about", hand=TEXTS["en"]["left"])
    person.post("screen")
    person.post("instructions")
    person.rate()
    person.post("ready")
    page.goto(url + person.here)
    expect(page.locator(".question input").first).to_be_focused()


def test_what_a_screen_reader_is_told_of_a_trial(page: Page, url: str) -> None:
    to_first_trial(page, url)
    expect(page.locator("body")).to_match_aria_snapshot("""
      - banner:
        - paragraph: Grey discs
        - paragraph:
          - text: 1 of 3
          - progressbar "1 of 3"
      - main:
        - figure:
          - img "The picture to judge"
        - group "The object looks translucent.":
          - radio "1, completely disagree"
          - radio "2"
          - radio "3"
          - radio "4"
          - radio "5"
          - radio "6"
          - radio "7, completely agree"
        - group "The object looks realistic.":
          - radio "1, completely disagree"
          - radio "7, completely agree"
        - paragraph:
          - button "Next" [disabled]
          - status
    """)
    page.keyboard.press("3")
    page.keyboard.press("5")
    expect(page.get_by_role("radio", checked=True)).to_have_count(2)
    page.keyboard.press("Enter")
    expect(page.get_by_role("status")).to_have_text("Saved")  # a live region: spoken when it changes
    expect(page.get_by_role("progressbar", name="2 of 3")).to_have_attribute("value", "1")


def test_nothing_moves_for_whom_that_disturbs(browser: Browser, url: str) -> None:
    moves = (
        "() => [...document.querySelectorAll('*')].filter(e => getComputedStyle(e).transitionDuration !== '0s').length"
    )
    with browser.new_context(reduced_motion="reduce") as context:
        page = context.new_page()
        to_first_trial(page, url)
        assert page.evaluate(moves) == 0
        page.emulate_media(reduced_motion="no-preference")
        assert page.evaluate(moves) > 0


def test_with_colours_of_ones_own_the_answer_and_the_focus_are_seen(browser: Browser, url: str) -> None:
    with browser.new_context(forced_colors="active") as context:
        page = context.new_page()
        to_first_trial(page, url)
        page.keyboard.press("3")
        chosen, other = (darkness(page.locator(".scale span").nth(step)) for step in (2, 3))
        assert abs(chosen - other) > 64
        assert abs(darkness(page.locator("#stage"), corner=True) - 128) <= 1  # the picture's surround stays
        tab(page)


def darkness(locator: Locator, *, corner: bool = False) -> float:
    """Mean grey value (0..255) of what is drawn there, or of its first pixel."""
    with Image.open(io.BytesIO(locator.screenshot())) as drawn:
        grey = drawn.convert("L")
        return float(grey.getpixel((0, 0)) if corner else ImageStat.Stat(grey).mean[0])  # type: ignore[arg-type]


PHONE = {"has_touch": True, "is_mobile": True, "device_scale_factor": 3}


@pytest.mark.parametrize(
    ("width", "height", "device", "refused"),
    [
        (390, 844, PHONE, True),
        (844, 390, PHONE, True),
        (820, 1180, PHONE, False),  # a tablet
        (390, 844, {}, False),  # a narrow window on a computer
    ],
)
def test_a_phone_is_told_to_use_a_computer(
    browser: Browser, url: str, width: int, height: int, device: dict[str, bool], refused: bool
) -> None:
    with browser.new_context(viewport={"width": width, "height": height}, **device) as context:  # type: ignore[arg-type]
        page = context.new_page()
        page.goto(f"{url}/?language=en")
        expect(page.get_by_text("please open the link you were given on a computer")).to_be_visible(visible=refused)
        expect(page.get_by_role("button", name="I agree to take part")).to_be_visible(visible=not refused)
        expect(page.get_by_role("button", name="I do not want to take part")).to_be_visible()


def test_without_the_setting_phones_may_take_part(browser: Browser, tmp_path: Path) -> None:
    with (
        served(translated_study(tmp_path / "study")) as url,
        browser.new_context(
            viewport={"width": 390, "height": 844},
            **PHONE,  # type: ignore[arg-type]
        ) as context,
    ):
        page = context.new_page()
        page.goto(url)
        page.get_by_role("button", name="I agree to take part").tap()
        page.wait_for_selector("body.about")
