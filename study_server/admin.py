"""The researcher's page: the door, how the study goes, and whether people are let in."""

import time
from typing import Any, get_args

from fastapi import APIRouter, Request, Response
from fastapi.responses import JSONResponse, RedirectResponse
from sqlalchemy import Connection

from study_server import counts, gates, happenings
from study_server.downloads import router as downloads
from study_server.exports.export import ROWS
from study_server.gates import Gate
from study_server.guards.admin_door import COOKIE_S, Locked, Unlocked, cookie_name, cookie_value, is_secret
from study_server.sessions import release_s
from study_server.site import AtSite, Fields, Site, answer, site_of, sorry, wants_json
from study_server.times import times

__all__ = ["Locked", "ask_secret", "router"]

router = APIRouter(prefix="/admin")
router.include_router(downloads)

TOO_MANY = "Too many wrong secrets; please wait a minute."


def ask_secret(request: Request, _: Exception) -> Response:
    """The door."""
    if "authorization" in request.headers and site_of(request).throttle.is_closed():
        return sorry(request, 429, TOO_MANY)
    data = {"step": "login", "title": "Admin", "error": "The admin secret is needed."}
    response = answer(request, "login.html", data, 401)
    response.headers["WWW-Authenticate"] = "Bearer"
    return response


@router.post("/login")
def login(request: Request, site: AtSite, fields: Fields) -> Response:
    """Opens the door to the browser that brings the secret."""
    if not is_secret(site, fields.get("secret", "").strip()):
        if site.throttle.is_closed():
            return sorry(request, 429, TOO_MANY)
        site.throttle.note()
        data = {"step": "login", "title": "Admin", "error": "That is not the admin secret of this study."}
        return answer(request, "login.html", data, 401)
    response = RedirectResponse("/admin", 303)
    secure = request.url.scheme == "https"
    name, value = cookie_name(site), cookie_value(site, time.time())
    response.set_cookie(name, value, max_age=COOKIE_S, path="/admin", httponly=True, samesite="strict", secure=secure)
    return response


@router.post("/logout")
def logout(site: AtSite) -> Response:
    """Closes the door again."""
    response = RedirectResponse("/admin", 303)
    response.delete_cookie(cookie_name(site), path="/admin")
    return response


@router.get("/login", include_in_schema=False)
@router.get("/logout", include_in_schema=False)
@router.get("/gate", include_in_schema=False)
def back() -> Response:
    """Somebody opens the address of a form, as by Enter in the address bar: to the page, or its door."""
    return RedirectResponse("/admin", 303)


@router.get("")
def progress(request: Request, site: Unlocked) -> Response:
    """How many came, where they are, who left and when, how long they take, and what to do about it."""
    now = time.time()
    with site.database.reading() as connection:
        data = {
            "step": "admin",
            "title": site.study.title,
            "mode": site.mode,
            "tables": list(ROWS),
            "at": round(now, 3),
            "is_sqlite": site.database.is_sqlite,
            **figures(connection, site, now),
        }
    return answer(request, "admin.html", data)


def figures(connection: Connection, site: Site, now: float) -> dict[str, Any]:
    """Everything on the page that changes while people take part, of one snapshot."""
    which = (site.study.identity, site.mode)
    return {
        **counts.overview(connection, *which, now, release_s(site.study)),
        "times": times(connection, *which),
        "withdrawals": happenings.withdrawals(connection, *which),
        "refusals": happenings.refusals(connection, *which),
        "retention": happenings.retention(connection, site.study, now),
        "gate": gates.standing(connection, *which),
    }


@router.post("/gate")
def change_gate(request: Request, site: Unlocked, fields: Fields) -> Response:
    """Pauses, closes or opens the study. Closing it on people who are under way needs `sure=yes`."""
    which, now = (site.study.identity, site.mode), time.time()
    state: Gate | None = next((known for known in get_args(Gate) if known == fields.get("state")), None)
    if state is None:
        return sorry(request, 422, "state: must be open, paused or closed.")
    with site.database.writing() as connection:
        active = counts.active(connection, *which, now, release_s(site.study))
        if state == "closed" and active and fields.get("sure") != "yes":
            return ask_to_close(request, site, active)
        gates.set_gate(connection, *which, state, now)
        standing = gates.standing(connection, *which)
    return JSONResponse(standing) if wants_json(request) else RedirectResponse("/admin", 303)


def ask_to_close(request: Request, site: Site, active: int) -> Response:
    """Tells how many people would be turned away."""
    people = "1 person is" if active == 1 else f"{active} people are"
    error = f"{people} under way and would be turned away; to close all the same, send sure=yes."
    data = {"step": "close", "title": site.study.title, "mode": site.mode, "active": active, "error": error}
    return answer(request, "close.html", data, 409)
