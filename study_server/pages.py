"""What a participant's page holds at each step: one dict, shown as HTML or sent as JSON."""

import re
from collections.abc import Collection
from typing import Any

from sqlalchemy import Connection, RowMapping

from study_server.manifest import BuiltStudy
from study_server.pictures import picture_facts
from study_server.sessions import unanswered
from study_server.tokens import External

NUMBERS = ("no questions", "one question", "two questions", "three questions", "four questions", "five questions")


def paragraphs(text: str) -> list[str]:
    """A study's text at its empty lines."""
    return [part.strip() for part in re.split(r"\n\s*\n", text) if part.strip()]


def consent_page(study: BuiltStudy, mode: str, token: str, external: External | None) -> dict[str, Any]:
    """Before anything is stored."""
    survey = study.settings.survey
    return {
        **frame(study, mode, token, "consent"),
        "paragraphs": paragraphs(survey.consent),
        "contact": survey.contact,
        "retention": survey.retention,
        "external": {} if external is None else external.as_query(),
    }


def frame(study: BuiltStudy, mode: str, token: str, step: str) -> dict[str, Any]:
    """What every page of a participant has."""
    return {"step": step, "title": study.settings.survey.title or study.title, "mode": mode, "here": f"/s/{token}"}


def page(connection: Connection, study: BuiltStudy, session: RowMapping) -> dict[str, Any]:
    """The page where this session stands."""
    step = str(session["step"])
    survey = study.settings.survey
    data = {**frame(study, session["mode"], session["token"], step), "session": session["id"]}
    if step == "about":
        data["fields"] = [field.model_dump(mode="json") for field in survey.about]
    elif step == "instructions":
        data["paragraphs"] = paragraphs(filled(survey.instructions, study))
        data["practice"] = survey.practice
    elif step == "ready":
        data["trials"] = len(study.stimuli)
    elif step in ("practice", "trials"):
        data |= trial_page(connection, study, session)
    elif step == "comments":
        data["question"] = survey.comments
    elif step == "done":
        data["paragraphs"] = paragraphs(survey.thanks)
        data["completion_code"] = session["completion_code"]
    return data


def trial_page(connection: Connection, study: BuiltStudy, session: RowMapping) -> dict[str, Any]:
    """The picture that is due, the questions under it, and the picture after it, to be fetched ahead."""
    due, *later = unanswered(connection, session["id"], limit=2)
    following = next((picture_facts(study.by_id[row["stimulus"]]) for row in later), None)
    return {
        "place": due["place"],
        "practice": due["practice"],
        "trial": due["trial"],
        "trials": study.settings.survey.practice if due["practice"] else len(study.stimuli),
        "stimulus": due["stimulus"],  # simulated raters answer by it: two stimuli may be one picture
        "picture": picture_facts(study.by_id[due["stimulus"]]),
        "next_picture": following,
        "questions": [question.model_dump(mode="json") for question in study.settings.question],
    }


def filled(text: str, study: BuiltStudy) -> str:
    """The instructions with {questions}, {scale} (the longest one's steps) and {keys} replaced."""
    n = len(study.settings.question)
    count = NUMBERS[n] if n < len(NUMBERS) else f"{n} questions"
    scales = {question.scale for question in study.settings.question}
    return text.replace("{questions}", count).replace("{scale}", str(max(scales))).replace("{keys}", key_words(scales))


def key_words(scales: Collection[int]) -> str:
    """Which keys answer questions of these numbers of steps (static/survey.js): 1 to 9, and 0 for 10; 11 has none."""
    words = f"1 to {min(max(scales), 9)}"
    if max(scales) >= 10:
        words += ", and 0 for 10"
    if max(scales) >= 11:
        words += " (11 has no key)"
    return words if len(set(scales)) == 1 else f"{words}, as far as each question's scale goes"
