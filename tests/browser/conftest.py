import json
import shutil
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, Playwright, sync_playwright

sys.path.insert(0, str(Path(__file__).parents[1]))

from accessible import with_axe
from study_fixture import write_study
from tuner_panel import BASE, Panel
from tuner_server import tuned

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
def chromium() -> str:
    """Where the browser is; without one the tests fail: they would show nothing."""
    path = next(filter(None, map(shutil.which, CHROMIUM)), None)
    assert path, f"no browser found: install one of {', '.join(CHROMIUM)}"
    return path


@pytest.fixture(scope="session")
def driver() -> Iterator[Playwright]:
    """What drives browsers."""
    with sync_playwright() as playwright:
        yield playwright


@pytest.fixture(scope="session")
def launch(driver: Playwright, chromium: str) -> Callable[..., Browser]:
    """Starts a real headless Chromium with further switches."""
    return lambda *switches: driver.chromium.launch(executable_path=chromium, args=[*QUIET, *switches])


@pytest.fixture
def launch_with(driver: Playwright, chromium: str, tmp_path: Path) -> Iterator[Callable[..., BrowserContext]]:
    """The same for somebody who has made settings (Chromium's Preferences, nested); in a window of its own size."""
    started: list[BrowserContext] = []

    def start(preferences: dict[str, Any], *switches: str) -> BrowserContext:
        folder = tmp_path / f"profile-{len(started)}"
        (folder / "Default").mkdir(parents=True)
        (folder / "Default" / "Preferences").write_text(json.dumps(preferences), encoding="utf-8")
        arguments = [*QUIET, *switches]
        started.append(
            driver.chromium.launch_persistent_context(
                folder, executable_path=chromium, args=arguments, no_viewport=True
            )
        )
        return started[-1]

    yield start
    for context in started:
        context.close()


@pytest.fixture(scope="session")
def browser(launch: Callable[..., Browser]) -> Iterator[Browser]:
    """One browser for all tests that need no switches of their own."""
    plain = launch()
    yield plain
    plain.close()


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


@pytest.fixture(scope="session")
def panel_opened(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Panel]:
    """A tuner's page for all tests of its panel."""
    with (
        tuned(BASE, tmp_path_factory.mktemp("tuned")) as address,
        with_axe(browser.new_context(viewport={"width": 1280, "height": 800})) as context,
    ):
        context.set_default_timeout(15_000)
        yield Panel(context.new_page(), address)


@pytest.fixture
def panel(panel_opened: Panel) -> Iterator[Panel]:
    """That page, with the settings that it started with; a script error in it fails the test."""
    yield panel_opened
    panel_opened.reset()
    errors, panel_opened.errors[:] = panel_opened.errors.copy(), ()
    assert errors == []
