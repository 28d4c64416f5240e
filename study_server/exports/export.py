"""The export: CSV files that the analysis, and any other program, starts from."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from sqlalchemy import and_, func, select

from fakesss.problem import BadInput
from study_server.exports import export_rows
from study_server.exports.cells import csv_text
from study_server.exports.codebook import TABLES, codebook_rows, columns_of
from study_server.exports.export_rows import Row, Source
from study_server.manifest import load_study
from study_server.sessions import presentations, sessions
from study_server.site import Mode
from study_server.storage import schema
from study_server.storage.database import open_existing, secret
from study_server.storage.engines import shown_url
from study_server.storage.staging import staged

ROWS: dict[str, Callable[[Source], Iterator[Row]]] = {
    "ratings": export_rows.rating_rows,
    "wide": export_rows.wide_rows,
    "participants": export_rows.participant_rows,
    "displays": export_rows.display_rows,
    "events": export_rows.event_rows,
    "stimuli": export_rows.stimulus_rows,
    "codebook": codebook_rows,
}


def table_text(table: str, source: Source) -> Iterator[str]:
    """One exported table as pieces of CSV text."""
    return csv_text(list(columns_of(table, source.study)), ROWS[table](source))


def export_ratings(
    study_folder: Path, out: Path, *, mode: Mode = "live", database_url: str | None = None
) -> list[Path]:
    """Write every table as CSV into the folder `out`, made if it is not there; gives their paths.

    Raises `BadInput` if the study is not built, the database cannot be opened, or `out` cannot be written.
    """
    with snapshot(Path(study_folder), mode, database_url) as source, staged(Path(out)) as folder:
        for table in TABLES:
            write_table(folder / f"{table}.csv", table_text(table, source))
    return [Path(out) / f"{table}.csv" for table in TABLES]


def write_table(path: Path, pieces: Iterator[str]) -> None:
    """One CSV file: UTF-8 without a byte order mark, which R, awk and join would take for part of the first name."""
    with path.open("w", encoding="utf-8", newline="") as file:
        file.writelines(pieces)


@contextmanager
def snapshot(study_folder: Path, mode: Mode, database_url: str | None) -> Iterator[Source]:
    """The study's ratings of one mode as they are now, for exports outside the server."""
    study = load_study(study_folder)
    database = open_existing(study_folder, database_url)
    salt = secret(database, "salt")
    with database.reading() as connection:
        versions = connection.scalars(select(schema.studies.c.identity)).all()
        if versions and study.identity not in versions:
            shown = shown_url(database.engine.url)
            raise BadInput(f"{shown}: is of another version of this study; export it with the study as it was")
        yield Source(connection, study, mode, salt)


def left_out(study_folder: Path, mode: Mode, database_url: str | None = None) -> list[str]:
    """That there is no session of this mode of the folder's study, and what else there is: a sentence each."""
    study = load_study(Path(study_folder))
    database = open_existing(study_folder, database_url)
    version = (sessions.study == study.identity).label("version")
    query = select(version, sessions.mode, func.count()).group_by(version, sessions.mode).order_by(sessions.mode)
    with database.reading() as connection:
        found = connection.execute(query).all()
    shown = shown_url(database.engine.url)
    holds = f"{shown}: also holds"
    mine = any(is_ours and held == mode for is_ours, held, _ in found)
    told = [] if mine else [f"{shown}: holds no {mode} session of this study; the tables have no rows of people"]
    told += [
        f"{holds} {n} {other} session(s), left out here; `fakesss export --mode {other}` writes them"
        for is_ours, other, n in found
        if is_ours and other != mode
    ]
    others = sum(n for is_ours, _, n in found if not is_ours)
    again = "left out here; with the study's folder as it was then they can be exported"
    return told + ([f"{holds} {others} session(s) of another version of this study, {again}"] if others else [])


def mode_to_analyse(study_folder: Path, database_url: str | None = None) -> Mode:
    """What a report is about: the first of live, simulated and pilot with a rating of a real trial; live without any.

    Agreeing to take part and practising are no ratings: one visitor of the live study hides nobody's answers.
    """
    rated = schema.ratings.join(schema.presentations).join(schema.sessions)
    mine = and_(sessions.study == load_study(study_folder).identity, presentations.practice.is_(False))
    with open_existing(study_folder, database_url).reading() as connection:
        found = connection.scalars(select(sessions.mode).select_from(rated).where(mine).distinct()).all()
    order: tuple[Mode, ...] = ("live", "simulated", "pilot")
    return next((mode for mode in order if mode in found), "live")
