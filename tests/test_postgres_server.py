"""The tests' own PostgreSQL: real, durable, empty for each test."""

import subprocess
import sys
import time
from pathlib import Path

import psycopg
import pytest
from postgres_server import PostgresServer
from sqlalchemy import create_engine, text


def test_each_database_is_empty_and_of_its_kind(database_url: str) -> None:
    engine = create_engine(database_url)
    with engine.begin() as connection:
        connection.execute(text("CREATE TABLE seen (number INTEGER)"))  # fails where another test's table is left
        connection.execute(text("INSERT INTO seen VALUES (1)"))
        assert connection.scalar(text("SELECT count(*) FROM seen")) == 1
    engine.dispose()
    assert engine.dialect.name == database_url.split(":")[0].split("+")[0]


def test_what_was_committed_survives_a_crash_and_nothing_else_does(postgres: PostgresServer, postgres_url: str) -> None:
    address = postgres_url.replace("+psycopg", "")
    connection = psycopg.connect(address)
    durability = [connection.execute(f"SHOW {name}").fetchone() for name in ("fsync", "synchronous_commit")]
    connection.execute("CREATE TABLE seen (number INTEGER)")
    connection.execute("INSERT INTO seen VALUES (1)")
    connection.commit()
    connection.execute("INSERT INTO seen VALUES (2)")
    postgres.kill()
    with pytest.raises(psycopg.OperationalError):
        connection.commit()
    connection.close()
    with pytest.raises(psycopg.OperationalError):
        psycopg.connect(address)
    postgres.start()
    with psycopg.connect(address) as after:
        assert after.execute("SELECT number FROM seen").fetchall() == [(1,)]
    assert durability == [("on",), ("on",)]


def test_the_server_goes_with_a_killed_test_run() -> None:
    program = (
        "import postgres_server as p\nwith p.postgres_server() as server: print(server.folder, flush=True); input()"
    )
    here = Path(__file__).parent
    with subprocess.Popen(
        [sys.executable, "-c", program], cwd=here, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as run:
        assert run.stdout is not None
        folder = Path(run.stdout.readline().strip())
        assert (folder / "data" / "postmaster.pid").exists()
        run.kill()
    end = time.monotonic() + 30
    while folder.exists():
        assert time.monotonic() < end
        time.sleep(0.05)
