"""What moves a session from one step to the next."""

import secrets
from collections.abc import Callable, Mapping, Sequence

from sqlalchemy import Connection, RowMapping, select

from study_server.counts import failed_checks
from study_server.manifest import BuiltStudy
from study_server.screen.screen_check import leave_screen
from study_server.sessions import Session, advance, after_about, expected_and_stored, record
from study_server.settings import AboutField, Survey
from study_server.wording.texts import N_

CODE_LETTERS = "ABCDEFGHJKLMNPQRSTUVWXYZ23456789"
"""Without I, O, 0 and 1, which are mistaken for one another when copied by hand."""

CODE_LENGTH = 8
LONGEST_TEXT = 10_000

UNANSWERED = N_("Please answer this question.")
NO_CHOICE = N_("Please choose one of these answers.")

Values = Mapping[str, str]
Problems = Mapping[str, str]
"""What is wrong with a form: field -> sentence. Nothing: the step is left."""


def leave_about(connection: Connection, study: BuiltStudy, session: Session, values: Values, now: float) -> Problems:
    """Keeps the answers about the participant; stays if a required one is missing or is none of the choices."""
    asked = study.settings.survey.about
    told = {field.name: values.get(field.name, "").strip()[:LONGEST_TEXT] for field in asked}
    problems = {field.name: problem(field, told[field.name]) for field in asked if problem(field, told[field.name])}
    if not problems:
        out = any(told[field.name] in field.screen_out for field in asked)
        advance(connection, session, now, step="screened_out" if out else after_about(study), about=told)
    return problems


def problem(field: AboutField, value: str) -> str:
    """Why `value` is no answer to this question, in a sentence; empty if it is one."""
    if not value:
        return UNANSWERED if field.required else ""
    return NO_CHOICE if field.choices and value not in field.choices else ""


def leave_instructions(connection: Connection, study: BuiltStudy, session: Session, _: Values, now: float) -> None:
    """On to practice, if there is any."""
    advance(connection, session, now, step="practice" if study.settings.survey.practice else "trials")


def leave_ready(connection: Connection, _study: BuiltStudy, session: Session, _: Values, now: float) -> None:
    """From practice to the trials."""
    advance(connection, session, now, step="trials")


def leave_comments(connection: Connection, _study: BuiltStudy, session: Session, values: Values, now: float) -> None:
    """Keeps the comment, if there is one."""
    advance(connection, session, now, step="done", comments=values.get("comments", "").strip()[:LONGEST_TEXT] or None)


LEAVE: dict[str, Callable[[Connection, BuiltStudy, RowMapping, Values, float], Problems | None]] = {
    "about": leave_about,
    "screen": leave_screen,
    "instructions": leave_instructions,
    "ready": leave_ready,
    "comments": leave_comments,
}


def after_answers(
    connection: Connection, study: BuiltStudy, session: Session, waiting: Sequence[RowMapping], now: float
) -> Session:
    """Moves on when practice or the trials are through; the completion code is made when every rating is stored.

    `waiting`: what is to be answered next. Gives the session as it is then.
    """
    if session["step"] == "practice" and (not waiting or not waiting[0]["practice"]):
        return advance(connection, session, now, step="ready")
    if session["step"] == "trials" and not waiting:
        return finish(connection, study, session, now)
    return advance(connection, session, now)


def finish(connection: Connection, study: BuiltStudy, session: Session, now: float) -> Session:
    """Closes the session. The ratings are counted, not assumed: no code without every expected row."""
    expected, stored = expected_and_stored(connection, session["id"])
    if stored != expected:
        raise RuntimeError(f"session {session['id']}: {stored} of {expected} ratings stored, yet no trial is left")
    survey, checks = study.settings.survey, failed_checks()
    failed = connection.scalar(select(checks.c.checks_failed).where(checks.c.session == session["id"])) or 0
    is_external = session["external_participant"] is not None
    code = completion_code(survey, failed >= survey.failed_checks, is_external)
    step = "comments" if survey.comments else "done"
    record(connection, session["id"], now, "finished", {})
    return advance(connection, session, now, step=step, finished_at=now, completion_code=code)


def completion_code(survey: Survey, failed: bool, is_external: bool) -> str:
    """The code agreed with Prolific for who came from there, or else the study's own, or one drawn by lot."""
    agreed = (survey.prolific.failed_checks if failed else "") or survey.prolific.completed
    own = (agreed if is_external else "") or survey.completion_code
    return own or "".join(secrets.choice(CODE_LETTERS) for _ in range(CODE_LENGTH))
