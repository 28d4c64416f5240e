"""Whether people are let in: the researcher's pause and close. Every change is kept; the latest counts.

open: everybody. paused: nobody starts, who is under way goes on. closed: nobody starts and nobody goes on, but answers
that were given before and arrive late are still stored.
"""

from typing import Literal

from sqlalchemy import Connection, insert, select

from study_server import schema

Gate = Literal["open", "paused", "closed"]

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
