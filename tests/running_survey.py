"""A study served in each of the ways there are: SQLite, PostgreSQL, and PostgreSQL with two worker processes."""

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from server_process import server_process
from stored import sound
from waiting import until

from study_server.serve import served
from study_server.storage.database import default_url

KINDS = ("sqlite", "postgres", "two workers")


@dataclass(frozen=True)
class Running:
    """A served study: its address, and that of its database."""

    url: str
    database: str


@contextlib.contextmanager
def running_survey(kind: str, study: Path, log: Path, postgres_url: str = "") -> Iterator[Running]:
    """The built study, served in one of the `KINDS`; what it holds at the end is judged."""
    database = postgres_url or default_url(study)
    if kind == "two workers":
        with server_process(study, log, database_url=database, workers=2) as server:
            until(lambda: len(server.workers()) == 2)
            yield Running(server.url, database)
        assert server.unforeseen() == []
    else:
        with served(study, database_url=database) as url:
            yield Running(url, database)
    sound(database)
