"""Writes on both databases: answered when on disk, alone in failure, never half."""

import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import pytest
from database_works import adding, keys, refused
from sqlalchemy import func, select
from sqlalchemy.exc import IntegrityError

from study_server.storage import schema
from study_server.storage.database import Database, open_database, reason, remembered


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    database = open_database(database_url)
    yield database
    database.close()


def test_what_fails_undoes_itself_and_nobody_else(database: Database) -> None:
    def one(number: int) -> str:
        try:
            return str(database.write((refused if number % 3 == 0 else adding)(str(number))))
        except ValueError as error:
            return f"refused {error}"

    with ThreadPoolExecutor(20) as pool:
        said = list(pool.map(one, range(200)))
    assert said == [f"refused {n}" if n % 3 == 0 else str(n) for n in range(200)]
    assert keys(database) == {str(n) for n in range(200) if n % 3}


def test_the_same_key_from_many_at_once_is_stored_once(database: Database) -> None:
    with ThreadPoolExecutor(10) as pool:
        futures = [pool.submit(database.write, adding("same", str(number))) for number in range(10)]
    assert sorted(type(future.exception()) is IntegrityError for future in futures) == [False] + [True] * 9


def test_a_snapshot_does_not_move(database: Database) -> None:
    count = select(func.count()).select_from(schema.meta)
    with database.reading() as connection:
        before = connection.scalar(count)
        database.write(adding("new"))
        assert connection.scalar(count) == before
    assert "new" in keys(database)


def test_first_uses_race_to_one_value(database_url: str) -> None:
    def one(number: int) -> str:
        database = open_database(database_url)
        with database.writing() as connection:
            value = remembered(connection, "salt", lambda: number)
        database.close()
        return value

    with ThreadPoolExecutor(8) as pool:
        assert len(set(pool.map(one, range(8)))) == 1


def test_errors_hold_no_values(database: Database) -> None:
    database.write(adding("secret-token", "secret-answer"))
    with pytest.raises(IntegrityError) as caught:
        database.write(adding("secret-token", "secret-answer"))
    assert "secret-answer" not in str(caught.value)
    assert "secret" not in reason(caught.value)


def test_closing_writes_what_waits_and_a_later_use_opens_again(database: Database) -> None:
    futures = [database.submit(adding(str(number))) for number in range(200)]
    database.close()
    assert all(future.done() for future in futures)
    assert len(keys(database)) == 200
    assert database.write(adding("later")) == "later"


@pytest.mark.parametrize("ending", ["", "del database", "database.close()"])
def test_a_process_that_ends_has_written_what_waited(database_url: str, ending: str) -> None:
    program = f"""
import sys
from sqlalchemy import insert
from study_server.storage import group_commit, schema
from study_server.storage.database import open_database
database = open_database(sys.argv[1])
for number in range(300):
    values = {{"key": f"row {{number}}", "value": ""}}
    database.submit(lambda connection, values=values: connection.execute(insert(schema.meta).values(values)).rowcount)
{ending}
"""
    subprocess.run([sys.executable, "-c", program, database_url], check=True, timeout=60)
    assert len(keys(open_database(database_url))) == 300
