"""Where answers are kept: beside the study whatever its folder is called, never in memory, and never a traceback."""

from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from stored import sound
from study_fixture import write_study
from survey_client import Participant

import fakesss.cli_analysis
import fakesss.cli_study
import fakesss.cli_survey  # noqa: F401  (all add their commands)
from fakesss.cli import commands
from fakesss.problem import BadInput
from study_server.serve import served
from study_server.storage.database import default_url, open_database
from study_server.storage.engines import parsed_url, shown_url, sqlite_url

NAMES = ["is it red?", "a%41b", "a?mode=memory", "x#y", "a&b=c;d", "a@b:c", "[x]", "über 半", "100%", '\'s "x"', "a+b"]


@pytest.mark.parametrize("name", NAMES)
def test_the_answers_lie_in_the_studys_folder_whatever_it_is_called(tmp_path: Path, name: str) -> None:
    study = write_study(tmp_path / name)
    with served(study) as url:
        Participant(url).to_trials().to_end()
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert len(sound(default_url(study)).sessions) == 1
    assert CliRunner().invoke(commands, ["backup", str(study), "-o", str(tmp_path / "copy.sqlite")]).exit_code == 0
    assert len(sound(sqlite_url(tmp_path / "copy.sqlite")).sessions) == 1
    assert parsed_url(shown_url(default_url(study))).database == str(study / "ratings.sqlite")


BAD = [
    ("postgresql://a:b@c:port/d", "is no database address; write sqlite:///FILE or postgresql://USER@HOST/NAME"),
    ("nonsense", "is no database address; write sqlite:///FILE"),
    ("mysql://root:b@localhost/x", "mysql is neither SQLite nor PostgreSQL"),
    ("oracle+nothing://x", "oracle.nothing is neither SQLite nor PostgreSQL"),
    ("postgresql+asyncpg://a:b@localhost/x", "postgresql.asyncpg is neither SQLite nor PostgreSQL by psycopg; write"),
    ("sqlite+aiosqlite:///x.sqlite", "neither SQLite nor PostgreSQL by psycopg; write sqlite:///FILE"),
    ("sqlite:///file:mem?mode=memory&uri=true", "takes no parameters; write a . in its name as %3F"),
    ("sqlite:///file::memory:?uri=true", "takes no parameters"),
    ("sqlite:///x.sqlite?timeout=x", "takes no parameters"),
    ("sqlite:///:memory:", "names no file, so that every answer would be lost"),
    ("sqlite://", "names no file, so that every answer would be lost"),
]


@pytest.mark.parametrize(("address", "said"), BAD)
def test_an_address_where_nothing_can_be_kept(address: str, said: str) -> None:
    with pytest.raises(BadInput, match=said) as caught:
        open_database(address)
    assert "b@" not in str(caught.value), "a password"


COMMANDS = ["serve", "simulate", "export", "report", "backup", "forget"]


def invoked(command: str, study: Path, address: str) -> Result:
    options = ["--yes"] if command == "forget" else []
    return CliRunner().invoke(commands, [command, str(study), "--database", address, *options])


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize(("address", "said"), [("", 'database "": names no database'), BAD[0], BAD[6]])
def test_every_command_says_so_in_a_sentence(study: Path, command: str, address: str, said: str) -> None:
    before = sorted(study.rglob("*"))
    result = invoked(command, study, address)
    assert isinstance(result.exception, BadInput)
    assert said.split("write a .")[0] in str(result.exception)
    assert sorted(study.rglob("*")) == before


SECRET_PLACES = [
    "postgresql://u:TOPSECRET@127.0.0.1:1/db",
    "postgresql://u@127.0.0.1:1/db?password=TOPSECRET",
    "postgresql://u@127.0.0.1:1/db?sslmode=disable&sslpassword=TOPSECRET",
    "postgresql://u@127.0.0.1:1/db?pass%77ord=TOPSECRET",
    "postgresql://u@127.0.0.1:port/db?password=TOPSECRET",
    "postgresql+asyncpg://u@127.0.0.1/db?password=TOPSECRET",
    "sqlite:///x.sqlite?password=TOPSECRET",
]


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("address", SECRET_PLACES)
def test_no_command_prints_a_password(study: Path, command: str, address: str) -> None:
    result = invoked(command, study, address)
    assert isinstance(result.exception, BadInput)
    assert "TOPSECRET" not in f"{result.output}{result.exception}"


def test_what_says_where_a_database_is_is_shown() -> None:
    shown = shown_url("postgresql://u@/db?host=/run/postgresql&password=TOPSECRET&sslmode=require")
    assert shown == "postgresql://u@/db?host=%2Frun%2Fpostgresql&sslmode=require"
