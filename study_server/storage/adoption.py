"""A study meets its database: noted on first use, refused where answers to two studies would be mixed."""

import json
import time
from dataclasses import asdict

from sqlalchemy import Connection, and_, func, insert, select, update

from fakesss.problem import BadInput
from study_server.manifest import BuiltStudy
from study_server.ordering.assignment import Design
from study_server.storage import schema
from study_server.storage.database import Database


def adopt_study(database: Database, study: BuiltStudy, shown: str) -> None:
    """Note the study and its order rows on first use.

    Raises `BadInput` if live ratings of a study with other words or other pictures are in the same database: answers
    to two different studies must not be mixed. Pilot sessions of an earlier version stay, apart, and are not resumed.
    """
    with database.writing() as connection:
        others = live_elsewhere(connection, study.identity)
        if others:
            aside = "move that file aside" if database.is_sqlite else "name another database with --database"
            raise BadInput(
                f"{shown}: holds {others} live session(s) of another version of this study; "
                f"{aside}, or restore study.toml and its pictures as they were"
            )
        this = schema.studies.c.identity == study.identity
        if not connection.execute(update(schema.studies).where(this).values(opened_at=time.time())).rowcount:
            insert_study(connection, study)


def live_elsewhere(connection: Connection, study: str) -> int:
    """How many live sessions of other versions than `study` (an identity) the database holds."""
    versions = select(schema.studies.c.identity).where(schema.studies.c.identity != study)
    theirs = and_(schema.sessions.c.study.in_(versions), schema.sessions.c.mode == "live")  # finds them by the index
    return connection.scalar(select(func.count()).select_from(schema.sessions).where(theirs)) or 0


def insert_study(connection: Connection, study: BuiltStudy) -> None:
    """The study's words and its order rows, as they will be for all who take part."""
    connection.execute(
        insert(schema.studies).values(
            identity=study.identity,
            sha256=study.sha256,
            title=study.title,
            settings=json.loads(study.settings.model_dump_json()),
            opened_at=time.time(),
        )
    )
    rows = design_of(study).rows()
    connection.execute(
        insert(schema.order_rows),
        [
            {"study": study.identity, "row": number, "trials": [asdict(trial) for trial in row]}
            for number, row in enumerate(rows)
        ],
    )


def design_of(study: BuiltStudy) -> Design:
    """Who is shown what in which order, as the manifest and [survey] together say."""
    survey, questions = study.settings.survey, study.settings.question
    repeats = {stimulus.id: stimulus.repeat_of for stimulus in study.stimuli if stimulus.repeat_of is not None}
    return Design(
        stimuli=tuple(stimulus.id for stimulus in study.stimuli if stimulus.id not in repeats),
        repeats=repeats,
        questions=tuple(question.name for question in questions),
        steps=tuple(question.scale for question in questions),
        order=survey.order,
        blocks=survey.blocks,
        checks=survey.checks,
        practice=survey.practice,
        seed=study.seed,
    )
