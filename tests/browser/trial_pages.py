"""Straight to the pictures, past the pages that other tests are about."""

import base64
import io
import sqlite3
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image
from playwright.sync_api import Page, expect
from steps import answerable
from study_fixture import write_study
from survey_client import Participant

from study_server.manifest import load_study

Pixels = npt.NDArray[np.uint8]

SHORT = {"about": [], "screen_check": [], "practice": 0}


def short_study(folder: Path, pictures: int = 6, size: int = 96, **survey: Any) -> Path:
    """A study that begins with its instructions and has no practice."""
    return write_study(folder / "study", pictures=pictures, size=size, survey={**SHORT, **survey})


def begun(url: str, *, ready: bool = True) -> str:
    """The address of a new session at its first trial: practice if there is any and not `ready`."""
    person = Participant(url).consent()
    person.post("instructions")
    while ready and person.state["step"] == "practice":
        person.rate()
    if person.state["step"] == "ready":
        person.post("ready")
    return url + person.here


def open_trials(page: Page, url: str, count: str = "1 of 6") -> str:
    """A new session's first trial on this page; its address."""
    address = begun(url)
    page.goto(address)
    answerable(page, count)
    return address


def saved(page: Page) -> None:
    """Wait until the server has every answer that was given on this page."""
    expect(page.locator("#saved")).to_have_text("Saved", timeout=20_000)


def shown_and_rendered(page: Page, study: Path) -> tuple[Pixels, Pixels]:
    """The picture as it stands on the screen and as it is in its file, both (height, width, 3), uint8."""
    screenshot = page.context.new_cdp_session(page).send("Page.captureScreenshot", {"format": "png"})
    screen = np.asarray(Image.open(io.BytesIO(base64.b64decode(screenshot["data"]))).convert("RGB"))
    image = page.locator("#stage img")
    sha256 = image.get_attribute("data-sha256")
    path = next(each.path for each in load_study(study).stimuli if each.sha256 == sha256)
    rendered = np.asarray(Image.open(path).convert("RGB"))
    corner = image.evaluate("img => [img.getBoundingClientRect().left, img.getBoundingClientRect().top]")
    left, top = (side * page.evaluate("devicePixelRatio") for side in corner)
    assert (left, top) == pytest.approx((round(left), round(top)), abs=0.05)  # on whole pixels
    height, width = rendered.shape[:2]
    return screen[round(top) : round(top) + height, round(left) : round(left) + width], rendered


def displays(study: Path) -> list[dict[str, Any]]:
    """How each answered picture stood on the screen, as stored, in the order of the answers."""
    database = sqlite3.connect(study / "ratings.sqlite")
    database.row_factory = sqlite3.Row
    query = "select * from presentations where answered_at is not null order by answered_at"
    found = [dict(row) for row in database.execute(query)]
    database.close()
    return found
