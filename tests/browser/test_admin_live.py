"""The admin page in a browser: it updates by itself, disturbs nobody at it, and says when it cannot."""

import re
from pathlib import Path

import httpx
import pytest
from playwright.sync_api import Page, expect
from study_fixture import write_study
from survey_client import Participant

from study_server.app import admin_secret
from study_server.serve import served

POLL_MS = 6_000
"""A little more than the page waits between two questions."""


@pytest.fixture
def admin(page: Page, study: Path, url: str) -> Page:
    """The page, opened by the form, with the browser's clock in our hand."""
    page.clock.install()
    page.goto(f"{url}/admin")
    page.get_by_label("Secret").fill(admin_secret(study))
    page.keyboard.press("Enter")
    page.wait_for_selector("body.admin")
    return page


SLOW_MS = 30_000
"""The same where answers take up to 1.5 s: the page then waits twenty times as long as the last one took."""


def later(page: Page, ms: int = SLOW_MS) -> None:
    """So long afterwards by the page's clock, once what it asked for by then is there."""
    with page.expect_response(lambda response: response.url.endswith("/admin")):
        page.clock.fast_forward(ms)


def asked_within(page: Page, ms: int) -> int:
    """How often the page asks in so long, by its clock."""
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.clock.fast_forward(ms)
    page.evaluate("fetch('/static/icon.svg')")  # what was asked before this has been heard of when this is answered
    return sum(url.endswith("/admin") for url in asked)


def test_figures_and_tables_follow_what_people_do(admin: Page, url: str) -> None:
    expect(admin.locator("[data-figure=started]")).to_have_text("0")
    expect(admin.get_by_text("Nobody is under way.")).to_be_visible()
    person = Participant(url).to_trials()
    person.rate()
    later(admin)
    expect(admin.locator("[data-figure=started]")).to_have_text("1")
    expect(admin.locator("[data-figure=ratings]")).to_have_text("2")
    expect(admin.locator("[data-rows=steps] tbody tr")).to_have_text("trials1")
    expect(admin.locator("[data-rows='times.trials'] tbody tr")).to_have_count(1)
    expect(admin.locator("[data-rows='times.trials'] [data-key=median_s]").last).to_have_text("1.0")
    assert admin.locator("[data-rows=rows] progress").first.evaluate("bar => [bar.value, bar.max]") == [1, 1]
    person.to_end()
    later(admin)
    expect(admin.locator("[data-figure=finished]")).to_have_text("1")
    expect(admin.locator("[data-rows=steps]")).to_be_hidden()
    expect(admin.get_by_text("Nobody is under way.")).to_be_visible()


def test_updated_and_loaded_anew_it_reads_the_same(admin: Page, url: str) -> None:
    """The page that the server writes and the one that the script fills in are one."""
    first, second = Participant(url).to_trials(), Participant(url).to_trials()
    first.to_end()
    second.rate()
    second.send(second.answers(stimulus_sha256="0" * 64))
    second.client.post(f"{second.here}/withdraw", json={"sure": "yes"})
    third = Participant(url).to_trials()
    third.send(third.answers(stimulus_sha256="0" * 64))
    admin.request.post(f"{url}/admin/gate", form={"state": "paused"})
    later(admin)
    expect(admin.locator("[data-figure='gate.state']")).to_have_text("paused")
    shown = drawn(admin)
    admin.reload()
    assert drawn(admin) == shown


def drawn(page: Page) -> dict[str, list[str]]:
    """All that is read and drawn on the page, but for the time of day."""
    page.evaluate("document.getElementById('updated').textContent = ''")
    drawings = page.locator("main svg, main progress").evaluate_all("all => all.map(one => one.outerHTML)")
    shapes = [re.sub(r"\.0(?=[\" h])", "", drawing) for drawing in drawings]  # 1.0 and 1 are one number
    return {"words": page.locator("main").inner_text().splitlines(), "shapes": shapes}


def test_focus_and_scroll_stay(admin: Page, url: str) -> None:
    link = admin.get_by_role("link", name="codebook.csv")
    link.focus()
    admin.evaluate("scrollTo(0, 240)")
    Participant(url).to_trials().rate()
    later(admin)
    expect(admin.locator("[data-figure=ratings]")).to_have_text("2")
    expect(link).to_be_focused()
    assert admin.evaluate("scrollY") == 240


def test_it_asks_nothing_while_nobody_sees_it(admin: Page) -> None:
    admin.evaluate("Object.defineProperty(document, 'hidden', {get: () => window.away}); window.away = true")
    admin.evaluate("document.dispatchEvent(new Event('visibilitychange'))")
    assert asked_within(admin, 60_000) == 0
    admin.evaluate("window.away = false")
    with admin.expect_response(lambda response: response.url.endswith("/admin")):
        admin.evaluate("document.dispatchEvent(new Event('visibilitychange'))")
        admin.clock.fast_forward(10)


def test_a_server_that_is_away_is_told_and_asked_less_and_less(admin: Page) -> None:
    admin.route("**/admin", lambda route: route.abort())
    with admin.expect_event("requestfailed"):
        admin.clock.fast_forward(POLL_MS)
    expect(admin.locator("#trouble")).to_have_text("The server does not answer. Trying again …")
    assert asked_within(admin, 8_000) == 0  # 10 s, then 20 s, at most a minute
    assert asked_within(admin, 3_000) == 1
    admin.unroute("**/admin")
    later(admin, 21_000)
    expect(admin.locator("#trouble")).to_have_text("")


def test_a_closed_door_is_told_and_not_knocked_at(admin: Page, url: str) -> None:
    admin.context.clear_cookies()
    later(admin)
    expect(admin.locator("#trouble")).to_contain_text("The door has closed")
    assert asked_within(admin, 120_000) == 0
    admin.get_by_role("link", name="open it with the secret").click()
    expect(admin.get_by_label("Secret")).to_be_focused()


def test_who_listens_hears_of_it_once_a_minute(admin: Page, url: str) -> None:
    Participant(url).consent()
    later(admin)
    expect(admin.locator("[data-figure=started]")).to_have_text("1")
    expect(admin.locator("#spoken")).to_have_text("")
    later(admin, 61_000)
    expect(admin.locator("#spoken")).to_have_text("1 started, 0 finished, 1 active, 0 dropped; 0 ratings.")


def test_pause_close_and_open_by_keyboard(admin: Page, url: str) -> None:
    person = Participant(url).to_trials()
    admin.get_by_role("button", name="Pause").press("Enter")
    expect(admin.locator("[data-figure='gate.state']")).to_have_text("paused")
    admin.get_by_role("button", name="Close …").press("Enter")
    admin.wait_for_selector("body.close")
    expect(admin.get_by_text("1 person is under way and would be turned away.")).to_be_visible()
    admin.get_by_role("button", name="Close and turn them away").press("Enter")
    expect(admin.locator("[data-figure='gate.state']")).to_have_text("closed")
    assert person.client.get(person.here).json()["step"] == "closed"
    admin.get_by_role("button", name="Open again").press("Enter")
    expect(admin.locator("[data-figure='gate.state']")).to_have_text("open")
    assert httpx.get(f"{url}/health").json()["gate"] == "open"


@pytest.mark.parametrize("width", [390, 640])
def test_nothing_is_cut_off_on_a_phone_or_at_200_percent(page: Page, tmp_path: Path, width: int) -> None:
    study = write_study(tmp_path / "narrow", pictures=9, size=20)
    with served(study) as url:
        Participant(url).to_trials().rate()
        page.set_viewport_size({"width": width, "height": 700})
        page.goto(f"{url}/admin")
        page.get_by_label("Secret").fill(admin_secret(study))
        page.keyboard.press("Enter")
        page.wait_for_selector("body.admin")
        assert page.evaluate("document.documentElement.scrollWidth") == width
        cut = "[...document.querySelectorAll('.scroll')].filter(e => e.scrollWidth > e.clientWidth).length"
        assert page.evaluate(cut) == 0
