"""The tuner from its address to a study, by keyboard alone; and every part of its page for everybody."""

import io
import urllib.parse
from collections.abc import Iterator
from pathlib import Path

import pytest
from accessible import cut_off, tab, violations, with_axe
from PIL import Image, ImageStat
from playwright.sync_api import Browser, Page, expect
from tuner_pages import opened
from tuner_server import tuned

from fakesss.scene import Scene
from fakesss.tuner.looks import DRAWINGS, LOOKS
from stimuli.study import Study
from stimuli.sweep import write_sweep

pytestmark = [pytest.mark.browser, pytest.mark.gl]

SCENE = Scene.from_dict(
    {"object": "torus:1000", "size": (96, 96), "supersampling": 1, "occlusion": {"rays": 4}}, "test"
)
TABS = ("Lights", "Material", "Camera", "Shader", "Sweep")
MOST_STOPS = 250  # of the focus, in all of the page


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the tuner writes."""
    return tmp_path_factory.mktemp("tuner")


@pytest.fixture(scope="module")
def url(folder: Path) -> Iterator[str]:
    """One tuner for all of these."""
    with tuned(SCENE, folder, write_study=write_sweep) as address:
        yield address


@pytest.fixture(scope="module")
def reader(browser: Browser, url: str) -> Iterator[Page]:
    """A tab with axe."""
    with with_axe(browser.new_context(viewport={"width": 1280, "height": 800})) as context:
        page = context.new_page()
        opened(page, url)
        yield page


def reach(page: Page, selector: str) -> None:
    """Press Tab until what `selector` names has the focus; all that is passed can be seen to have it."""
    for _ in range(MOST_STOPS):
        tab(page)
        if page.evaluate("selector => document.activeElement.matches(selector)", selector):
            return
    raise AssertionError(f"Tab does not lead to {selector}")


def test_from_the_address_to_a_study_by_keyboard_alone(page: Page, url: str, folder: Path) -> None:
    talk, keys = opened(page, url), page.keyboard
    reach(page, "#place")
    keys.press("ArrowRight")
    talk.settled(after=1)
    assert talk.changes == {"camera.azimuth": -5}
    reach(page, "#tab-lights")
    keys.press("ArrowRight")
    expect(page.get_by_role("tab", name="Material")).to_be_focused()
    reach(page, '[data-path="material.backlight"] input[type=range]')
    before = len(talk.of("wish"))
    keys.press("ArrowRight")
    talk.settled(after=before)
    assert talk.changes["material.backlight"] > SCENE.material.backlight
    reach(page, "#pin")
    keys.press("Enter")
    expect(page.locator("#pins img[src]")).to_have_count(1)
    reach(page, "#tab-material")
    keys.press("End")
    reach(page, '[data-place="across"] .path')
    keys.type("thickness exp")
    expect(page.locator("#sweep-grid img")).to_have_count(3)
    reach(page, "#study-folder")
    keys.press("Control+A")
    keys.type("by-keyboard")
    reach(page, "#write-study")
    keys.press("Enter")
    expect(page.locator("#study-written")).to_contain_text(f"fakesss run {folder / 'by-keyboard'}")
    study = Study.load(folder / "by-keyboard")
    assert [factor.path for factor in study.factor] == ["material.thickness_exponent"]
    assert study.scene.camera.azimuth == -5
    assert study.scene.material.backlight == talk.changes["material.backlight"]
    fragment = urllib.parse.unquote(urllib.parse.urlsplit(page.url).fragment)
    assert '"camera.azimuth":-5' in fragment


@pytest.mark.parametrize("name", TABS)
def test_a_tab_is_for_everybody(reader: Page, name: str) -> None:
    reader.get_by_role("tab", name=name).click()
    assert violations(reader) == []
    for width in (1920, 1280, 640, 390):  # 640: 1280 at 200 %
        assert cut_off(reader, width) == [], width


def test_pins_and_drawers_are_for_everybody(reader: Page) -> None:
    for _ in range(2):
        reader.locator("#pin").click()
    expect(reader.locator("#pins img[src]")).to_have_count(2)
    reader.locator("#show-difference").click()
    for drawer in ("#show-passes", "#show-messages"):
        reader.locator(drawer).click()
        assert violations(reader) == [], drawer
        for width in (1280, 390):
            assert cut_off(reader, width) == [], (drawer, width)
        reader.locator(drawer).click()


def test_what_is_chosen_is_seen_in_forced_colours(browser: Browser, url: str) -> None:
    with browser.new_context(forced_colors="active", viewport={"width": 1280, "height": 800}) as context:
        page = context.new_page()
        opened(page, url)
        surround = page.locator("#place").screenshot()
        assert Image.open(io.BytesIO(surround)).convert("RGB").getpixel((2, 2)) == (58, 58, 58)
        page.get_by_role("tab", name="Shader").click()
        chosen, other = (
            page.locator('[data-effect="blur"] .segments span').nth(place).screenshot() for place in (0, 1)
        )
        assert abs(grey(chosen) - grey(other)) > 64
        page.keyboard.press("Tab")
        tab(page)


def grey(shot: bytes) -> float:
    """Mean grey value, 0..255."""
    return float(ImageStat.Stat(Image.open(io.BytesIO(shot)).convert("L")).mean[0])


def test_every_intermediate_says_what_it_is(page: Page, url: str) -> None:
    talk = opened(page, url)
    assert page.locator("#view option").all_inner_texts() == list(LOOKS.values())
    page.get_by_role("tab", name="Shader").click()
    page.locator("#show-axes").check()
    for number, (name, title) in enumerate(LOOKS.items()):
        page.locator("#view").select_option(name)
        if number:
            header = talk.settled(after=number)
            assert header["view"] == name
            expect(page.locator("#caption")).to_contain_text(title)
            has_legend = bool(header["legend"]["scale"] or header["legend"]["marks"])
            expect(page.locator("#legend")).to_be_visible(visible=has_legend)
        drawn = page.locator("#overlay").evaluate(
            "canvas => canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.some(Boolean)"
        )
        assert drawn == (name not in DRAWINGS)
