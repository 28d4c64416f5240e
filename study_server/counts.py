"""Who started, is active, finished or dropped: one query, used by the admin page, the export and the report's link."""

from array import array
from collections import Counter
from collections.abc import Sequence
from statistics import median
from typing import Any

from sqlalchemy import Connection, Integer, Select, Subquery, and_, case, cast, func, select

from study_server.sessions import UNDER_WAY, presentations, sessions, status
from study_server.settings import CHECK_NAME
from study_server.storage import schema

STATES = ("active", "finished", "dropped", "screened-out", "withdrawn")

SUMS = ("ratings", "checks_failed", "displays_scaled")
"""Columns of `summaries` that the admin page adds up."""

MINUTES = 60
RECENT_MINUTES = 10
"""Ratings of the last ten minutes count as recent."""


def summaries(study: str, mode: str, now: float, release_s: float) -> Select[Any]:
    """Query: one row a session of this study version and mode, in order of start.

    Columns: those of `sessions`, `status`, `trials_answered`, `trials`, `ratings`, `checks_failed`, `displays_scaled`
    (real trials only).
    """
    answered = (
        select(
            presentations.session,
            func.count().label("trials"),
            func.sum(case((presentations.answered_at.is_not(None), 1), else_=0)).label("trials_answered"),
            func.sum(case((presentations.scaled.is_(True), 1), else_=0)).label("displays_scaled"),
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
            answered.c.displays_scaled,
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
    """The figures of the admin page, counted while the sessions go by: memory does not grow with their number.

    `started` is the sum of the five states. `dropped_at[t]`: dropped sessions that answered exactly t trials. `rows`:
    finished + active sessions of each order row. `steps`: where the active ones are. `median_minutes`: from consent to
    the last rating, of finished sessions; None without any.
    """
    asked = ("status", "step", "row", "trials_answered", "ratings", "checks_failed", "displays_scaled")
    people = summaries(study, mode, now, release_s).order_by(None).subquery().c
    columns = (*(people[name] for name in asked), (people.finished_at - people.started_at).label("duration_s"))
    states, dropped, held, steps, sums = Counter[str](), Counter[int](), Counter[int](), Counter[str](), Counter[str]()
    durations_s = array("d")
    for person in connection.execute(select(*columns).execution_options(yield_per=500)).mappings():
        states[person["status"]] += 1
        dropped[person["trials_answered"]] += person["status"] == "dropped"
        held[person["row"]] += person["status"] in ("finished", "active")
        steps[person["step"]] += person["status"] == "active"
        for name in SUMS:
            sums[name] += person[name]
        if person["duration_s"] is not None and person["duration_s"] >= 0:  # below 0: the clock was set back
            durations_s.append(person["duration_s"])
    order = schema.order_rows.c
    rows = connection.scalars(select(order.row).where(order.study == study).order_by(order.row)).all()
    trials = connection.scalar(select(order.trials).where(order.study == study).limit(1)) or []
    return {
        "started": states.total(),
        **{state.replace("-", "_"): states[state] for state in STATES},
        **{name: sums[name] for name in SUMS},
        **recent_ratings(connection, study, mode, now),
        "median_minutes": round(median(durations_s) / 60, 1) if durations_s else None,
        "steps": [{"step": step, "people": steps[step]} for step in UNDER_WAY if steps[step]],
        "dropped_at": [{"trials": t, "people": dropped[t]} for t in range(len(trials))],
        "rows": [{"row": row + 1, "people": held[row]} for row in rows],
        "balance": balance([held[row] for row in rows]),
    }


def balance(people: Sequence[int]) -> str:
    """How evenly the order rows are taken, in a sentence."""
    most, fewest = max(people), min(people)
    if most == fewest:
        return f"Every row has {most}: balanced exactly."
    return f"Between {fewest} and {most} people a row: max - min is {most - fewest}."


def recent_ratings(connection: Connection, study: str, mode: str, now: float) -> dict[str, Any]:
    """Ratings of real trials by when they were stored.

    `ratings_by_minute`: of each of the last `MINUTES` minutes, the oldest first. `recent_ratings`: in the last
    `RECENT_MINUTES`.
    """
    ago = cast(func.floor((now - schema.ratings.c.stored_at) / 60), Integer).label("ago")
    joined = schema.ratings.join(schema.presentations).join(schema.sessions)
    mine = and_(sessions.study == study, sessions.mode == mode, presentations.practice.is_(False))
    since = schema.ratings.c.stored_at > now - 60 * MINUTES
    found = connection.execute(select(ago, func.count()).select_from(joined).where(mine, since).group_by("ago")).all()
    by_minute = [0] * MINUTES
    for minutes, ratings in found:
        by_minute[-1 - min(max(minutes, 0), MINUTES - 1)] += ratings  # one stored after `now` is of this minute
    return {"recent_ratings": sum(by_minute[-RECENT_MINUTES:]), "ratings_by_minute": by_minute}


def active(connection: Connection, study: str, mode: str, now: float, release_s: float) -> int:
    """How many are under way: only that, for a transaction that others wait for."""
    mine = and_(sessions.study == study, sessions.mode == mode, status(now, release_s) == "active")
    return connection.scalar(select(func.count()).select_from(schema.sessions).where(mine)) or 0
