"""kill -9 under load ("server killed 100 times"): acknowledged ratings are there, once; nobody is stuck; no early code.

On SQLite the server is killed; on PostgreSQL in turn one of two workers, their parent and PostgreSQL itself.
"""

import os
import signal
from pathlib import Path
from typing import Any

import pytest
from load import strike, under_load
from postgres_server import PostgresServer
from server_process import server_process
from study_fixture import write_study
from survey_client import Participant
from waiting import until

from study_server.serve import START_S
from study_server.storage.database import default_url


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
        # uvicorn waits START_S for the pong of a worker that is killed between its ping and its pong
        until(lambda: "fakesss: a worker waits: postgresql" in server.said(), seconds=2 * START_S)
        postgres.start()
        person.rate()  # the connection waits in line until somebody is there to answer it
        assert person.to_end()
    assert server.unforeseen() == []
