"""The outbox as a test sees it: in the browser's storage, and as rows of the database."""

import json
import sqlite3
import time
from pathlib import Path
from typing import Any

from playwright.sync_api import Page

UNSAVED = "Not saved yet – trying again. Please keep this page open. Answers not saved: {}"
STOPPED = "it goes on as soon as your answers are saved. Answers not saved: {}"


def unreachable(page: Page) -> None:
    """Pages and pictures come, answers do not go."""
    page.route("**/ratings", lambda route: route.abort())


def reachable(page: Page) -> None:
    """The same network, mended; the browser tells the page."""
    page.unroute("**/ratings")
    page.evaluate("dispatchEvent(new Event('online'))")


def kept(page: Page) -> list[dict[str, Any]]:
    """What stands in the browser's storage, by trial."""
    values = page.evaluate(
        "Object.keys(localStorage).filter(k => k.startsWith('fakesss-outbox')).map(k => localStorage[k])"
    )
    return sorted(map(json.loads, values), key=lambda entry: int(entry["answer"]["place"]))


def until_none_is_kept(page: Page) -> None:
    """Wait for an empty outbox. (`wait_for_function` would be stopped by our Content-Security-Policy.)"""
    deadline = time.monotonic() + 10
    while kept(page):
        assert time.monotonic() < deadline
        page.wait_for_timeout(20)


def stored(study: Path) -> list[dict[str, Any]]:
    """The rows of `ratings` and of their revisions, in the order of storing."""
    database = sqlite3.connect(study / "ratings.sqlite")
    database.row_factory = sqlite3.Row
    columns = "place, question, rating, rt_ms, shown_at, stored_at, submission"
    both = f"select {columns} from ratings union all select {columns} from revisions order by stored_at, place"
    found = [dict(row) for row in database.execute(both)]
    database.close()
    return found
