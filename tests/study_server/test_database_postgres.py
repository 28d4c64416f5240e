"""PostgreSQL: addresses, sessions as we need them, and transactions that end in something other than success."""

import subprocess
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import pytest
from postgres_server import PASSWORD, PostgresServer
from sqlalchemy import Connection, event, insert, select, text, update
from sqlalchemy.exc import DatabaseError, OperationalError

from fakesss.problem import BadInput
from study_server.announcement import warnings
from study_server.storage import schema
from study_server.storage.database import Database, is_writable, open_database, remembered
from study_server.storage.retries import TRIES

values = schema.meta.c.value


@pytest.fixture
def database(postgres_url: str) -> Iterator[Database]:
    database = open_database(postgres_url)
    yield database
    database.close()


def add(connection: Connection, key: str, value: str = "") -> str:
    connection.execute(insert(schema.meta).values(key=key, value=value))
    return key


def value(database: Database, key: str) -> str | None:
    with database.reading() as connection:
        return connection.scalar(select(values).where(schema.meta.c.key == key))


def shown(database: Database, setting: str) -> str:
    with database.reading() as connection:
        return str(connection.scalar(text(f"SHOW {setting}")))


def lose(connection: Connection, server: PostgresServer) -> None:
    """The server drops this connection."""
    server.execute(f"SELECT pg_terminate_backend({connection.scalar(text('SELECT pg_backend_pid()'))})")


@pytest.mark.parametrize("scheme", ["postgres", "postgresql", "postgresql+psycopg"])
def test_every_usual_spelling_of_the_address(postgres_url: str, scheme: str) -> None:
    database = open_database(postgres_url.replace("postgresql+psycopg", scheme))
    assert is_writable(database)
    database.close()


def test_without_the_driver_one_sentence_says_what_to_install(postgres_url: str) -> None:
    program = """
import sys
sys.modules["psycopg"] = None
from fakesss.problem import BadInput
from study_server.storage.database import open_database
try:
    open_database(sys.argv[1])
except BadInput as problem:
    print(problem)
"""
    said = subprocess.run([sys.executable, "-c", program, postgres_url], capture_output=True, text=True, check=True)
    assert said.stdout.strip().endswith("needs psycopg; install it with: pip install 'fakesss[postgres]'")
    assert PASSWORD not in said.stdout


@pytest.mark.parametrize(
    ("change", "said"),
    [(":{port}/", "cannot be opened for writing .*refused"), ("survey:", "cannot be opened for writing .*password")],
)
def test_a_server_that_cannot_be_used(postgres: PostgresServer, change: str, said: str) -> None:
    postgres.start()
    wrong = {":{port}/": (f":{postgres.port}/", ":9/"), "survey:": (PASSWORD, "wrong-password")}[change]
    with pytest.raises(BadInput, match=said) as caught:
        open_database(postgres.url().replace(*wrong))
    assert PASSWORD not in str(caught.value)
    assert "wrong-password" not in str(caught.value)


@pytest.mark.parametrize("url", ["sqlite://", "sqlite:///:memory:", "mysql://root@localhost/x"])
def test_an_address_we_cannot_keep_answers_at(url: str) -> None:
    with pytest.raises(BadInput, match=r"names no file|neither SQLite nor PostgreSQL"):
        open_database(url)


@pytest.mark.parametrize(("server", "ours"), [("off", "on"), ("remote_apply", "remote_apply")])
def test_a_commit_waits_for_the_disk_whatever_the_server_is_set_to(
    postgres: PostgresServer, postgres_url: str, server: str, ours: str
) -> None:
    name = postgres_url.rpartition("/")[2]
    postgres.execute(f"ALTER DATABASE {name} SET synchronous_commit = {server}")
    database = open_database(postgres_url)
    assert shown(database, "synchronous_commit") == ours
    database.close()


def test_a_server_that_does_not_wait_for_its_disk_is_warned_of(database: Database) -> None:
    assert warnings(database, is_local=True, has_proxies=False) == []


def test_nothing_is_waited_for_without_end(database: Database) -> None:
    limits = ("statement_timeout", "lock_timeout", "idle_in_transaction_session_timeout")
    assert [shown(database, limit) for limit in limits] == ["5min", "30s", "15min"]


def test_readers_cannot_write(database: Database) -> None:
    with database.reading() as connection, pytest.raises(DatabaseError, match="read-only transaction"):
        add(connection, "never")


def test_a_deadlock_is_tried_again(database: Database) -> None:
    database.write(lambda connection: (add(connection, "a", "0"), add(connection, "b", "0")))
    both = threading.Barrier(2)
    runs: list[str] = []

    def cross(first: str, second: str) -> None:
        def work(connection: Connection) -> None:
            runs.append(first)
            for key in (first, second):
                connection.execute(
                    update(schema.meta).where(schema.meta.c.key == key).values(value=values.concat(first))
                )
                if len(runs) <= 2 and key == first:
                    both.wait()

        database.write(work)

    with ThreadPoolExecutor(2) as pool:
        list(pool.map(cross, "ab", "ba"))
    assert len(runs) == 3
    assert sorted(str(value(database, "a"))) == sorted(str(value(database, "b"))) == ["0", "a", "b"]


def test_a_race_for_one_key_finds_the_winners_row(database: Database) -> None:
    both = threading.Barrier(2)
    runs: list[int] = []

    def find_or_add(number: int) -> str:
        def work(connection: Connection) -> str:
            runs.append(number)
            found = connection.scalar(select(values).where(schema.meta.c.key == "one"))
            if found is None:
                both.wait()
                add(connection, "one", str(number))
            return found or str(number)

        return database.write(work)

    with ThreadPoolExecutor(2) as pool:
        assert len(set(pool.map(find_or_add, (1, 2)))) == 1
    assert len(runs) == 3


def test_what_fails_for_good_fails_after_a_few_tries(database: Database) -> None:
    runs: list[int] = []

    def work(connection: Connection) -> None:
        runs.append(1)
        add(connection, "schema_version")

    with pytest.raises(DatabaseError):
        database.write(work)
    assert len(runs) == TRIES


def test_a_connection_lost_before_the_commit_is_tried_again(database: Database, postgres: PostgresServer) -> None:
    runs: list[int] = []

    def work(connection: Connection) -> str:
        runs.append(1)
        if len(runs) == 1:
            add(connection, "lost")
            lose(connection, postgres)
        return add(connection, "kept")

    assert database.write(work) == "kept"
    assert len(runs) == 2
    assert (value(database, "lost"), value(database, "kept")) == (None, "")


def test_a_connection_lost_at_the_commit_is_no_success_and_no_second_run(
    database: Database, postgres: PostgresServer
) -> None:
    runs: list[int] = []

    def work(connection: Connection) -> str:
        runs.append(1)
        event.listen(connection, "commit", lambda c: lose(c, postgres))
        return add(connection, "unknown")

    with pytest.raises(OperationalError):
        database.write(work)
    assert runs == [1]
    assert database.write(lambda connection: remembered(connection, "unknown", lambda: "again")) == "again"


def test_a_server_that_was_restarted_is_found_again(database: Database, postgres: PostgresServer) -> None:
    database.write(lambda connection: add(connection, "before"))
    postgres.kill()
    assert not is_writable(database)
    postgres.start()
    assert is_writable(database)
    assert value(database, "before") == ""
