"""A participant's session in the database: started once, found by its token, moved on step by step."""

import secrets
from collections.abc import Mapping
from typing import Any

from sqlalchemy import Connection, RowMapping, and_, case, func, insert, select, update
from sqlalchemy.sql.elements import ColumnElement

from study_server import schema
from study_server.assignment import practice_stimuli
from study_server.manifest import BuiltStudy
from study_server.tokens import External

sessions = schema.sessions.c
presentations = schema.presentations.c


def status(now: float, release_s: float) -> ColumnElement[str]:
    """finished, active, dropped or withdrawn: the one definition that assignment, pages and exports share."""
    return case(
        (sessions.step == "withdrawn", "withdrawn"),
        (sessions.finished_at.is_not(None), "finished"),
        (sessions.seen_at > now - release_s, "active"),
        else_="dropped",
    )


def release_s(study: BuiltStudy) -> float:
    """Seconds of silence after which a session counts as dropped."""
    return study.settings.survey.release_after_minutes * 60


def find(connection: Connection, token: str) -> RowMapping | None:
    """The session under this token, if it was started."""
    found = connection.execute(select(schema.sessions).where(sessions.token == token))
    return found.mappings().one_or_none()


def start(
    connection: Connection, study: BuiltStudy, mode: str, token: str, external: External | None, now: float
) -> RowMapping:
    """The session under `token`, made if it is not there: an order row reserved and every trial written down.

    Must run in a writing transaction: choosing the row and taking it is one step.
    """
    known = find(connection, token)
    if known is not None:
        return known
    row, order = emptiest_row(connection, study, mode, now)
    new = {
        "id": secrets.token_hex(8),
        "token": token,
        "study": study.identity,
        "mode": mode,
        "row": row,
        "step": "about" if study.settings.survey.about else "instructions",
        "started_at": now,
        "seen_at": now,
        "about": {},
    }
    if external is not None:
        new["external_study"] = external.study
        new["external_participant"] = external.participant
        new["external_session"] = external.session
    connection.execute(insert(schema.sessions).values(new))
    connection.execute(insert(schema.presentations), planned(study, str(new["id"]), order))
    record(connection, str(new["id"]), now, "started", {})
    started = find(connection, token)
    assert started is not None
    return started


def emptiest_row(connection: Connection, study: BuiltStudy, mode: str, now: float) -> tuple[int, list[str]]:
    """The order row with the fewest finished and active sessions, the first of several, and its stimuli."""
    holds = and_(
        sessions.study == schema.order_rows.c.study,
        sessions.row == schema.order_rows.c.row,
        sessions.mode == mode,
        status(now, release_s(study)).in_(("finished", "active")),
    )
    chosen = connection.execute(
        select(schema.order_rows.c.row, schema.order_rows.c.stimuli)
        .outerjoin(schema.sessions, holds)
        .where(schema.order_rows.c.study == study.identity)
        .group_by(schema.order_rows.c.study, schema.order_rows.c.row)
        .order_by(func.count(sessions.id), schema.order_rows.c.row)
        .limit(1)
    ).one()
    return chosen.row, chosen.stimuli


def planned(study: BuiltStudy, session: str, order: list[str]) -> list[dict[str, Any]]:
    """The session's presentations: practice first, then the trials in their order."""
    practice = practice_stimuli([stimulus.id for stimulus in study.stimuli], study.settings.survey.practice)
    shown: dict[str, int] = {}
    plan = []
    for place, name in enumerate([*practice, *order]):
        stimulus = study.by_id[name]
        is_practice = place < len(practice)
        original = stimulus.repeat_of or name
        if not is_practice:
            shown[original] = shown.get(original, 0) + 1
        plan.append(
            {
                "session": session,
                "place": place,
                "practice": is_practice,
                "trial": place + 1 if is_practice else place + 1 - len(practice),
                "presentation": 1 if is_practice else shown[original],
                "stimulus": name,
                "stimulus_sha256": stimulus.sha256,
                "repeat_of": stimulus.repeat_of,
            }
        )
    return plan


def advance(connection: Connection, session: RowMapping, now: float, **changes: Any) -> None:
    """Store `changes` of the session's row and that it was heard of."""
    values = {"seen_at": now, **changes}
    connection.execute(update(schema.sessions).where(sessions.id == session["id"]).values(values))


def record(connection: Connection, session: str, now: float, kind: str, detail: Mapping[str, Any]) -> None:
    """An event of the session, for the export."""
    connection.execute(insert(schema.events).values(session=session, at=now, kind=kind, detail=dict(detail)))


def unanswered(connection: Connection, session: str, limit: int) -> list[RowMapping]:
    """The next `limit` presentations that still wait for their ratings; the first is where the participant is."""
    query = (
        select(schema.presentations)
        .where(presentations.session == session, presentations.answered_at.is_(None))
        .order_by(presentations.place)
        .limit(limit)
    )
    return list(connection.execute(query).mappings())


def expected_and_stored(connection: Connection, session: str, questions: int) -> tuple[int, int]:
    """How many ratings of real trials the session should have and how many are stored."""
    mine = and_(presentations.session == session, presentations.practice.is_(False))
    trials = connection.scalar(select(func.count()).select_from(schema.presentations).where(mine))
    stored = connection.scalar(select(func.count()).select_from(schema.ratings.join(schema.presentations)).where(mine))
    return (trials or 0) * questions, stored or 0


def withdraw(connection: Connection, session: RowMapping, now: float) -> None:
    """Delete what the participant said and who they are elsewhere.

    What stays is that there was a session, and how much was deleted: neither when it was finished nor the completion
    code, which says at the recruiting service who it was. An external person who returns is still known, for their
    token follows from their name.
    """
    deleted = 0
    for table in (schema.revisions, schema.ratings, schema.events):
        gone = connection.execute(table.delete().where(table.c.session == session["id"]))
        deleted += gone.rowcount if table is schema.ratings else 0
    facts = ("answered_at", "shown_at", "device_pixel_ratio", "zoom", "drawn_width_px", "window_width_px",
             "window_height_px", "focus_lost_ms")  # fmt: skip
    mine = presentations.session == session["id"]
    connection.execute(update(schema.presentations).where(mine).values(dict.fromkeys(facts)))
    connection.execute(insert(schema.withdrawals).values(session=session["id"], at=now, ratings_deleted=deleted))
    forgotten = dict.fromkeys(
        ("finished_at", "completion_code", "comments", "external_study", "external_participant", "external_session")
    )
    advance(connection, session, now, step="withdrawn", about={}, **forgotten)
