"""Every page that a participant can see, one after the other, for tests that look at each of them."""

from collections.abc import Callable

from playwright.sync_api import Page, expect

Look = Callable[[str], object]
"""Called with a page's name once the page is there and at rest."""


def whole_session(page: Page, url: str, look: Look) -> None:
    """From the link to the completion code, then withdrawal. The study asks what translated_study.py asks."""
    page.goto(url)
    look("consent")
    page.locator(".agree button").click()
    page.wait_for_selector("body.about")
    look("about")
    page.locator("input[name=hand]").first.check()
    page.locator("main button").click()
    screen_check(page, look)
    page.wait_for_selector("body.instructions")
    look("instructions")
    page.locator("main button").click()
    answer(page, "practice", look)
    page.wait_for_selector("body.ready")
    look("ready")
    page.locator("main button").click()
    answer(page, "trials", look)
    for _ in range(2):
        answer(page, "trials", lambda _: None)
    page.wait_for_selector("body.comments")
    look("comments")
    page.locator("main button").click()
    page.wait_for_selector("#code")
    look("done")
    page.locator("footer a").click()
    page.wait_for_selector("body.withdraw")
    look("withdraw")
    page.locator("main button").click()
    page.wait_for_selector("body.withdrawn")
    look("withdrawn")


def screen_check(page: Page, look: Look) -> None:
    """One check after the other."""
    page.wait_for_selector("body.screen")
    checks = page.locator(".check").count()
    for number in range(checks):
        expect(page.locator(".check").nth(number)).to_be_visible()
        look(f"screen {number + 1}")
        page.locator(".check:not([hidden]) [data-next]").first.click()


def answer(page: Page, step: str, look: Look) -> None:
    """The trial that is shown, with 4 for every question."""
    page.wait_for_selector(f"body.{step}")
    expect(page.locator(".question input:enabled:checked")).to_have_count(0)
    expect(page.locator(".question input:enabled").first).to_be_focused()
    look(step)
    before = page.locator("#count").inner_text()
    for _ in range(page.locator(".question").count()):
        page.keyboard.press("4")
    page.keyboard.press("Enter")
    page.wait_for_function(
        "before => !document.querySelector('#trial') || document.getElementById('count').innerText !== before",
        arg=before,
    )
