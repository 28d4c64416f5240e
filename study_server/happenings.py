"""What the researcher should know of besides figures: withdrawals, refused answers, a date that is past."""

import datetime
from typing import Any

from sqlalchemy import Connection, select

from study_server.exports.cells import minute
from study_server.manifest import BuiltStudy
from study_server.sessions import sessions
from study_server.storage import schema

LATEST = 20
"""How many of each are shown; the export has all."""

FORGOTTEN = "forgotten_at"
"""Key in `meta`: when `fakesss forget` last deleted what could name people, Unix seconds."""


def withdrawals(connection: Connection, study: str, mode: str) -> list[dict[str, Any]]:
    """The latest ones: when, and how many ratings were deleted."""
    gone = schema.withdrawals
    mine = select(gone).join(schema.sessions).where(sessions.study == study, sessions.mode == mode)
    found = connection.execute(mine.order_by(gone.c.at.desc()).limit(LATEST)).mappings()
    return [{"at": minute(row["at"]), "ratings_deleted": row["ratings_deleted"]} for row in found]


def refusals(connection: Connection, study: str, mode: str) -> list[dict[str, Any]]:
    """The latest answers that were not stored: when, of which session, why."""
    event = schema.events.c
    mine = select(event.at, event.session, event.detail).join_from(schema.events, schema.sessions)
    mine = mine.where(event.kind == "refused", sessions.study == study, sessions.mode == mode)
    found = connection.execute(mine.order_by(event.id.desc()).limit(LATEST)).mappings()
    return [
        {"at": minute(row["at"]), "session": row["session"], "because": row["detail"].get("because", "")}
        for row in found
    ]


def retention(connection: Connection, study: BuiltStudy, now: float) -> dict[str, Any]:
    """Until when the answers are to be kept, whether that is past, and when people were forgotten (None: not yet)."""
    until = study.settings.survey.retention_until
    today = datetime.datetime.fromtimestamp(now, datetime.UTC).date()
    forgotten = connection.scalar(select(schema.meta.c.value).where(schema.meta.c.key == FORGOTTEN))
    return {
        "until": until.isoformat() if until else None,
        "is_past": until is not None and today > until,
        "forgotten": minute(float(forgotten)) if forgotten else None,
    }
