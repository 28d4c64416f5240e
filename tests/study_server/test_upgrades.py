"""A database that an earlier release wrote in the middle of a study: everybody goes on where they were.

tests/data/study_of_release_1 was written by that release: `done` finished (6, 5, 2), `mid` rated one picture with 3,
`early` agreed to take part, `gone` withdrew.
"""

import shutil
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest
from survey_client import ABOUT, Participant

from fakesss.problem import BadInput
from study_server.app import create_app
from study_server.serve import served
from study_server.storage import schema
from study_server.storage.database import Database, open_database
from study_server.storage.engines import sqlite_url

Rows = Callable[..., list[dict[str, str]]]

RELEASE_1 = Path(__file__).parents[1] / "data" / "study_of_release_1"


@pytest.fixture
def old(tmp_path: Path) -> Path:
    return Path(shutil.copytree(RELEASE_1, tmp_path / "study"))


def person(url: str, name: str) -> Participant:
    return Participant(url, f"?STUDY_ID=s&PROLIFIC_PID={name}")


def test_everybody_goes_on_where_they_were(old: Path, csv_rows: Rows) -> None:
    with served(old) as url:
        assert person(url, "done").state["completion_code"] == "2PGCAXUV"
        assert person(url, "gone").state["step"] == "withdrawn"
        early = person(url, "early")
        assert early.post("about", **ABOUT)["step"] == "screen"
        mid = person(url, "mid")
        assert (mid.state["step"], mid.state["trial"]) == ("trials", 2)
        mid.rate(4)
        mid.rate(4)
        assert mid.to_end()
        ratings = csv_rows(old, url, "ratings")
    given = Counter(row["rating"] for row in ratings)
    assert given == {"6": 2, "5": 2, "2": 2, "3": 2, "4": 4, "": 6}


def test_newcomers_get_the_rows_of_nobody_who_finished(old: Path, csv_rows: Rows) -> None:
    """`mid` and `early` have been silent since the file was written, so five of the six rows are free."""
    with served(old) as url:
        for _ in range(5):
            assert Participant(url).to_trials().to_end()
        people = csv_rows(old, url, "participants")
    assert Counter(person["status"] for person in people) == {"finished": 6, "dropped": 2, "withdrawn": 1}
    assert {person["order_row"] for person in people if person["status"] == "finished"} == set("123456")


def test_the_tables_are_those_of_a_new_database(old: Path, tmp_path: Path) -> None:
    def columns(database: Database) -> dict[str, set[str]]:
        with database.reading() as connection:
            return {
                name: {row[1] for row in connection.exec_driver_sql(f"PRAGMA table_info({name})")}
                for name in schema.tables.tables
            }

    upgraded = open_database(sqlite_url(old / "ratings.sqlite"))
    assert columns(upgraded) == columns(open_database(sqlite_url(tmp_path / "new.sqlite")))


def test_a_later_releases_database_is_refused(old: Path) -> None:
    database = open_database(sqlite_url(old / "ratings.sqlite"))
    with database.writing() as connection:
        this = schema.meta.c.key == "schema_version"
        connection.execute(schema.meta.update().where(this).values(value="99"))
    with pytest.raises(BadInput, match="has schema 99"):
        create_app(old)
