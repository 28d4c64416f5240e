"""One database per study: opened, checked, read in snapshots, written to in transactions that are on disk at the end.

SQLite has one writer (`group_commit`), PostgreSQL many (`retries`); who reads and writes need not know which.
"""

import secrets
import time
import weakref
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, TypeVar

from sqlalchemy import Connection, Engine, Table, func, select, update
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.exc import DatabaseError, TimeoutError

from fakesss.problem import BadInput
from study_server.storage import schema
from study_server.storage.engines import AT_ONCE, connect, empty_log, parsed_url, shown_url, sqlite_file, sqlite_url
from study_server.storage.foreign_tables import check_columns, holds_ours
from study_server.storage.group_commit import LOG_WAIT_S, GroupCommit
from study_server.storage.retries import Retries
from study_server.storage.upgrades import upgrade

T = TypeVar("T")


class Database:
    """A study's database as this process uses it: readers see snapshots, a commit means on disk.

    `write` is for what many send at the same moment, `writing` for all else. Neither may be used inside the other.
    """

    def __init__(self, url: str) -> None:
        self.engine = connect(url)
        self.is_sqlite = self.engine.dialect.name == "sqlite"
        self.writer = GroupCommit(self.engine) if self.is_sqlite else Retries(self.engine, AT_ONCE)
        snapshots = {} if self.is_sqlite else {"isolation_level": "REPEATABLE READ", "postgresql_readonly": True}
        self.reader = self.engine.execution_options(**snapshots)
        # what is waiting is written before the process ends, or before nobody knows this any more
        weakref.finalize(self, finish, self.writer, self.engine)

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """A connection that sees one snapshot, however long it reads and whatever others write."""
        with self.reader.connect() as connection:
            yield connection

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        """A transaction in the caller's thread, with SQLite alone from its first statement; on disk when left."""
        with self.writer.writing() as connection:
            yield connection

    def write(self, work: Callable[[Connection], T]) -> T:
        """The result of `work` once what it wrote is on disk; what it raises undoes it whole.

        `work` may share its commit with others, and may be run again after a failure that left nothing (PostgreSQL),
        so it must do nothing but read, write and reckon. Raises `sqlalchemy.exc.DatabaseError` if it is not on disk.
        """
        return self.submit(work).result()

    def submit(self, work: Callable[[Connection], T]) -> "Future[T]":
        """The same without waiting, for asynchronous callers: `await asyncio.wrap_future(database.submit(work))`."""
        return self.writer.submit(work)

    def empty_log(self) -> None:
        """See to it that what a transaction deleted is gone from SQLite's log too; PostgreSQL's is its own matter."""
        if isinstance(self.writer, GroupCommit):
            self.writer.empty_log()

    def close(self) -> None:
        """What is waiting is written, and the connections closed; a use after that opens others."""
        finish(self.writer, self.engine)


def finish(writer: GroupCommit | Retries, engine: Engine) -> None:
    """Write what is waiting, so that the file of SQLite alone is whole, then close the connections."""
    writer.close()
    if isinstance(writer, GroupCommit):
        empty_log(engine, LOG_WAIT_S)
    engine.dispose()


def default_url(folder: Path) -> str:
    """Where the ratings of the study in `folder` are kept unless told otherwise."""
    return sqlite_url(folder / "ratings.sqlite")


def chosen_url(folder: Path, given: str | None) -> str:
    """The address `given`, or else the study's own; `BadInput` for an empty one, perhaps of a variable not set."""
    if given is None:
        return default_url(folder)
    if not given.strip():
        raise BadInput('--database "": names no database; give its address, or leave --database out')
    return given


def open_existing(folder: Path, given: str | None) -> Database:
    """The database `given`, or else the one of the study in `folder`; `BadInput` rather than a new empty one."""
    url = chosen_url(folder, given)
    parts = parsed_url(url)
    if parts.get_backend_name() == "sqlite" and not (file := sqlite_file(parts)).is_file():
        raise BadInput(f"{file}: no such file; nobody has been served this study yet")
    return open_database(url, new=False)


def open_database(url: str, *, new: bool = True) -> Database:
    """The database at `url` with all tables in place; one that an earlier release wrote is upgraded.

    `new`: one without tables gets them. Raises `BadInput` if it cannot be opened or written, holds another program's
    tables, or belongs to a later version of this program.
    """
    shown = shown_url(url)
    database = Database(url)
    with ExitStack() as unless_opened:
        unless_opened.callback(database.close)
        try:
            with database.writing() as connection:
                take_turns(connection)
                prepare(connection, shown, new=new)
        except DatabaseError as error:
            said = f"cannot be opened for writing ({reason(error)}); check it and its rights"
            raise BadInput(f"{shown}: {said}") from None
        unless_opened.pop_all()
    return database


def prepare(connection: Connection, shown: str, *, new: bool) -> None:
    """Our tables, made if there are none and `new` allows it, brought to this version; else `BadInput`."""
    if not holds_ours(connection, shown) and not new:
        raise BadInput(f"{shown}: holds no answers; nobody has been served this study from it yet")
    schema.tables.create_all(connection)
    version = upgrade(connection, remembered(connection, "schema_version", lambda: schema.VERSION))
    if version != schema.VERSION:
        raise BadInput(f"{shown}: has schema {version}, this program knows {schema.VERSION}; use the one it is from")
    check_columns(connection, shown)


def take_turns(connection: Connection) -> None:
    """Until this transaction ends, no other process that asks for the same is past this line.

    For what must be looked up and then made once by several workers that start together. SQLite's writers take turns
    anyway.
    """
    if connection.dialect.name == "postgresql":
        connection.execute(select(func.pg_advisory_xact_lock(int.from_bytes(b"fakesss"))))


def reason(error: DatabaseError) -> str:
    """What the database said, in a line, without the values it said it of: they may be tokens and answers."""
    diagnosis = getattr(error.orig, "diag", None)
    said = getattr(diagnosis, "message_primary", None) or str(error.orig)
    return " ".join(said.split())


def remembered(connection: Connection, key: str, make: Callable[[], object]) -> str:
    """The value of `key` in `meta`; made and stored on first use, once even if several processes ask at once."""
    stored = select(schema.meta.c.value).where(schema.meta.c.key == key)
    value = connection.scalar(stored)
    if value is None:
        insert_if_new(connection, schema.meta, {"key": key, "value": str(make())})
        value = connection.scalar(stored)
    return str(value)


def insert_if_new(connection: Connection, table: Table, row: Mapping[str, Any]) -> bool:
    """Insert `row` unless one with an equal key is there; whether it was inserted.

    A transaction that is inserting the same key just now is waited for.
    """
    insert = sqlite.insert if connection.dialect.name == "sqlite" else postgresql.insert
    return connection.execute(insert(table).values(row).on_conflict_do_nothing()).rowcount == 1


def secret(database: Database, name: str) -> str:
    """A random secret kept in the database under `name`: 192 bits, made on first use."""
    with database.writing() as connection:
        return remembered(connection, name, lambda: secrets.token_urlsafe(24))


def is_writable(database: Database) -> bool:
    """Whether a row can be brought to disk right now."""

    def touch(connection: Connection) -> None:
        now = str(time.time())
        remembered(connection, "health", lambda: now)
        connection.execute(update(schema.meta).where(schema.meta.c.key == "health").values(value=now))

    try:
        database.write(touch)
    except (DatabaseError, TimeoutError):
        return False
    return True
