"""The researcher's pages: how the study goes, the export, the report."""

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

from fastapi import APIRouter, Depends, Request, Response
from fastapi.responses import FileResponse, RedirectResponse, StreamingResponse

from fakesss.problem import BadInput
from study_server import counts
from study_server.admin_door import COOKIE, COOKIE_S, cookie_value, is_admin, is_secret
from study_server.export import ROWS, Source, table_text
from study_server.sessions import release_s
from study_server.site import AtSite, Fields, Mode, Site, answer, site_of, sorry

router = APIRouter(prefix="/admin")

TOO_MANY = "Too many wrong secrets; please wait a minute."


class Locked(Exception):
    """The admin's secret is needed."""


def unlocked(request: Request, site: AtSite) -> Site:
    """The site, for those who may see this page."""
    if not is_admin(request, site):
        raise Locked
    return site


Unlocked = Annotated[Site, Depends(unlocked)]


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
    value = cookie_value(site, time.time())
    response.set_cookie(COOKIE, value, max_age=COOKIE_S, path="/admin", httponly=True, samesite="strict", secure=secure)
    return response


@router.post("/logout")
def logout() -> Response:
    """Closes the door again."""
    response = RedirectResponse("/admin", 303)
    response.delete_cookie(COOKIE, path="/admin")
    return response


@router.get("")
def progress(request: Request, site: Unlocked) -> Response:
    """How many came, where they are, who left and when."""
    with site.database.reading() as connection:
        figures = counts.overview(connection, site.study.identity, site.mode, time.time(), release_s(site.study))
    data = {"step": "admin", "title": site.study.title, "mode": site.mode, "tables": list(ROWS), **figures}
    return answer(request, "admin.html", data)


@router.get("/export/{table}.csv")
def download(request: Request, site: Unlocked, table: str, mode: Mode | None = None) -> Response:
    """One table of the export, sent as it is read: of `mode`, or else of the mode that is served."""
    if table not in ROWS:
        return sorry(request, 404, "There is no such table.")

    chosen = mode or site.mode

    def pieces() -> Iterator[str]:
        with site.database.reading() as connection:
            yield from table_text(table, Source(connection, site.study, chosen, site.salt))

    disposition = f'attachment; filename="{table}{"" if chosen == "live" else f"-{chosen}"}.csv"'
    return StreamingResponse(pieces(), media_type="text/csv", headers={"Content-Disposition": disposition})


@router.get("/report/{path:path}")
def report(request: Request, site: Unlocked, path: str) -> Response:
    """The report, written anew when its first page is asked for."""
    if site.reporter is None:
        return sorry(request, 404, "This server was started without a report; run `fakesss report` on the study.")
    with site.database.reading() as connection:
        figures = counts.overview(connection, site.study.identity, site.mode, time.time(), release_s(site.study))
    if not figures["ratings"]:
        return sorry(request, 409, "There are no ratings yet, so there is nothing to report.")
    try:
        folder = site.reporter.folder(anew=path in ("", "index.html"))
    except BadInput as problem:
        return sorry(request, 409, str(problem))
    wanted = file_inside(folder, path or "index.html")
    return FileResponse(wanted) if wanted else sorry(request, 404, "The report has no such file.")


def file_inside(folder: Path, name: str) -> Path | None:
    """The file of that name in or under `folder`, or None."""
    try:
        path = (folder / name).resolve()
        return path if path.is_relative_to(folder.resolve()) and path.is_file() else None
    except (OSError, ValueError):  # a name that no file can have: too long, or with a NUL
        return None
