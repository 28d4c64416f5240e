"""What moves by itself in the tuner: steady by the clock, one step of undo, and only for who wants it."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect
from tuner_pages import by_hand, opened, panel, wait
from tuner_server import tuned

from fakesss.scene import Scene

pytestmark = [pytest.mark.browser, pytest.mark.gl]

SIZE = 128
BASE = Scene.from_dict(
    {"object": "torus:1000", "size": (SIZE, SIZE), "supersampling": 2, "occlusion": {"rays": 4}}, "test"
)


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """One tuner for all of these."""
    with tuned(BASE, tmp_path_factory.mktemp("tuner")) as address:
        yield address


def test_auto_rotation_keeps_to_the_clock(page: Page, url: str) -> None:
    talk = by_hand(page, url)
    panel(page, "Camera")
    page.locator("#auto-rotation").check()
    page.clock.run_for(2000)
    page.locator("#auto-rotation").uncheck()
    talk.settled(after=1)
    assert talk.changes == {"camera.azimuth": pytest.approx(60, abs=1)}  # 30 degrees a second
    page.locator("#undo").click()
    wait(page, lambda: talk.changes == {})


def test_what_is_set_while_it_turns_is_a_step_of_its_own(page: Page, url: str) -> None:
    talk = by_hand(page, url)
    panel(page, "Camera")
    page.locator("#auto-rotation").check()
    page.clock.run_for(1000)
    page.locator("#place").focus()
    page.keyboard.press("Shift+ArrowUp")
    page.clock.run_for(1000)
    wait(page, lambda: talk.changes["camera.azimuth"] > 55)
    assert talk.of("wish")[-1]["moving"]
    page.locator("#undo").click()  # which also stops it
    wait(page, lambda: set(talk.changes) == {"camera.azimuth"} and talk.changes["camera.azimuth"] < 35)
    expect(page.locator("#auto-rotation")).not_to_be_checked()
    page.locator("#undo").click()
    wait(page, lambda: talk.changes == {})


def test_random_lighting_moves_the_light_alone_and_steadily(page: Page, url: str) -> None:
    talk = by_hand(page, url)
    panel(page, "Lights")
    page.locator("#random-lighting").check()
    page.clock.run_for(3000)
    page.locator("#random-lighting").uncheck()
    talk.settled(after=1)
    assert set(talk.changes) <= {"light.azimuth", "light.elevation"}

    def towards(azimuth: float, elevation: float) -> Any:
        a, e = np.radians((azimuth, elevation))
        return np.array([np.sin(a) * np.cos(e), np.sin(e), np.cos(a) * np.cos(e)])

    now = {"azimuth": BASE.light.azimuth, "elevation": BASE.light.elevation}
    now |= {path.removeprefix("light."): value for path, value in talk.changes.items()}
    cosine = towards(BASE.light.azimuth, BASE.light.elevation) @ towards(**now)
    assert 0 < np.degrees(np.arccos(np.clip(cosine, -1, 1))) < 61  # 20 degrees a second, on a way that may turn
    page.locator("#undo").click()
    wait(page, lambda: talk.changes == {})


def test_who_wants_less_motion_is_asked(browser: Browser, url: str) -> None:
    with browser.new_context(reduced_motion="reduce") as context:
        page = context.new_page()
        talk = opened(page, url)
        panel(page, "Camera")
        page.locator("#auto-rotation").click()
        page.get_by_role("button", name="Keep still").click()
        expect(page.locator("#auto-rotation")).not_to_be_checked()
        assert talk.changes == {}
        page.locator("#auto-rotation").click()
        page.get_by_role("button", name="Let it move").click()
        wait(page, lambda: talk.changes)
        expect(page.locator("#auto-rotation")).to_be_checked()
