"""A database that is not there, is empty, or is another program's: one sentence, and nothing is made."""

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from sqlalchemy import inspect, text
from study_fixture import write_study
from survey_client import Participant

import fakesss.cli_analysis
import fakesss.cli_study
import fakesss.cli_survey  # noqa: F401  (all add their commands)
from fakesss.cli import commands
from fakesss.problem import BadInput
from study_server.app import SECRET_VARIABLE, create_app
from study_server.serve import served
from study_server.storage import schema
from study_server.storage.database import default_url, open_database
from study_server.storage.engines import connect, sqlite_url

READERS = [
    ["export"],
    ["export", "--format", "psych-ds"],
    ["report"],
    ["forget", "--yes"],
    ["simulate", "--url", "http://127.0.0.1:9"],
]


def invoked(command: list[str], study: Path, *more: str) -> Result:
    return CliRunner().invoke(commands, [command[0], str(study), *command[1:], *more])


def refused(command: list[str], study: Path, *more: str) -> str:
    before = sorted(study.parent.rglob("*"))
    result = invoked(command, study, *more)
    assert isinstance(result.exception, BadInput), result.output
    assert sorted(study.parent.rglob("*")) == before, "something was made"
    return str(result.exception)


@pytest.mark.parametrize("command", READERS)
def test_who_only_reads_makes_no_database(study: Path, command: list[str]) -> None:
    assert f"{study / 'ratings.sqlite'}: no such file" in refused(command, study)
    typo = study / "typo.sqlite"
    assert f"{typo}: no such file" in refused(command, study, "--database", sqlite_url(typo))


@pytest.mark.parametrize("command", READERS)
def test_an_empty_postgresql_database_stays_empty(study: Path, postgres_url: str, command: list[str]) -> None:
    said = refused(command, study, "--database", postgres_url)
    assert said.endswith("holds no answers; nobody has been served this study from it yet")
    engine = connect(postgres_url)
    assert inspect(engine).get_table_names() == []
    engine.dispose()


def test_simulate_makes_no_database_beside_a_study_that_was_not_built(tmp_path: Path) -> None:
    (tmp_path / "study").mkdir()
    assert "fakesss build" in refused(["simulate"], tmp_path / "study")


def test_a_secret_of_the_environment_needs_no_database(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`simulate --url` from another machine, where no database is."""
    write_study(study.parent / "elsewhere")
    with served(study.parent / "elsewhere") as url:
        monkeypatch.setenv(SECRET_VARIABLE, "a secret of the environment")
    monkeypatch.setattr("study_server.simulation.walk.PATIENCE_S", 0.0)
    assert url in refused(["simulate", "--url", url], study)


def test_an_export_without_a_session_of_its_mode_says_which_there_are(study: Path) -> None:
    with served(study, mode="pilot") as url:
        Participant(url).to_trials()
    result = invoked(["export"], study)
    assert result.exit_code == 0
    assert "holds no live session of this study; the tables have no rows of people" in result.stderr
    assert "holds 1 pilot session(s)" in result.stderr
    assert "--mode pilot" in result.stderr
    assert invoked(["export", "--mode", "pilot"], study).stderr == ""


FOREIGN = {
    "ratings": "CREATE TABLE ratings (film VARCHAR(9) PRIMARY KEY, stars INTEGER)",
    "presentations": "CREATE TABLE presentations (slide VARCHAR(9) PRIMARY KEY)",
    "sessions": "CREATE TABLE sessions (cookie VARCHAR(9) PRIMARY KEY, expires INTEGER)",
    "meta": "CREATE TABLE meta (name VARCHAR(9) PRIMARY KEY, content VARCHAR(9))",
    "meta of the same columns": "CREATE TABLE meta (key VARCHAR(9) PRIMARY KEY, value VARCHAR(9))",
}


@pytest.mark.parametrize("kind", FOREIGN)
def test_tables_of_another_program_are_said_at_the_start(study: Path, database_url: str, kind: str) -> None:
    engine = connect(database_url)
    with engine.begin() as connection:
        connection.execute(text(FOREIGN[kind]))
    before = inspect(engine).get_table_names()
    said = rf"holds tables of another program \({kind.split()[0]}\); give the survey a database of its own"
    with pytest.raises(BadInput, match=said):
        create_app(study, database_url=database_url)
    assert inspect(engine).get_table_names() == before
    engine.dispose()


def test_a_table_of_ours_that_another_program_has_replaced(study: Path) -> None:
    open_database(default_url(study)).close()
    with closing(sqlite3.connect(study / "ratings.sqlite")) as file:
        file.executescript(f"DROP TABLE {schema.ratings.name}; {FOREIGN['ratings']}")
    with pytest.raises(BadInput, match=r"another program \(ratings\)"):
        create_app(study)
