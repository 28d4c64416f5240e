"""What every endpoint needs at hand, and how it answers: the same dict as a page or as JSON."""

import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Literal

from fastapi import Depends, Request, Response
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from study_server.guards.rate_limit import Limits
from study_server.guards.throttle import Throttle
from study_server.health import Health
from study_server.manifest import BuiltStudy
from study_server.storage.database import Database
from study_server.wording.language import catalogue, negotiated, words
from study_server.wording.templating import templates
from study_server.wording.texts import N_

Mode = Literal["live", "pilot", "simulated"]

HERE = Path(__file__).parent


@dataclass
class Reporter:
    """Writes the report, one at a time, and remembers where."""

    make: Callable[[], Path]
    lock: threading.Lock = field(default_factory=threading.Lock)
    written: Path | None = None

    def folder(self, *, anew: bool) -> Path:
        """The report's folder; the report is written first if it should be new or there is none."""
        with self.lock:
            if anew or self.written is None:
                self.written = Path(self.make())
            return self.written


@dataclass(frozen=True)
class Site:
    """One served study."""

    study: BuiltStudy
    database: Database
    mode: Mode
    signing_key: str
    salt: str
    admin_secret: str
    reporter: Reporter | None = None
    throttle: Throttle = field(default_factory=Throttle)
    limits: Limits = field(default_factory=Limits)
    health: Health = field(default_factory=Health)


def site_of(request: Request) -> Site:
    """The site that this request came to."""
    site: Site = request.app.state.site
    return site


async def at_site(request: Request) -> Site:
    """The same for endpoints; asynchronous, because what is not is run in another thread, which costs more than it."""
    return site_of(request)


AtSite = Annotated[Site, Depends(at_site)]


async def posted_fields(request: Request) -> dict[str, str]:
    """A form's fields, posted by a browser's form or as a JSON object of strings; lines end in a line feed.

    A form sends two characters for a line's end where one was typed. Raises `HTTPException` 400 for a body that is no
    JSON, 422 for text that not every database can hold.
    """
    if request.headers.get("content-type", "").startswith("application/json"):
        try:
            data = await request.json() if await request.body() else {}
        except (ValueError, RecursionError):
            raise HTTPException(400, "The body is not JSON.") from None
        items = data.items() if isinstance(data, dict) else ()
        fields = {key: str(value) for key, value in items if isinstance(value, (str, int, float))}
    else:
        fields = {key: value for key, value in (await request.form()).items() if isinstance(value, str)}
    if not is_text("".join((*fields, *fields.values()))):
        raise HTTPException(422, "The body holds what is no text: half letters (lone surrogates), or NUL.")
    return {key: value.replace("\r\n", "\n").replace("\r", "\n") for key, value in fields.items()}


Fields = Annotated[dict[str, str], Depends(posted_fields)]


def is_text(text: str) -> bool:
    """Whether `text` can be stored: JSON's escapes can spell halves of letters, and PostgreSQL has no place for NUL."""
    try:
        return b"\0" not in text.encode()
    except UnicodeEncodeError:
        return False


def wants_json(request: Request) -> bool:
    """Whether the caller is a program: it says so, or wants a file that only programs read."""
    return "application/json" in request.headers.get("accept", "") or request.url.path.endswith(".json")


def answer(request: Request, template: str, data: Mapping[str, Any], http_status: int = 200) -> Response:
    """`data` as a page in its language, or as JSON if that is what was asked for."""
    language = data.get("language", "en")
    if wants_json(request):
        response: Response = JSONResponse(dict(data), http_status)
    else:
        response = templates.TemplateResponse(request, template, {**data, "language": language}, http_status)
    response.headers["Content-Language"] = language
    response.headers["Vary"] = "Accept, Accept-Language"
    return response


def sorry(request: Request, http_status: int, sentence: str, **blanks: object) -> Response:
    """An error in one sentence, {blanks} filled in, in the language of whom it is for."""
    language, settings = language_of(request, sentence), site_of(request).study.settings
    data = {
        "step": "error",
        "title": words(settings, language)(settings.named()["title"]),
        "heading": catalogue(language).gettext(NOT_FOUND if http_status == 404 else SORRY),
        "error": told(request, sentence, **blanks),
        "language": language,
    }
    return answer(request, "sorry.html", data, http_status)


NOT_FOUND, SORRY = N_("Not found"), N_("Sorry")


def told(request: Request, sentence: str, **blanks: object) -> str:
    """`sentence` with {blanks} filled in, in the language of whom it is for."""
    text = catalogue(language_of(request, sentence)).gettext(sentence)
    return text.format(**blanks) if blanks else text


def language_of(request: Request, sentence: str) -> str:
    """Of the session that the endpoint found (`request.state.language`), else of the visitor.

    English on admin pages, and where `sentence` is in no other language, being for programmers: no page has two.
    """
    found: str = getattr(request.state, "language", "") or visitor_language(request)
    is_translated = catalogue(found).gettext(sentence) != sentence
    return found if is_translated and not request.url.path.startswith("/admin") else "en"


def visitor_language(request: Request, chosen: str = "") -> str:
    """Of somebody whose session has not begun: chosen by hand (a form, ?language=de), or by the browser."""
    accepted = request.headers.get("accept-language", "")
    wanted = chosen or request.query_params.get("language", "")
    return negotiated(site_of(request).study.settings.survey, accepted, wanted)
