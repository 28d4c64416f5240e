"""What an earlier release of this program wrote, brought to what this one reads: nobody under way is lost.

Each step runs in the transaction that found the old version, so that a database is of one version or of the next.
"""

from collections.abc import Callable

from alembic.migration import MigrationContext
from alembic.operations import Operations
from sqlalchemy import JSON, Boolean, Column, Connection, Double, Integer, String, Table, column, select, table, update

from study_server.storage import schema


def upgrade(connection: Connection, version: str) -> str:
    """Bring the tables from `version` on as far as steps are known; gives the version they are of then."""
    while version in STEPS:
        STEPS[version](connection)
        version = str(int(version) + 1)
        connection.execute(update(schema.meta).where(schema.meta.c.key == "schema_version").values(value=version))
    return version


def trials_and_languages(connection: Connection) -> None:
    """1 to 2: order rows hold trials rather than stimuli; sessions a language, the screen, the visitor."""
    add_columns(
        connection,
        schema.sessions,
        Column("language", String, nullable=False, server_default="en"),
        Column("screen", JSON, nullable=False, server_default="{}"),
        Column("client", JSON, nullable=False, server_default="{}"),
    )
    add_columns(
        connection,
        schema.presentations,
        Column("questions", JSON, nullable=False, server_default="[]"),
        Column("check_expected", Integer),
        Column("answers_expected", Integer, nullable=False, server_default="0"),
        Column("drawn_height_px", Double),
        Column("gamut", String),
        Column("scaled", Boolean),
    )
    add_columns(connection, schema.order_rows, Column("trials", JSON, nullable=False, server_default="[]"))
    for study in connection.execute(select(schema.studies.c.identity, schema.studies.c.settings)).all():
        ask_all_questions(connection, study.identity, [question["name"] for question in study.settings["question"]])
    Operations(MigrationContext.configure(connection)).drop_column("order_rows", "stimuli")


def ask_all_questions(connection: Connection, study: str, questions: list[str]) -> None:
    """Version 1 asked every question of the study under every picture."""
    rows, sessions, presentations = schema.order_rows, schema.sessions.c, schema.presentations
    before = table("order_rows", column("study"), column("row"), column("stimuli", JSON))
    for old in connection.execute(select(before).where(before.c.study == study)).all():
        trials = [{"stimulus": name, "questions": questions, "check": None} for name in old.stimuli]
        this = (rows.c.study == study, rows.c.row == old.row)
        connection.execute(update(rows).where(*this).values(trials=trials))
    mine = presentations.c.session.in_(select(sessions.id).where(sessions.study == study))
    asked = {"questions": questions, "answers_expected": len(questions)}
    connection.execute(update(presentations).where(mine).values(asked))


def add_columns(connection: Connection, to: Table, *columns: Column) -> None:  # type: ignore[type-arg]
    """`columns` at the end of the table."""
    operations = Operations(MigrationContext.configure(connection))
    for new in columns:
        operations.add_column(to.name, new)


STEPS: dict[str, Callable[[Connection], None]] = {"1": trials_and_languages}
