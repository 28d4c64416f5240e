"""The rows of the exported tables, read from one snapshot a few sessions at a time: memory does not grow with them."""

import json
import math
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

from sqlalchemy import Connection, RowMapping, select

from study_server.counts import summaries
from study_server.exports.cells import iso
from study_server.exports.columns import DISPLAYS, RATINGS, STIMULI
from study_server.guards.tokens import pseudonym
from study_server.manifest import BuiltStudy
from study_server.sessions import presentations, release_s, sessions
from study_server.settings import CHECK_NAME
from study_server.site import Mode
from study_server.storage import schema

AT_ONCE = 20
"""Sessions read with one query a table: fewer queries, and still little memory."""

UNRATED = ("withdrawn", "screened-out")
"""The states of sessions of which no rating is expected any more."""

Row = dict[str, Any]


@dataclass(frozen=True)
class Source:
    """One snapshot of the database, and what turns it into tables."""

    connection: Connection
    study: BuiltStudy
    mode: Mode
    salt: str
    now: float = field(default_factory=time.time)
    """Unix seconds: who is active and who dropped is judged by one moment in all tables."""

    def people(self) -> Iterator[RowMapping]:
        """The sessions with their status: the query of the admin page."""
        query = summaries(self.study.identity, self.mode, self.now, release_s(self.study))
        yield from self.connection.execute(query.execution_options(yield_per=500)).mappings()

    def participant(self, session: RowMapping) -> str:
        """The pseudonym of the person behind a session."""
        return pseudonym(self.salt, session["external_participant"] or session["id"])


@dataclass(frozen=True)
class Visit:
    """A session with its real trials in order, and its answers that count by place and question."""

    person: RowMapping
    trials: list[RowMapping] = field(default_factory=list)
    answers: dict[tuple[int, str], Row] = field(default_factory=dict)


def visits(source: Source) -> Iterator[Visit]:
    """Every session of which ratings are expected, in order of start."""
    expected = (person for person in source.people() if person["status"] not in UNRATED)
    for people in groups(expected, AT_ONCE):
        found = {person["id"]: Visit(person) for person in people}
        read_trials(source.connection, found)
        read_answers(source.connection, found)
        yield from found.values()


def groups(people: Iterable[RowMapping], size: int) -> Iterator[list[RowMapping]]:
    """`size` at a time; the last ones may be fewer."""
    rest = iter(people)
    while group := list(islice(rest, size)):
        yield group


def read_trials(connection: Connection, found: dict[str, Visit]) -> None:
    """The trials of these sessions, without practice."""
    mine = (presentations.session.in_(list(found)), presentations.practice.is_(False))
    query = select(schema.presentations).where(*mine).order_by(presentations.session, presentations.place)
    for trial in connection.execute(query).mappings():
        found[trial["session"]].trials.append(trial)


def read_answers(connection: Connection, found: dict[str, Visit]) -> None:
    """The answers of these sessions that count: the last revision, or else the first answer."""
    revised = schema.revisions.c
    first = select(schema.ratings).where(schema.ratings.c.session.in_(list(found)))
    later = select(schema.revisions).where(revised.session.in_(list(found))).order_by(revised.revision)
    for query in (first, later):
        for row in connection.execute(query).mappings():
            found[row["session"]].answers[row["place"], row["question"]] = {
                "rating": row["rating"],
                "rt_ms": round(row["rt_ms"], 1),
                "shown_at": iso(row["shown_at"]),
                "answered_at": iso(row["answered_at"]),
                "revision": row.get("revision", 0),
            }


NOT_THE_TRIALS = ("session", "check_expected")
"""Columns of ratings.csv that the trial's row in the database has too, but that are not every question's."""


def rating_rows(source: Source) -> Iterator[Row]:
    """One row for each expected rating of every session not withdrawn, answered or not; latest revision."""
    for visit in visits(source):
        person = visit.person
        shared = {
            "session": person["id"],
            "participant": source.participant(person),
            "mode": source.mode,
            "started_at": iso(person["started_at"]),
            "study_sha256": source.study.sha256,
        }
        for trial in visit.trials:
            facts = {name: trial[name] for name in RATINGS if name in trial and name not in NOT_THE_TRIALS} | shared
            facts["shown_at"] = iso(trial["shown_at"])
            for question in trial["questions"]:
                yield facts | {"question": question} | visit.answers.get((trial["place"], question), {})
            if trial["check_expected"] is not None:
                yield facts | check_row(trial, visit.answers.get((trial["place"], CHECK_NAME), {}))


def check_row(trial: RowMapping, given: Row) -> Row:
    """What the row of an instructed item has besides: what was asked for, and whether it was done."""
    expected = trial["check_expected"]
    passed = {"check_passed": int(given["rating"] == expected)} if given else {}
    return {"question": CHECK_NAME, "check_expected": expected} | given | passed


def participant_rows(source: Source) -> Iterator[Row]:
    """One row a session, whatever became of it."""
    for person in source.people():
        about = {f"about_{name}": value for name, value in person["about"].items()}
        screen = {f"screen_{name}": value for name, value in person["screen"].items()}
        yield about | person["client"] | screen | participant_row(source, person)


def participant_row(source: Source, person: RowMapping) -> Row:
    """What is known of every session."""
    return {
        "session": person["id"],
        "participant": source.participant(person),
        "mode": source.mode,
        "status": person["status"],
        "step": person["step"],
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


def display_rows(source: Source) -> Iterator[Row]:
    """One row for each picture of a real trial that was shown and rated: how it stood on the screen."""
    for visit in visits(source):
        for trial in visit.trials:
            if trial["answered_at"] is not None:
                facts = {name: trial[name] for name in DISPLAYS if name in trial}
                yield facts | {
                    "mode": source.mode,
                    "shown_at": iso(trial["shown_at"]),
                    "scaled": None if trial["scaled"] is None else int(trial["scaled"]),
                }


def event_rows(source: Source) -> Iterator[Row]:
    """What happened besides ratings, in order; nothing of practice, whose answers are in no table either."""
    query = (
        select(schema.events)
        .join(schema.sessions)
        .where(sessions.study == source.study.identity, sessions.mode == source.mode)
        .order_by(schema.events.c.id)
    )
    for event in source.connection.execute(query.execution_options(yield_per=500)).mappings():
        if is_of_practice(source, event["detail"]):
            continue
        detail = json.dumps(event["detail"], ensure_ascii=False, sort_keys=True)
        yield {**event, "mode": source.mode, "at": iso(event["at"]), "detail": detail}


def is_of_practice(source: Source, detail: Row) -> bool:
    """Whether an event is about a practice trial: a changed answer says so, a refused one has its place."""
    place: float = detail.get("place", math.inf)
    return bool(detail.get("practice")) or place < source.study.settings.survey.practice


def stimulus_rows(source: Source) -> Iterator[Row]:
    """The manifest's facts about every picture, one column a factor."""
    for stimulus in source.study.stimuli:
        facts = stimulus.facts
        levels = {f"factor_{name}": level for name, level in (facts.get("factors") or {}).items()}
        kept = {name: facts.get(name) for name in STIMULI}
        yield kept | levels | {"stimulus": stimulus.id, "rows": "|".join(facts.get("rows") or ())}


def wide_rows(source: Source) -> Iterator[Row]:
    """One row for each session of which ratings are expected: each answer in a column of its own."""
    for visit in visits(source):
        row = participant_row(source, visit.person)
        checks = 0
        for trial in visit.trials:
            for question in trial["questions"]:
                row[wide_name(trial["stimulus"], question)] = rating_of(visit, trial, question)
            if trial["check_expected"] is not None:
                checks += 1
                given = visit.answers.get((trial["place"], CHECK_NAME), {})
                row[f"check_{checks}"] = check_row(trial, given).get("check_passed")
        yield row


def rating_of(visit: Visit, trial: RowMapping, question: str) -> int | None:
    """The answer that counts, or None."""
    given: int | None = visit.answers.get((trial["place"], question), {}).get("rating")
    return given


def wide_name(stimulus: str, question: str) -> str:
    """The column of wide.csv for a picture and a question: `--wide "{stimulus}__{question}"` reads it back."""
    return f"{stimulus}__{question}"
