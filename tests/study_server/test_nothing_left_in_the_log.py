"""SQLite's log: empty after a withdrawal, and after every end of the server, so that the one file is whole."""

import contextlib
import shutil
import signal
import sqlite3
from pathlib import Path

import pytest
from server_process import server_process
from study_fixture import write_study
from survey_client import Participant
from waiting import until

from study_server.serve import served

ABOUT = [{"name": "work", "text": "What do you do?"}]
PERSON = "?PROLIFIC_PID=5f00aurora42&STUDY_ID=64borealis&SESSION_ID=99cassiopeia"
NAMES = (b"5f00aurora42", b"64borealis", b"99cassiopeia", b"lighthouse keeper", b"my dog Perseus", b"Gazer/1.0")


@pytest.fixture
def talkative(tmp_path: Path) -> Path:
    """A study that asks and records more than ours do."""
    return write_study(tmp_path / "study", survey={"about": ABOUT, "record": ["address", "browser"]})


def take_part(url: str) -> Participant:
    """Somebody who tells a lot about themselves, to the end."""
    person = Participant(url, PERSON)
    person.client.headers["User-Agent"] = "Gazer/1.0"
    person.consent()
    person.post("about", work="lighthouse keeper " * 300)  # longer than a page of the file
    person.to_trials()
    while person.state["step"] == "trials":
        person.rate()
    person.post("comments", comments="This one looks like my dog Perseus.")
    return person


def withdraw(person: Participant) -> None:
    assert person.client.post(f"{person.here}/withdraw", json={"sure": "yes"}).status_code < 400


def found(study: Path) -> set[bytes]:
    """The names that are in the bytes of the database's files."""
    left = b"".join(path.read_bytes() for path in study.glob("ratings.sqlite*"))
    return {name for name in NAMES if name in left}


def log_size(study: Path) -> int:
    """Bytes of the log; 0 also if there is none."""
    log = study / "ratings.sqlite-wal"
    return log.stat().st_size if log.exists() else 0


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_after_the_end_the_file_alone_is_whole(study: Path, tmp_path: Path, number: signal.Signals) -> None:
    with server_process(study, tmp_path / "log") as server:
        for _ in range(3):
            Participant(server.url).to_trials().rate()
        server.end(number)
        assert number == signal.SIGINT or not server.unforeseen()
    assert log_size(study) == 0
    shutil.copy(study / "ratings.sqlite", tmp_path / "alone.sqlite")
    with contextlib.closing(sqlite3.connect(tmp_path / "alone.sqlite")) as alone:
        assert alone.execute("SELECT count(*) FROM sessions").fetchone() == (3,)
        assert alone.execute("SELECT count(*) FROM ratings").fetchone()[0] > 0


def test_after_a_withdrawal_the_bytes_are_gone(talkative: Path) -> None:
    with served(talkative) as url:
        person = take_part(url)
        assert found(talkative) == set(NAMES)
        withdraw(person)
        assert found(talkative) == set()


def test_with_a_reader_they_go_when_it_has_read(talkative: Path) -> None:
    """The reply does not wait for it, nor do others' answers."""
    with served(talkative) as url, contextlib.closing(sqlite3.connect(talkative / "ratings.sqlite")) as reader:
        person = take_part(url)
        reader.execute("BEGIN")
        reader.execute("SELECT count(*) FROM sessions").fetchone()
        withdraw(person)
        Participant(url).to_trials().to_end()
        assert found(talkative) == set(NAMES)
        reader.execute("COMMIT")
        until(lambda: found(talkative) == set(), 20)


def test_what_a_killed_server_could_not_remove_goes_at_the_next_start(talkative: Path, tmp_path: Path) -> None:
    with server_process(talkative, tmp_path / "log") as server:
        with contextlib.closing(sqlite3.connect(talkative / "ratings.sqlite")) as reader:
            person = take_part(server.url)
            reader.execute("BEGIN")
            reader.execute("SELECT count(*) FROM sessions").fetchone()
            withdraw(person)
            server.kill()
            assert found(talkative) == set(NAMES)
        server.start()
        until(lambda: found(talkative) == set(), 20)
