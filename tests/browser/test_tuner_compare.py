"""The tuner's comparisons: undo and redo, the setting before, pins, differences."""

import re
import secrets
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from accessible import violations, with_axe
from PIL import Image
from playwright.sync_api import Browser, BrowserContext, Page, expect
from tuner_pages import Pixels, Talk, on_canvas, one_page, opened, pinned, press, shows, wait
from tuner_server import tuned

from fakesss.renderer import render_file
from fakesss.scene import Scene

pytestmark = [pytest.mark.browser, pytest.mark.gl]

SIZE = 96
BASE = Scene.from_dict(
    {"object": "sphere:1000", "size": (SIZE, SIZE), "supersampling": 1, "occlusion": {"rays": 4}}, "test"
)
LEFT = {"light.azimuth": -40}


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """One tuner for all of these."""
    with tuned(BASE, tmp_path_factory.mktemp("tuner")) as address:
        yield address


@pytest.fixture(scope="module")
def opened_once(browser: Browser, url: str) -> Iterator[Talk]:
    """A page for most of these; a script error in it fails the last one."""
    with one_page(browser, url) as talk:
        yield talk


@pytest.fixture
def talk(opened_once: Talk) -> Talk:
    """That page with everything as at the start but what undo remembers."""
    page = opened_once.page
    while page.locator("#pins .remove").count():
        page.locator("#pins .remove").first.click()
    if page.locator("#reset-all").is_enabled():
        page.locator("#reset-all").click()
        wait(page, lambda: opened_once.changes == {})
    opened_once.settled()
    return opened_once


@pytest.fixture
def page(talk: Talk) -> Page:
    """The page itself."""
    return talk.page


@pytest.fixture
def fresh(context: BrowserContext, url: str) -> Talk:
    """A page that nobody has used."""
    return opened(context.new_page(), url)


def rendered(changes: dict[str, Any], folder: Path) -> Pixels:
    """The file that `fakesss render` makes of the scene, (height, width, 3)."""
    path = folder / f"{secrets.token_hex(4)}.png"
    render_file(BASE.replace(changes, "test"), path, timed=False)
    return np.asarray(Image.open(path).convert("RGB"))


def test_undo_and_redo_by_button_and_by_key(fresh: Talk) -> None:
    page = fresh.page
    first = on_canvas(page)
    second = press(fresh, "Shift+ArrowLeft")
    page.keyboard.press("Control+z")
    shows(page, first)
    page.keyboard.press("Control+Shift+Z")
    shows(page, second)
    page.locator("#undo").click()
    shows(page, first)
    expect(page.locator("#undo")).to_be_disabled()
    expect(page.locator("#undo")).to_be_focused()
    expect(page.locator("#spoken")).to_have_text("After undo: light azimuth −35.")
    page.keyboard.press("Control+y")
    shows(page, second)
    expect(page.locator("#redo")).to_be_disabled()


def test_undo_in_a_field_is_the_field_s_own_while_its_text_is_not_taken(page: Page, talk: Talk) -> None:
    press(talk, "Shift+ArrowLeft")
    page.get_by_role("tab", name="Material").click()
    field = page.locator("#panel-material input.typed").first
    field.click()
    shown = field.input_value()
    field.press("7")
    field.press("Control+z")
    expect(field).to_have_value(shown)
    assert talk.changes == LEFT
    field.press("Control+z")  # there is nothing typed any more
    wait(page, lambda: talk.changes == {})
    field.fill("0.7")
    field.press("Enter")
    wait(page, lambda: talk.changes != {})
    field.press("Control+z")
    wait(page, lambda: talk.changes == {})
    page.locator("#view").focus()  # a list has no undo of its own
    page.keyboard.press("Control+y")
    wait(page, lambda: talk.changes != {})


def test_holding_b_shows_the_setting_before(page: Page, talk: Talk) -> None:
    first = on_canvas(page)
    second = press(talk, "Shift+ArrowLeft")
    asked = len(talk.of("wish"))
    page.keyboard.down("b")
    shows(page, first)
    expect(page.locator("#caption")).to_contain_text("light azimuth −35")
    expect(page.locator("#previous")).to_have_attribute("aria-pressed", "true")
    page.keyboard.up("b")
    shows(page, second)
    expect(page.locator("#previous")).to_have_attribute("aria-pressed", "false")
    assert (len(talk.of("wish")), talk.changes) == (asked, LEFT)  # nothing was changed by looking
    page.locator("#letter-keys").uncheck()
    page.keyboard.down("b")
    expect(page.locator("#previous")).to_have_attribute("aria-pressed", "false")
    page.keyboard.up("b")
    page.locator("#letter-keys").check()


def test_the_setting_before_by_a_click_and_until_something_changes(page: Page, talk: Talk) -> None:
    first = on_canvas(page)
    second = press(talk, "Shift+ArrowLeft")
    page.locator("#previous").click()
    shows(page, first)
    expect(page.locator("#previous")).to_have_css("background-color", "rgb(255, 255, 255)")  # also under the pointer
    page.locator("#previous").click()
    shows(page, second)
    page.locator("#previous").press("Enter")
    shows(page, first)
    third = press(talk, "Shift+ArrowLeft")
    assert not np.array_equal(third, first) and not np.array_equal(third, second)
    expect(page.locator("#previous")).to_have_attribute("aria-pressed", "false")
    shows(page, third)


def test_the_button_can_be_held_too(fresh: Talk) -> None:
    page = fresh.page
    first = on_canvas(page)
    second = press(fresh, "Shift+ArrowLeft")
    page.clock.install(time=0)
    page.clock.pause_at(10)
    page.locator("#previous").hover()
    page.mouse.down()
    shows(page, first)
    page.clock.run_for(1000)
    page.mouse.move(300, 300)  # let go elsewhere
    page.mouse.up()
    shows(page, second)


def test_pins_are_named_by_what_differs_and_brought_back(page: Page, talk: Talk) -> None:
    expect(page.locator("#compare")).to_be_hidden()
    first = on_canvas(page)
    pinned(page, 1)
    expect(page.locator("#pins .values")).to_have_text("as the live picture")
    second = press(talk, "Shift+ArrowLeft")
    pinned(page, 2)
    expect(page.locator("#pins .values")).to_have_text(["light azimuth −35", "light azimuth −40"])
    page.get_by_role("button", name="Bring back pin 1: light azimuth −35").click()
    shows(page, first)
    assert talk.changes == {}
    page.keyboard.press("Control+z")
    shows(page, second)
    page.get_by_role("textbox", name="Name of pin 2").fill("from the left")
    page.keyboard.press("Tab")
    expect(page.get_by_role("button", name="Remove from the left")).to_be_visible()
    page.get_by_role("button", name="Remove pin 1").click()
    expect(page.locator("#pins li")).to_have_count(1)
    expect(page.get_by_role("textbox", name="Name of pin 1")).to_have_value("from the left")


def test_a_digit_held_shows_a_pin(page: Page, talk: Talk) -> None:
    first = on_canvas(page)
    pinned(page, 1)
    second = press(talk, "Shift+ArrowLeft")
    pinned(page, 2)
    third = press(talk, "Shift+ArrowLeft")
    for key, picture in (("1", first), ("2", second)):
        page.keyboard.down(key)
        shows(page, picture)
        page.keyboard.up(key)
        shows(page, third)
    page.get_by_role("button", name="Remove pin 1").click()
    page.locator("#place").focus()
    page.keyboard.down("1")  # which is the second now
    shows(page, second)
    page.keyboard.up("1")
    page.get_by_role("button", name="Look at pin 1").click()
    shows(page, second)


def test_there_are_four_pins_at_most_and_a_reload_keeps_them(fresh: Talk) -> None:
    page = fresh.page
    for number in range(1, 5):
        pinned(page, number)
        press(fresh, "Shift+ArrowLeft")
    expect(page.locator("#pin")).to_be_disabled()
    page.get_by_role("textbox", name="Name of pin 3").fill("third")
    page.keyboard.press("Tab")
    words = page.locator("#pins .values").all_text_contents()
    page.reload()
    wait(page, lambda: page.locator("#pins img").count() == 4)
    assert page.locator("#pins .values").all_text_contents() == words
    expect(page.get_by_role("textbox", name="Name of pin 3")).to_have_value("third")
    page.get_by_role("button", name="Remove third").click()
    expect(page.locator("#pin")).to_be_enabled()


def test_the_difference_is_that_of_the_rendered_files(page: Page, talk: Talk, tmp_path: Path) -> None:
    pinned(page, 1)
    page.locator("#show-difference").click()
    expect(page.locator("#difference-words")).to_have_text("No pixel differs.")
    assert not on_canvas(page)[..., :3].any()
    page.locator("#place").focus()
    page.keyboard.down("Shift")
    page.keyboard.down("ArrowLeft")
    expect(page.locator("#difference-words")).to_have_text("")  # they were true of another picture
    page.keyboard.up("ArrowLeft")
    page.keyboard.up("Shift")
    expect(page.locator("#difference-words")).to_contain_text("Largest")  # drawn anew with the new picture
    before, after = (rendered(changes, tmp_path).astype(int) for changes in ({}, LEFT))
    apart = np.abs(before - after)
    wait(page, lambda: np.array_equal(on_canvas(page)[..., :3], np.minimum(8 * apart, 255)))
    page.locator("#difference-gain").select_option("1")
    wait(page, lambda: np.array_equal(on_canvas(page)[..., :3], apart))
    found = re.fullmatch(
        r"Largest (\d+) of 255, at \((\d+), (\d+)\); mean ([\d.]+); ([\d.]+) % of the pixels differ\.",
        page.locator("#difference-words").text_content() or "",
    )
    assert found
    largest, x, y, mean, share = map(float, found.groups())
    assert largest == apart.max() == apart[int(y), int(x)].max()
    assert mean == pytest.approx(apart.mean(), rel=0.06)
    assert share == pytest.approx(100 * apart.any(axis=2).mean(), rel=0.06)
    page.locator("#show-difference").click()
    wait(page, lambda: np.array_equal(on_canvas(page)[..., :3], after))


def test_pictures_of_different_sizes_have_no_difference(page: Page, talk: Talk) -> None:
    pinned(page, 1)
    page.get_by_role("tab", name="Shader").click()
    width = page.locator('.control[data-path="size"] input.typed').first
    seen = len(talk.of("wish"))
    width.fill("64")
    width.press("Enter")
    talk.settled(after=seen)
    page.locator("#show-difference").click()
    expect(page.locator("#difference-words")).to_contain_text("different sizes: 64 × 96 and 96 × 96")


def test_a_pin_whose_picture_fails_after_a_reload_stays_and_that_is_said(fresh: Talk) -> None:
    page = fresh.page
    pinned(page, 1)
    page.route("**/picture", lambda route: route.fulfill(status=503, json={"error": "Come again."}))
    press(fresh, "Shift+ArrowLeft")
    page.reload()
    expect(page.locator("#log")).to_contain_text("A pin's picture could not be drawn: Come again.")
    expect(page.locator("#pins li")).to_have_count(1)


def test_what_cannot_be_drawn_cannot_be_pinned(page: Page) -> None:
    page.get_by_role("tab", name="Camera").click()
    for path, distance in (("camera.far", "3"), ("camera.near", "5")):
        field = page.locator(f".control[data-path='{path}'] input.typed")
        field.fill(distance)
        field.press("Enter")
    page.locator("#pin").click()
    expect(page.locator("#log")).to_contain_text("This cannot be pinned:")
    expect(page.locator("#pins li")).to_have_count(0)


def test_axe_finds_nothing_wrong_with_pins_and_drawers_open(context: BrowserContext, url: str) -> None:
    page = with_axe(context).new_page()
    talk = opened(page, url)
    pinned(page, 1)
    press(talk, "Shift+ArrowLeft")
    page.locator("#show-passes").click()
    page.locator("#show-messages").click()
    assert violations(page) == []
