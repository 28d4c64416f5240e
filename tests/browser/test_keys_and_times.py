"""Which keys answer, and which times are stored of it."""

import sqlite3
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect
from steps import answerable, rate
from trial_pages import begun, displays, open_trials, saved, short_study
from whole_sessions import answered

from study_server.serve import served

pytestmark = pytest.mark.browser

CHOSEN = "[...document.querySelectorAll('input:checked')].map(i => i.value).join()"
FOCUS = "document.activeElement.name || document.activeElement.id || document.activeElement.localName"


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Six pictures; it begins with its instructions."""
    return short_study(tmp_path)


def test_digits_answer_only_while_the_focus_is_in_the_trial(page: Page, url: str) -> None:
    """WCAG 2.1.4: a single-key shortcut that cannot be switched off works only where the focus is."""
    open_trials(page, url)
    page.keyboard.press("3")
    page.get_by_role("link", name="Withdraw my answers").focus()
    page.keyboard.press("5")
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("5")
    assert page.evaluate(CHOSEN) == "3"
    page.locator("#stage").click()  # anywhere in the trial
    assert page.evaluate(FOCUS) == "trial"
    page.keyboard.press("6")
    assert page.evaluate(CHOSEN) == "3,6"


def test_digits_of_a_french_keyboard_answer(page: Page, url: str) -> None:
    open_trials(page, url)
    keyboard = page.context.new_cdp_session(page)
    for modifiers, key in ((0, "'"), (8, "5")):  # unshifted, and with Shift
        code = "Digit4" if modifiers == 0 else "Digit5"
        event = {"type": "keyDown", "key": key, "code": code, "text": key, "modifiers": modifiers}
        keyboard.send("Input.dispatchKeyEvent", event)
    assert page.evaluate(CHOSEN) == "4,5"
    keyboard.send("Input.dispatchKeyEvent", {"type": "keyDown", "key": "$", "code": "Digit4", "modifiers": 8})
    assert page.evaluate(CHOSEN) == "4,5"  # Shift and 4 on other keyboards


def test_keys_that_scroll_to_questions_out_of_sight_answer_none(page: Page, tmp_path: Path) -> None:
    study = short_study(tmp_path / "tall", size=1000)
    with served(study) as url:
        open_trials(page, url)
        page.keyboard.press("ArrowDown")
        page.keyboard.press("Space")
        page.wait_for_function("() => scrollY > 0")
        assert page.evaluate(CHOSEN) == ""
        page.keyboard.press("4")  # the shortcut is meant, wherever the page stands
        assert page.evaluate(CHOSEN) == "4"
        assert page.evaluate(FOCUS) == "question-1"


def test_times_of_a_second_trial(page: Page, url: str, study: Path) -> None:
    """Not since the page was loaded, and not since the first picture; what happened out of sight is told apart."""
    open_trials(page, url)
    page.wait_for_timeout(700)
    rate(page, "44")
    answerable(page, "2 of 6")
    begun_at = page.evaluate("performance.now()")
    page.wait_for_timeout(200)
    page.evaluate("document.hasFocus = () => false, dispatchEvent(new Event('blur')), null")
    page.wait_for_timeout(400)
    page.evaluate("delete document.hasFocus, dispatchEvent(new Event('focus')), null")
    page.keyboard.press("4")
    took = page.evaluate("performance.now()") - begun_at
    page.wait_for_timeout(300)
    page.keyboard.press("4")
    page.keyboard.press("Enter")
    saved(page)
    rt_ms = reaction_times(study)[2:]
    assert 600 <= rt_ms[0] <= took + 250  # the first frame is just before the trial is seen to be open
    assert 300 <= rt_ms[1] - rt_ms[0] < 300 + 0.5 * took
    lost = displays(study)[1]["focus_lost_ms"]
    assert 400 <= lost < rt_ms[0] - 150


def reaction_times(study: Path) -> list[float]:
    """All that are stored, in ms, in order of trial and question."""
    database = sqlite3.connect(study / "ratings.sqlite")
    found = [row[0] for row in database.execute("select rt_ms from ratings order by place, rowid")]
    database.close()
    return found


def test_a_key_counts_when_it_is_pressed_however_busy_the_page_is(page: Page, url: str, study: Path) -> None:
    open_trials(page, url)
    keyboard = page.context.new_cdp_session(page)
    page.evaluate("document.querySelector('input').addEventListener('keydown', block); function block() {}")
    page.evaluate("""() => {
        window.pressed = [];
        addEventListener("keydown", (event) => {
            window.pressed.push(event.timeStamp);
            for (const until = performance.now() + 400; performance.now() < until; );
        }, { capture: true });
    }""")
    shown = page.evaluate("performance.now()")
    page.keyboard.press("4")
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Enter")
    saved(page)
    keyboard.detach()
    first, second = reaction_times(study)
    pressed = page.evaluate("window.pressed")
    assert second - first == pytest.approx(pressed[1] - pressed[0], abs=1)
    assert first < pressed[0] - shown + 300  # not the 400 ms later at which the page heard of it


@pytest.mark.parametrize("how", ["reload", "tab closed"])
def test_a_reload_begins_no_new_reaction_time(
    page: Page, context: BrowserContext, url: str, study: Path, how: str
) -> None:
    """People who reloaded seemed to have answered in 30 ms, and were suspected of not having looked."""
    open_trials(page, url)
    page.wait_for_timeout(600)
    if how == "reload":
        page.reload()
    else:
        address = page.url
        page.close(run_before_unload=True)
        page = context.new_page()
        page.goto(address)
    answerable(page, "1 of 6")
    rate(page, "44")
    answerable(page, "2 of 6")
    rate(page, "44")  # another trial has its own times
    saved(page)
    rt_ms = reaction_times(study)
    assert rt_ms[0] >= 600 > rt_ms[2]
    [(_, stored_at, shown_at), _] = answered(study)
    assert stored_at - shown_at >= 0.6
    assert 0 < displays(study)[0]["focus_lost_ms"] < rt_ms[0] - 500  # while there was no page


def test_plain_http_does_not_block_the_page_while_pictures_are_hashed(
    launch: Callable[..., Browser], tmp_path: Path
) -> None:
    study = short_study(tmp_path / "large", size=1000)
    browser = launch("--host-resolver-rules=MAP lab.test 127.0.0.1")
    page = browser.new_page()
    page.add_init_script("""
        window.longest = 0;
        new PerformanceObserver((list) => {
            for (const { duration } of list.getEntries()) window.longest = Math.max(window.longest, duration);
        }).observe({ type: "longtask" });
    """)
    with served(study) as url:
        path = begun(url).removeprefix(url)
        page.goto(url.replace("127.0.0.1", "lab.test") + path)
        assert page.evaluate("isSecureContext") is False
        answerable(page, "1 of 6")
        page.evaluate("""async () => {
            const { plainSha256 } = await import("/static/sha256.js");
            window.longest = 0;
            let turns = 0;
            const count = setInterval(() => turns++);
            await plainSha256(new ArrayBuffer(4_000_000));
            clearInterval(count);
            window.turns = turns;
        }""")
        assert page.evaluate("window.turns") >= 10
    browser.close()


def test_pictures_looked_at_are_forgotten(page: Page, url: str) -> None:
    """Each picture kept would fill the memory of who sees many."""
    page.add_init_script("""
        const revoke = URL.revokeObjectURL;
        window.revoked = 0;
        URL.revokeObjectURL = (url) => { window.revoked += 1; revoke.call(URL, url); };
    """)
    open_trials(page, url)
    for trial in range(1, 6):
        rate(page, "44")
        answerable(page, f"{trial + 1} of 6")
    page.wait_for_function("() => window.revoked === 5")
    expect(page.locator("#stage img")).to_be_visible()
