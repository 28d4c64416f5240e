"""50 writers at once, no "database is locked", also while another program reads or writes the same SQLite file."""

import contextlib
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from at_once import at_once
from stored import sound
from study_fixture import write_study
from survey_client import Participant

from study_server.serve import served
from study_server.storage import engines
from study_server.storage.database import default_url
from study_server.storage.engines import sqlite_url

HOLD = """
import sqlite3, sys
connection = sqlite3.connect(sys.argv[1], isolation_level=None)
connection.execute(sys.argv[2])
connection.execute("SELECT count(*) FROM ratings").fetchall()
print("holds", flush=True)
sys.stdin.read()
connection.execute("COMMIT")
"""


@contextlib.contextmanager
def holding(database: Path, begin: str, seconds: float = 2.0) -> Iterator[None]:
    """Another program with a transaction open on the file for so long, and at least until the block begins."""
    command = [sys.executable, "-c", HOLD, str(database), begin]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as program:
        assert program.stdout is not None
        assert program.stdin is not None
        assert program.stdout.readline() == "holds\n"
        letting_go = threading.Timer(seconds, program.stdin.close)
        letting_go.start()
        try:
            yield
        finally:
            letting_go.join()
    assert program.returncode == 0


@contextlib.contextmanager
def running(*command: str | Path) -> Iterator[None]:
    """Another program that does its work beside the block, and ends well."""
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as program:
        yield
        said = program.communicate()[1]
    assert program.returncode == 0, said


def test_fifty_writers_and_another_program(tmp_path: Path) -> None:
    study = write_study(tmp_path / "study", 6)
    database = study / "ratings.sqlite"
    neighbours = [
        contextlib.nullcontext(),
        holding(database, "BEGIN IMMEDIATE"),
        holding(database, "BEGIN"),
        running(sys.executable, "-m", "fakesss", "export", study, "-o", tmp_path / "export"),
        running("sqlite3", database, f".backup {tmp_path / 'copy.sqlite'}"),
        running("sqlite3", database, "VACUUM"),
    ]
    with served(study) as url:
        people = [Participant(url).to_trials() for _ in range(50)]
        for neighbour in neighbours:
            with neighbour:
                replies = at_once(url, [(f"{person.here}/ratings", person.answers()) for person in people])
            assert [reply.status for reply in replies] == [200] * 50
            for person, reply in zip(people, replies, strict=True):
                person.state = reply.data["next"]
        assert all(person.to_end() for person in people)
    stored = sound(default_url(study))
    assert sum(map(len, stored.answers.values())) == 50 * 7 * 2
    sound(sqlite_url(tmp_path / "copy.sqlite"))


def test_a_program_that_never_lets_go_is_told_to_the_participant_and_no_more(
    study: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Somebody has the file open in a database browser, with a change that is not saved."""
    monkeypatch.setattr(engines, "BUSY_TIMEOUT_S", 0.2)
    with served(study) as url:
        person = Participant(url).to_trials()
        with holding(study / "ratings.sqlite", "BEGIN IMMEDIATE", seconds=1.0):
            reply = person.send(person.answers())
            assert reply.status_code == 503
            assert reply.json()["error"] == "This could not be saved just now; please try again in a moment."
            assert person.client.get("/health").status_code == 503
            assert person.client.get(person.here).json()["trial"] == 1
        assert person.send(person.answers()).status_code == 200
    sound(default_url(study))
