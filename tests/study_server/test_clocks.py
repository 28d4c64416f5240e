"""Clocks that are wrong: a participant's, or the server's, set back in the middle of a session."""

import sqlite3
from collections.abc import Callable
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path

import httpx
from survey_client import JSON, Participant

from study_server.app import admin_secret


def test_no_answer_was_given_after_it_was_stored(url: str, exported: Callable[..., list[dict[str, str]]]) -> None:
    person = Participant(url).to_trials()
    body = person.answers(since_shown_ms=0.0)
    body["answers"][0]["rt_ms"] = 2.5e9  # four weeks
    assert person.send(body).status_code == 200
    answered = [datetime.fromisoformat(row["answered_at"]) for row in exported() if row["rating"]]
    assert len(answered) == 2 and max(answered) <= datetime.now(UTC)


def test_a_clock_that_was_set_back_makes_no_negative_minutes(study: Path, url: str) -> None:
    assert Participant(url).to_trials().to_end()
    with closing(sqlite3.connect(study / "ratings.sqlite")) as connection, connection:
        connection.execute("UPDATE sessions SET started_at = finished_at + 3600")
    headers = {**JSON, "Authorization": f"Bearer {admin_secret(study)}"}
    page = httpx.get(f"{url}/admin", headers=headers).json()
    assert (page["finished"], page["median_minutes"]) == (1, None)
