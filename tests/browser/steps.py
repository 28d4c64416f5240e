"""A participant at the keyboard."""

import csv
from collections import Counter
from pathlib import Path

from playwright.sync_api import Page, expect

from study_server.exports.export import export_ratings


def answerable(page: Page, count: str) -> None:
    """Wait until the trial called `count` can be answered."""
    expect(page.locator("#count")).to_have_text(count)
    expect(page.locator(".question input").first).to_be_enabled()


def to_practice(page: Page, url: str) -> None:
    """From the link to the practice picture, by keyboard."""
    page.goto(url)
    press_the_button(page, "consent")
    page.wait_for_selector("body.about")
    for group in ("age", "background", "vision"):
        page.locator(f"input[name={group}]").first.focus()
        page.keyboard.press("Space")
    page.keyboard.press("Enter")
    press_the_button(page, "screen")
    press_the_button(page, "instructions")
    answerable(page, "Practice 1 of 1")


def to_trials(page: Page, url: str) -> None:
    """From the link to the first picture that counts, by keyboard."""
    to_practice(page, url)
    rate(page, "44")
    press_the_button(page, "ready")
    answerable(page, "1 of 3")


def press_the_button(page: Page, step: str) -> None:
    """Enter on a page's button. None has the focus from the start: a second Enter would skip the page."""
    page.wait_for_selector(f"body.{step}")
    page.locator("main button:visible").first.press("Enter")


def rate(page: Page, keys: str) -> None:
    """One key a question, then Enter."""
    for key in keys:
        page.keyboard.press(key)
    page.keyboard.press("Enter")


def rows(study: Path) -> list[dict[str, str]]:
    """The exported ratings."""
    export_ratings(study, study / "out")
    with (study / "out" / "ratings.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def ratings_by_trial(study: Path) -> dict[int, tuple[str, ...]]:
    """Answers by trial in order of the questions, after checking that each stands there exactly once."""
    exported = rows(study)
    assert set(Counter((row["session"], row["trial"], row["question"]) for row in exported).values()) <= {1}
    found: dict[int, tuple[str, ...]] = {}
    for row in exported:
        found[int(row["trial"])] = (*found.get(int(row["trial"]), ()), row["rating"])
    return found
