"""Who started, is active, finished or dropped: one query, used by the admin page, the export and the report's link."""

from collections import Counter
from typing import Any

from sqlalchemy import Connection, RowMapping, Select, Subquery, and_, case, func, select

from study_server import schema
from study_server.sessions import presentations, sessions, status
from study_server.settings import CHECK_NAME

STATES = ("active", "finished", "dropped", "screened-out", "withdrawn")

RECENT_S = 600.0
"""Ratings of the last ten minutes count as recent."""


def current_study(connection: Connection) -> RowMapping | None:
    """The study as it is now: the one opened last."""
    latest = select(schema.studies).order_by(schema.studies.c.opened_at.desc()).limit(1)
    return connection.execute(latest).mappings().one_or_none()


def summaries(study: str, mode: str, now: float, release_s: float) -> Select[Any]:
    """Query: one row a session of this study version and mode, in order of start.

    Columns: those of `sessions`, `status`, `trials_answered`, `trials`, `ratings`, `checks_failed` (real trials only).
    """
    answered = (
        select(
            presentations.session,
            func.count().label("trials"),
            func.sum(case((presentations.answered_at.is_not(None), 1), else_=0)).label("trials_answered"),
        )
        .where(presentations.practice.is_(False))
        .group_by(presentations.session)
        .subquery()
    )
    rated = (
        select(presentations.session, func.count().label("ratings"))
        .select_from(schema.ratings.join(schema.presentations))
        .where(presentations.practice.is_(False))
        .group_by(presentations.session)
        .subquery()
    )
    failed = failed_checks()
    return (
        select(
            schema.sessions,
            status(now, release_s).label("status"),
            answered.c.trials,
            answered.c.trials_answered,
            func.coalesce(rated.c.ratings, 0).label("ratings"),
            func.coalesce(failed.c.checks_failed, 0).label("checks_failed"),
        )
        .join(answered, answered.c.session == sessions.id)
        .outerjoin(rated, rated.c.session == sessions.id)
        .outerjoin(failed, failed.c.session == sessions.id)
        .where(sessions.study == study, sessions.mode == mode)
        .order_by(sessions.started_at, sessions.id)
    )


def failed_checks() -> Subquery:
    """Query: per session, how many instructed items were answered otherwise than asked, as answers now stand."""
    revised, first = schema.revisions.c, schema.ratings.c
    latest = (
        select(revised.rating)
        .where(revised.session == first.session, revised.place == first.place, revised.question == first.question)
        .order_by(revised.revision.desc())
        .limit(1)
        .scalar_subquery()
    )
    return (
        select(first.session, func.count().label("checks_failed"))
        .select_from(schema.ratings.join(schema.presentations))
        .where(presentations.practice.is_(False), first.question == CHECK_NAME)
        .where(func.coalesce(latest, first.rating) != presentations.check_expected)
        .group_by(first.session)
        .subquery()
    )


def overview(connection: Connection, study: str, mode: str, now: float, release_s: float) -> dict[str, Any]:
    """The figures of the admin page.

    `dropped_at[t]`: dropped sessions that answered exactly t trials. `rows`: finished + active sessions of each order
    row. `started` is the sum of the five states.
    """
    people = connection.execute(summaries(study, mode, now, release_s)).mappings().all()
    states = Counter(person["status"] for person in people)
    dropped = Counter(person["trials_answered"] for person in people if person["status"] == "dropped")
    held = Counter(person["row"] for person in people if person["status"] in ("finished", "active"))
    order = schema.order_rows.c
    rows = connection.execute(select(order.row, order.trials).where(order.study == study).order_by(order.row)).all()
    return {
        "started": len(people),
        **{state.replace("-", "_"): states[state] for state in STATES},
        "ratings": sum(person["ratings"] for person in people),
        "recent_ratings": recent_ratings(connection, study, mode, now),
        "dropped_at": [{"trials": t, "people": dropped[t]} for t in range(len(rows[0].trials))],
        "rows": [{"row": row.row + 1, "people": held[row.row]} for row in rows],
    }


def recent_ratings(connection: Connection, study: str, mode: str, now: float) -> int:
    """Ratings of real trials stored within the last `RECENT_S` seconds."""
    joined = schema.ratings.join(schema.presentations).join(schema.sessions)
    mine = and_(sessions.study == study, sessions.mode == mode, presentations.practice.is_(False))
    since = schema.ratings.c.stored_at > now - RECENT_S
    return connection.scalar(select(func.count()).select_from(joined).where(mine, since)) or 0
