"""The server process of the tests: killed, started again at the same address, and gone with a killed test run."""

import subprocess
import sys
import time
from pathlib import Path

import httpx
import pytest
from server_process import NotStarted, ServerProcess, server_process
from study_fixture import write_study

from study_server.storage.engines import sqlite_url


def test_killed_and_started_again_at_the_same_address(tmp_path: Path) -> None:
    study = write_study(tmp_path / "study")
    options = {"mode": "pilot", "database_url": sqlite_url(tmp_path / "x.sqlite")}
    with server_process(study, tmp_path / "log", **options) as server:
        server.kill()
        with pytest.raises(httpx.ConnectError):
            httpx.get(server.url)
        server.start()
        assert httpx.get(f"{server.url}/health").status_code == 200
        server.stop()
    assert server.said().count("(pilot)") == 2
    assert (tmp_path / "x.sqlite").exists()


def test_what_keeps_it_from_starting_is_said(tmp_path: Path) -> None:
    server = ServerProcess(tmp_path, tmp_path / "log")
    with pytest.raises(NotStarted, match="BadInput"):
        server.start()


def test_the_server_goes_with_a_killed_test_run(tmp_path: Path) -> None:
    study = write_study(tmp_path / "study")
    program = f"""
from pathlib import Path
from server_process import server_process
with server_process(Path({str(study)!r}), Path({str(tmp_path / "log")!r})) as server:
    print(server.url, flush=True)
    input()
"""
    with subprocess.Popen(
        [sys.executable, "-c", program],
        cwd=Path(__file__).parent, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    ) as run:  # fmt: skip
        assert run.stdout is not None
        url = run.stdout.readline().strip()
        assert httpx.get(f"{url}/health").status_code == 200
        run.kill()
    end = time.monotonic() + 30
    while time.monotonic() < end:
        try:
            httpx.get(f"{url}/health")
        except httpx.TransportError:
            return
        time.sleep(0.05)
    raise AssertionError("it still answers")
