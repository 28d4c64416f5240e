"""Engines for the two databases we know, set so that a commit means: on disk, and nobody waits for ever."""

import contextlib
import os
import re
import sqlite3
from pathlib import Path
from typing import Any

from sqlalchemy import URL, Connection, Engine, create_engine, event
from sqlalchemy.engine import make_url
from sqlalchemy.exc import ArgumentError

from fakesss.problem import BadInput

BUSY_TIMEOUT_S = 30
"""How long a writer of another process, or a lock, is waited for."""

STATEMENT_TIMEOUT_S = 300
"""How long one statement may take: the export of a large study is one."""

IDLE_TIMEOUT_S = 900
"""How long PostgreSQL keeps a transaction of which it hears nothing: an export is read at its reader's pace."""

AT_ONCE = 10
"""Transactions at once in one process on PostgreSQL, of writers and as many of readers."""

DRIVERS = {
    "postgres": "postgresql+psycopg",
    "postgresql": "postgresql+psycopg",
    "postgresql+psycopg": "postgresql+psycopg",
    "sqlite": "sqlite",
    "sqlite+pysqlite": "sqlite",
}
"""What people write, and the driver we use for it."""

SHOWN = (
    "host",
    "hostaddr",
    "port",
    "dbname",
    "user",
    "service",
    "passfile",
    "sslmode",
    "sslrootcert",
    "sslcert",
    "sslkey",
)
"""Parameters of libpq that say where a database is; of the others some are passwords."""

FORMS = "write sqlite:///FILE or postgresql://USER@HOST/NAME"

POSTGRESQL = {
    "connect_timeout": 10,
    "keepalives_idle": 30,
    "keepalives_interval": 10,
    "keepalives_count": 3,
    "tcp_user_timeout": 30_000,
    "application_name": "fakesss",
}
"""libpq's parameters: a server that has gone silent is noticed within a minute. What the address says goes first."""


def connect(address: str) -> Engine:
    """An engine whose transactions begin when and how we say.

    Parameters are kept out of errors and logs: they hold participants' tokens and answers.
    """
    url = parsed_url(address)
    if url.drivername not in DRIVERS:
        raise BadInput(f"{shown_url(address)}: {url.drivername} is neither SQLite nor PostgreSQL by psycopg; {FORMS}")
    url = url.set(drivername=DRIVERS[url.drivername])
    return sqlite(url) if url.drivername == "sqlite" else postgresql(url)


def parsed_url(address: str) -> URL:
    """The parts of a database's address; `BadInput` if it is none."""
    try:
        return make_url(address)
    except (ArgumentError, ValueError):
        raise BadInput(f'"{without_password(address)}": is no database address; {FORMS}') from None


def without_password(address: str) -> str:
    """What cannot be read as an address, without what may be a password in it."""
    return re.sub(r"\?.*", "?...", re.sub(r"://.*@", "://...@", address, flags=re.DOTALL), flags=re.DOTALL)


def sqlite_url(file: Path) -> str:
    """The address of an SQLite file. `?` begins an address's parameters and `%` spells a character by its number."""
    return "sqlite:///" + str(file).replace("%", "%25").replace("?", "%3F")


def shown_url(address: str | URL) -> str:
    """`address` fit to be printed: without a password, in whichever place it stands."""
    url = parsed_url(address) if isinstance(address, str) else address
    if url.drivername == "sqlite" and url.database and not url.query:
        return sqlite_url(Path(url.database))
    query = {name: value for name, value in url.query.items() if name in SHOWN}
    return url.set(query=query).render_as_string(hide_password=True)


def sqlite_file(url: URL) -> Path:
    """The file of an SQLite address; `BadInput` if it names none, for in memory every answer would be lost."""
    if url.database in (None, "", ":memory:"):
        raise BadInput(
            f"{shown_url(url)}: names no file, so that every answer would be lost at the end; write sqlite:///FILE"
        )
    if url.query:  # among them mode=memory
        raise BadInput(
            f"{shown_url(url)}: the address of an SQLite file takes no parameters; write a ? in its name as %3F"
        )
    return Path(str(url.database))


def sqlite(url: URL) -> Engine:
    """An engine on the file of `url`."""
    sqlite_file(url)
    engine = create_engine(
        url, connect_args={"timeout": BUSY_TIMEOUT_S}, pool_size=20, max_overflow=40, hide_parameters=True
    )
    event.listen(engine, "do_connect", make_private)
    event.listen(engine, "connect", prepare_sqlite)
    event.listen(engine, "begin", begin_sqlite)
    return engine


def make_private(_dialect: Any, _record: Any, arguments: Any, _named: Any) -> None:
    """A new file is its owner's alone, whatever the umask; SQLite makes the -wal and -shm beside it like it."""
    with contextlib.suppress(OSError):  # it is there already, or SQLite will say what is wrong
        os.close(os.open(arguments[0], os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600))


def prepare_sqlite(connection: Any, _record: Any) -> None:
    """Pragmas of every new SQLite connection.

    synchronous=FULL makes a commit wait for the disk: without it a rating could be acknowledged and lost.
    secure_delete overwrites what a withdrawal deletes, once `empty_log` has brought that into the file.
    """
    connection.isolation_level = None  # the driver must not begin transactions by itself
    for pragma in ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON", "secure_delete=ON"):
        connection.execute(f"PRAGMA {pragma}")


def empty_log(engine: Engine, wait_s: float) -> bool:
    """Bring all that SQLite's -wal holds into the file and cut it to nothing, so that the file alone is whole.

    Whether it is so; not if somebody reads an older snapshot for longer than `wait_s`, during which nobody can write,
    or if the disk is full. By a connection of its own, for those of the pool may all be in use.
    """
    file = Path(str(engine.url.database))
    if not file.is_file():
        return True
    try:
        with contextlib.closing(sqlite3.connect(file, wait_s, isolation_level=None)) as connection:
            is_busy: int = connection.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()[0]
    except sqlite3.Error:
        return False
    return not is_busy


def begin_sqlite(connection: Connection) -> None:
    """BEGIN, or BEGIN IMMEDIATE for writers, which then cannot fail half-way for want of the lock."""
    connection.exec_driver_sql(f"BEGIN {connection.get_execution_options().get('sqlite_begin', '')}")


def postgresql(url: URL) -> Engine:
    """An engine on a PostgreSQL server, by psycopg 3; `BadInput` where that is not installed."""
    arguments = {name: value for name, value in POSTGRESQL.items() if name not in url.query}
    try:
        engine = create_engine(
            url,
            connect_args=arguments,
            pool_size=AT_ONCE,
            max_overflow=AT_ONCE,
            pool_timeout=BUSY_TIMEOUT_S,
            pool_pre_ping=True,
            hide_parameters=True,
        )
    except ModuleNotFoundError as error:
        raise BadInput(
            f"{shown_url(url)}: needs {error.name}; install it with: pip install 'fakesss[postgres]'"
        ) from None
    event.listen(engine, "connect", prepare_postgresql)
    return engine


def prepare_postgresql(connection: Any, _record: Any) -> None:
    """Settings of every new PostgreSQL session.

    A server may be set up to acknowledge before it has written (synchronous_commit=off); stricter settings stay.
    """
    settings = {
        "statement_timeout": STATEMENT_TIMEOUT_S,
        "lock_timeout": BUSY_TIMEOUT_S,
        "idle_in_transaction_session_timeout": IDLE_TIMEOUT_S,
    }
    connection.autocommit = True
    for name, seconds in settings.items():
        connection.execute(f"SET {name} = '{seconds}s'")
    connection.execute(
        "SELECT set_config('synchronous_commit', 'on', false) WHERE current_setting('synchronous_commit') = 'off'"
    )
    connection.autocommit = False
