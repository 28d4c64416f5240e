"""After the retention date: who people were is gone from the tables and the files' bytes; what they rated stays."""

import json
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import httpx
import psycopg
import pytest
from click.testing import CliRunner
from stored import sound
from study_fixture import write_study
from survey_client import JSON, Participant
from waiting import until

import fakesss.cli_survey  # noqa: F401  (adds the command)
from fakesss.cli import commands
from fakesss.problem import BadInput
from study_server.app import admin_secret
from study_server.exports.export import export_ratings
from study_server.serve import served
from study_server.storage import schema
from study_server.storage.database import default_url, open_database, secret
from study_server.storage.engines import parsed_url
from study_server.storage.forget import forget, scrub_file

ABOUT_FIELDS = [
    {"name": "age", "text": "Age?", "choices": ["18-24", "25-34"]},
    {"name": "work", "text": "What do you do?"},
]
SURVEY = {"about": ABOUT_FIELDS, "record": ["address", "browser"], "retention_until": "2020-01-31"}
PERSON = "?PROLIFIC_PID=5f00aurora42&STUDY_ID=64borealis&SESSION_ID=99cassiopeia"
NAMES = ("5f00aurora42", "64borealis", "99cassiopeia", "lighthouse keeper", "my dog Perseus", "Gazer/1.0")
Exported = Callable[..., list[dict[str, str]]]


def take_part(url: str) -> Participant:
    """Somebody from a recruiting service who tells a lot about themselves."""
    person = Participant(url, PERSON)
    person.client.headers["User-Agent"] = "Gazer/1.0"
    person.consent()
    person.post("about", age="25-34", work="lighthouse keeper")
    while person.state["step"] not in ("comments", "done"):
        if person.state["step"] in ("practice", "trials"):
            person.rate()
        else:
            person.post(person.state["step"])
    person.post("comments", comments="This one looks like my dog Perseus.")
    return person


def everything(database_url: str) -> str:
    """All rows of all tables as text, read without our code."""
    names = [table.name for table in schema.tables.sorted_tables]
    if database_url.startswith("sqlite"):
        with closing(sqlite3.connect(str(parsed_url(database_url).database))) as file:
            return repr([file.execute(f"SELECT * FROM {name}").fetchall() for name in names])
    with psycopg.connect(database_url.replace("+psycopg", "")) as connection:
        return repr([connection.execute(f"SELECT * FROM {name}".encode()).fetchall() for name in names])


def bytes_of(study: Path) -> bytes:
    """The database's files, whatever there is of them."""
    return b"".join(path.read_bytes() for path in sorted(study.glob("ratings.sqlite*")))


def admin_page(study: Path, url: str, database_url: str | None = None) -> dict[str, Any]:
    headers = {**JSON, "Authorization": f"Bearer {admin_secret(study, database_url)}"}
    page: dict[str, Any] = httpx.get(f"{url}/admin", headers=headers).json()
    return page


def test_names_go_and_ratings_stay(tmp_path: Path, database_url: str) -> None:
    study = write_study(tmp_path / "study", survey=SURVEY)
    with served(study, database_url=database_url) as url:
        person = take_part(url)
        code = person.state["completion_code"]
        page = admin_page(study, url, database_url)
        assert page["retention"] == {"until": "2020-01-31", "is_past": True, "forgotten": None}
    named = everything(database_url)
    assert all(name in named for name in (*NAMES, code, person.here.removeprefix("/s/")))
    before = sound(database_url)
    told = forget(study, database_url)
    assert (told["sessions"], told["ratings_kept"]) == (1, 8)
    left = everything(database_url)
    assert [name for name in (*NAMES, code, person.here.removeprefix("/s/")) if name in left] == []
    assert "25-34" in left
    (session,) = before.sessions
    database = open_database(database_url)
    with database.reading() as connection:
        assert len(connection.execute(schema.ratings.select().where(schema.ratings.c.session == session)).all()) == 8
    database.close()
    with served(study, database_url=database_url) as url:
        page = admin_page(study, url, database_url)
        assert page["retention"]["forgotten"] and page["gate"]["state"] == "closed"
        assert (page["finished"], page["ratings"]) == (1, 6)
        assert httpx.get(f"{url}{person.here}", headers=JSON).status_code == 404


def test_a_pseudonym_cannot_be_reckoned_again(study: Path, csv_rows: Exported) -> None:
    with served(study) as url:
        take_part_plainly(url)
        before = csv_rows(study, url, "participants")[0]
    old = secrets_of(study)
    forget(study)
    with served(study) as url:
        assert not old & secrets_of(study)
        after = csv_rows(study, url, "participants")[0]
        assert csv_rows(study, url, "ratings")[0]["rating"] == "4"
    assert after["participant"] != before["participant"]
    assert after["session"] == before["session"]


def secrets_of(study: Path) -> set[str]:
    """What pseudonyms and addresses are made with."""
    database = open_database(default_url(study))
    return {secret(database, "salt"), secret(database, "signing_key")}


def take_part_plainly(url: str) -> None:
    """Somebody from a recruiting service, in a study with the usual questions."""
    Participant(url, PERSON).to_trials().to_end()


@pytest.mark.parametrize("is_served", [True, False], ids=["served", "not served"])
def test_the_bytes_are_gone_from_the_files(tmp_path: Path, is_served: bool) -> None:
    """With a server that has the files open too, and without one."""
    study = write_study(tmp_path / "study", survey=SURVEY)
    with served(study) as url:
        token = take_part(url).here.removeprefix("/s/")
        if is_served:
            forget(study)
            assert httpx.get(f"{url}/health").json()["gate"] == "closed"
            assert gone(study, token)
    if not is_served:
        assert not gone(study, token)
        forget(study)
    assert gone(study, token)


def test_what_another_program_deleted_goes_too(study: Path) -> None:
    """Other programs leave deleted bytes in free pages."""
    with served(study) as url:
        take_part_plainly(url)
    with closing(sqlite3.connect(study / "ratings.sqlite")) as other:
        other.execute("PRAGMA secure_delete = OFF")
        other.execute("UPDATE sessions SET comments = ?", ("the lighthouse keeper " * 1000,))
        other.commit()
        other.execute("UPDATE sessions SET comments = NULL")
        other.commit()
    assert b"lighthouse keeper" in bytes_of(study)
    forget(study)
    assert b"lighthouse keeper" not in bytes_of(study)


def gone(study: Path, token: str) -> bool:
    """Whether no name is in the files; half of them would be an error of this test."""
    found = [name in bytes_of(study) for name in (name.encode() for name in (*NAMES, token))]
    assert len(set(found)) == 1, found
    return not any(found)


def test_a_reader_that_holds_old_bytes_is_told_of(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("study_server.storage.forget.BUSY_TIMEOUT_S", 0.2)
    with served(study) as url:
        take_part_plainly(url)
    file = study / "ratings.sqlite"
    with closing(sqlite3.connect(file)) as reader:
        reader.execute("BEGIN")
        reader.execute("SELECT count(*) FROM sessions").fetchone()
        with pytest.raises(BadInput, match=r"old bytes are still in the files .*; stop it and run this again"):
            forget(study)
    scrub_file(str(file))
    assert b"5f00aurora42" not in bytes_of(study)


def test_the_command_asks_first(study: Path) -> None:
    run = CliRunner().invoke
    missing = run(commands, ["forget", str(study), "--yes"])
    assert isinstance(missing.exception, BadInput) and not (study / "ratings.sqlite").exists()
    with served(study) as url:
        take_part_plainly(url)
    said_no = run(commands, ["forget", str(study)], input="n\n")
    assert "nothing was deleted" in str(said_no.exception)
    assert b"5f00aurora42" in bytes_of(study)
    result = run(commands, ["forget", str(study), "--json"], input="y\n")
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["sessions"] == 1
    assert "1 sessions: delete what could name people, and STUDY/report, for good?" in result.stderr
    assert b"5f00aurora42" not in bytes_of(study)
    assert run(commands, ["forget", str(study), "--yes"]).exit_code == 0


def copies_of(study: Path) -> list[Path]:
    """The report's tables as they lie in the study's folder, and an export."""
    folders = [study / "report" / "data", study / "report" / "pilot" / "data", study / "export"]
    for folder in folders:
        export_ratings(study, folder)
    (study / "report" / "index.html").write_text("what people said")
    return folders


def test_the_report_goes_and_exports_are_named(tmp_path: Path) -> None:
    study = write_study(tmp_path / "study", survey=SURVEY)
    with served(study) as url:
        take_part(url)
    copies_of(study)
    said = CliRunner().invoke(commands, ["forget", str(study), "--yes"]).output
    assert f"{study / 'report'} was deleted; fakesss report {study} writes it anew" in " ".join(said.splitlines())
    assert str(study / "export") in said and not (study / "report").exists()
    holding = [path for path in study.rglob("*") if path.is_file() and b"my dog Perseus" in path.read_bytes()]
    assert holding == [study / "export" / "participants.csv"]


def test_who_withdraws_goes_from_the_reports_tables_too(tmp_path: Path) -> None:
    study = write_study(tmp_path / "study", survey=SURVEY)
    with served(study) as url:
        person, stays = take_part(url), Participant(url, "?PROLIFIC_PID=another&STUDY_ID=64borealis").consent()
        tables = copies_of(study)[:2]
        session = person.state["session"]
        holding = [path for table in tables for path in table.glob("*.csv") if session in path.read_text()]
        assert {path.name for path in holding} >= {"participants.csv", "ratings.csv", "events.csv"}
        person.client.post(f"{person.here}/withdraw", json={"sure": "yes"})
        until(lambda: not any(session in path.read_text() for path in holding))
    for table in tables:
        left = (table / "participants.csv").read_text()
        assert stays.state["session"] in left and "Perseus" not in left
        assert len((table / "codebook.csv").read_text()) > 1000
