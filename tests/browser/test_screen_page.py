"""The screen check through a real browser: by keyboard, by mouse, on a phone, at several pixel ratios, left alone."""

import csv
import io
import math
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from playwright.sync_api import Browser, Locator, Page, expect
from study_fixture import write_study

from study_server.exports.export import export_ratings
from study_server.screen.plates import PLATES
from study_server.screen.screen_check import DARK_STEPS, FACTS, LIGHT_STEPS, MATCHES, columns, gamma
from study_server.serve import served

pytestmark = pytest.mark.browser

AXE = Path(__file__).parents[2] / "node_modules" / "axe-core" / "axe.min.js"
PARTS = ["card", "wedge", "plates"]
CHECKS = 3 + len(PLATES)
PHONE = {"viewport": {"width": 390, "height": 844}, "device_scale_factor": 3, "is_mobile": True, "has_touch": True}


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """A study that begins with every part of the screen check."""
    return write_study(tmp_path / "study", survey={"about": [], "screen_check": PARTS})


@pytest.fixture
def url(study: Path) -> Iterator[str]:
    """The study, served."""
    with served(study) as address:
        yield address


def to_check(page: Page, url: str) -> None:
    """From the link to the first check."""
    page.goto(url)
    page.locator("main button").first.click()
    page.wait_for_selector("body.screen")
    at_check(page, 1)


def at_check(page: Page, number: int) -> None:
    """Wait for this check, which alone is shown."""
    expect(page.locator("#count")).to_have_text(f"Check {number} of {CHECKS}")
    expect(page.locator(".check:visible")).to_have_count(1)


def stored(study: Path) -> dict[str, str]:
    """The only participant's screen columns, without their prefix; empty ones left out."""
    export_ratings(study, study / "out")
    with (study / "out" / "participants.csv").open(newline="", encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    return {name.removeprefix("screen_"): row[name] for name in columns(PARTS) if row[name]}


def test_the_whole_check_by_keyboard(page: Page, url: str, study: Path) -> None:
    to_check(page, url)
    press = page.keyboard.press
    page.locator("#card input[type=range]").focus()
    for _ in range(80):
        press("ArrowRight")
    assert page.evaluate(
        "(({width, height}) => [width, height])(document.getElementById('rectangle').getBoundingClientRect())"
    ) == pytest.approx([300, 300 * 53.98 / 85.6], abs=0.05)
    press("Enter")
    at_check(page, 2)
    press("Tab")
    press("Space")  # 0 patches
    for _ in range(6):
        press("ArrowRight")
    press("Tab")
    press("Space")
    press("Enter")
    at_check(page, 3)
    for steps in (5, 0, -7):
        press("Tab")  # less
        press("Tab")  # the slider
        for _ in range(abs(steps)):
            press("ArrowRight" if steps > 0 else "ArrowLeft")
        press("Tab")  # more
    press("Tab")
    press("Enter")
    for number, answer in enumerate(("12", "47", "", "25", "47"), 4):
        at_check(page, number)
        press("Tab")
        page.keyboard.type(answer)
        press("Enter")
    page.wait_for_selector("body.instructions")
    told = stored(study)
    assert (told["card"], float(told["px_per_mm"])) == ("measured", pytest.approx(300 / 85.6, abs=1e-4))
    assert (told["dark_steps"], told["light_steps"]) == ("6", "0")
    assert (told["match_25"], told.get("match_50"), told["match_75"]) == ("95", None, "83")
    assert "gamma" not in told
    assert [told.get(f"plate_{index}_right") for index in range(1, 6)] == ["1", "1", None, "1", "0"]
    assert told["plates_right"] == "3"


def test_by_mouse_dragging_the_corner_and_going_back(page: Page, url: str, study: Path) -> None:
    to_check(page, url)
    box = page.locator("#corner").bounding_box()
    assert box
    x, y = box["x"] + 30, box["y"] + 30
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y + 10)
    page.mouse.move(x + 103, y + 50)
    page.mouse.up()
    page.mouse.move(x, y)  # no button held: nothing moves
    page.get_by_role("button", name="Larger").click()
    page.get_by_role("button", name="It fits").click()
    at_check(page, 2)
    page.locator(".scale label:visible").nth(4).click()
    page.get_by_role("button", name="Next").click()
    at_check(page, 3)
    for _ in range(3):
        page.get_by_role("button", name="Brighter").nth(1).click()
    page.get_by_role("button", name="Back").click()
    at_check(page, 2)
    assert page.locator("input[name=dark_steps]:checked").input_value() == "4"
    for number in (3, 4):
        page.get_by_role("button", name="Next").click()
        at_check(page, number)
    for number in range(5, CHECKS + 1):
        page.get_by_role("button", name="I see no number").click()
        at_check(page, number)
    page.get_by_role("button", name="Back").click()
    page.locator(".answer input:visible").fill("25")  # on second thoughts
    page.get_by_role("button", name="Next").click()
    page.get_by_role("button", name="I see no number").click()
    page.wait_for_selector("body.instructions")
    told = stored(study)
    assert float(told["px_per_mm"]) == pytest.approx((220 + 103 + 1) / 85.6, abs=1e-4)
    assert (told["dark_steps"], told.get("light_steps")) == ("4", None)
    assert (told["match_50"], float(told["gamma"])) == ("93", pytest.approx(gamma(93), abs=1e-4))
    assert [told[f"plate_{index}"] for index in range(1, 6)] == ["nothing", "nothing", "nothing", "25", "nothing"]
    assert told["plates_right"] == "1"


def test_a_reload_keeps_the_place_and_the_answers(page: Page, url: str, study: Path) -> None:
    to_check(page, url)
    page.get_by_role("button", name="Larger").click()
    page.reload()
    at_check(page, 1)
    page.get_by_role("button", name="It fits").click()
    page.locator(".scale label:visible").nth(4).click()
    page.get_by_role("button", name="Next").click()
    page.get_by_role("button", name="Brighter").nth(1).click()
    page.reload()
    at_check(page, 3)
    page.get_by_role("button", name="Next").click()
    page.locator(".answer input:visible").fill("12")
    page.get_by_role("button", name="Next").click()
    page.get_by_role("button", name="I see no number").click()
    page.reload()
    for number in range(6, CHECKS + 1):
        at_check(page, number)
        page.get_by_role("button", name="Next").click()
    page.wait_for_selector("body.instructions")
    told = stored(study)
    assert (told["card"], float(told["px_per_mm"])) == ("measured", pytest.approx(221 / 85.6, abs=1e-4))
    assert (told["dark_steps"], told["match_50"], told["plate_1"], told["plate_2"]) == ("4", "91", "12", "nothing")
    assert "match_25" not in told and "plate_3" not in told


def test_one_button_leaves_it_with_what_the_browser_knows_anyway(page: Page, url: str, study: Path) -> None:
    to_check(page, url)
    page.keyboard.press("Tab")
    expect(page.locator("#why")).to_contain_text(". We also store its size in pixels")
    expect(page.get_by_role("button", name="Continue without these checks")).to_be_focused()
    page.keyboard.press("Enter")
    page.wait_for_selector("body.instructions")
    told = stored(study)
    assert set(told) == set(FACTS)
    size = page.evaluate("[screen.width, screen.height, innerWidth, innerHeight, screen.colorDepth].map(String)")
    names = ("width_px", "height_px", "window_width_px", "window_height_px", "color_depth")
    assert [told[name] for name in names] == size


@pytest.mark.parametrize(("button", "word"), [("I have no card at hand", "none"), ("It fits", "unmoved")])
def test_a_card_that_was_not_measured_is_no_measurement(
    page: Page, url: str, study: Path, button: str, word: str
) -> None:
    to_check(page, url)
    page.get_by_role("button", name=button).click()
    at_check(page, 2)
    page.get_by_role("button", name="Continue without these checks").click()
    page.wait_for_selector("body.instructions")
    told = stored(study)
    assert (told["card"], told.get("px_per_mm")) == (word, None)


def test_back_does_not_return_to_it(page: Page, url: str) -> None:
    to_check(page, url)
    page.locator("main button").first.click()
    page.wait_for_selector("body.instructions")
    page.go_back()
    page.wait_for_selector("body.instructions")


@pytest.mark.parametrize("ratio", [1, 1.25, 1.5, 2])
def test_stripes_and_patches_are_drawn_on_device_pixels(launch: Callable[..., Browser], url: str, ratio: float) -> None:
    # a switch, because an emulated ratio scales a page laid out for ratio 1
    browser = launch(f"--force-device-scale-factor={ratio}", "--window-size=1713,1201")
    page = browser.new_context(no_viewport=True).new_page()
    to_check(page, url)
    page.get_by_role("button", name="It fits").click()
    for canvas, ground, steps in zip(page.locator(".wedge").all(), (0, 255), (DARK_STEPS, LIGHT_STEPS), strict=True):
        shown = pixels(page, canvas, ratio)
        middle = shown[len(shown) // 2]
        seen = middle[np.flatnonzero(np.diff(middle, prepend=ground))]  # where the value changes along the bar
        assert sorted(set(seen.tolist()) - {ground}) == sorted(steps)
        assert set(shown[2].tolist()) == {ground}
    page.get_by_role("button", name="Next").click()
    at_check(page, 3)
    for canvas, percent in zip(page.locator(".match").all(), MATCHES, strict=True):
        shown = pixels(page, canvas, ratio)
        size = len(shown)
        stripes, square = shown[:, 3], shown[size // 2 - 20 : size // 2 + 20, size // 2 - 20 : size // 2 + 20]
        assert set(stripes.tolist()) == {0, 255}
        period = 2 if percent == 50 else 4
        whole = stripes[: size // period * period].reshape(-1, period)
        assert (whole == whole[0]).all()
        assert (whole[0] == 255).mean() == percent / 100
        assert set(square.ravel().tolist()) == {90}
    browser.close()


def test_stripes_follow_the_pixel_ratio(page: Page, url: str) -> None:
    to_check(page, url)
    for name in ("It fits", "Next"):
        page.get_by_role("button", name=name).click()
    session = page.context.new_cdp_session(page)
    for ratio in (1, 1.75, 1.1):
        # another width, since Chromium tells of an emulated ratio only with it; the stripes' own room stays as wide
        metrics = {"width": 1280 + int(10 * ratio), "height": 800, "deviceScaleFactor": ratio, "mobile": False}
        session.send("Emulation.setDeviceMetricsOverride", metrics)
        expect(page.locator(".match").nth(1)).to_have_js_property("height", int(200 * ratio))


def pixels(page: Page, canvas: Locator, ratio: float) -> NDArray[np.int_]:
    """The grey values (height, width) of a canvas in a screenshot, one for each pixel of the screen."""
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    assert box
    screen = np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("RGB")).astype(int)
    left, top = (math.floor(box[side] * ratio + 0.5) for side in ("x", "y"))
    width, height = canvas.evaluate("canvas => [canvas.width, canvas.height]")
    assert (width, height) == pytest.approx((box["width"] * ratio, box["height"] * ratio), abs=0.05)
    cut = screen[top : top + height, left : left + width]
    assert np.ptp(cut, axis=2).max() == 0
    return cut[:, :, 0]


@pytest.mark.parametrize(
    "opened", [PHONE, {"viewport": {"width": 320, "height": 256}}, {"viewport": {"width": 1280, "height": 800}}]
)
def test_every_check_fits_its_window_and_has_names_and_targets(
    browser: Browser, url: str, opened: dict[str, object]
) -> None:
    context = browser.new_context(**opened, reduced_motion="reduce")  # type: ignore[arg-type]
    page = context.new_page()
    to_check(page, url)
    page.evaluate(AXE.read_text(encoding="utf-8"))
    page.locator("#card input[type=range]").press("End")  # as large as it gets
    for number in range(1, 5):
        at_check(page, number)
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        sizes = page.evaluate(
            "[...document.querySelectorAll('main button, main input:not([type=hidden], [type=radio]), .scale label')]"
            ".map(each => each.getBoundingClientRect()).filter(box => box.width).map(box => [box.width, box.height])"
        )
        assert min(map(min, sizes)) >= 24
        found = page.evaluate("axe.run(document, {runOnly: ['wcag2a', 'wcag2aa', 'wcag21aa', 'wcag22aa']})")
        assert [(each["id"], each["nodes"][0]["html"]) for each in found["violations"]] == []
        page.locator("[data-next]:visible").first.click()
        at_check(page, number + 1)
        expect(page.locator("h2:visible")).to_be_focused()  # a screen reader begins there
    context.close()


def test_without_javascript_it_says_so_and_can_be_left(browser: Browser, url: str, study: Path) -> None:
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(url)
    page.locator("main button").first.click()
    expect(page.locator("noscript .notice")).to_contain_text("need JavaScript")
    assert page.locator(".check:visible").count() == 0
    page.locator("main button").first.click()
    expect(page.locator("body")).to_have_class("instructions")
    assert stored(study) == {}
    context.close()
