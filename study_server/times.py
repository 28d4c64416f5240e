"""How long a trial takes: quartiles of the time from the picture's first frame to the last choice under it."""

from typing import Any

from sqlalchemy import Connection, Float, and_, cast, func, or_, select
from sqlalchemy.sql.elements import ColumnElement

from study_server.sessions import presentations, sessions
from study_server.storage import schema

QUARTILES = {"q1_s": 1, "median_s": 2, "q3_s": 3}
"""Name of each and how many quarters of the times lie below it."""


def times(connection: Connection, study: str, mode: str) -> dict[str, list[dict[str, Any]]]:
    """Seconds per trial, of first answers to real trials: by place in the session (`trials`), and by `stimuli`.

    Each row: `trial` or `stimulus`, `answers` (how many were timed), `q1_s`, `median_s`, `q3_s`.
    """
    by_trial = quartiles(connection, study, mode, presentations.trial)
    by_stimulus = quartiles(connection, study, mode, presentations.stimulus)
    return {
        "trials": [{"trial": trial, **row} for trial, row in sorted(by_trial.items())],
        "stimuli": [{"stimulus": stimulus, **row} for stimulus, row in sorted(by_stimulus.items())],
    }


def quartiles(connection: Connection, study: str, mode: str, by: ColumnElement[Any]) -> dict[Any, dict[str, Any]]:
    """Quartiles of the time of each trial, grouped by the column `by` of the presentations.

    As R's `quantile` and numpy have them by default (type 7 of Hyndman and Fan 1996, *American Statistician* 50,
    361-365): between the values of rank 1 + q (n - 1), linearly. The database sorts, and sends at most six of each
    group's values: those next to a quartile.
    """
    rated = schema.ratings.c
    trials = (
        select(by.label("part"), func.max(rated.rt_ms).label("ms"))
        .select_from(schema.ratings.join(schema.presentations).join(schema.sessions))
        .where(sessions.study == study, sessions.mode == mode, presentations.practice.is_(False))
        .group_by(rated.session, rated.place, by)
        .subquery()
    )
    part = trials.c.part
    ranked = select(
        part,
        cast(trials.c.ms, Float(53)).label("ms"),
        (func.row_number().over(partition_by=part, order_by=trials.c.ms) - 1).label("rank"),
        (func.count().over(partition_by=part) - 1).label("last"),
    ).subquery()
    rank, last = ranked.c.rank, ranked.c.last
    # 4 rank is within 4 of q last exactly for the ranks on either side of q last / 4
    near = [and_(4 * rank > quarters * last - 4, 4 * rank < quarters * last + 4) for quarters in QUARTILES.values()]
    values: dict[Any, dict[int, float]] = {}
    lasts: dict[Any, int] = {}
    for row in connection.execute(select(ranked).where(or_(*near))):
        values.setdefault(row.part, {})[row.rank] = row.ms
        lasts[row.part] = row.last
    return {name: summary(found, lasts[name]) for name, found in values.items()}


def summary(values: dict[int, float], last: int) -> dict[str, Any]:
    """Seconds, to the tenth, from the times in ms by their rank 0 .. last."""
    row: dict[str, Any] = {"answers": last + 1}
    for name, quarters in QUARTILES.items():
        rank, part = divmod(quarters * last, 4)
        ms = values[rank] if part == 0 else values[rank] + part / 4 * (values[rank + 1] - values[rank])
        row[name] = round(ms / 1000, 1)
    return row
