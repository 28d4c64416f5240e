"""Whether people are let in: the researcher's pause and close. Every change is kept; the latest counts.

open: everybody. paused: nobody starts, who is under way goes on. closed: nobody starts and nobody goes on, but answers
that were given before and arrive late are still stored.
"""

from typing import Any, Literal

from sqlalchemy import Connection, insert, select

from study_server.exports.cells import minute
from study_server.storage import schema

Gate = Literal["open", "paused", "closed"]

MEANING: dict[Gate, str] = {
    "open": "People can start, and go on.",
    "paused": "Nobody can start; who is under way goes on.",
    "closed": "Nobody can start or go on; answers that arrive late are still stored.",
}

LATEST = 20
"""How many changes are shown."""

gates = schema.gates.c


def gate(connection: Connection, study: str, mode: str) -> Gate:
    """How the gate of this study (its identity) and mode stands."""
    mine = select(gates.state).where(gates.study == study, gates.mode == mode)
    state: Gate | None = connection.scalar(mine.order_by(gates.id.desc()).limit(1))
    return state or "open"


def set_gate(connection: Connection, study: str, mode: str, state: Gate, now: float) -> None:
    """From now on."""
    if gate(connection, study, mode) != state:
        connection.execute(insert(schema.gates).values(study=study, mode=mode, state=state, at=now))


def standing(connection: Connection, study: str, mode: str) -> dict[str, Any]:
    """How the gate stands, what that means, and its latest changes."""
    state = gate(connection, study, mode)
    mine = select(gates.at, gates.state).where(gates.study == study, gates.mode == mode)
    changes = connection.execute(mine.order_by(gates.id.desc()).limit(LATEST))
    history = [{"at": minute(at), "state": changed_to} for at, changed_to in changes]
    return {"state": state, "meaning": MEANING[state], "history": history}
