"""What outlives the tuner's page: links that restore, and the scene's file."""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pytest
from playwright.sync_api import Browser, Page, expect
from tuner_pages import Talk, drag, link, one_page, opened, panel, wait
from tuner_server import tuned

from fakesss.scene import Scene

pytestmark = [pytest.mark.browser, pytest.mark.gl]

SCENE = Scene.from_dict(
    {"object": "torus:1000", "size": (64, 64), "supersampling": 1, "occlusion": {"rays": 4}}, "test"
)
SETTINGS: dict[str, Any] = {
    "changes": {"material.backlight": 0.75, "lights": [{"kind": "directional", "azimuth": 100.0}]},
    "effects": {"shadows": "on", "backlight": "off"},
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the tuner writes."""
    return tmp_path_factory.mktemp("tuner")


@pytest.fixture(scope="module")
def url(folder: Path) -> Iterator[str]:
    """One tuner for all of these."""
    with tuned(SCENE, folder) as address:
        yield address


@pytest.fixture(scope="module")
def opened_once(browser: Browser, url: str) -> Iterator[Talk]:
    """A page for all of these; a script error in it fails the last one."""
    with one_page(browser, url, permissions=["clipboard-read", "clipboard-write"]) as talk:
        yield talk


@pytest.fixture
def talk(opened_once: Talk) -> Talk:
    """That page with everything as at the start but what undo remembers."""
    page = opened_once.page
    page.unroute_all()
    page.keyboard.press("Escape")  # a dialog
    page.locator("#view").select_option("picture")
    if page.locator("#reset-all").is_enabled():
        page.locator("#reset-all").click()
        wait(page, lambda: opened_once.changes == {})
    opened_once.settled()
    return opened_once


@pytest.fixture
def page(talk: Talk) -> Page:
    """Its page."""
    return talk.page


def test_a_link_restores_everything(page: Page, talk: Talk, url: str) -> None:
    drag(page, 20, 0)
    talk.settled()
    page.locator("#view").select_option("second")
    page.locator("#link").click()
    expect(page.locator("#link-result")).to_have_text("Copied.")
    copied = page.evaluate("() => navigator.clipboard.readText()")
    assert copied == page.url == page.locator("#link-text").input_value()
    other = page.context.new_page()
    restored = opened(other, copied)
    wait(other, lambda: restored.changes == talk.changes != {})
    expect(other.locator("#view")).to_have_value("second")
    other.close()

    page.locator("#link-paste").fill(link("http://127.0.0.1:1/of-yesterday/", SETTINGS))
    page.keyboard.press("Enter")
    wait(page, lambda: talk.of("wish")[-1]["settings"] == SETTINGS)
    expect(page.locator("#link-dialog")).to_be_hidden()
    expect(page.locator("#view")).to_have_value("picture")  # of a link that names none
    page.locator("#undo").click()
    page.locator("#view").select_option("second")
    assert page.url == copied
    page.evaluate("address => { location.hash = new URL(address).hash }", link(url, SETTINGS))
    wait(page, lambda: talk.of("wish")[-1]["settings"] == SETTINGS)


def type_in(page: Page, path: str, value: str) -> None:
    """A number of the panel's tab that is open."""
    field = page.locator(f'.control[data-path="{path}"] input.typed')
    field.fill(value)
    field.press("Enter")


def test_a_reload_loses_no_more_than_what_was_refused(page: Page, talk: Talk) -> None:
    panel(page, "Camera")
    type_in(page, "camera.far", "3")
    talk.settled()
    drawn = talk.changes
    type_in(page, "camera.near", "5")
    expect(page.locator("#notice")).to_contain_text("near 5.0 must be < far 3")
    wait(page, lambda: "near" not in page.url)
    page.route("**/scene.toml", lambda route: route.abort())  # nobody answers for once
    page.reload()
    expect(page.locator("#log")).to_contain_text("Reload the page to try again.")
    page.unroute_all()
    page.reload()
    wait(page, lambda: talk.changes == drawn == {"camera.far": 3})
    talk.settled()


def test_only_a_link_that_was_pasted_is_used(page: Page, talk: Talk) -> None:
    start = page.url
    page.locator("#view").select_option("second")
    page.locator("#link").click()
    page.locator("#link-use").click()
    expect(page.locator("#link-result")).to_have_text("Paste a link first.")
    expect(page.locator("#view")).to_have_value("second")
    page.locator("#link-paste").fill(start)
    page.keyboard.press("Enter")
    expect(page.locator("#link-dialog")).to_be_hidden()
    expect(page.locator("#view")).to_have_value("picture")


BROKEN = {
    "#s=%7B%22changes": "it is cut off or mistyped",
    "#s=null": "it is cut off or mistyped",
    "#t=1": "it is cut off or mistyped",
    f"#s={quote(json.dumps({'changes': {'material.backlihgt': 1}}))}": 'did you mean "material.backlight"?',
    f"#s={quote(json.dumps({'changes': {'object': '/etc/passwd.obj'}}))}": "is no file of this tuner",
}


def test_a_broken_link_says_so_and_changes_nothing(page: Page, talk: Talk) -> None:
    before, result = page.url, page.locator("#link-result")
    first = len(talk.of("wish"))
    page.locator("#link").click()
    for fragment, sentence in BROKEN.items():
        page.locator("#link-paste").fill(before + fragment)
        page.locator("#link-use").click()
        expect(result).to_contain_text("This link restores nothing: ")
        expect(result).to_contain_text(sentence)
        page.evaluate("fragment => { location.hash = fragment }", fragment)
        wait(page, lambda: page.url == before)
    assert len(talk.of("wish")) == first


def test_a_scene_is_downloaded_or_written_once(page: Page, talk: Talk, folder: Path) -> None:
    drag(page, 20, 0)
    talk.settled()
    page.locator("#save").click()
    page.locator("#save-file").fill("mine.toml")
    with page.expect_download() as download:
        page.locator("#download").click()
    assert download.value.suggested_filename == "mine.toml"
    scene = Scene.from_dict(tomllib.loads(Path(download.value.path()).read_text(encoding="utf-8")), "mine.toml")
    assert scene == SCENE.replace(talk.changes)
    page.locator("#save-here").click()
    expect(page.locator("#save-result")).to_contain_text("Written: ")
    assert Scene.load(folder / "mine.toml") == scene
    page.locator("#save-here").click()
    expect(page.locator("#save-result .problem")).to_contain_text("exists already; choose another name")
