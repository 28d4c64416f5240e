"""The participant's way: link, consent, about you, instructions, practice, trials, comments, thank-you.

A participant has one address, and the server holds where they are in it: refresh, back, a second tab or another
browser show the same step. A form that arrives for a step already left changes nothing.
"""

import asyncio
import logging
import time
from collections.abc import Collection, Mapping, Sequence
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Request, Response
from fastapi.responses import JSONResponse, RedirectResponse
from pydantic_core import to_json
from sqlalchemy import Connection, RowMapping
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException

from study_server import answers, pages, sessions, steps
from study_server.gates import gate
from study_server.guards.rate_limit import retry_after
from study_server.guards.tokens import External, belongs_to, is_valid, make_token
from study_server.sessions import Session
from study_server.site import AtSite, Fields, Site, answer, sorry, told, visitor_language
from study_server.storage.copies import strike_out
from study_server.wording.texts import N_

MOST_REFUSALS = 100
"""Of one session that are noted: whoever sends nonsense for ever does not fill the disk with it."""

log = logging.getLogger(__name__)

router = APIRouter()

STRANGER = N_("This address does not belong to a participant of this study; please open the link you were given again.")
HALF = N_("This address is only a part of your link; please open the link you were given again.")
UNFILLED = N_("This link does not say who you are ({name}); please tell the people who gave it to you.")
TOO_OFTEN = N_("Too much was asked at once; please wait a few seconds and try again. Nothing is lost.")
CROWD = N_("Many people are starting at this moment; please wait a few seconds and try again.")
ANOTHER_VERSION = N_("Another version of this study is under way; please tell the people who gave you the link.")


async def own_token(request: Request, site: AtSite, token: str) -> str:
    """The token in the address: made by this server, and not asked about too often. The database is not needed for it.

    Raises `HTTPException` 404 or 429.
    """
    if not is_valid(site.signing_key, token):
        raise HTTPException(404, STRANGER)
    wait = site.limits.session(token, request.method)
    if wait:
        raise HTTPException(429, TOO_OFTEN, retry_after(wait))
    return token


Token = Annotated[str, Depends(own_token)]


@router.head("/", include_in_schema=False)
@router.get("/")
def link(request: Request, site: AtSite) -> Response:
    """The link that is sent out: gives the visitor an address of their own. Stores nothing."""
    missing = External.missing(request.query_params)
    if missing:
        return sorry(request, 404, UNFILLED, name=missing)
    return to_page(request, make_token(site.signing_key, External.from_query(request.query_params)))


def to_page(request: Request, token: str) -> Response:
    """To the page where this participant is. The link's query stays: before a session is there only it has the names
    that the visitor came with, and the language chosen by hand."""
    query = f"?{request.url.query}" if request.url.query else ""
    return RedirectResponse(f"/s/{token}{query}", 303)


@router.get("/s/{token}")
def here(request: Request, site: AtSite, token: Token) -> Response:
    """Where this participant is."""
    with site.database.reading() as connection:
        session = find(request, connection, token)
        data = current_page(request, site, connection, token, session)
    return answer(request, f"{data['step']}.html", data)


def current_page(
    request: Request, site: Site, connection: Connection, token: str, session: RowMapping | None
) -> dict[str, Any]:
    """The page of this session, or the consent page; the study's gate may stand before either."""
    if session is not None:
        return session_page(site, connection, session)
    language = visitor_language(request)
    standing = gate(connection, site.study.identity, site.mode)
    if standing != "open":
        return pages.shut_page(site.study, site.mode, token, language, standing)
    external = named(site, token, request.query_params)
    return pages.consent_page(site.study, site.mode, token, language, external)


def session_page(
    site: Site, connection: Connection, session: Session, waiting: Sequence[RowMapping] = ()
) -> dict[str, Any]:
    """Where this session stands, `waiting` for its next presentations; a closed study ends it for who is under way."""
    if is_shut_out(site, connection, session):
        data = pages.shut_page(site.study, session["mode"], session["token"], session["language"], "closed")
        return data | {"session": session["id"]}
    return pages.page(connection, site.study, session, waiting)


def is_shut_out(site: Site, connection: Connection, session: Session) -> bool:
    """Whether the study was closed on them; never who gave every rating: they may comment, and see their code."""
    under_way = session["step"] in sessions.UNDER_WAY and session["finished_at"] is None
    return under_way and gate(connection, site.study.identity, site.mode) == "closed"


def named(site: Site, token: str, *queries: Mapping[str, str]) -> External | None:
    """The names that `token` was made of, from the first of `queries` that has any; None if of none.

    Raises `HTTPException` 404 if they are missing or another person's: nobody who came with names becomes nameless.
    """
    external = next(filter(None, map(External.from_query, queries)), None)
    if not belongs_to(site.signing_key, token, external):
        raise HTTPException(404, STRANGER if external else HALF)
    return external


@router.post("/s/{token}/consent")
def consent(request: Request, site: AtSite, token: Token, fields: Fields) -> Response:
    """Starts the session, once, however often it is sent. A program says `simulated=yes` and is kept apart."""
    is_simulated = fields.get("simulated") == "yes"
    with site.database.writing() as connection:
        begun = sessions.find(connection, token) is not None
        if not begun and gate(connection, site.study.identity, site.mode) != "open":
            return to_page(request, token)
        if not begun:
            visitor = sessions.Visitor(
                token=token,
                mode="simulated" if is_simulated else site.mode,
                external=named(site, token, request.query_params, fields),
                language=visitor_language(request, fields.get("language", "")),
                client=client_facts(request, site.study.settings.survey.record),
            )
            start(site, connection, visitor)
    return RedirectResponse(f"/s/{token}", 303)


def start(site: Site, connection: Connection, visitor: sessions.Visitor) -> None:
    """Starts the session of `visitor`, or raises `HTTPException`: 429 for a crowd, 409 for two studies in one place."""
    wait = site.limits.start(simulated=visitor.mode == "simulated")
    if wait:
        raise HTTPException(429, CROWD, retry_after(wait))
    try:
        sessions.start(connection, site.study, visitor, time.time())
    except sessions.AnotherVersion:
        log.error("nobody can start: another version of this study has live sessions in the same database")
        raise HTTPException(409, ANOTHER_VERSION) from None


@router.post("/s/{token}/declined")
def declined(request: Request, site: AtSite, token: Token, fields: Fields) -> Response:
    """Somebody does not agree to take part: thanked, and led back to where they came from. Stores nothing."""
    language = visitor_language(request, fields.get("language", ""))
    data = pages.declined_page(site.study, site.mode, token, language, named(site, token, request.query_params, fields))
    return answer(request, "declined.html", data)


def client_facts(request: Request, asked: Collection[str]) -> dict[str, str]:
    """Network address and browser, as far as the study asks to store them."""
    facts = {"address": request.client.host if request.client else "", "browser": request.headers.get("user-agent", "")}
    return {name: value[:500] for name, value in facts.items() if name in asked}


@router.post("/s/{token}/ratings")
async def ratings(request: Request, site: AtSite, token: Token, sent: answers.Posted) -> Response:
    """Stores one picture's answers; replies when they are on disk, with the page that comes next."""
    now = time.time()

    def save(connection: Connection) -> dict[str, Any]:
        """All of it in one transaction: checked, stored, and what comes next."""
        session = known(request, connection, token, lock=True)
        ahead = pages.looked_ahead(site.study)
        near = sessions.near(connection, session["id"], sent.place, 1 + ahead)
        planned = answers.accepted(site.study, session, near, sent)
        saved = answers.store(connection, planned, sent, now)
        waiting: Sequence[RowMapping] = [row for row in near if row["place"] > sent.place]
        if planned["answered_at"] is not None:
            waiting = sessions.unanswered(connection, session["id"], 1 + ahead)
        session = steps.after_answers(connection, site.study, session, waiting, now)
        return {"saved": saved, "next": session_page(site, connection, session, waiting)}

    try:
        reply = await asyncio.wrap_future(site.database.submit(save))
    except answers.Refused as refused:
        await run_in_threadpool(note_refusal, site, token, sent, refused, now)
        return JSONResponse({"error": told(request, refused.sentence, **refused.blanks)}, refused.http_status)
    return Response(to_json(reply), media_type="application/json")


@router.get("/s/{token}/withdraw")
def ask_withdraw(request: Request, site: AtSite, token: Token) -> Response:
    """Explains what withdrawing means."""
    with site.database.reading() as connection:
        session = find(request, connection, token)
    if session is None:
        return sorry(request, 404, STRANGER)
    return answer(
        request, "withdraw.html", pages.frame(site.study, session["mode"], token, "withdraw", session["language"])
    )


@router.get("/s/{token}/{step}")
def back(request: Request, token: Token) -> Response:
    """Somebody opens the address of a form, as after an error: to the page where they are."""
    return to_page(request, token)


@router.post("/s/{token}/withdraw")
def withdraw(request: Request, site: AtSite, token: Token, fields: Fields) -> Response:
    """Deletes what this participant said; asked for twice, because it cannot be undone."""
    with site.database.writing() as connection:
        session = find(request, connection, token, lock=True)
        if session is None:
            return sorry(request, 404, STRANGER)
        leaves = fields.get("sure") == "yes" and session["step"] != "withdrawn"
        if leaves:
            sessions.withdraw(connection, session, time.time())
    if leaves:
        site.database.empty_log()
        strike_out(site, session["id"])
    return RedirectResponse(f"/s/{token}", 303)


@router.post("/s/{token}/{step}")
def leave_step(request: Request, site: AtSite, token: Token, step: str, fields: Fields) -> Response:
    """Leaves a step that asks nothing or asks by a form; a step that is not the current one stays as it is.

    422 is the same page again, which says what was wrong.
    """
    now = time.time()
    with site.database.writing() as connection:
        session = find(request, connection, token, lock=True)
        if session is None or step not in steps.LEAVE:
            return sorry(request, 404, STRANGER)
        if session["step"] == step and not is_shut_out(site, connection, session):
            problems = steps.LEAVE[step](connection, site.study, session, fields, now)
            if problems:
                again = pages.about_again(connection, site.study, session, fields, problems)
                return answer(request, "about.html", again, 422)
    return RedirectResponse(f"/s/{token}", 303)


def find(request: Request, connection: Connection, token: str, *, lock: bool = False) -> RowMapping | None:
    """The session under `token`, if it was started; errors from here on are told in its language."""
    session = sessions.find(connection, token, lock=lock)
    if session is not None:
        request.state.language = session["language"]
    return session


def known(request: Request, connection: Connection, token: str, *, lock: bool = False) -> Session:
    """The started session under `token`, or `Refused`."""
    session = find(request, connection, token, lock=lock)
    if session is None:
        raise answers.Refused(404, STRANGER)
    return session


def note_refusal(site: Site, token: str, sent: answers.Posted, refused: answers.Refused, now: float) -> None:
    """A refused answer leaves an event, so that the researcher sees that something was wrong with it."""
    with site.database.writing() as connection:
        session = sessions.find(connection, token)
        if session is None or session["step"] == "withdrawn":
            return
        if sessions.noted(connection, session["id"], "refused") < MOST_REFUSALS:
            detail = {"place": sent.place, "stimulus_sha256": sent.stimulus_sha256, "because": str(refused)}
            sessions.record(connection, session["id"], now, "refused", detail)
