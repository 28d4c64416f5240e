"""Works for a database's writer, and what it holds afterwards: for the tests of writing."""

from collections.abc import Callable

from sqlalchemy import Connection, insert, select

from study_server.storage import schema
from study_server.storage.database import Database

Work = Callable[[Connection], object]


def adding(key: str, value: str = "") -> Work:
    """A work that inserts one row and gives its key."""

    def work(connection: Connection) -> str:
        connection.execute(insert(schema.meta).values(key=key, value=value))
        return key

    return work


def refused(key: str) -> Work:
    """A work that fails after it wrote."""

    def work(connection: Connection) -> None:
        adding(key)(connection)
        raise ValueError(key)

    return work


def keys(database: Database) -> set[str]:
    with database.reading() as connection:
        return set(connection.scalars(select(schema.meta.c.key))) - {"schema_version", "health"}
