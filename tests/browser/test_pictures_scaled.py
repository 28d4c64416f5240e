"""A picture that is not drawn pixel by pixel is flagged or refused, whatever made it larger or smaller."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect
from steps import answerable, rate
from trial_pages import begun, displays, open_trials, saved, short_study, shown_and_rendered

from study_server.serve import served

pytestmark = pytest.mark.browser


def resize(page: Page, width: int, height: int = 800) -> None:
    """Make the window so large."""
    page.set_viewport_size({"width": width, "height": height})


def test_a_picture_that_does_not_fit_is_refused_until_it_does(page: Page, tmp_path: Path) -> None:
    study = short_study(tmp_path, size=400, scaled_pictures="refuse")
    with served(study) as url:
        resize(page, 390)
        page.goto(begun(url))
        notice = page.get_by_role("alert")
        expect(notice).to_contain_text("make this window larger")
        expect(page.locator("#stage img")).to_be_hidden()
        expect(page.locator(".question").first).to_be_hidden()
        resize(page, 900)
        answerable(page, "1 of 6")
        expect(notice).to_be_hidden()
        assert np.array_equal(*shown_and_rendered(page, study))
        resize(page, 390)  # while it is looked at
        expect(notice).to_be_visible()
        expect(page.locator("#stage img")).to_be_hidden()
        page.wait_for_timeout(300)
        rate(page, "44")  # what cannot be seen is not rated
        expect(page.locator("#count")).to_have_text("1 of 6")
        resize(page, 900)
        expect(page.locator("#stage img")).to_be_visible()
        page.keyboard.press("Enter")
        answerable(page, "2 of 6")
        saved(page)
    (row,) = displays(study)
    assert (row["drawn_width_px"], row["drawn_height_px"], row["scaled"]) == (400, 400, 0)
    assert row["focus_lost_ms"] >= 300


def test_a_picture_that_does_not_fit_is_flagged(page: Page, tmp_path: Path) -> None:
    study = short_study(tmp_path, size=400)
    with served(study) as url:
        open_trials(page, url)
        resize(page, 300)  # shrunk for a while counts as shrunk
        expect(page.locator("#stage img")).not_to_have_js_property("width", 400)
        page.evaluate(PAINTED)
        width = page.locator("#stage img").evaluate("img => img.getBoundingClientRect().width")
        resize(page, 900)
        rate(page, "44")
        saved(page)
    (row,) = displays(study)
    assert width < 300
    assert (row["drawn_width_px"], row["drawn_height_px"]) == pytest.approx((width, width), abs=0.02)
    assert row["scaled"] == 1
    assert row["gamut"] in ("srgb", "p3", "rec2020")


PAINTED = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done))))"
"""What stands on the page now was on the screen."""

NEVER_LOOKED_AT = {
    "for less than a frame": """() => {
        const room = document.querySelector("main");
        const sized = (width) => {
            room.style.width = width;
            dispatchEvent(new Event("resize"));
        };
        requestAnimationFrame(() => {
            sized("150px");
            requestAnimationFrame(() => sized(""));
        });
    }""",
    "without room": "() => (document.querySelector('main').style.width = '1px', dispatchEvent(new Event('resize')))",
    "hidden": """() => {
        Object.defineProperty(document, "visibilityState", { configurable: true, value: "hidden" });
        document.querySelector("main").style.width = "150px";
        dispatchEvent(new Event("resize"));
    }""",
}
SEEN_AGAIN = """() => {
    delete document.visibilityState;
    document.querySelector("main").style.width = "";
    document.dispatchEvent(new Event("visibilitychange"));
}"""


@pytest.mark.parametrize("how", NEVER_LOOKED_AT)
@pytest.mark.parametrize("policy", ["flag", "refuse"])
def test_a_size_at_which_nobody_looked_is_not_how_it_was_drawn(
    page: Page, tmp_path: Path, how: str, policy: str
) -> None:
    """Chromium passes through a window of 1 x 1 while it resizes: pictures seemed to have been drawn 0 pixels wide."""
    study = short_study(tmp_path, size=400, scaled_pictures=policy)
    with served(study) as url:
        open_trials(page, url)
        page.evaluate(NEVER_LOOKED_AT[how])
        page.evaluate(PAINTED)
        page.evaluate(PAINTED)
        if how == "without room":
            assert page.locator("#stage.covered").count() == 0
        page.evaluate(SEEN_AGAIN)
        rate(page, "44")
        saved(page)
    (row,) = displays(study)
    assert (row["drawn_width_px"], row["drawn_height_px"], row["scaled"]) == (400, 400, 0)


PHONE: dict[str, Any] = {
    "viewport": {"width": 390, "height": 800},
    "device_scale_factor": 3,
    "is_mobile": True,
    "has_touch": True,
}


def pinch(page: Page, scale: float) -> None:
    """Two fingers enlarge the page so far, and frames with that are drawn."""
    page.context.new_cdp_session(page).send("Emulation.setPageScaleFactor", {"pageScaleFactor": scale})
    page.wait_for_function(f"Math.abs(visualViewport.scale - {scale}) < 0.01")
    page.evaluate(PAINTED)


def test_a_picture_enlarged_by_two_fingers_is_flagged(browser: Browser, tmp_path: Path) -> None:
    study = short_study(tmp_path)
    with served(study) as url, browser.new_context(**PHONE) as context:
        page = context.new_page()
        open_trials(page, url)
        pinch(page, 2.5)
        pinch(page, 1)  # for a while counts
        rate(page, "44")
        saved(page)
    (row,) = displays(study)
    assert row["scaled"] == 1
    assert (row["drawn_width_px"], row["zoom"]) == pytest.approx((2.5 * 96, 2.5), rel=0.02)  # of one moment


def test_a_picture_enlarged_by_two_fingers_is_refused(browser: Browser, tmp_path: Path) -> None:
    study = short_study(tmp_path, scaled_pictures="refuse")
    with served(study) as url, browser.new_context(**PHONE) as context:
        page = context.new_page()
        open_trials(page, url)
        pinch(page, 2.5)
        expect(page.locator("#stage img")).to_be_hidden()
        rate(page, "44")
        expect(page.locator("#count")).to_have_text("1 of 6")
        pinch(page, 1)
        page.keyboard.press("Enter")
        answerable(page, "2 of 6")
        saved(page)
    (row,) = displays(study)
    assert (row["scaled"], row["drawn_width_px"]) == (0, 96)
