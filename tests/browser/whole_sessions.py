"""Sessions from the first trial to the code by somebody whose browser or network fails, and what was stored of them."""

import re
from pathlib import Path

from playwright.sync_api import Page, expect
from sqlalchemy import select
from steps import rate
from stored import Stored, sound

from study_server.storage import schema
from study_server.storage.database import default_url, open_database

PATIENCE_MS = 90_000
"""For what may take long on a busy machine; nothing takes so long when all is well."""


def keys_of(trial: int) -> str:
    """What is answered to both questions of a trial: never as to its neighbours."""
    return f"{trial % 7 + 1}{(3 * trial + 2) % 7 + 1}"


def due(page: Page, trial: int) -> None:
    """Wait until this trial can be answered."""
    expect(page.locator("#count")).to_have_text(re.compile(rf"^{trial} of "), timeout=PATIENCE_MS)
    expect(page.locator(".question input").first).to_be_enabled(timeout=PATIENCE_MS)


def answer(page: Page, trial: int) -> None:
    """This trial, as soon as it can be."""
    due(page, trial)
    rate(page, keys_of(trial))


def to_code(page: Page) -> str:
    """From the last answer over the comments to the completion code."""
    page.wait_for_selector("body.comments", timeout=PATIENCE_MS)
    page.locator("main button").first.press("Enter")
    return page.locator("#code").inner_text(timeout=PATIENCE_MS)


def all_is_stored(study: Path, code: str, trials: int = 6) -> None:
    """One finished session with this code; its answers once each, none changed, stored in their order."""
    found = sound(default_url(study))
    [session] = found.sessions.values()
    assert (session["completion_code"], session["step"]) == (code, "done")
    assert len(code) == 8
    [answers] = found.answers.values()
    practice = min(place for place, _, _ in answered(study, practice=False))
    assert {key: given for key, given in answers.items() if key[0] >= practice} == {
        (practice + trial - 1, name): [int(key)]
        for trial in range(1, trials + 1)
        for name, key in zip(("translucent", "realistic"), keys_of(trial), strict=True)
    }
    times = [row[1] for row in answered(study)]
    assert times == sorted(times)


def answered(study: Path, *, practice: bool = True) -> list[tuple[int, float, float]]:
    """(place, when it was stored, when it was shown), in seconds since 1970, of each answered trial, by place.

    Without those of practice unless `practice`.
    """
    rated = schema.presentations.c
    query = select(rated.place, rated.answered_at, rated.shown_at).where(rated.answered_at.is_not(None))
    query = query if practice else query.where(rated.practice.is_(False))
    database = open_database(default_url(study))
    try:
        with database.reading() as connection:
            return [(row[0], row[1], row[2]) for row in connection.execute(query.order_by(rated.place))]
    finally:
        database.close()


def session_now(study: Path) -> tuple[Stored, str]:
    """What is stored, judged, and the step of the one session."""
    found = sound(default_url(study))
    [session] = found.sessions.values()
    return found, str(session["step"])
