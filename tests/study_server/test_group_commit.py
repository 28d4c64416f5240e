"""SQLite's one writer: many share a commit, in the order of asking, and nobody is answered before it."""

import sqlite3
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

import pytest
from database_works import Work, adding, keys, refused
from sqlalchemy import Connection, event, func, insert, select, text
from sqlalchemy.exc import DatabaseError, IntegrityError, OperationalError

from study_server.storage import group_commit, schema
from study_server.storage.database import Database, open_database
from study_server.storage.engines import sqlite_url
from study_server.storage.group_commit import GROUP_WORKS


@pytest.fixture
def lite(tmp_path: Path) -> Iterator[Database]:
    database = open_database(sqlite_url(tmp_path / "lite.sqlite"))
    yield database
    database.close()


@contextmanager
def line_behind(database: Database) -> Iterator[None]:
    """SQLite's writer is busy as long as the block runs: what it asks for stands in line."""
    begun, ended = threading.Event(), threading.Event()

    def hold() -> None:
        with database.writing():
            begun.set()
            ended.wait()

    thread = threading.Thread(target=hold)
    thread.start()
    begun.wait()
    try:
        yield
    finally:
        ended.set()
        thread.join()


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """A group is never too slow to take in one more, however busy this machine is."""
    monkeypatch.setattr(group_commit, "GROUP_S", 60.0)


def commits_of(database: Database) -> list[int]:
    """Grows with each commit: how many rows there are then."""
    rows: list[int] = []

    @event.listens_for(database.engine, "commit")
    def note(connection: Connection) -> None:
        rows.append(connection.scalar(select(func.count()).select_from(schema.meta)) or 0)

    return rows


@pytest.mark.usefixtures("patient")
def test_who_waits_together_shares_a_commit(lite: Database) -> None:
    with line_behind(lite):
        futures = [lite.submit(adding(str(number))) for number in range(GROUP_WORKS)]
        rows = commits_of(lite)
    assert [future.result() for future in futures] == [str(number) for number in range(GROUP_WORKS)]
    assert [after - before for before, after in pairwise(rows)] == [GROUP_WORKS]


@pytest.mark.usefixtures("patient")
def test_a_group_is_bounded(lite: Database) -> None:
    with line_behind(lite):
        futures = [lite.submit(adding(str(number))) for number in range(2 * GROUP_WORKS + 1)]
        rows = commits_of(lite)
    for future in futures:
        future.result()
    assert [after - before for before, after in pairwise(rows)] == [GROUP_WORKS, GROUP_WORKS, 1]


def test_a_slow_work_takes_nobody_with_it(lite: Database) -> None:
    def slow(_: Connection) -> None:
        until = time.monotonic() + 1.5 * group_commit.GROUP_S
        while time.monotonic() < until:
            pass

    with line_behind(lite):
        futures = [lite.submit(slow), lite.submit(adding("late"))]
        rows = commits_of(lite)
    assert futures[1].result() == "late"
    assert [after - before for before, after in pairwise(rows)] == [0, 1]


def test_nobody_is_answered_before_the_commit(lite: Database, tmp_path: Path) -> None:
    reached, go = threading.Event(), threading.Event()

    @event.listens_for(lite.engine, "commit")
    def wait(_: Connection) -> None:
        reached.set()
        go.wait()

    futures = [lite.submit(adding("kept")), lite.submit(refused("not kept"))]
    reached.wait()
    assert not any(future.done() for future in futures)
    go.set()
    assert futures[0].result() == "kept"
    other = sqlite3.connect(tmp_path / "lite.sqlite")
    assert ("kept",) in other.execute("SELECT key FROM meta").fetchall()
    other.close()


@pytest.mark.usefixtures("patient")
def test_a_commit_that_fails_is_everybodys_error(lite: Database) -> None:
    def breaks_the_commit(connection: Connection) -> None:
        connection.execute(text("PRAGMA defer_foreign_keys = ON"))
        values = {"session": "nobody", "at": 0.0, "kind": "x", "detail": {}}
        connection.execute(insert(schema.events).values(values))

    with line_behind(lite):
        futures = [lite.submit(work) for work in (adding("a"), breaks_the_commit, refused("b"))]
    assert all(isinstance(future.exception(), IntegrityError) for future in futures)
    assert keys(lite) == set()
    assert lite.write(adding("c")) == "c"


@pytest.mark.usefixtures("patient")
def test_a_transaction_that_sqlite_gives_up_is_everybodys_error(lite: Database) -> None:
    def given_up(connection: Connection) -> None:
        connection.exec_driver_sql("ROLLBACK")  # as SQLite may do by itself when a write fails
        raise MemoryError

    with line_behind(lite):
        futures = [lite.submit(work) for work in (adding("a"), given_up, adding("b"))]
    assert [type(future.exception()) for future in futures[:2]] == [MemoryError, MemoryError]
    assert futures[2].result() == "b"
    assert keys(lite) == {"b"}


@pytest.mark.usefixtures("patient")
def test_with_no_room_left_what_was_acknowledged_is_there_and_nothing_else(lite: Database) -> None:
    with lite.engine.connect() as connection:
        pages = connection.exec_driver_sql("PRAGMA page_count").scalar_one()
    limit = [pages + 2]
    event.listen(lite.engine, "begin", lambda c: c.exec_driver_sql(f"PRAGMA max_page_count={limit[0]}"))
    with line_behind(lite):
        futures = [lite.submit(adding(str(size), "x" * size)) for size in (1, 100_000, 2)]
    acknowledged = {future.result() for future in futures if future.exception() is None}
    assert isinstance(futures[1].exception(), OperationalError)
    assert keys(lite) == acknowledged
    limit[0] = 100_000
    assert lite.write(adding("large", "x" * 100_000)) == "large"


def test_order_of_asking_is_order_of_writing(lite: Database) -> None:
    order: list[str] = []

    def noting(name: str) -> Work:
        return lambda _: order.append(name)

    def alone() -> None:
        with lite.writing():
            order.append("alone")

    with line_behind(lite):
        lite.submit(noting("before"))
        thread = threading.Thread(target=alone)
        thread.start()
        while len(lite.writer.line.waiting) < 2:
            time.sleep(0.001)
        lite.submit(noting("after"))
    thread.join()
    lite.write(noting("last"))
    assert order == ["before", "alone", "after", "last"]


def test_a_transaction_inside_a_transaction_is_an_error_and_no_deadlock(lite: Database) -> None:
    with lite.writing(), pytest.raises(RuntimeError, match="inside a transaction"):
        lite.write(adding("never"))
    with pytest.raises(RuntimeError, match="inside a transaction"):
        lite.write(lambda _: lite.write(adding("never")))
    assert lite.write(adding("then")) == "then"


def test_another_process_that_writes_is_waited_for(lite: Database, tmp_path: Path) -> None:
    other = sqlite3.connect(tmp_path / "lite.sqlite", isolation_level=None, check_same_thread=False)
    other.execute("BEGIN IMMEDIATE")
    future = lite.submit(adding("mine"))
    other.execute("INSERT INTO meta VALUES ('theirs', '')")
    other.execute("COMMIT")
    assert future.result() == "mine"
    other.close()
    assert keys(lite) == {"mine", "theirs"}


def test_a_database_that_is_gone_is_an_error_not_a_wait(lite: Database) -> None:
    with lite.writing() as connection:
        schema.meta.drop(connection)
    with pytest.raises(DatabaseError):
        lite.write(adding("nowhere"))
