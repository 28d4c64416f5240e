"""When the time is past for which people were told that their answers are kept: what could name them is deleted.

What stays is what they saw and rated, when, on what display, and which of the offered choices they took about
themselves. The report is deleted too, for the tables that it was made of lie in its folder; `fakesss report` writes it
anew. Earlier exports and backups stay as they are: exports in the study's folder are named.
"""

import contextlib
import secrets
import sqlite3
import time
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, delete, func, insert, select, text, update

from fakesss.problem import BadInput
from study_server import gates
from study_server.happenings import FORGOTTEN
from study_server.storage import schema
from study_server.storage.copies import delete_report, exports_in
from study_server.storage.database import Database, open_existing
from study_server.storage.engines import BUSY_TIMEOUT_S

KEYS = ("salt", "signing_key")
"""Made anew at the next start: with the old ones a name could be turned into its pseudonym, or into its address."""

NAMING = ("comments", "completion_code", "external_study", "external_participant", "external_session")
"""Columns of `sessions` that are emptied. The completion code says at the recruiting service who somebody is."""

MODES = ("live", "pilot", "simulated")


def sessions_held(study_folder: Path, database_url: str | None = None) -> int:
    """How many sessions of every mode and version the study's database holds; `BadInput` if there is none."""
    with open_existing(study_folder, database_url).reading() as connection:
        return connection.scalar(select(func.count()).select_from(schema.sessions)) or 0


def forget(study_folder: Path, database_url: str | None = None) -> dict[str, Any]:
    """Delete what could name people, close the study, and see to it that the bytes are gone from the files too.

    Of every mode and version of the study in the database. Returns `sessions`, `ratings_kept`, `forgotten_at`, and the
    folders `report_deleted` (None: there was none) and `exports_left`. Raises `BadInput` if there is no database,
    another program holds it so that old bytes cannot go, or the report cannot be deleted.
    """
    database = open_existing(study_folder, database_url)
    now = time.time()
    with database.writing() as connection:
        sessions = forget_sessions(connection)
        for study in connection.scalars(select(schema.studies.c.identity)).all():
            for mode in MODES:
                gates.set_gate(connection, study, mode, "closed", now)
        connection.execute(delete(schema.meta).where(schema.meta.c.key.in_((*KEYS, FORGOTTEN))))
        connection.execute(insert(schema.meta).values(key=FORGOTTEN, value=str(now)))
        ratings = connection.scalar(select(func.count()).select_from(schema.ratings)) or 0
    scrub(database)
    report = delete_report(study_folder)
    return {
        "sessions": sessions,
        "ratings_kept": ratings,
        "forgotten_at": now,
        "report_deleted": str(report) if report else None,
        "exports_left": [str(folder) for folder in exports_in(study_folder)],
    }


def forget_sessions(connection: Connection) -> int:
    """Every session becomes nobody's; how many there are."""
    kept = {
        study.identity: {field["name"] for field in study.settings["survey"]["about"] if field["choices"]}
        for study in connection.execute(select(schema.studies.c.identity, schema.studies.c.settings))
    }
    sessions = schema.sessions.c
    people = connection.execute(select(sessions.id, sessions.study, sessions.about)).all()
    for person in people:
        values: dict[str, Any] = dict.fromkeys(NAMING)
        values["about"] = {name: told for name, told in person.about.items() if name in kept[person.study]}
        values |= {"client": {}, "token": f"forgotten-{secrets.token_urlsafe(24)}"}
        connection.execute(update(schema.sessions).where(sessions.id == person.id).values(values))
    return len(people)


def scrub(database: Database) -> None:
    """Write the tables anew, so that neither free pages nor the log keep what was deleted.

    PostgreSQL: gone from the tables; its write-ahead log is overwritten in time, archives of that are not.
    """
    if database.is_sqlite:
        database.close()
        scrub_file(str(database.engine.url.database))
        return
    with database.engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
        for table in (schema.sessions, schema.meta):
            connection.execute(text(f"VACUUM FULL {table.name}"))


def scrub_file(path: str) -> None:
    """The same for SQLite's file and the -wal beside it; `BadInput` if a reader holds on to them."""
    said = "another program is reading them"
    try:
        with contextlib.closing(sqlite3.connect(path, BUSY_TIMEOUT_S, isolation_level=None)) as connection:
            connection.execute("VACUUM")
            is_busy = connection.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()[0]
    except sqlite3.OperationalError as error:
        is_busy, said = True, str(error)
    if is_busy:
        raise BadInput(f"{path}: forgotten, but old bytes are still in the files ({said}); stop it and run this again")
