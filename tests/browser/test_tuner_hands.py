"""What hands, fingers, wheel and keys do to the tuner's picture; each gesture is one step of undo."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, CDPSession, Page, expect
from tuner_pages import Talk, by_hand, drag, middle, one_page, opened, wait
from tuner_server import tuned

from fakesss.scene import Scene

pytestmark = [pytest.mark.browser, pytest.mark.gl]

SIZE = 128
BASE = Scene.from_dict(
    {"object": "torus:1000", "size": (SIZE, SIZE), "supersampling": 2, "occlusion": {"rays": 4}}, "test"
)
HALF_TURN = 180 / SIZE  # degrees by one CSS pixel


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """One tuner for all of these."""
    with tuned(BASE, tmp_path_factory.mktemp("tuner")) as address:
        yield address


@pytest.fixture(scope="module")
def opened_once(browser: Browser, url: str) -> Iterator[Talk]:
    """A page for all of these; a script error in it fails the last one."""
    with one_page(browser, url) as talk:
        yield talk


@pytest.fixture
def talk(opened_once: Talk) -> Talk:
    """That page with everything as at the start."""
    reset = opened_once.page.locator("#reset-all")
    if reset.is_enabled():
        reset.click()
        wait(opened_once.page, lambda: opened_once.changes == {})
    opened_once.settled()
    return opened_once


def undone_at_once(talk: Talk) -> None:
    """Undo leads back to the start in one step."""
    talk.page.locator("#undo").click()
    wait(talk.page, lambda: talk.changes == {})


def test_a_drag_turns_the_object_and_is_one_step_of_undo(talk: Talk) -> None:
    first = talk.settled()
    drag(talk.page, 40, 16)
    header = talk.settled(after=first["number"])
    assert talk.changes == {
        "camera.azimuth": pytest.approx(-40 * HALF_TURN, abs=0.1),
        "camera.elevation": pytest.approx(BASE.camera.elevation + 16 * HALF_TURN, abs=0.1),
    }
    moving = [frame for frame in talk.of("frame") if frame["moving"]]
    assert moving and {frame["type"] for frame in moving} == {"image/jpeg"}
    assert talk.most_under_way == 1
    undone_at_once(talk)
    assert talk.settled(after=header["number"])["scene_sha256"] == first["scene_sha256"]


@pytest.mark.parametrize(
    ("button", "moved"), [("right", {"light.azimuth", "light.elevation"}), ("middle", {"camera.field_of_view"})]
)
def test_other_buttons_move_the_light_and_the_lens(talk: Talk, button: str, moved: set[str]) -> None:
    drag(talk.page, 12, -12, button)
    wait(talk.page, lambda: set(talk.changes) == moved)
    talk.settled()
    if button == "right":
        assert talk.changes["light.azimuth"] == pytest.approx(BASE.light.azimuth + 12 * HALF_TURN, abs=0.1)
        assert talk.changes["light.elevation"] == pytest.approx(BASE.light.elevation + 12 * HALF_TURN, abs=0.1)
    else:
        assert talk.changes["camera.field_of_view"] < BASE.camera.field_of_view
    undone_at_once(talk)


def test_the_menu_is_kept_away_from_the_picture_only(talk: Talk) -> None:
    asked = """element => !element.dispatchEvent(new MouseEvent("contextmenu", { bubbles: true, cancelable: true }))"""
    assert talk.page.locator("#picture").evaluate(asked)
    assert not talk.page.locator(".bar").evaluate(asked)


def test_elevation_ends_at_the_poles_and_a_double_click_puts_the_camera_back(talk: Talk) -> None:
    drag(talk.page, 0, 200)
    wait(talk.page, lambda: talk.changes == {"camera.elevation": 90})
    talk.page.locator("#place").dblclick()
    wait(talk.page, lambda: talk.changes == {})


def test_the_wheel_zooms_from_the_fitted_distance_in_one_step(page: Page, url: str) -> None:
    talk = by_hand(page, url)
    page.mouse.move(*middle(page))
    fitted = 1 / np.sin(np.radians(BASE.camera.field_of_view / 2))
    for turn in range(1, 4):
        page.mouse.wheel(0, 100)
        there = pytest.approx(fitted * np.exp(0.1 * turn), rel=1e-3)
        wait(page, lambda there=there: talk.changes == {"camera.distance": there})
    assert talk.of("wish")[-1]["moving"]
    page.clock.run_for(1000)  # the hand is off the wheel
    assert not talk.settled()["moving"]
    undone_at_once(talk)


@pytest.mark.parametrize(
    ("keys", "changes", "said"),
    [
        (["ArrowRight"] * 4, {"camera.azimuth": -20}, "Camera -20° around"),
        (["ArrowDown"] * 2, {"camera.elevation": 18}, "18° up; light"),
        (["Shift+ArrowLeft"] * 3, {"light.azimuth": -50}, "light -50° around"),
        (["-"] * 2, {"camera.distance": pytest.approx(3.8637 * 1.05**2, rel=1e-3)}, "Camera 0° around"),
    ],
)
def test_a_held_key_is_one_gesture(talk: Talk, keys: list[str], changes: dict[str, Any], said: str) -> None:
    keyboard, seen = talk.page.keyboard, len(talk.of("wish"))
    talk.page.locator("#place").focus()
    *held, key = keys[0].split("+")
    for modifier in held:
        keyboard.down(modifier)
    for _ in keys:
        keyboard.down(key)  # again and again without an end: that is what holding it looks like
    keyboard.up(key)
    for modifier in held:
        keyboard.up(modifier)
    talk.settled(after=seen)
    assert talk.changes == changes
    expect(talk.page.locator("#spoken")).to_contain_text(said)
    undone_at_once(talk)


class Fingers:
    """Touches by the browser's own protocol."""

    def __init__(self, page: Page) -> None:
        self.devtools: CDPSession = page.context.new_cdp_session(page)

    def touch(self, kind: str, *points: tuple[float, float]) -> None:
        places = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(points)]
        self.devtools.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": places})

    def drag(self, start: list[tuple[float, float]], end: list[tuple[float, float]], steps: int = 8) -> None:
        self.touch("touchStart", *start)
        for step in range(1, steps + 1):
            share = step / steps
            between = [(a + share * (c - a), b + share * (d - b)) for (a, b), (c, d) in zip(start, end, strict=True)]
            self.touch("touchMove", *between)
        self.touch("touchEnd")


@pytest.fixture
def tablet(browser: Browser) -> Iterator[Page]:
    """A page that is touched."""
    with browser.new_context(viewport={"width": 1024, "height": 768}, has_touch=True) as context:
        yield context.new_page()


def test_one_finger_turns_two_light_and_a_pinch_zooms(tablet: Page, url: str) -> None:
    talk = opened(tablet, url)
    x, y = middle(tablet)
    fingers = Fingers(tablet)
    fingers.drag([(x, y)], [(x + 40, y)])
    talk.settled(after=1)
    assert set(talk.changes) == {"camera.azimuth"}
    seen = len(talk.of("wish"))
    fingers.drag([(x - 30, y), (x + 30, y)], [(x + 10, y - 20), (x + 70, y - 20)])
    talk.settled(after=seen)
    assert set(talk.changes) == {"camera.azimuth", "light.azimuth", "light.elevation"}
    assert talk.changes["light.azimuth"] > BASE.light.azimuth
    assert talk.changes["light.elevation"] > BASE.light.elevation
    seen = len(talk.of("wish"))
    fingers.drag([(x - 20, y), (x + 20, y)], [(x - 60, y), (x + 60, y)])
    talk.settled(after=seen)
    assert talk.changes["camera.distance"] < 3.8637 * 0.5
    for left in ({"camera.azimuth", "light.azimuth", "light.elevation"}, {"camera.azimuth"}, set()):
        tablet.locator("#undo").click()
        wait(tablet, lambda left=left: set(talk.changes) == left)


def test_a_touch_that_is_taken_away_ends_the_gesture(tablet: Page, url: str) -> None:
    talk = opened(tablet, url)
    x, y = middle(tablet)
    fingers = Fingers(tablet)
    fingers.touch("touchStart", (x, y))
    fingers.touch("touchMove", (x + 30, y))
    fingers.touch("touchCancel")
    assert not talk.settled(after=1)["moving"]
