"""Straight to the pictures, past the pages that other tests are about."""

from pathlib import Path
from typing import Any

from playwright.sync_api import Page, expect
from steps import answerable
from study_fixture import write_study
from survey_client import Participant

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
