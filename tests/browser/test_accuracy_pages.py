"""The pages of `fakesss tradeoff` and `fakesss fit` in a real browser: for everyone, at every width, on paper."""

from itertools import pairwise
from pathlib import Path

import pytest
from accessible import cut_off, tab, violations, with_axe
from fit_document import small_fit
from playwright.sync_api import BrowserContext, Page
from tradeoff_document import small

from fakesss.accuracy.page import write_page
from fakesss.accuracy.page_fit import write_fit_page

pytestmark = [pytest.mark.browser, pytest.mark.gl]

LEVELS = "[...document.querySelectorAll('h1,h2,h3,h4,h5,h6')].map(each => Number(each.tagName[1]))"
EMPTY = """() => [...document.querySelectorAll("img")].filter(each => !each.complete || each.naturalWidth === 0)
  .map(each => each.alt)"""
DRAWN = """() => [...document.querySelectorAll("figure.plot svg")].map(each => each.getBoundingClientRect())
  .map(({ width, height }) => Math.min(width, height))"""
PAPER = {"width": 672, "height": 1000}  # what A4 leaves between the margins, in CSS pixels


@pytest.fixture(scope="module")
def addresses(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Both pages, as files."""
    folder: Path = tmp_path_factory.mktemp("accuracy")
    (document, pictures), (fit, fitted) = small(), small_fit()
    made = {
        "tradeoff": write_page(document, folder / "tradeoff", pictures),
        "fit": write_fit_page(fit, folder / "fit", fitted),
    }
    return {name: path.as_uri() for name, path in made.items()}


@pytest.fixture(params=["tradeoff", "fit"])
def accuracy(request: pytest.FixtureRequest, context: BrowserContext, addresses: dict[str, str]) -> Page:
    """One of the pages, opened from its file; what it asks for elsewhere fails the test."""
    page = with_axe(context).new_page()
    page.on("request", lambda asked: pytest.fail(asked.url) if asked.url.startswith("http") else None)
    page.goto(addresses[request.param])
    return page


def test_axe_finds_nothing_and_headings_have_no_gaps(accuracy: Page) -> None:
    assert violations(accuracy) == []
    levels = accuracy.evaluate(LEVELS)
    assert levels.count(1) == 1 and all(after - before <= 1 for before, after in pairwise(levels))


@pytest.mark.parametrize("width", [1280, 640, 390])
def test_nothing_is_cut_off(accuracy: Page, width: int) -> None:
    """On a screen, on the same at 200 %, on a phone; what is wider scrolls in a box that the keyboard reaches."""
    assert cut_off(accuracy, width) == []
    assert accuracy.locator(".scroll:not([tabindex='0'])").count() == 0


def test_every_picture_and_figure_is_drawn(accuracy: Page) -> None:
    assert accuracy.evaluate(EMPTY) == []
    sizes = accuracy.evaluate(DRAWN)
    assert len(sizes) >= 3 and min(sizes) > 100


def test_the_keyboard_skips_to_the_results(accuracy: Page) -> None:
    assert tab(accuracy) == "Skip to the results"
    accuracy.keyboard.press("Enter")
    assert accuracy.evaluate("location.hash") == "#results"


def test_on_paper_nothing_is_wider_than_the_page(accuracy: Page) -> None:
    accuracy.emulate_media(media="print")
    accuracy.set_viewport_size(PAPER)
    assert accuracy.evaluate("document.documentElement.scrollWidth") <= PAPER["width"]
