"""A backup taken while people rate restores whole, and says what it is."""

import json
import os
import shutil
import sqlite3
import subprocess
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, contextmanager
from pathlib import Path

import httpx
import pytest
from click.testing import CliRunner
from postgres_server import PASSWORD, binaries
from stored import sound
from study_fixture import write_study
from survey_client import JSON, Participant
from waiting import until

import fakesss.cli_survey  # noqa: F401  (adds the command)
from fakesss.cli import commands
from fakesss.problem import BadInput
from study_server.app import admin_secret
from study_server.serve import served
from study_server.storage import backup as backups
from study_server.storage.engines import sqlite_url

Acknowledged = dict[tuple[str, int, str], int]


@contextmanager
def people_rating(url: str, raters: int) -> Iterator[Acknowledged]:
    """So many people come and rate, one after another each, while the block runs; what was acknowledged so far."""
    acknowledged: Acknowledged = {}
    over = threading.Event()

    def rate_on() -> None:
        while not over.is_set():
            person = Participant(url).to_trials()
            while person.state["step"] == "trials" and not over.is_set():
                session, place = person.state["session"], person.state["place"]
                reply = person.rate()
                acknowledged.update({(session, place, row["question"]): row["rating"] for row in reply["saved"]})

    with ThreadPoolExecutor(raters) as pool:
        walks = [pool.submit(rate_on) for _ in range(raters)]
        try:
            yield acknowledged
        finally:
            over.set()
        for walk in walks:
            walk.result()


@pytest.mark.parametrize("copies", [3, pytest.param(40, marks=pytest.mark.long)])
def test_a_backup_under_load_restores_whole(study: Path, tmp_path: Path, copies: int) -> None:
    restored = shutil.copytree(study, tmp_path / "restored")
    with served(study) as url, httpx.Client(base_url=url, timeout=60) as admin:
        admin.headers["Authorization"] = f"Bearer {admin_secret(study)}"
        away = Participant(url).to_trials()
        away.rate(6)
        with people_rating(url, raters=4) as acknowledged:
            for copy in range(1, copies + 1):
                until(lambda least=20 * copy: len(acknowledged) > least)  # type: ignore[misc]
                before = dict(acknowledged)
                response = admin.get("/admin/backup")
                at_the_end = len(acknowledged)
                assert response.status_code == 200
                (restored / "ratings.sqlite").write_bytes(response.content)
                held = sound(sqlite_url(restored / "ratings.sqlite"))  # whole trials only, no row without its session
                kept = {(name, *key): given[0] for name in held.sessions for key, given in held.answers[name].items()}
                assert {key: kept.get(key) for key in before} == before
                assert at_the_end >= len(before)
        assert not list(study.glob(".backup-*"))
    with served(restored) as url:
        away.client.base_url = httpx.URL(url)
        away.state = away.client.get(away.here).json()
        assert away.state["trial"] == 2
        assert away.to_end()
        Participant(url).to_trials().to_end()


def test_the_writer_does_not_wait_for_a_backup(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """People are answered while a copy is being made, however long that takes: here, until they have been."""
    answered = threading.Event()
    copy = backups.snapshot

    def slow(source: Path, target: Path) -> None:
        with closing(sqlite3.connect(source)) as reader:  # the snapshot that VACUUM INTO reads is held all the while
            reader.execute("BEGIN")
            reader.execute("SELECT count(*) FROM ratings").fetchone()
            assert answered.wait(60)
            copy(source, target)

    monkeypatch.setattr(backups, "snapshot", slow)
    with served(study) as url, ThreadPoolExecutor() as pool:
        person = Participant(url).to_trials()
        headers = {"Authorization": f"Bearer {admin_secret(study)}"}
        copying = pool.submit(httpx.get, f"{url}/admin/backup", headers=headers, timeout=60)
        person.rate()
        answered.set()
        assert copying.result().status_code == 200


def test_only_who_brings_the_secret_gets_one(url: str, study: Path) -> None:
    assert httpx.get(f"{url}/admin/backup", headers=JSON).status_code == 401
    response = httpx.get(f"{url}/admin/backup", headers={"Authorization": f"Bearer {admin_secret(study)}"})
    assert response.headers["cache-control"] == "no-store"
    assert "attachment" in response.headers["content-disposition"]
    assert int(response.headers["content-length"]) == len(response.content)
    assert response.content.startswith(b"SQLite format 3\0")


def test_the_command_copies_and_replaces_nothing(url: str, study: Path, tmp_path: Path) -> None:
    Participant(url).to_trials().rate()
    out = tmp_path / "monday.sqlite"
    result = CliRunner().invoke(commands, ["backup", str(study), "-o", str(out), "--json"])
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout) == {"file": str(out), "bytes": out.stat().st_size}
    assert out.stat().st_mode & 0o077 == 0, "it holds secrets"
    assert len(sound(sqlite_url(out)).sessions) == 1
    before = out.read_bytes()
    with pytest.raises(BadInput, match="is there already"):
        backups.backup(study, out)
    assert out.read_bytes() == before
    named = Path(backups.backup(study)["file"])
    assert named.parent == study and named.name.startswith("ratings-")


def test_what_is_no_sound_database_gives_no_backup(tmp_path: Path) -> None:
    study = write_study(tmp_path / "study")
    with pytest.raises(BadInput, match="no such file; nobody has been served this study yet"):
        backups.backup(study)
    with served(study) as url:
        Participant(url).to_trials().to_end()
    file = study / "ratings.sqlite"
    with pytest.raises(BadInput, match=r"the folder .* does not exist|cannot be written"):
        backups.backup(study, tmp_path / "nowhere" / "copy.sqlite")
    data = bytearray(file.read_bytes())
    with closing(sqlite3.connect(file)) as connection:
        connection.execute("PRAGMA foreign_keys = OFF")
        connection.execute("DELETE FROM sessions")
        connection.commit()
    with pytest.raises(BadInput, match=r"is damaged .a row of .* belongs to nothing"):
        backups.backup(study, tmp_path / "copy.sqlite")
    data[4096 * 3 : 4096 * 6] = os.urandom(4096 * 3)
    file.write_bytes(data)
    with pytest.raises(BadInput, match=r"cannot be copied|is damaged"):
        backups.backup(study, tmp_path / "copy.sqlite")
    file.write_text("a diary")
    with pytest.raises(BadInput, match="file is not a database"):
        backups.backup(study, tmp_path / "copy.sqlite")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["study"]


def test_postgresql_is_told_its_own_command_which_works(postgres_url: str, tmp_path: Path) -> None:
    """The very command that is printed makes a dump, given the password by the environment."""
    study = write_study(tmp_path / "study")
    with served(study, database_url=postgres_url) as url:
        Participant(url).to_trials().rate()
        headers = {**JSON, "Authorization": f"Bearer {admin_secret(study, postgres_url)}"}
        response = httpx.get(f"{url}/admin/backup", headers=headers)
    assert response.status_code == 409
    with pytest.raises(BadInput) as told:
        backups.backup(study, database_url=postgres_url)
    assert response.json()["error"] == str(told.value)
    assert PASSWORD not in str(told.value)
    command = str(told.value).partition("run: ")[2].split()
    environment = {**os.environ, "PGPASSWORD": PASSWORD}
    subprocess.run([binaries() / command[0], *command[1:]], cwd=tmp_path, env=environment, check=True)
    listed = subprocess.run(
        [binaries() / "pg_restore", "--list", "ratings.dump"], cwd=tmp_path, check=True, capture_output=True, text=True
    )
    assert "TABLE DATA public ratings" in listed.stdout
