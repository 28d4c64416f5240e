"""Sweep from here: the preview, and the study whose pictures are those that were seen."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from accessible import cut_off, violations, with_axe
from playwright.sync_api import Browser, Locator, Page, Route, WebSocketRoute, expect
from tuner_pages import Stills, Talk, drag, link, middle, opened, panel, wait
from tuner_server import tuned

from fakesss.cli_study import build_study
from fakesss.renderer import render_file
from fakesss.scene import Scene
from stimuli.sweep import write_sweep

pytestmark = [pytest.mark.browser, pytest.mark.gl]

SCENE = Scene.from_dict(
    {"object": "torus:1000", "size": (96, 64), "supersampling": 1, "occlusion": {"rays": 4}}, "test"
)
SETTINGS: dict[str, Any] = {
    "changes": {"material.backlight": 0.75, "lights": [{"kind": "directional", "azimuth": 100.0}]},
    "effects": {"shadows": "on", "backlight": "off"},
}
"""A further light, and effects by hand that set the very fields that are varied below."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the tuner writes."""
    return tmp_path_factory.mktemp("tuner")


@pytest.fixture(scope="module")
def url(folder: Path) -> Iterator[str]:
    """One tuner for all of these."""
    with tuned(SCENE, folder, write_study=write_sweep) as address:
        yield address


@pytest.fixture
def talk(page: Page, url: str) -> Talk:
    """The page with its Sweep tab."""
    found = opened(page, url)
    page.locator("#tab-sweep").click()
    return found


def factor(page: Page, place: str) -> Locator:
    """The part of the panel for what varies `across` or `down`."""
    return page.locator(f".factor[data-place={place}]")


def vary(page: Page, place: str, path: str, levels: str = "") -> None:
    """Let a setting vary, with these levels if it is a number."""
    factor(page, place).locator(".path").select_option(path)
    if levels:
        factor(page, place).locator(".levels").fill(levels)
        factor(page, place).locator(".levels").press("Enter")


def previewed(page: Page, pictures: int) -> Locator:
    """The preview's buttons once all their pictures are there."""
    buttons = page.locator("#sweep-grid td button")
    expect(buttons).to_have_count(pictures)
    expect(page.locator("#sweep-grid .waits")).to_have_count(0)
    expect(page.locator("#sweep-grid img[src]")).to_have_count(pictures)
    return buttons


def names(buttons: Locator) -> list[str | None]:
    return [button.get_attribute("aria-label") for button in buttons.all()]


def messages(page: Page) -> list[WebSocketRoute]:
    """The connections of a page that is opened next, to say something in the tuner's place."""
    found: list[WebSocketRoute] = []

    def between(route: WebSocketRoute) -> None:
        route.connect_to_server()
        found.append(route)

    page.route_web_socket("**/socket", between)
    return found


def test_what_is_seen_is_what_is_built_and_rendered(page: Page, url: str, folder: Path) -> None:
    stills, talk = Stills(page), opened(page, url)
    page.goto(link(url, SETTINGS))
    wait(page, lambda: talk.of("wish")[-1]["settings"] == SETTINGS)
    talk.settled()
    page.locator("#tab-sweep").click()
    vary(page, "across", "material.backlight", "0.5, 1.5")
    vary(page, "down", "lights.0.shadows")
    buttons = previewed(page, 4)
    assert names(buttons)[:2] == ["light 2 casts shadows on, backlight 0.5", "light 2 casts shadows on, backlight 1.5"]
    page.locator("#study-folder").fill("as-seen")
    page.locator("#write-study").click()
    expect(page.locator("#study-written")).to_contain_text(f"fakesss run {folder / 'as-seen'}")
    stimuli = build_study(folder / "as-seen")["stimuli"]
    assert [entry["label"].replace("true", "on").replace("false", "off") for entry in stimuli] == names(buttons)
    for index in (0, 3):
        buttons.nth(index).click()
        before = len(talk.of("wish"))
        page.locator("#use-these").click()
        number = talk.settled(after=before)["number"]
        page.keyboard.press("Control+S")
        page.locator("#save-file").fill(f"seen-{index}")
        page.keyboard.press("Enter")
        expect(page.locator("#save-result code")).to_contain_text("fakesss render")
        page.keyboard.press("Escape")
        render_file(Scene.load(folder / f"seen-{index}.toml"), folder / f"seen-{index}.png")
        stimulus = (folder / "as-seen" / "stimuli" / stimuli[index]["file"]).read_bytes()
        assert stimulus == stills.by_number[number] == (folder / f"seen-{index}.png").read_bytes()
        page.locator("#undo").click()
        talk.settled(after=before + 1)
    assert len({entry["sha256"] for entry in stimuli}) == 4


def test_the_preview_follows_what_does_not_vary_once_it_stands_still(page: Page, talk: Talk) -> None:
    asked: list[bool] = []
    vary(page, "across", "material.thickness_exponent")
    buttons = previewed(page, 3)
    shown = page.locator("#sweep-grid img").first.get_attribute("src")
    page.on("request", lambda request: asked.append(True) if request.url.endswith("/picture") else None)
    x, y = middle(page)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 20, y, steps=5)
    wait(page, lambda: page.locator("#place").get_attribute("data-moving") == "true")
    expect(page.locator("#sweep-grid .waits")).to_have_count(3)
    factor(page, "across").locator(".count").fill("5")
    expect(page.locator("#sweep-grid .waits")).to_have_count(5)
    assert asked == []
    page.mouse.up()
    talk.settled(after=1)
    previewed(page, 5)
    assert len(asked) == 5
    assert page.locator("#sweep-grid img").first.get_attribute("src") != shown
    page.locator("#tab-lights").click()
    drag(page, 5, 5)
    talk.settled(after=2)
    assert len(asked) == 5, "drawn although nobody sees it"
    page.locator("#tab-sweep").click()
    previewed(page, 5)
    assert len(asked) == 10
    expect(buttons.nth(2)).to_contain_text("25 now")


def test_pictures_that_are_not_wanted_any_more_are_not_waited_for(page: Page, talk: Talk) -> None:
    held: list[Route] = []
    failed: list[str] = []
    page.on("requestfailed", lambda request: failed.append(request.url))
    patient = [True]
    page.route("**/picture", lambda route: held.append(route) if patient else route.continue_())
    vary(page, "across", "material.backlight", "0, 1, 2")
    wait(page, lambda: held)
    vary(page, "across", "material.backlight", "0.5, 1")
    wait(page, lambda: held[-1].request.post_data_json["settings"]["changes"] == {"material.backlight": 0.5})
    wait(page, lambda: len(failed) == len(held) - 1)
    asked = held[-1].request.post_data_json
    assert asked["size"][0] <= SCENE.size[0] and asked["size"] != [0, 0]
    patient.clear()
    held[-1].continue_()
    previewed(page, 2)


def test_a_picture_goes_to_the_stage_and_back(page: Page, talk: Talk) -> None:
    vary(page, "across", "material.backlight", "0, 1.2, 3")
    vary(page, "down", "material.thickness_exponent", "5, 25")
    buttons = previewed(page, 6)
    assert page.locator("#sweep-count").text_content() == (
        "6 pictures, 3 ratings each: about 2 minutes a person at 5 s a rating."
    )
    buttons.first.focus()
    for key in ("ArrowDown", "ArrowRight", "ArrowRight", "ArrowLeft"):
        page.keyboard.press(key)
    expect(buttons.nth(4)).to_be_focused()
    assert [button.get_attribute("tabindex") for button in buttons.all()] == ["-1"] * 4 + ["0", "-1"]
    page.keyboard.press("End")
    page.keyboard.press("Enter")
    expect(page.locator("#caption")).to_have_text("thickness exponent 25, backlight 3")
    expect(buttons.last).to_have_attribute("aria-pressed", "true")
    page.locator("#back-to-live").click()
    expect(page.locator("#caption")).to_have_text("")
    expect(buttons.last).to_have_attribute("aria-pressed", "false")
    expect(page.locator("#sweep-cell")).to_be_hidden()
    assert talk.changes == {}
    late: list[Route] = []
    page.route("**/picture", lambda route: late.append(route))
    buttons.last.click()
    wait(page, lambda: late)
    drag(page, 5, 5)  # before its picture is there
    expect(page.locator("#sweep-cell")).to_be_hidden()
    expect(buttons.last).to_have_attribute("aria-pressed", "false")
    page.unroute_all()
    page.locator("#undo").click()
    talk.settled()
    previewed(page, 6)
    seen = len(talk.of("wish"))
    buttons.first.click()
    page.locator("#use-these").click()
    talk.settled(after=seen)
    assert talk.changes == {"material.backlight": 0, "material.thickness_exponent": 5}


def test_shaders_that_changed_draw_the_picture_on_the_stage_anew(page: Page, url: str) -> None:
    said = messages(page)
    opened(page, url)
    panel(page, "Sweep")
    vary(page, "across", "material.backlight", "0, 2")
    buttons = previewed(page, 2)
    buttons.last.click()
    expect(page.locator("#caption")).to_have_text("backlight 2")
    asked: list[Any] = []
    page.on("request", lambda request: asked.append(request.post_data_json))
    said[-1].send('{"type": "again"}')
    expect(page.locator("#caption")).to_have_text("backlight 2")
    expect(buttons.last).to_have_attribute("aria-pressed", "true")
    whole = {"settings": {"changes": {"material.backlight": 2}, "effects": {}}}
    wait(page, lambda: whole in asked)


def test_what_cannot_be_or_cannot_be_told_apart_is_said(page: Page, talk: Talk, folder: Path) -> None:
    vary(page, "down", "blur.kernel")
    vary(page, "across", "material.thickness_exponent", "10, -1")
    problem = factor(page, "across").locator(".problem")
    expect(problem).to_contain_text("at least 0")
    expect(page.locator("#sweep-preview")).to_be_hidden()
    expect(page.locator("#write-study")).to_be_disabled()
    vary(page, "across", "camera.near", "0.5, 60")
    vary(page, "down", "camera.far", "50")
    expect(page.locator("#sweep-grid .failed")).to_have_count(1)
    expect(page.locator("#sweep-warning")).to_contain_text("near 60.0 must be < far 50")
    page.locator("#write-study").click()
    expect(page.locator("#study-written .problem")).to_contain_text("near 60.0 must be < far 50")
    vary(page, "down", "")
    vary(page, "across", "shadow.samples", "1, 2")
    same = "The same picture twice: shadow samples 2 = shadow samples 1."
    expect(page.locator("#sweep-warning")).to_contain_text(same)
    page.locator("#study-folder").fill("../up")
    page.locator("#write-study").click()
    expect(page.locator("#study-written .problem")).to_contain_text('folder "../up": cannot be the name')
    assert not (folder.parent / "up").exists()


def test_the_value_now_is_marked_and_can_be_added(page: Page, talk: Talk) -> None:
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    vary(page, "across", "material.thickness_exponent", "10, 40")
    page.locator("#study-title").press("Enter")
    now = factor(page, "across").locator(".now")
    expect(now).to_contain_text("Now 25, which is none of them.")
    now.get_by_role("button").click()
    expect(factor(page, "across").locator(".levels")).to_have_value("10, 25, 40")
    expect(now).to_have_text("Now 25. Add it", use_inner_text=False)
    expect(now.get_by_role("button")).to_be_hidden()
    panel(page, "Shader")
    page.locator("#technique").uncheck()  # backlight off, by hand
    panel(page, "Sweep")
    vary(page, "across", "material.backlight", "0, 1.2, 1.2000001")
    expect(now).to_contain_text("Now 0.")
    expect(page.locator("#sweep-grid td")).to_have_text(["0 now", "1.2 now", "1.2000001 now"])
    expect(page.locator("#sweep-grid .is-now:visible")).to_have_count(1)
    vary(page, "across", "shadow.samples")
    for end, value in (("from", "1"), ("to", "5"), ("count", "9")):
        factor(page, "across").locator(f".{end}").fill(value)
        factor(page, "across").locator(f".{end}").press("Enter")
    expect(factor(page, "across").locator(".levels")).to_have_value("1, 2, 3, 4, 5")
    expect(factor(page, "across").locator(".count")).to_have_value("5")
    assert not [url for url in asked if url.endswith("/study")], "written by Enter in a field"


def test_the_preview_and_the_dialogs_are_for_everybody(browser: Browser, url: str) -> None:
    with with_axe(browser.new_context(viewport={"width": 1280, "height": 800})) as context:
        page = context.new_page()
        opened(page, url)
        page.locator("#tab-sweep").click()
        vary(page, "across", "blur.kernel")
        vary(page, "down", "material.backlight", "0, 1.2")
        buttons = previewed(page, 8)
        buttons.first.click()
        small = buttons.first.bounding_box()
        for opener in ("", "#sweep-larger", "#link", "#save"):
            if opener:
                page.locator(opener).click()
            assert violations(page) == [], opener
            for width in (1280, 640, 390):  # 640: 1280 at 200 %
                assert cut_off(page, width) == [], (opener, width)
            if opener == "#sweep-larger":
                large = previewed(page, 8).first.bounding_box()
                assert small and large and large["width"] > small["width"]
            page.keyboard.press("Escape")
        expect(page.locator("#sweep-preview #sweep-grid")).to_be_visible()
