"""The picture on screen is the picture rendered, pixel by pixel, or there is none."""

import io
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page, Route, expect
from steps import answerable, rate, rows, to_practice, to_trials
from study_fixture import draw_disc
from trial_pages import saved

from study_server.manifest import load_study

pytestmark = pytest.mark.browser


@pytest.mark.parametrize("ratio", [1, 1.25, 1.5, 2])
def test_one_file_pixel_is_one_screen_pixel(
    launch: Callable[..., Browser], url: str, study: Path, ratio: float
) -> None:
    # a switch, because an emulated ratio scales a page laid out for ratio 1
    browser = launch(f"--force-device-scale-factor={ratio}", "--window-size=1113,801")
    page = browser.new_context(no_viewport=True).new_page()
    to_practice(page, url)
    box = page.locator("#stage img").bounding_box()
    assert box
    screen = np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("RGB"))
    left, top = (math.floor(box[side] * ratio + 0.5) for side in ("x", "y"))
    shown = screen[top : top + 200, left : left + 200].astype(int)
    sha256 = page.locator("#stage img").get_attribute("data-sha256")
    path = next(each.path for each in load_study(study).stimuli if each.sha256 == sha256)
    rendered = np.asarray(Image.open(path).convert("RGB")).astype(int)
    assert np.abs(shown - rendered).max() == 0
    assert page.evaluate("devicePixelRatio") == ratio
    browser.close()


def test_a_window_too_narrow_is_seen_in_the_data(browser: Browser, url: str, study: Path) -> None:
    context = browser.new_context(viewport={"width": 180, "height": 700})
    page = context.new_page()
    to_trials(page, url)
    rate(page, "44")
    saved(page)
    assert float(rows(study)[0]["drawn_width_px"]) < 180
    context.close()


def test_a_picture_changed_on_the_server_is_not_shown(page: Page, browser: Browser, url: str, study: Path) -> None:
    to_practice(page, url)
    original = {path: path.read_bytes() for path in (study / "stimuli").glob("*.png")}
    for path in original:
        draw_disc(path, 200, hue=99)
    elsewhere = browser.new_context()  # a browser that has no good copy in its cache
    tab = elsewhere.new_page()
    tab.goto(page.url)
    expect(tab.locator("[role=alert]")).to_contain_text("so it is not shown")
    assert tab.locator("#stage img").count() == 0
    for path, data in original.items():
        path.write_bytes(data)
    answerable(tab, "Practice 1 of 1")  # it kept trying
    elsewhere.close()


def test_a_picture_changed_on_the_way_is_not_shown(page: Page, url: str, study: Path) -> None:
    other = (study / "stimuli" / "img03.png").read_bytes()
    exact = (study / "stimuli" / "img01.png").read_bytes()

    def swap(route: Route) -> None:
        body = other[: len(exact)].ljust(len(exact), b"\0")
        route.fulfill(body=body, content_type="image/png")

    page.route("**/picture/*", swap)
    page.goto(url)
    to_first_picture(page)
    expect(page.locator("[role=alert]")).to_contain_text("did not arrive as it was made")
    assert page.locator("#stage img").count() == 0
    assert page.locator(".question input").first.is_disabled()
    page.unroute("**/picture/*")
    answerable(page, "Practice 1 of 1")


def to_first_picture(page: Page) -> None:
    """To the practice trial, whether or not its picture comes."""
    page.locator("main button").first.click()
    for group in ("age", "background", "vision"):
        page.locator(f"input[name={group}]").first.check()
    for step in ("screen", "instructions"):
        page.locator("main button").first.click()
        page.wait_for_selector(f"body.{step}")
    page.locator("main button").first.click()
    page.wait_for_selector("body.practice")


def test_a_wrong_hash_reported_by_the_browser_is_refused(page: Page, url: str, study: Path) -> None:
    to_trials(page, url)
    page.route("**/ratings", forge)
    rate(page, "44")
    expect(page.locator("#saved")).to_contain_text("not the one that belongs here")
    assert not any(row["rating"] for row in rows(study))


def forge(route: Route) -> None:
    """Say that another picture was on the screen."""
    body = dict(route.request.post_data_json) | {"stimulus_sha256": "0" * 64}
    route.continue_(post_data=body)


@pytest.mark.parametrize("length", [0, 1, 55, 56, 63, 64, 65, 1000, 100_003])
def test_our_own_sha256_is_sha256(page: Page, url: str, length: int) -> None:
    page.goto(url)
    program = """async (length) => {
        const { plainSha256 } = await import("/static/sha256.js");
        const data = Uint8Array.from({ length }, (_, i) => (i * 7 + 3) % 251);
        const hex = (buffer) => [...new Uint8Array(buffer)].map((b) => b.toString(16).padStart(2, "0")).join("");
        return [hex(plainSha256(data.buffer)), hex(await crypto.subtle.digest("SHA-256", data))];
    }"""
    ours, theirs = page.evaluate(program, length)
    assert ours == theirs


def test_the_next_picture_is_there_before_it_is_due(page: Page, url: str) -> None:
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url) if "/picture/" in request.url else None)
    to_trials(page, url)
    page.wait_for_timeout(200)
    before = len(asked)
    assert before >= 2
    page.route("**/picture/*", lambda route: route.abort())
    rate(page, "44")
    answerable(page, "2 of 3")
