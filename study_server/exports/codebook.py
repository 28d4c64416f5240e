"""Which columns each exported table has, in their order: what is fixed, and what the study adds."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from study_server.exports.cells import cell
from study_server.exports.columns import (
    CLIENT,
    CODEBOOK,
    DISPLAYS,
    EVENTS,
    FORGOTTEN,
    PARTICIPANTS,
    RATINGS,
    STIMULI,
    UNANSWERED,
    Column,
    flag,
)
from study_server.exports.export_rows import Row, Source, wide_name
from study_server.manifest import BuiltStudy
from study_server.screen import screen_check
from study_server.settings import CHECK_NAME

WIDE = ("session", "participant", "mode", "status", "started_at", "order_row", "language", "checks_failed")
"""What wide.csv says of a session before its answers."""

CHOSEN = "not answered, or withdrawn"
WRITTEN = f"not answered, withdrawn, {FORGOTTEN}"
"""What an empty answer about the person means."""

TABLES = ("ratings", "wide", "participants", "displays", "events", "stimuli", "codebook")
"""The exported tables in their order."""


def columns_of(table: str, study: BuiltStudy) -> dict[str, Column]:
    """The columns of an exported table in their order. They follow from the study alone, never from the answers."""
    fixed = {"displays": DISPLAYS, "events": EVENTS, "codebook": CODEBOOK}
    return fixed[table] if table in fixed else OF_STUDY[table](study)


def rating_columns(study: BuiltStudy) -> dict[str, Column]:
    """The long table, with the study's questions; a rating's highest step is that of the longest scale."""
    questions = study.settings.question
    names = (*(question.name for question in questions), *([CHECK_NAME] if study.settings.survey.checks else []))
    highest = max(question.scale for question in questions)
    return RATINGS | {
        "question": replace(RATINGS["question"], values=names),
        "rating": replace(RATINGS["rating"], maximum=highest),
        "check_expected": replace(RATINGS["check_expected"], maximum=questions[0].scale),
    }


def participant_columns(study: BuiltStudy) -> dict[str, Column]:
    """The people, with what the study asks about them and stores about their visit."""
    survey = study.settings.survey
    about = {
        f"about_{asked.name}": Column(asked.text, values=asked.choices, missing=CHOSEN if asked.choices else WRITTEN)
        for asked in survey.about
    }
    screen = screen_check.columns(survey.screen_check)
    return PARTICIPANTS | about | screen | {name: CLIENT[name] for name in survey.record}


def stimulus_columns(study: BuiltStudy) -> dict[str, Column]:
    """The pictures, with the level of every factor."""
    return STIMULI | {f"factor_{factor['name']}": factor_column(factor) for factor in study.factors}


def factor_column(factor: Mapping[str, Any]) -> Column:
    """The level of one factor: a number, or one of the study's words."""
    levels = factor.get("levels", ())
    numbers = bool(levels) and all(isinstance(level, int | float) and not isinstance(level, bool) for level in levels)
    return Column(
        f"level of {factor.get('path', factor['name'])}",
        "number" if numbers else "text",
        values=tuple(str(cell(level)) for level in levels),
        missing="a picture of other origin",
    )


def wide_columns(study: BuiltStudy) -> dict[str, Column]:
    """One row a session: first who, then every picture of the manifest by every question of study.toml, then checks."""
    answers = {
        wide_name(stimulus.id, question.name): Column(
            f"rating of {stimulus.id} on {question.name}"
            + (f", the showing that is the repeat of {stimulus.repeat_of}" if stimulus.repeat_of else ""),
            "integer",
            minimum=1,
            maximum=question.scale,
            missing=UNANSWERED,
        )
        for stimulus in study.stimuli
        for question in study.settings.question
    }
    checks = {
        f"check_{number}": flag(
            f"instructed item {number} in the order of showing; 1: the instructed answer was given; 0: another one",
            UNANSWERED,
        )
        for number in range(1, study.settings.survey.checks + 1)
    }
    return {name: PARTICIPANTS[name] for name in WIDE} | answers | checks


OF_STUDY: dict[str, Callable[[BuiltStudy], dict[str, Column]]] = {
    "ratings": rating_columns,
    "wide": wide_columns,
    "participants": participant_columns,
    "stimuli": stimulus_columns,
}
"""The tables with columns that the study adds or bounds."""


def codebook_rows(source: Source) -> Iterator[Row]:
    """One row for every column of every table, this one's too."""
    for table in TABLES:
        yield from described(f"{table}.csv", columns_of(table, source.study))


def described(file: str, columns: Mapping[str, Column]) -> Iterator[Row]:
    """The codebook's rows about one file."""
    for name, column in columns.items():
        yield {
            "table": file,
            "column": name,
            "description": column.description,
            "type": column.type,
            "unit": column.unit,
            "minimum": column.minimum,
            "maximum": column.maximum,
            "values": "|".join(column.values),
            "missing": column.missing,
        }
