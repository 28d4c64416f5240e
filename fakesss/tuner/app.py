"""The tuner's web application: the page, what it starts from, its WebSocket, and how refusals read."""

import asyncio
import contextlib
import logging
from collections.abc import AsyncIterator
from dataclasses import asdict

from fastapi import APIRouter, FastAPI, WebSocket
from fastapi.exceptions import RequestValidationError
from fastapi.responses import HTMLResponse
from fastapi.staticfiles import StaticFiles
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

from fakesss import __version__
from fakesss.calls import EFFECTS
from fakesss.media import MEDIA
from fakesss.problem import BadInput
from fakesss.shader_source import ShaderError
from fakesss.shapes import names
from fakesss.tuner import asking, keep
from fakesss.tuner.answers import Answer, refused
from fakesss.tuner.guards import BODY_LIMIT
from fakesss.tuner.page import HERE, page
from fakesss.tuner.presets import qualities
from fakesss.tuner.reload import watch_shaders
from fakesss.tuner.state import AtTuner, Gone, Tuner
from fakesss.tuner.viewer import Viewer

log = logging.getLogger(__name__)
router = APIRouter()


def create_app(tuner: Tuner) -> FastAPI:
    """The application of `tuner`, without its guards."""
    app = FastAPI(
        title="fakesss tune",
        docs_url=None,
        redoc_url=None,
        openapi_url=None,
        lifespan=watching,
        default_response_class=Answer,
        redirect_slashes=False,  # it would lead out of the address that holds the secret
        max_body_size=BODY_LIMIT,
    )
    app.state.tuner = tuner
    app.mount("/static", StaticFiles(directory=HERE / "static"))
    for part in (router, asking.router, keep.router):
        app.include_router(part)
    for problem in (BadInput, ShaderError):
        app.add_exception_handler(problem, unfit)
    app.add_exception_handler(RequestValidationError, not_understood)
    app.add_exception_handler(HTTPException, unanswerable)
    app.add_exception_handler(Gone, nobody)
    app.add_exception_handler(Exception, unexpected)
    return app


@contextlib.asynccontextmanager
async def watching(app: FastAPI) -> AsyncIterator[None]:
    """Loads the object, and looks after the shaders while the application runs."""
    tasks = [asyncio.create_task(work(app.state.tuner)) for work in (Tuner.begin, watch_shaders)]
    yield
    for task in tasks:
        task.cancel()


@router.get("/")
def the_page(tuner: AtTuner) -> HTMLResponse:
    """The tuner's page."""
    return HTMLResponse(page(tuner.base))


@router.get("/start.json")
def start(tuner: AtTuner) -> Answer:
    """What the page starts from."""
    from fakesss.tuner.looks import LOOKS  # loads matplotlib

    return Answer(
        {
            "base": tuner.base.model_dump(mode="json"),
            "objects": names(),
            "brought": tuner.uploads.names,
            "media": {name: asdict(medium) for name, medium in MEDIA.items()},
            "views": dict(LOOKS),
            "effects": list(EFFECTS),
            "qualities": qualities(tuner.base),
            "folder": str(tuner.folder),
            "shaders": str(tuner.shaders),
            "version": __version__,
        }
    )


@router.websocket("/socket")
async def socket(connection: WebSocket, tuner: AtTuner) -> None:
    """Wishes in, frames out."""
    await Viewer(tuner, connection).watch()


def unfit(request: Request, error: Exception) -> Response:
    """What a user can mend."""
    return refused(422, str(error))


def not_understood(request: Request, error: Exception) -> Response:
    """A body or an address that is not of the expected form."""
    assert isinstance(error, RequestValidationError)
    first = error.errors()[0]
    where = ".".join(str(part) for part in first["loc"])
    return refused(422, f"{where}: {first['msg']}.")


def unanswerable(request: Request, error: Exception) -> Response:
    """No such address, not with this method, a body that is longer than it said or cannot be read."""
    assert isinstance(error, HTTPException)
    sentences = {
        400: "The request could not be read: it is no JSON in UTF-8, or its numbers or tables go beyond all bounds.",
        404: "There is no such page.",
        405: f"This address does not take {request.method}.",
    }
    sentence = sentences.get(error.status_code, f"{error.detail}.")
    return refused(error.status_code, sentence, error.headers)


def nobody(request: Request, error: Exception) -> Response:
    """The browser has left; nobody reads this."""
    return Response(status_code=499)


def unexpected(request: Request, error: Exception) -> Response:
    """A fault of ours, which is logged on its way up."""
    return refused(500, "Something went wrong here, a fault of the program; its terminal tells more.")
