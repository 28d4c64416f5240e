"""One database per study: opened, checked, and written to in whole transactions that are on disk when they return."""

import secrets
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, Engine, create_engine, event, insert, select, update
from sqlalchemy.engine import make_url
from sqlalchemy.exc import ArgumentError, DatabaseError, NoSuchModuleError, OperationalError

from fakesss.problem import BadInput
from study_server import schema

BUSY_TIMEOUT_S = 30.0
"""How long a writer of another process is waited for."""


@dataclass(frozen=True)
class Database:
    """The engine and this process's writer lock.

    SQLite lets one connection write. Waiting at a lock is fair and wakes at once; SQLite's own busy handler sleeps
    and may pass over a waiter for long.
    """

    engine: Engine
    writer: threading.Lock = field(default_factory=threading.Lock)

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """A connection that sees one snapshot."""
        with self.engine.connect() as connection:
            yield connection

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        """A transaction that holds the write lock from its first statement; on disk when the block is left."""
        writable = self.engine.execution_options(sqlite_begin="IMMEDIATE")
        with self.writer, writable.begin() as connection:
            yield connection


def default_url(folder: Path) -> str:
    """Where the ratings of the study in `folder` are kept unless told otherwise."""
    return f"sqlite:///{folder / 'ratings.sqlite'}"


def open_database(url: str) -> Database:
    """The database at `url` with all tables in place.

    Raises `BadInput` if it cannot be opened or written, or belongs to another version of this program.
    """
    shown = shown_url(url)
    try:
        database = Database(connect(url))
        with database.writing() as connection:
            schema.tables.create_all(connection)
            version = remembered(connection, "schema_version", lambda: schema.VERSION)
    except (OperationalError, DatabaseError) as error:
        raise BadInput(f"{shown}: cannot be opened for writing ({error.orig}); check the path and its rights") from None
    except (ArgumentError, NoSuchModuleError, ImportError) as error:
        raise BadInput(f"{shown}: is no database address ({error}); write sqlite:///FILE") from None
    if version != schema.VERSION:
        raise BadInput(f"{shown}: has schema {version}, this program knows {schema.VERSION}; use the one it is from")
    return database


def shown_url(url: str) -> str:
    """`url` fit to be printed: without its password."""
    try:
        return make_url(url).render_as_string(hide_password=True)
    except ArgumentError:
        return f'"{url}"'


def connect(url: str) -> Engine:
    """An engine whose transactions begin when and how we say."""
    engine = create_engine(url)
    if engine.dialect.name == "sqlite":
        engine = create_engine(url, connect_args={"timeout": BUSY_TIMEOUT_S}, pool_size=20, max_overflow=40)
        event.listen(engine, "connect", prepare_sqlite)
        event.listen(engine, "begin", begin_sqlite)
    return engine


def prepare_sqlite(connection: Any, _record: Any) -> None:
    """Pragmas of every new SQLite connection.

    synchronous=FULL makes a commit wait for the disk: without it a rating could be acknowledged and lost.
    secure_delete overwrites what a withdrawal deletes.
    """
    connection.isolation_level = None  # the driver must not begin transactions by itself
    for pragma in ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON", "secure_delete=ON"):
        connection.execute(f"PRAGMA {pragma}")


def begin_sqlite(connection: Connection) -> None:
    """BEGIN, or BEGIN IMMEDIATE for writers, which then cannot fail half-way for want of the lock."""
    connection.exec_driver_sql(f"BEGIN {connection.get_execution_options().get('sqlite_begin', '')}")


def remembered(connection: Connection, key: str, make: Any) -> str:
    """The value of `key` in `meta`; made and stored on first use."""
    value = connection.scalar(select(schema.meta.c.value).where(schema.meta.c.key == key))
    if value is None:
        value = str(make())
        connection.execute(insert(schema.meta).values(key=key, value=value))
    return str(value)


def secret(database: Database, name: str) -> str:
    """A random secret kept in the database under `name`: 192 bits, made on first use."""
    with database.writing() as connection:
        return remembered(connection, name, lambda: secrets.token_urlsafe(24))


def is_writable(database: Database) -> bool:
    """Whether a row can be brought to disk right now."""
    try:
        with database.writing() as connection:
            remembered(connection, "health", time.time)
            connection.execute(update(schema.meta).where(schema.meta.c.key == "health").values(value=str(time.time())))
    except DatabaseError:
        return False
    return True
