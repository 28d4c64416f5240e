"""One thread of linear algebra a worker, as workers fill the cores; property tests without deadline, since a busy
machine is no failure (`make test-long` draws many more examples). Databases of both kinds."""

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings
from postgres_server import PostgresServer, postgres_server

from study_server.storage.engines import sqlite_url

assert "numpy" not in sys.modules, "numpy reads the number of threads when it is imported, and was imported before"
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

settings.register_profile("usual", deadline=None)
settings.register_profile("long", deadline=None, max_examples=2000)
settings.load_profile("usual")


@pytest.fixture(scope="session")
def postgres() -> Iterator[PostgresServer]:
    """A running PostgreSQL server, one for each of pytest's processes that asks for it."""
    with postgres_server() as server:
        yield server


@pytest.fixture
def postgres_url(postgres: PostgresServer) -> Iterator[str]:
    """The address of a new empty PostgreSQL database."""
    with postgres.new_database() as url:
        yield url


@pytest.fixture(params=["sqlite", "postgres"])
def database_url(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """The address of a new empty database: the test runs once with each kind."""
    if request.param == "sqlite":
        return sqlite_url(tmp_path / "ratings.sqlite")
    return str(request.getfixturevalue("postgres_url"))
