"""The picture on screen is the picture rendered, pixel by pixel, or there is none."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, BrowserContext, Page, Route, expect
from steps import answerable, rate, rows, to_practice, to_trials
from study_fixture import draw_disc
from trial_pages import begun, displays, open_trials, saved, short_study, shown_and_rendered

from study_server.serve import served

pytestmark = pytest.mark.browser


ZOOMS = (0.9, 1.0, 1.1, 1.25, 1.5)


@pytest.mark.parametrize("ratio", [1, 1.25, 1.5, 2])
def test_one_file_pixel_is_one_screen_pixel(
    launch_with: Callable[..., BrowserContext], tmp_path: Path, ratio: float
) -> None:
    """What the compositor drew, taken at the window's own resolution, against the file, at each page zoom.

    The ratio is a switch, because an emulated one scales a page laid out for ratio 1. The zoom is the browser's own (as
    by Ctrl and +), kept in its settings for each site; so each zoom is another name of this machine.
    """
    study = short_study(tmp_path, size=201)
    levels = {name_of(zoom): {"zoom_level": math.log(zoom, 1.2), "last_modified": "0"} for zoom in ZOOMS}
    names = ",".join(f"MAP {name} 127.0.0.1" for name in levels)
    switches = (f"--force-device-scale-factor={ratio}", "--window-size=1113,801", f"--host-resolver-rules={names}")
    browser = launch_with({"partition": {"per_host_zoom_levels": {"x": levels}}}, *switches)
    page = browser.new_page()
    with served(study) as url:
        path = begun(url).removeprefix(url)
        for zoom in ZOOMS:
            page.goto(url.replace("127.0.0.1", name_of(zoom)) + path)
            answerable(page, "1 of 6")
            assert page.evaluate("devicePixelRatio") == pytest.approx(ratio * zoom, rel=1e-6)
            assert np.array_equal(*shown_and_rendered(page, study)), f"zoom {zoom}"
            rate(page, "44")
            saved(page)
            path = begun(url).removeprefix(url)
        drawn = {(row["drawn_width_px"], row["drawn_height_px"], row["scaled"]) for row in displays(study)}
        assert drawn == {(201, 201, 0)}
        assert [row["zoom"] for row in displays(study)] == pytest.approx(list(ZOOMS), rel=0.01)


def name_of(zoom: float) -> str:
    """The site at which the browser has this zoom."""
    return f"at-{zoom:.0%}.test".replace("%", "")


def test_a_window_moved_to_another_screen_shows_file_pixels_there(page: Page, tmp_path: Path) -> None:
    study = short_study(tmp_path)
    with served(study) as url:
        open_trials(page, url)
        metrics = {"width": 1280, "height": 800, "mobile": False}
        inspector = page.context.new_cdp_session(page)
        inspector.send("Emulation.setDeviceMetricsOverride", {**metrics, "deviceScaleFactor": 2})
        inspector.send("Page.captureScreenshot")  # draws a frame, which a window without a screen does not by itself
        expect(page.locator("#stage img")).to_have_css("width", "48px")
        rate(page, "44")
        saved(page)
    (row,) = displays(study)
    assert (row["device_pixel_ratio"], row["drawn_width_px"], row["scaled"]) == (2, 96, 0)


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


@pytest.mark.parametrize("length", [0, 1, 55, 56, 63, 64, 65, 1000, 300_003])
def test_our_own_sha256_is_sha256(page: Page, url: str, length: int) -> None:
    page.goto(url)
    program = """async (length) => {
        const { plainSha256 } = await import("/static/sha256.js");
        const data = Uint8Array.from({ length }, (_, i) => (i * 7 + 3) % 251);
        const hex = (buffer) => [...new Uint8Array(buffer)].map((b) => b.toString(16).padStart(2, "0")).join("");
        return [hex(await plainSha256(data.buffer)), hex(await crypto.subtle.digest("SHA-256", data))];
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
