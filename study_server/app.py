"""The web application of one study."""

import contextlib
import logging
import os
from collections.abc import AsyncIterator, Callable, Iterator
from pathlib import Path

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from fastapi.staticfiles import StaticFiles
from sqlalchemy.exc import DatabaseError, TimeoutError
from starlette.exceptions import HTTPException

from fakesss.problem import BadInput
from study_server import admin, participant, pictures
from study_server.gates import gate
from study_server.guards.admin_door import SHORTEST_SECRET
from study_server.guards.web_safety import WebSafety
from study_server.manifest import load_study, study_changed
from study_server.openapi import described
from study_server.screen import plates
from study_server.site import HERE, AtSite, Mode, Reporter, Site, site_of, sorry
from study_server.storage.adoption import adopt_study
from study_server.storage.database import chosen_url, open_database, open_existing, reason, secret
from study_server.storage.engines import shown_url
from study_server.wording.texts import N_

log = logging.getLogger(__name__)

SECRET_VARIABLE = "FAKESSS_ADMIN_SECRET"


def create_app(
    study_folder: Path,
    *,
    database_url: str | None = None,
    mode: Mode = "live",
    make_report: Callable[[], Path] | None = None,
    report_script: str = "'none'",
) -> FastAPI:
    """The application that serves the built study in `study_folder`; `app.state.site` is its `Site`.

    `database_url` defaults to ratings.sqlite in the folder. `make_report` writes the report and returns its folder;
    `report_script` names the one script its page may run, as a source of a Content-Security-Policy ('sha256-...').
    Raises `BadInput` if the study is not built, study.toml or a picture is not as built, or the database is unusable.
    """
    site = open_site(Path(study_folder), database_url, mode, make_report)
    app = FastAPI(title=site.study.title, docs_url=None, redoc_url=None, lifespan=closing)
    app.state.site = site
    frame_ancestors = site.study.settings.survey.frame_ancestors
    app.add_middleware(WebSafety, report_script=report_script, frame_ancestors=frame_ancestors)
    app.mount("/static", StaticFiles(directory=HERE / "static"))
    app.get("/health")(health)
    app.head("/health", include_in_schema=False)(health)  # as monitors ask
    for router in (pictures.router, plates.router, admin.router, participant.router):
        app.include_router(router)
    app.add_exception_handler(DatabaseError, not_saved)
    app.add_exception_handler(TimeoutError, not_saved)
    app.add_exception_handler(RequestValidationError, not_understood)
    app.add_exception_handler(HTTPException, no_page)
    app.add_exception_handler(admin.Locked, admin.ask_secret)
    app.openapi = described(app)  # type: ignore[method-assign]
    return app


@contextlib.asynccontextmanager
async def closing(app: FastAPI) -> AsyncIterator[None]:
    """Closes the database when no request is under way any more: uvicorn then ends the process by the signal it got."""
    yield
    app.state.site.database.close()


def open_site(folder: Path, url: str | None, mode: Mode, make_report: Callable[[], Path] | None) -> Site:
    """Study and database, opened and matched."""
    study = load_study(folder)
    if study_changed(study):
        raise BadInput(
            f"{folder / 'study.toml'}: has changed since the pictures were built; run `fakesss build {folder}`, "
            "or restore it"
        )
    url = chosen_url(folder, url)
    database = open_database(url)
    with blaming(url):
        adopt_study(database, study, shown_url(url))
        return Site(
            study=study,
            database=database,
            mode=mode,
            signing_key=f"{secret(database, 'signing_key')} {mode} {study.identity}",
            salt=secret(database, "salt"),
            admin_secret=given_secret() or secret(database, "admin_secret"),
            reporter=Reporter(make_report) if make_report else None,
        )


@contextlib.contextmanager
def blaming(url: str) -> Iterator[None]:
    """Says that the database at `url` can be opened and not written: its disk is full, or it has just gone."""
    try:
        yield
    except DatabaseError as error:
        raise BadInput(
            f"{shown_url(url)}: cannot be written ({reason(error)}); check its disk and its rights"
        ) from None


def admin_secret(study_folder: Path, database_url: str | None = None) -> str:
    """The secret that opens /admin of this study: from FAKESSS_ADMIN_SECRET, or kept in its database.

    `BadInput` if that is not there.
    """
    given = given_secret()
    if given:
        return given
    database = open_existing(Path(study_folder), database_url)
    with blaming(chosen_url(Path(study_folder), database_url)):
        return secret(database, "admin_secret")


def given_secret() -> str:
    """The environment's secret, "" if there is none; `BadInput` if it is too short."""
    given = os.environ.get(SECRET_VARIABLE, "")
    if 0 < len(given) < SHORTEST_SECRET:
        raise BadInput(f"{SECRET_VARIABLE}: has {len(given)} characters; give at least {SHORTEST_SECRET}, or none")
    return given


def health(site: AtSite) -> Response:
    """200 if a rating could be brought to disk now, else 503."""
    if site.health.is_well(site.database):
        with site.database.reading() as connection:
            standing = gate(connection, site.study.identity, site.mode)
        facts = {"status": "ok", "study": site.study.title, "identity": site.study.identity, "mode": site.mode}
        return JSONResponse(facts | {"gate": standing})
    return JSONResponse({"status": "the database cannot be written"}, 503)


def not_saved(request: Request, error: Exception) -> Response:
    """The database failed: nothing was stored, and the browser is to try again."""
    site_of(request).health.doubt()
    log.error("the database failed: %s", reason(error) if isinstance(error, DatabaseError) else error)
    return sorry(request, 503, N_("This could not be saved just now; please try again in a moment."))


def not_understood(request: Request, error: Exception) -> Response:
    """A body or an address that is not of the expected form."""
    assert isinstance(error, RequestValidationError)
    first = error.errors()[0]
    where = ".".join(str(part) for part in first["loc"])
    return sorry(request, 422, f"{where}: {first['msg']}.")


def no_page(request: Request, error: Exception) -> Response:
    """No such address, not with this method, or what an endpoint refuses: in its words where it has any."""
    assert isinstance(error, HTTPException)
    response = sorry(
        request, error.status_code, N_("There is no such page.") if error.detail == "Not Found" else error.detail
    )
    response.headers.update(error.headers or {})
    return response
