"""What every address takes and gives, for programs that read /openapi.json.

Endpoints take forms and return the same dict as a page or as JSON, which FastAPI cannot read off their signatures; so
it stands here, in one table. tests/study_server/test_openapi_fuzz.py holds the server to it.
"""

from collections.abc import Callable
from typing import Any

from fastapi import FastAPI

Schema = dict[str, Any]

TEXT: Schema = {"type": "string"}
NUMBER: Schema = {"type": "number"}
REF = "#/components/schemas/"


def record(*required: str, **properties: Schema) -> Schema:
    """A JSON object; it may hold more than is named."""
    return {"type": "object", "required": list(required), "properties": properties}


def pointer(name: str) -> Schema:
    """One of the `SCHEMAS`."""
    return {"$ref": REF + name}


SCHEMAS: dict[str, Schema] = {
    "Error": record("error", error=TEXT),
    "Page": record("step", "title", "language", step=TEXT, title=TEXT, language=TEXT, here=TEXT, mode=TEXT),
    "Health": record("status", status=TEXT, study=TEXT, identity=TEXT, mode=TEXT, gate=TEXT),
    "Saved": record("question", "rating", "revision", question=TEXT, rating=NUMBER, revision=NUMBER),
    "Acknowledged": record(
        "saved", "next", saved={"type": "array", "items": pointer("Saved")}, next=pointer("Page")
    ),
    "Progress": record("step", "title", "started", "finished", "gate", step=TEXT, title=TEXT, gate=pointer("Gate")),
    "Gate": record("state", "meaning", "history", state=TEXT, meaning=TEXT, history={"type": "array"}),
}  # fmt: skip

STATUS = {
    200: "as asked for",
    303: "go there",
    304: "as you have it",
    400: "the body is not JSON, or no form",
    401: "the admin secret is needed",
    403: "posted from another site",
    404: "there is none",
    405: "not with this method",
    408: "slower than a minute",
    409: "not now",
    410: "withdrawn",
    413: "more than 128 KiB",
    422: "not of the form that is asked for",
    429: "asked too often; wait as long as Retry-After says",
    503: "nothing was stored; try again",
}

Media = dict[str, Schema]


def page(name: str = "Page") -> Media:
    """For people and for programs."""
    return {"text/html": {}, "application/json": {"schema": pointer(name)}}


def json_only(name: str) -> Media:
    """For programs."""
    return {"application/json": {"schema": pointer(name)}}


def file(media_type: str) -> Media:
    """A download."""
    return {media_type: {}}


def form(*required: str, **fields: Schema) -> Schema:
    """The body of a post: a browser's form, or a JSON object of strings."""
    schema = record(*required, **fields)
    return {
        "content": {"application/x-www-form-urlencoded": {"schema": schema}, "application/json": {"schema": schema}}
    }


PERSON = {name: TEXT | {"maxLength": 200} for name in ("STUDY_ID", "PROLIFIC_PID", "SESSION_ID")}
YES: Schema = {"type": "string", "enum": ["yes"]}
STEP_FORM = form(
    age=TEXT, background=TEXT, vision=TEXT, comments=TEXT, px_per_mm=TEXT, card=TEXT, device_pixel_ratio=TEXT
)
POSTED = (400, 403, 408, 413, 422)
SESSION = (404, 429, 503)
LOCKED = (401, 422, 429, 503)

ADDRESSES: dict[tuple[str, str], tuple[Media, tuple[int, ...], Schema | None]] = {
    ("get", "/health"): (json_only("Health"), (503,), None),
    ("get", "/picture/{sha256}.png"): (file("image/png"), (304, 404, 503), None),
    ("get", "/plate/{index}.svg"): (file("image/svg+xml"), (404, 422), None),
    ("get", "/admin/export/psych-ds.zip"): (file("application/zip"), LOCKED, None),
    ("get", "/admin/export/{table}.csv"): (file("text/csv"), (404, *LOCKED), None),
    ("get", "/admin/backup"): (file("application/vnd.sqlite3"), (409, *LOCKED), None),
    ("get", "/admin/report/{path}"): (file("*/*"), (404, 409, *LOCKED), None),
    ("post", "/admin/login"): ({}, (303, 401, 429, *POSTED), form("secret", secret=TEXT)),
    ("post", "/admin/logout"): ({}, (303, 403), None),
    ("get", "/admin"): (page("Progress"), LOCKED, None),
    ("post", "/admin/gate"): (
        page("Gate"), (303, 409, *LOCKED, *POSTED),
        form("state", state={"type": "string", "enum": ["open", "paused", "closed"]}, sure=YES),
    ),
    ("get", "/"): ({}, (303, 404), None),
    ("get", "/s/{token}"): (page(), SESSION, None),
    ("post", "/s/{token}/consent"): ({}, (303, 409, *SESSION, *POSTED), form(**PERSON, language=TEXT, simulated=YES)),
    ("post", "/s/{token}/declined"): (page(), (*SESSION, *POSTED), form(**PERSON, language=TEXT)),
    ("post", "/s/{token}/ratings"): (json_only("Acknowledged"), (409, 410, *SESSION, *POSTED), None),
    ("get", "/s/{token}/withdraw"): (page(), SESSION, None),
    ("post", "/s/{token}/withdraw"): ({}, (303, *SESSION, *POSTED), form(sure=YES)),
    ("get", "/s/{token}/{step}"): ({}, (303, *SESSION), None),
    ("post", "/s/{token}/{step}"): ({}, (303, *SESSION, *POSTED), STEP_FORM),
}  # fmt: skip
"""(method, path): what 200 gives (nothing: it never answers 200), the other statuses, the form if it takes one."""


def responses(media: Media, others: tuple[int, ...]) -> Schema:
    """The operation's answers; every refusal is one sentence in `error`, to people on a page."""
    found: dict[str, Schema] = {"200": {"description": STATUS[200], "content": media}} if media else {}
    for status in sorted({*others, 405}):
        found[str(status)] = {"description": STATUS[status]}
        if status >= 400:
            found[str(status)]["content"] = page("Error")
        if status == 303:
            found["303"]["headers"] = {"Location": {"required": True, "schema": TEXT}}
    if "503" in found and "Health" in str(media):
        found["503"]["content"] = json_only("Health")
    return found


def described(app: FastAPI) -> Callable[[], Schema]:
    """The application's own description, completed by the table; made once."""
    plain = app.openapi

    def openapi() -> Schema:
        """FastAPI's description with our schemas, the secret and what each address may reply."""
        description = plain()
        components = description.setdefault("components", {})
        components.setdefault("schemas", {}).update(SCHEMAS)
        components["securitySchemes"] = {"secret": {"type": "http", "scheme": "bearer"}}
        for (method, path), (media, others, body) in ADDRESSES.items():
            operation = description["paths"][path][method]
            operation["responses"] = responses(media, others)
            if body:
                operation["requestBody"] = body
            if path.startswith("/admin") and 401 in others and path != "/admin/login":
                operation["security"] = [{"secret": []}]
        return description

    return openapi
