"""Another picture in the place of the live one: the right one, in the same place, and as long as it is asked for."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page, Route, expect
from tuner_pages import Talk, link, on_canvas, one_page, panel, pinned, press, shows, wait
from tuner_server import tuned

from fakesss.scene import Scene

pytestmark = [pytest.mark.browser, pytest.mark.gl]

BASE = Scene.from_dict(
    {"object": "sphere:1000", "size": (64, 64), "supersampling": 1, "occlusion": {"rays": 4}}, "test"
)
TWO_FRAMES = "async () => { for (let n = 0; n < 2; n++) await new Promise(requestAnimationFrame) }"
MANY = {
    "material.backlight": 0.4,
    "material.shininess": 20,
    "material.thickness_exponent": 2,
    "material.diffuse_weight": 0.3,
    "light.azimuth": 20,
    "light.elevation": 30,
    "camera.elevation": 11,
    "camera.field_of_view": 41,
}


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """One tuner for all of these."""
    with tuned(BASE, tmp_path_factory.mktemp("tuner")) as address:
        yield address


@pytest.fixture(scope="module")
def talk(browser: Browser, url: str) -> Iterator[Talk]:
    """A page for all of these; a script error in it fails the last one."""
    with one_page(browser, url) as talk:
        yield talk


@pytest.fixture
def page(talk: Talk) -> Iterator[Page]:
    """The page itself; a test that fails leaves no key down for the next."""
    yield talk.page
    for key in ("b", "Digit1", "Shift"):
        talk.page.keyboard.up(key)


def test_a_picture_that_comes_after_its_press_is_not_shown(page: Page, talk: Talk) -> None:
    press(talk, "Shift+ArrowLeft")
    seen, held = len(talk.of("wish")), list[Route]()
    page.locator("#view").select_option("thickness")  # whose picture before is not kept
    talk.settled(after=seen)
    page.route("**/picture", lambda route: held.append(route))
    page.locator("#place").focus()
    page.keyboard.press("b")
    wait(page, lambda: held)
    before = on_canvas(page)
    press(talk, "ArrowLeft")
    page.keyboard.down("b")
    shows(page, before)
    with page.expect_response("**/picture") as answer:
        held[0].continue_()
    answer.value.finished()
    page.evaluate("() => new Promise((done) => setTimeout(done))")  # so that it may be decoded
    shows(page, before)
    expect(page.locator("#caption")).to_contain_text("camera azimuth 0")
    page.keyboard.up("b")
    page.unroute("**/picture")
    seen = len(talk.of("wish"))
    page.locator("#view").select_option("picture")
    talk.settled(after=seen)


def test_a_key_ends_its_look_wherever_and_as_whatever_it_is_let_go(page: Page, talk: Talk) -> None:
    first = on_canvas(page)
    pinned(page, 1)
    second = press(talk, "Shift+ArrowLeft")
    page.keyboard.down("Digit1")
    shows(page, first)
    page.keyboard.down("Shift")
    page.keyboard.up("Digit1")  # which is "!"
    shows(page, second)
    page.keyboard.up("Shift")
    page.keyboard.down("b")
    shows(page, first)
    page.get_by_role("textbox", name="Name of pin 1").focus()
    page.keyboard.up("b")
    shows(page, second)


def test_it_ends_what_moves_by_itself(page: Page, talk: Talk) -> None:
    panel(page, "Camera")
    first = on_canvas(page)
    seen = len(talk.of("wish"))
    page.locator("#auto-rotation").check()
    wait(page, lambda: len(talk.of("wish")) > seen + 1)
    page.locator("#place").focus()
    page.keyboard.down("b")
    shows(page, first)
    expect(page.locator("#auto-rotation")).not_to_be_checked()
    page.keyboard.up("b")


def test_a_long_caption_does_not_move_the_picture(page: Page, talk: Talk, url: str) -> None:
    seen = len(talk.of("wish"))
    page.goto(link(url, {"changes": MANY, "effects": {}}))
    talk.settled(after=seen)
    page.set_viewport_size({"width": 390, "height": 800})
    page.evaluate(TWO_FRAMES)  # so that the picture has moved to its place in the smaller window
    before = page.locator("#picture").bounding_box()
    page.locator("#place").focus()
    page.keyboard.down("b")
    expect(page.locator("#caption")).to_contain_text("backlight")
    assert page.locator("#picture").bounding_box() == before
    page.keyboard.up("b")
    page.set_viewport_size({"width": 1280, "height": 800})


def test_pins_are_drawn_anew_with_other_shaders(page: Page) -> None:
    image = page.locator("#pins img").first
    old = image.get_attribute("src")
    page.evaluate("fetch('reload', { method: 'POST' })")
    wait(page, lambda: image.get_attribute("src") != old)
    assert page.evaluate("address => fetch(address).then(() => true, () => false)", old) is False  # given up
