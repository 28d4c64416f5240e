"""The export: six CSV files that the analysis, and any other program, starts from."""

import json
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, RowMapping, and_, select

from fakesss.problem import BadInput
from study_server import schema
from study_server.cells import csv_text, iso
from study_server.columns import CLIENT, CODEBOOK, DISPLAYS, EVENTS, PARTICIPANTS, RATINGS, STIMULI
from study_server.counts import current_study, summaries
from study_server.database import default_url, open_database, secret, shown_url
from study_server.manifest import BuiltStudy, load_study
from study_server.sessions import presentations, release_s, sessions
from study_server.settings import CHECK_NAME
from study_server.site import Mode
from study_server.tokens import pseudonym


@dataclass(frozen=True)
class Source:
    """One snapshot of the database, and what turns it into tables."""

    connection: Connection
    study: BuiltStudy
    mode: Mode
    salt: str

    def people(self) -> Iterator[RowMapping]:
        """The sessions with their status: the query of the admin page."""
        query = summaries(self.study.identity, self.mode, time.time(), release_s(self.study))
        yield from self.connection.execute(query.execution_options(yield_per=500)).mappings()

    def participant(self, session: RowMapping) -> str:
        """The pseudonym of the person behind a session."""
        return pseudonym(self.salt, session["external_participant"] or session["id"])


def rating_rows(source: Source) -> Iterator[dict[str, Any]]:
    """One row for each expected rating of every session not withdrawn, answered or not; latest revision."""
    for person in source.people():
        if person["status"] in ("withdrawn", "screened-out"):
            continue
        given = answers_of(source.connection, person["id"])
        shared = {
            "session": person["id"],
            "participant": source.participant(person),
            "mode": source.mode,
            "started_at": iso(person["started_at"]),
            "study_sha256": source.study.sha256,
        }
        for trial in trials_of(source.connection, person["id"]):
            facts = {name: trial[name] for name in RATINGS if name in trial and name != "check_expected"}
            facts["shown_at"] = iso(trial["shown_at"])
            for question in trial["questions"]:
                yield facts | shared | {"question": question} | given.get((trial["place"], question), {})
            if trial["check_expected"] is not None:
                yield facts | shared | check_row(trial, given.get((trial["place"], CHECK_NAME), {}))


def check_row(trial: RowMapping, given: dict[str, Any]) -> dict[str, Any]:
    """What the row of an instructed item has besides: what was asked for, and whether it was done."""
    expected = trial["check_expected"]
    passed = {"check_passed": int(given["rating"] == expected)} if given else {}
    return {"question": CHECK_NAME, "check_expected": expected} | given | passed


def trials_of(connection: Connection, session: str) -> list[RowMapping]:
    """The session's real trials in order."""
    mine = and_(presentations.session == session, presentations.practice.is_(False))
    return list(connection.execute(select(schema.presentations).where(mine).order_by(presentations.place)).mappings())


def answers_of(connection: Connection, session: str) -> dict[tuple[int, str], dict[str, Any]]:
    """The answers that count, by place and question: the last revision, or else the first answer."""
    first = select(schema.ratings).where(schema.ratings.c.session == session)
    later = select(schema.revisions).where(schema.revisions.c.session == session).order_by(schema.revisions.c.revision)
    return {
        (row["place"], row["question"]): {
            "rating": row["rating"],
            "rt_ms": round(row["rt_ms"], 1),
            "shown_at": iso(row["shown_at"]),
            "answered_at": iso(row["answered_at"]),
            "revision": row.get("revision", 0),
        }
        for query in (first, later)
        for row in connection.execute(query).mappings()
    }


def participant_rows(source: Source) -> Iterator[dict[str, Any]]:
    """One row a session, whatever became of it."""
    for person in source.people():
        about = {f"about_{name}": value for name, value in person["about"].items()}
        screen = {f"screen_{name}": value for name, value in person["screen"].items()}
        yield (
            about
            | person["client"]
            | screen
            | {
                "session": person["id"],
                "participant": source.participant(person),
                "mode": source.mode,
                "status": person["status"],
                "started_at": iso(person["started_at"]),
                "finished_at": iso(person["finished_at"]),
                "last_seen_at": iso(person["seen_at"]),
                "order_row": person["row"] + 1,
                "trials": person["trials"],
                "trials_answered": person["trials_answered"],
                "ratings": person["ratings"],
                "checks_failed": person["checks_failed"],
                "language": person["language"],
                "comments": person["comments"],
                "study_sha256": source.study.sha256,
            }
        )


def display_rows(source: Source) -> Iterator[dict[str, Any]]:
    """One row for each picture of a real trial that was shown and rated: how it stood on the screen."""
    for person in source.people():
        for trial in trials_of(source.connection, person["id"]):
            if trial["answered_at"] is not None:
                facts = {name: trial[name] for name in DISPLAYS if name in trial}
                yield facts | {
                    "mode": source.mode,
                    "shown_at": iso(trial["shown_at"]),
                    "scaled": None if trial["scaled"] is None else int(trial["scaled"]),
                }


def event_rows(source: Source) -> Iterator[dict[str, Any]]:
    """What happened besides ratings, in order."""
    query = (
        select(schema.events)
        .join(schema.sessions)
        .where(sessions.study == source.study.identity, sessions.mode == source.mode)
        .order_by(schema.events.c.id)
    )
    for event in source.connection.execute(query).mappings():
        detail = json.dumps(event["detail"], ensure_ascii=False, sort_keys=True)
        yield {**event, "mode": source.mode, "at": iso(event["at"]), "detail": detail}


def stimulus_rows(source: Source) -> Iterator[dict[str, Any]]:
    """The manifest's facts about every picture, one column a factor."""
    for stimulus in source.study.stimuli:
        facts = stimulus.facts
        levels = {f"factor_{name}": level for name, level in (facts.get("factors") or {}).items()}
        kept = {name: facts.get(name) for name in STIMULI}
        yield kept | levels | {"stimulus": stimulus.id, "rows": "|".join(facts.get("rows") or ())}


def codebook_rows(source: Source) -> Iterator[dict[str, Any]]:
    """One row for every column of the other tables."""
    for name in ("ratings", "participants", "displays", "events", "stimuli"):
        for column, description in columns_of(name, source.study).items():
            yield {"table": f"{name}.csv", "column": column, "description": description}


def columns_of(table: str, study: BuiltStudy) -> dict[str, str]:
    """The columns of an exported table in their order, each described; some come from the study."""
    about = {f"about_{field.name}": field.text for field in study.settings.survey.about}
    client = {name: CLIENT[name] for name in study.settings.survey.record}
    factors = {f"factor_{factor['name']}": f"level of {factor.get('path', factor['name'])}" for factor in study.factors}
    return {
        "ratings": RATINGS,
        "participants": PARTICIPANTS | about | client,
        "displays": DISPLAYS,
        "events": EVENTS,
        "stimuli": STIMULI | factors,
        "codebook": CODEBOOK,
    }[table]


ROWS: dict[str, Callable[[Source], Iterator[dict[str, Any]]]] = {
    "ratings": rating_rows,
    "participants": participant_rows,
    "displays": display_rows,
    "events": event_rows,
    "stimuli": stimulus_rows,
    "codebook": codebook_rows,
}


def table_text(table: str, source: Source) -> Iterator[str]:
    """One exported table as pieces of CSV text."""
    return csv_text(list(columns_of(table, source.study)), ROWS[table](source))


def export_ratings(
    study_folder: Path, out: Path, *, mode: Mode = "live", database_url: str | None = None
) -> list[Path]:
    """Write every table as CSV into the folder `out`, made if it is not there; gives their paths.

    Raises `BadInput` if the study is not built, the database cannot be opened, or `out` cannot be written.
    """
    study = load_study(Path(study_folder))
    url = database_url or default_url(Path(study_folder))
    database = open_database(url)
    salt = secret(database, "salt")
    with database.reading() as connection:
        current = current_study(connection)
        if current is not None and current["identity"] != study.identity:
            raise BadInput(f"{shown_url(url)}: is of another version of this study; export it with the study as it was")
        source = Source(connection, study, mode, salt)
        return [write_table(Path(out), table, source) for table in ROWS]


def mode_to_analyse(study_folder: Path, database_url: str | None = None) -> Mode:
    """What a report is about: the first of live, simulated and pilot with a rating of a real trial; live without any.

    Agreeing to take part and practising are no ratings: one visitor of the live study hides nobody's answers.
    """
    rated = schema.ratings.join(schema.presentations).join(schema.sessions)
    mine = and_(sessions.study == load_study(study_folder).identity, presentations.practice.is_(False))
    with open_database(database_url or default_url(study_folder)).reading() as connection:
        found = connection.scalars(select(sessions.mode).select_from(rated).where(mine).distinct()).all()
    order: tuple[Mode, ...] = ("live", "simulated", "pilot")
    return next((mode for mode in order if mode in found), "live")


def write_table(folder: Path, table: str, source: Source) -> Path:
    """One CSV file."""
    path = folder / f"{table}.csv"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with path.open("w", encoding="utf-8", newline="") as file:
            file.writelines(table_text(table, source))
    except OSError as error:
        raise BadInput(f"{path}: cannot be written ({error.strerror}); choose another folder with -o") from None
    return path
