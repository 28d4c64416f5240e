"""A participant's session in the database: started once, found by its token, moved on step by step."""

import secrets
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from sqlalchemy import Connection, RowMapping, and_, bindparam, case, func, insert, select, update
from sqlalchemy.sql.elements import ColumnElement

from study_server.guards.tokens import External
from study_server.manifest import BuiltStudy
from study_server.storage import schema
from study_server.storage.adoption import design_of, live_elsewhere

sessions = schema.sessions.c
presentations = schema.presentations.c

UNDER_WAY = ("about", "screen", "instructions", "practice", "ready", "trials", "comments")
"""Steps of a session that are not its end."""


def status(now: float, release_s: float) -> ColumnElement[str]:
    """finished, active, dropped, screened-out or withdrawn: assignment, pages and exports share this definition."""
    return case(
        (sessions.step == "withdrawn", "withdrawn"),
        (sessions.step == "screened_out", "screened-out"),
        (sessions.finished_at.is_not(None), "finished"),
        (sessions.seen_at > now - release_s, "active"),
        else_="dropped",
    )


def release_s(study: BuiltStudy) -> float:
    """Seconds of silence after which a session counts as dropped."""
    return study.settings.survey.release_after_minutes * 60


Session = RowMapping | dict[str, Any]
"""A session's row, as read or as just changed."""

KNOWN = select(schema.sessions).where(sessions.token == bindparam("token"))
KNOWN_AND_LOCKED = KNOWN.with_for_update()
TRIAL = select(
    presentations.session, presentations.place, presentations.practice, presentations.trial, presentations.stimulus,
    presentations.stimulus_sha256, presentations.questions, presentations.check_expected, presentations.answered_at,
).order_by(presentations.place)  # fmt: skip
WAITING = TRIAL.where(presentations.session == bindparam("session"), presentations.answered_at.is_(None)).limit(
    bindparam("most")
)
NEAR = TRIAL.where(presentations.session == bindparam("session"), presentations.place >= bindparam("first")).limit(
    bindparam("most")
)
MOVED_ON = update(schema.sessions).where(sessions.id == bindparam("session"))
"""Statements that a save needs, built once: building one takes longer than SQLite takes to run it."""


def find(connection: Connection, token: str, *, lock: bool = False) -> RowMapping | None:
    """The session under this token, if it was started. `lock`: nobody else changes it meanwhile."""
    found = connection.execute(KNOWN_AND_LOCKED if lock else KNOWN, {"token": token})
    return found.mappings().one_or_none()


@dataclass(frozen=True)
class Visitor:
    """Who wants to start: the secret address, how a recruiting service calls them, their language, what may be kept."""

    token: str
    mode: str
    external: External | None = None
    language: str = "en"
    client: Mapping[str, str] = field(default_factory=dict)


class AnotherVersion(Exception):
    """Another version of the study, served on the same database, has taken live sessions."""


def start(connection: Connection, study: BuiltStudy, visitor: Visitor, now: float) -> RowMapping:
    """The session of this visitor, made if it is not there: an order row reserved and every trial written down.

    Must run in a writing transaction: choosing the row and taking it is one step. The studies' rows are locked for it,
    since PostgreSQL, unlike SQLite, has many writers at once; all of them, since two versions may be served at once.
    Raises `AnotherVersion` if this one would be the second with live sessions.
    """
    connection.execute(select(schema.studies.c.identity).order_by(schema.studies.c.identity).with_for_update())
    known = find(connection, visitor.token)
    if known is not None:
        return known
    if visitor.mode == "live" and live_elsewhere(connection, study.identity):
        raise AnotherVersion
    row, trials = emptiest_row(connection, study, visitor.mode, now)
    new = {
        "id": f"s{secrets.token_hex(8)}",  # not digits alone, which a spreadsheet would round
        "token": visitor.token,
        "study": study.identity,
        "mode": visitor.mode,
        "row": row,
        "step": first_step(study),
        "started_at": now,
        "seen_at": now,
        "language": visitor.language,
        "about": {},
        "screen": {},
        "client": dict(visitor.client),
    }
    if visitor.external is not None:
        new["external_study"] = visitor.external.study
        new["external_participant"] = visitor.external.participant
        new["external_session"] = visitor.external.session
    connection.execute(insert(schema.sessions).values(new))
    connection.execute(insert(schema.presentations), planned(study, str(new["id"]), trials))
    record(connection, str(new["id"]), now, "started", {})
    started = find(connection, visitor.token)
    assert started is not None
    return started


def first_step(study: BuiltStudy) -> str:
    """Where a session begins."""
    return "about" if study.settings.survey.about else after_about(study)


def after_about(study: BuiltStudy) -> str:
    """What follows the questions about the participant."""
    return "screen" if study.settings.survey.screen_check else "instructions"


def emptiest_row(connection: Connection, study: BuiltStudy, mode: str, now: float) -> tuple[int, list[dict[str, Any]]]:
    """The order row with the fewest finished and active sessions, the first of several, and its trials.

    So while nobody leaves, max - min over the rows is at most 1 at any moment. Who falls silent or withdraws opens a
    hole, which the next arrivals fill first; who comes back takes a place in the row they had, which may put it ahead
    until as many have started as the others lack. Finishing changes nothing: when nobody is under way any more, the
    finishers are as even as that (tests/study_server/test_two_thousand_arrivals.py states it exactly).
    """
    holds = and_(
        sessions.study == schema.order_rows.c.study,
        sessions.row == schema.order_rows.c.row,
        sessions.mode == mode,
        status(now, release_s(study)).in_(("finished", "active")),
    )
    row = connection.execute(
        select(schema.order_rows.c.row)
        .outerjoin(schema.sessions, holds)
        .where(schema.order_rows.c.study == study.identity)
        .group_by(schema.order_rows.c.row)
        .order_by(func.count(sessions.id), schema.order_rows.c.row)
        .limit(1)
    ).scalar_one()
    this = and_(schema.order_rows.c.study == study.identity, schema.order_rows.c.row == row)
    return row, connection.execute(select(schema.order_rows.c.trials).where(this)).scalar_one()


def planned(study: BuiltStudy, session: str, trials: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The session's presentations: practice first, then the trials in their order."""
    practice = [asdict(trial) for trial in design_of(study).practice_trials()]
    shown: Counter[tuple[str, ...]] = Counter()
    plan = []
    for place, trial in enumerate([*practice, *trials]):
        stimulus = study.by_id[trial["stimulus"]]
        is_practice = place < len(practice)
        showing = (stimulus.repeat_of or stimulus.id, *trial["questions"])
        shown[showing] += not is_practice
        plan.append(
            {
                "session": session,
                "place": place,
                "practice": is_practice,
                "trial": place + 1 if is_practice else place + 1 - len(practice),
                "presentation": 1 if is_practice else shown[showing],
                "stimulus": stimulus.id,
                "stimulus_sha256": stimulus.sha256,
                "repeat_of": stimulus.repeat_of,
                "questions": list(trial["questions"]),
                "check_expected": trial["check"],
                "answers_expected": len(trial["questions"]) + (trial["check"] is not None),
            }
        )
    return plan


def advance(connection: Connection, session: Session, now: float, **changes: Any) -> Session:
    """Store `changes` of the session's row and that it was heard of; the session as it is then."""
    values = {"seen_at": now, **changes}
    connection.execute(MOVED_ON, {"session": session["id"], **values})
    return {**session, **values}


def record(connection: Connection, session: str, now: float, kind: str, detail: Mapping[str, Any]) -> None:
    """An event of the session, for the export."""
    connection.execute(insert(schema.events).values(session=session, at=now, kind=kind, detail=dict(detail)))


def noted(connection: Connection, session: str, kind: str) -> int:
    """How many events of this kind the session has."""
    event = schema.events.c
    mine = select(func.count()).select_from(schema.events).where(event.session == session, event.kind == kind)
    return connection.scalar(mine) or 0


def unanswered(connection: Connection, session: str, limit: int) -> Sequence[RowMapping]:
    """The next `limit` presentations that still wait for their ratings; the first is where the participant is."""
    return connection.execute(WAITING, {"session": session, "most": limit}).mappings().all()


def near(connection: Connection, session: str, place: int, limit: int) -> Sequence[RowMapping]:
    """The presentation at `place`, the one before it and the `limit` after it, as far as there are any."""
    wanted = {"session": session, "first": place - 1, "most": limit + 2}
    return connection.execute(NEAR, wanted).mappings().all()


def expected_and_stored(connection: Connection, session: str) -> tuple[int, int]:
    """How many ratings of real trials the session should have and how many are stored."""
    mine = and_(presentations.session == session, presentations.practice.is_(False))
    expected = connection.scalar(select(func.sum(presentations.answers_expected)).where(mine))
    stored = connection.scalar(select(func.count()).select_from(schema.ratings.join(schema.presentations)).where(mine))
    return expected or 0, stored or 0


def withdraw(connection: Connection, session: RowMapping, now: float) -> None:
    """Delete what the participant said and who they are elsewhere.

    What stays is that there was a session, and how much was deleted: neither when it was finished nor the completion
    code, which says at the recruiting service who it was. An external person who returns is still known, for their
    token follows from their name.
    """
    _, deleted = expected_and_stored(connection, session["id"])
    for table in (schema.revisions, schema.ratings, schema.events):
        connection.execute(table.delete().where(table.c.session == session["id"]))
    facts = ("answered_at", "shown_at", "device_pixel_ratio", "zoom", "drawn_width_px", "drawn_height_px",
             "window_width_px", "window_height_px", "focus_lost_ms", "gamut", "scaled")  # fmt: skip
    mine = presentations.session == session["id"]
    connection.execute(update(schema.presentations).where(mine).values(dict.fromkeys(facts)))
    connection.execute(insert(schema.withdrawals).values(session=session["id"], at=now, ratings_deleted=deleted))
    forgotten = dict.fromkeys(
        ("finished_at", "completion_code", "comments", "external_study", "external_participant", "external_session")
    )
    advance(connection, session, now, step="withdrawn", about={}, screen={}, client={}, **forgotten)
