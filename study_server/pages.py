"""What a participant's page holds at each step: one dict, shown as HTML or sent as JSON. Its texts are translated."""

import hashlib
import re
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote, urlencode

from babel import Locale
from sqlalchemy import Connection, RowMapping

from study_server.guards.tokens import External
from study_server.manifest import BuiltStudy
from study_server.pictures import picture_facts
from study_server.screen import screen_check
from study_server.sessions import Session, unanswered
from study_server.settings import CHECK_NAME, Question, Survey
from study_server.wording import texts
from study_server.wording.language import Words, offered, words

HERE = Path(__file__).parent
OURS = sorted([*HERE.glob("static/*.js"), *HERE.glob("templates/*.html")])
RELEASE = hashlib.sha256(b"".join(path.read_bytes() for path in OURS)).hexdigest()[:16]
"""Tells the pages and scripts of this release from another's: a page older than its server loads itself anew."""

PROLIFIC = "https://app.prolific.com/submissions/complete?cc={code}"


def paragraphs(text: str) -> list[str]:
    """A study's text at its empty lines."""
    return [part.strip() for part in re.split(r"\n\s*\n", text) if part.strip()]


def consent_page(study: BuiltStudy, mode: str, token: str, language: str, external: External | None) -> dict[str, Any]:
    """Before anything is stored."""
    survey = study.settings.survey
    say = words(study.settings, language)
    return {
        **frame(study, mode, token, "consent", language),
        "paragraphs": paragraphs(say(survey.consent)) if survey.consent else our_consent(survey, say, external),
        "contact": say(survey.contact),
        "retention": say(survey.retention),
        "retention_until": survey.retention_until.isoformat() if survey.retention_until else "",
        "languages": [language_link(other, external) for other in offered(survey)],
        "query": language_link(language, external)["href"],
        "phones": survey.phones,
        "external": {} if external is None else external.as_query(),
    }


def our_consent(survey: Survey, say: Words, external: External | None) -> list[str]:
    """What taking part means and all that is stored of this visitor, a paragraph each."""
    told = [*map(say, texts.CONSENT)]
    if survey.screen_check:
        parts = [texts.SCREEN_PARTS[part] for part in texts.SCREEN_PARTS if part in survey.screen_check]
        told.append(" ".join(map(say, (texts.SCREEN, *parts))))
    if external is not None:
        told.append(say(texts.EXTERNAL))
    told.append(say(texts.STORED[tuple(sorted(set(survey.record)))]))
    if not (survey.retention or survey.retention_until):
        told.append(say(texts.NO_DATE))
    return told


def language_link(language: str, external: External | None) -> dict[str, str]:
    """How this page is reached in another language by hand; the language's name is as its speakers write it."""
    query = urlencode({"language": language, **(external.as_query() if external else {})})
    name = Locale(language).get_display_name() or language
    return {"code": language, "name": name.capitalize(), "href": f"?{query}"}


def shut_page(study: BuiltStudy, mode: str, token: str, language: str, step: str) -> dict[str, Any]:
    """Instead of the consent or any other page: the study is `paused` or `closed`."""
    return frame(study, mode, token, step, language)


def declined_page(study: BuiltStudy, mode: str, token: str, language: str, external: External | None) -> dict[str, Any]:
    """For somebody who does not agree to take part. Nothing is stored."""
    code = study.settings.survey.prolific.no_consent if external else ""
    return {
        **frame(study, mode, token, "declined", language),
        "return_url": return_url(study.settings.survey, code, external is not None),
        "completion_code": code,
    }


def frame(study: BuiltStudy, mode: str, token: str, step: str, language: str) -> dict[str, Any]:
    """What every page of a participant has."""
    title = words(study.settings, language)(study.settings.named()["title"])
    return {"step": step, "title": title, "mode": mode, "here": f"/s/{token}", "language": language}


def page(
    connection: Connection, study: BuiltStudy, session: Session, waiting: Sequence[RowMapping] = ()
) -> dict[str, Any]:
    """The page where this session stands. `waiting`: the presentations due next, if the caller has them at hand."""
    step = str(session["step"])
    survey = study.settings.survey
    say = words(study.settings, session["language"])
    data = {**frame(study, session["mode"], session["token"], step, session["language"]), "session": session["id"]}
    if step == "about":
        data["fields"] = [asked_about(field.model_dump(mode="json"), say) for field in survey.about]
    elif step == "screen":
        data |= screen_check.page(survey.screen_check)
    elif step == "instructions":
        data["paragraphs"] = instructions(study, say)
        data["practice"] = survey.practice
    elif step == "ready":
        data["trials"] = trials(study)
    elif step in ("practice", "trials"):
        data |= trial_page(study, waiting or unanswered(connection, session["id"], 1 + looked_ahead(study)), say)
    elif step == "comments":
        data["question"] = say(survey.comments)
    elif step in ("done", "screened_out"):
        data |= last_page(survey, session, say)
    return data


def asked_about(field: dict[str, Any], say: Words) -> dict[str, Any]:
    """A question about the participant. `choices` are what is stored; `labels` what is read."""
    del field["screen_out"]  # nobody is told which answer lets them in
    told = {"text": say(field["text"]), "labels": [say(choice) for choice in field["choices"]]}
    return field | told | {"given": "", "problem": ""}


def about_again(
    connection: Connection, study: BuiltStudy, session: Session, values: Mapping[str, str], problems: Mapping[str, str]
) -> dict[str, Any]:
    """The questions about the participant once more, with what was given and what is wrong with it."""
    say = words(study.settings, session["language"])
    data = page(connection, study, session)
    for field in data["fields"]:
        field |= {"given": values.get(field["name"], ""), "problem": say(problems.get(field["name"], ""))}
    return data | {"error": say(texts.N_("Nothing was saved yet: please look again at what is marked."))}


def instructions(study: BuiltStudy, say: Words) -> list[str]:
    """The study's own, or ours."""
    own = study.settings.survey.instructions
    told = paragraphs(say(own)) if own else [say(text) for text in texts.INSTRUCTIONS]
    return [filled(text, study, say) for text in told]


def last_page(survey: Survey, session: Session, say: Words) -> dict[str, Any]:
    """After the last thing asked: thanks, the code, the way back."""
    is_external = session["external_participant"] is not None
    screened_out = survey.prolific.screened_out if is_external else ""
    code = session["completion_code"] if session["step"] == "done" else screened_out
    return {
        "paragraphs": paragraphs(say(survey.thanks)) if session["step"] == "done" else [],
        "completion_code": code,
        "return_url": return_url(survey, code, is_external),
    }


def return_url(survey: Survey, code: str, is_external: bool) -> str:
    """Where the last page leads: what the study says, or Prolific for who came from there, or nowhere.

    Prolific takes only the codes agreed with it, and an address that needs a code leads nowhere without one.
    """
    is_agreed = code in survey.prolific.model_dump().values()
    address = survey.return_url or (PROLIFIC if is_external and is_agreed else "")
    return address.replace("{code}", quote(code, safe="")) if code or "{code}" not in address else ""


def trials(study: BuiltStudy) -> int:
    """How many pictures a participant rates, practice not counted."""
    blocks = len(study.settings.question) if study.settings.survey.blocks == "by-question" else 1
    return len(study.stimuli) * blocks


def looked_ahead(study: BuiltStudy) -> int:
    """How many trials after the one that is due a page holds."""
    return max(study.settings.survey.unsaved_ahead, 1)


def trial_page(study: BuiltStudy, waiting: Sequence[RowMapping], say: Words) -> dict[str, Any]:
    """The picture that is due and the questions under it, and the same for the next ones of this step.

    `ahead` is what the browser may show before the answers to the earlier ones are saved, and fetches beforehand.
    """
    due, *later = waiting
    return {
        **trial_facts(study, due, say),
        "practice": due["practice"],
        "trials": study.settings.survey.practice if due["practice"] else trials(study),
        "ahead": [trial_facts(study, row, say) for row in later if row["practice"] == due["practice"]],
        "unsaved_ahead": study.settings.survey.unsaved_ahead,
        "scaled_pictures": study.settings.survey.scaled_pictures,
        "release": RELEASE,
    }


def trial_facts(study: BuiltStudy, row: RowMapping, say: Words) -> dict[str, Any]:
    """One trial: where it stands, its picture, its questions."""
    questions = [shown(question, say) for question in study.settings.question if question.name in row["questions"]]
    if row["check_expected"] is not None:
        like = study.settings.checked_like(row["questions"], row["check_expected"])
        questions.append(instructed(like, row["check_expected"], say))
    return {
        "place": row["place"],
        "trial": row["trial"],
        "stimulus": row["stimulus"],  # simulated raters answer by it: two stimuli may be one picture
        "picture": picture_facts(study.by_id[row["stimulus"]]),
        "questions": questions,
    }


def shown(question: Question, say: Words) -> dict[str, Any]:
    """A question as the participant reads it."""
    told = {"text": say(question.text), "low": say(question.low), "high": say(question.high)}
    return {"name": question.name, "scale": question.scale, **told}


def instructed(like: Question, expected: int, say: Words) -> dict[str, Any]:
    """The item that asks for a certain answer, on the scale of `like`."""
    return shown(like, say) | {"name": CHECK_NAME, "text": say(texts.CHECK).replace("{answer}", str(expected))}


def filled(text: str, study: BuiltStudy, say: Words) -> str:
    """The instructions with {questions}, {scale} (the longest one's steps) and {keys} replaced."""
    n = 1 if study.settings.survey.blocks == "by-question" else len(study.settings.question)
    count = say.plural("one question", "{n} questions", n).replace("{n}", str(n))
    scales = {question.scale for question in study.settings.question}
    keys = key_words(scales, say)
    return text.replace("{questions}", count).replace("{scale}", str(max(scales))).replace("{keys}", keys)


def key_words(scales: Collection[int], say: Words) -> str:
    """Which keys answer questions of these numbers of steps (static/survey.js): 1 to 9, and 0 for 10; 11 has none."""
    told = say(texts.N_("1 to {last}")).format(last=min(max(scales), 9))
    if max(scales) >= 10:
        told += say(texts.N_(", and 0 for 10"))
    if max(scales) >= 11:
        told += say(texts.N_(" (11 has no key)"))
    return told if len(set(scales)) == 1 else told + say(texts.N_(", as far as each question's scale goes"))
