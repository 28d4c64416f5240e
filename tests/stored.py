"""What a study's database holds, judged: every answer once, nothing half, a completion code exactly with every row."""

import shutil
import tempfile
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, func, select

from study_server.storage import schema
from study_server.storage.database import open_database
from study_server.storage.engines import sqlite_url

Answers = Mapping[tuple[int, str], list[int]]
"""One session's: (place, question) -> the first answer and its revisions, oldest first; practice included."""


@dataclass(frozen=True)
class Stored:
    """Sound contents of a database. Sessions by their public id."""

    sessions: Mapping[str, Mapping[str, Any]]
    answers: Mapping[str, Answers]
    events: Mapping[str, Counter[str]]
    """Session -> how many events of each kind."""
    places_taken: list[int]
    """Sessions of each order row, withdrawn ones too."""


def sound(url: str) -> Stored:
    """What the database at `url` holds, after it was judged in one snapshot. Fails with what is wrong in it."""
    database = open_database(url)
    try:
        with database.reading() as connection:
            if database.is_sqlite:
                assert connection.exec_driver_sql("PRAGMA integrity_check").scalars().all() == ["ok"]
                assert connection.exec_driver_sql("PRAGMA foreign_key_check").all() == []
            return judged(connection)
    finally:
        database.close()


def sound_copy(folder: Path) -> Stored:
    """The same for ratings.sqlite in `folder`, from a copy: on another's disk SQLite cannot open it in place."""
    with tempfile.TemporaryDirectory() as copy:
        for path in folder.glob("ratings.sqlite*"):
            if not path.name.endswith("-shm"):  # is made anew from the log
                shutil.copy(path, copy)
        return sound(sqlite_url(Path(copy) / "ratings.sqlite"))


def judged(connection: Connection) -> Stored:
    """Everything, with each session judged."""
    sessions = {row["id"]: row for row in rows(connection, schema.sessions)}
    plans: dict[str, list[dict[str, Any]]] = {name: [] for name in sessions}
    for row in rows(connection, schema.presentations):
        plans[row["session"]].append(row)
    answers: dict[str, dict[tuple[int, str], list[int]]] = {name: {} for name in sessions}
    for row in rows(connection, schema.ratings):
        key = (row["place"], row["question"])
        assert key not in answers[row["session"]], f"twice: {key}"
        answers[row["session"]][key] = [row["rating"]]
    for row in sorted(rows(connection, schema.revisions), key=lambda row: row["revision"]):
        given = answers[row["session"]][row["place"], row["question"]]
        assert row["revision"] == len(given), f"revisions are not numbered 1, 2, ...: {row}"
        given.append(row["rating"])
    events: dict[str, Counter[str]] = {name: Counter() for name in sessions}
    for row in rows(connection, schema.events):
        events[row["session"]][row["kind"]] += 1
    withdrawals = Counter(row["session"] for row in rows(connection, schema.withdrawals))
    for name, session in sessions.items():
        judge(session, plans[name], answers[name], events[name], withdrawals[name])
    held = Counter(session["row"] for session in sessions.values())
    order_rows = connection.scalar(select(func.count()).select_from(schema.order_rows)) or 0
    return Stored(
        sessions=sessions,
        answers=answers,
        events=events,
        places_taken=[held[row] for row in range(order_rows)],
    )


def rows(connection: Connection, table: schema.Table) -> list[dict[str, Any]]:
    """All rows of a table."""
    return [dict(row) for row in connection.execute(select(table)).mappings()]


def judge(
    session: Mapping[str, Any],
    presentations: list[dict[str, Any]],
    answers: Answers,
    events: Counter[str],
    withdrawals: int,
) -> None:
    """One session: each picture's answers are there all or not at all, and a code stands for all of them."""
    who = f"session {session['id']} at {session['step']}"
    expected = stored = surplus = 0
    for planned in presentations:
        names = list(planned["questions"]) + ["check"] * (planned["check_expected"] is not None)
        given = sum((planned["place"], name) in answers for name in names)
        assert given in (0, len(names)), f"{who}: half of the answers to picture {planned['place']}"
        assert (planned["answered_at"] is not None) == bool(given), f"{who}: picture {planned['place']}"
        surplus -= given
        expected += len(names) * (not planned["practice"])
        stored += given * (not planned["practice"])
    assert len(answers) + surplus == 0, f"{who}: an answer to what was not asked"
    finished = session["finished_at"] is not None
    if session["step"] == "withdrawn":
        assert (withdrawals, stored, finished, session["completion_code"]) == (1, 0, False, None), who
        return
    assert withdrawals == 0, who
    assert finished == bool(session["completion_code"]) == (stored == expected), f"{who}: {stored} of {expected}"
    assert finished == (session["step"] in ("comments", "done")), who
    assert (events["started"], events["finished"]) == (1, int(finished)), f"{who}: {events}"
