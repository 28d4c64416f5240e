"""kill -9 under load ("server killed 100 times"): acknowledged ratings are there, once; nobody is stuck; no early code.

On SQLite the server is killed; on PostgreSQL in turn one of two workers, their parent and PostgreSQL itself.
"""

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from itertools import cycle
from pathlib import Path
from typing import Any

import pytest
from postgres_server import PostgresServer
from running_survey import until
from server_process import ServerProcess, server_process
from sqlalchemy import func, select
from stored import sound
from study_fixture import write_study
from survey_client import Participant

from study_server import schema
from study_server.app import admin_secret
from study_server.database import default_url
from study_server.engines import connect
from study_server.manifest import load_study
from study_server.simulate import simulate

RATERS = 12
"""In one round, the last of whom leaves in the middle. Rounds follow each other until the last blow has fallen."""


def ratings_at(url: str) -> int:
    """How many first answers are stored. Looked up over a connection of its own, so that none is open at a kill."""
    engine = connect(url)
    with engine.connect() as connection:
        number = connection.scalar(select(func.count()).select_from(schema.ratings))
    engine.dispose()
    return number or 0


@contextmanager
def under_load(server: ServerProcess, study: Path, url: str) -> Iterator["Future[list[dict[str, Any]]]"]:
    """Simulated raters take part while the block runs, and what became of their answers is judged after it."""
    built, secret, enough = load_study(study), admin_secret(study, url), threading.Event()

    def rounds() -> list[dict[str, Any]]:
        results = []
        while not enough.is_set():
            results.append(simulate(server.url, built, secret, started=RATERS, completed=RATERS - 1, progress=False))
        return results

    with ThreadPoolExecutor(1) as pool:
        load = pool.submit(rounds)
        try:
            yield load
        finally:
            enough.set()
    results = load.result()
    for result in results:
        assert (result["started"], result["completed"]) == (RATERS, RATERS - 1)
        assert (result["lost"], result["duplicated"]) == (0, 0)
        assert result["stored"] >= result["acknowledged"] >= (RATERS - 1) * 18
    stored = sound(url)
    finished = [session for session in stored.sessions.values() if session["completion_code"]]
    assert len(finished) == len(results) * (RATERS - 1)


def strike(load: "Future[Any]", url: str, blows: Sequence[Callable[[], None]], kills: int) -> None:
    """So many blows in turn, each after a few more ratings were stored and in the middle of others."""
    for number, blow in zip(range(kills), cycle(blows)):
        enough = ratings_at(url) + 1 + number % 7
        while ratings_at(url) < enough:
            assert not load.done(), load.result()
            time.sleep(0.001 * (number % 5))
        blow()


@pytest.mark.parametrize("kills", [2, pytest.param(100, marks=[pytest.mark.long, pytest.mark.timeout(1200)])])
def test_the_server_is_killed(tmp_path: Path, kills: int) -> None:
    study = write_study(tmp_path / "study", 9)

    def blow() -> None:
        server.kill()
        server.start()

    with (
        server_process(study, tmp_path / "server.log") as server,
        under_load(server, study, default_url(study)) as load,
    ):
        strike(load, default_url(study), [blow], kills)
    assert server.said().count("Traceback") == 0


@pytest.mark.parametrize("kills", [3, pytest.param(100, marks=[pytest.mark.long, pytest.mark.timeout(1200)])])
def test_a_worker_the_parent_of_two_and_postgresql_are_killed(
    tmp_path: Path, postgres: PostgresServer, postgres_url: str, kills: int
) -> None:
    study = write_study(tmp_path / "study", 9)

    def a_worker() -> None:
        os.kill(server.workers()[0], signal.SIGKILL)

    def the_database() -> None:
        postgres.kill()
        postgres.start()

    def the_parent() -> None:
        server.kill()
        server.start()

    options: dict[str, Any] = {"database_url": postgres_url, "workers": 2}
    with (
        server_process(study, tmp_path / "server.log", **options) as server,
        under_load(server, study, postgres_url) as load,
    ):
        strike(load, postgres_url, [a_worker, the_database, the_parent], kills)
    assert server.unforeseen() == []


def test_workers_that_find_no_database_say_so_and_wait_until_it_is_back(
    study: Path, tmp_path: Path, postgres: PostgresServer, postgres_url: str
) -> None:
    with server_process(study, tmp_path / "server.log", database_url=postgres_url, workers=2) as server:
        until(lambda: len(server.workers()) == 2)
        person = Participant(server.url).to_trials()
        postgres.kill()
        for worker in server.workers():
            os.kill(worker, signal.SIGKILL)
        until(lambda: "fakesss: a worker waits: postgresql" in server.said())
        postgres.start()
        person.rate()  # the connection waits in line until somebody is there to answer it
        assert person.to_end()
    assert server.unforeseen() == []
