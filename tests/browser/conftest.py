import shutil
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, sync_playwright

sys.path.insert(0, str(Path(__file__).parents[1]))

from study_fixture import write_study

from study_server.serve import served

CHROMIUM = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
QUIET = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]


@pytest.fixture(scope="session")
def launch() -> Iterator[Callable[..., Browser]]:
    """Starts a real headless Chromium with further switches; without one the tests fail: they would show nothing."""
    path = next(filter(None, map(shutil.which, CHROMIUM)), None)
    assert path, f"no browser found: install one of {', '.join(CHROMIUM)}"
    with sync_playwright() as playwright:
        yield lambda *switches: playwright.chromium.launch(executable_path=path, args=[*QUIET, *switches])


@pytest.fixture(scope="session")
def browser(launch: Callable[..., Browser]) -> Iterator[Browser]:
    """One browser for all tests that need no switches of their own."""
    chromium = launch()
    yield chromium
    chromium.close()


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Three pictures, two questions."""
    return write_study(tmp_path / "study", size=200)


@pytest.fixture
def url(study: Path) -> Iterator[str]:
    """The study, served."""
    with served(study) as address:
        yield address


@pytest.fixture
def context(browser: Browser) -> Iterator[BrowserContext]:
    """A fresh profile with a 1280 x 800 window at one device pixel per CSS pixel."""
    fresh = browser.new_context(viewport={"width": 1280, "height": 800})
    fresh.set_default_timeout(15_000)
    yield fresh
    fresh.close()


@pytest.fixture
def page(context: BrowserContext) -> Iterator[Page]:
    """A tab; a script error in it fails the test."""
    tab = context.new_page()
    errors: list[str] = []
    tab.on("pageerror", lambda error: errors.append(str(error)))
    yield tab
    assert errors == []
