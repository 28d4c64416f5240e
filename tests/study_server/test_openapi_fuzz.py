"""Requests that nobody would think of, made from the server's own OpenAPI, everywhere and at every step of a session.

Whatever is sent: no 5xx, and an answer of a status, a type and a shape that OpenAPI announces. SQLite and PostgreSQL,
which takes less: no NUL in text, no integer beyond 2^31.
"""

import contextlib
import http.client
import json
from collections.abc import Iterator
from dataclasses import dataclass
from urllib.parse import quote, urlsplit

import httpx
import pytest
import schemathesis
from every_step import at_every_step
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from schemathesis import Case, GenerationMode
from schemathesis.checks import not_a_server_error
from schemathesis.openapi.checks import UndefinedStatusCode
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_headers_conformance,
    response_schema_conformance,
    status_code_conformance,
)
from study_fixture import write_study
from survey_client import ABOUT, JSON, Participant

from study_server.app import create_app
from study_server.guards.rate_limit import Limits
from study_server.openapi import ADDRESSES
from study_server.serve import running

CHECKS = [
    not_a_server_error,
    status_code_conformance,
    content_type_conformance,
    response_headers_conformance,
    response_schema_conformance,
]
COUNTS = [5, pytest.param(500, marks=[pytest.mark.long, pytest.mark.timeout(3600)])]
"""Examples of each operation, well-formed and again malformed."""

STRANGE = (
    "inside\0NUL", "", "\ud800", "..", "../../ratings.sqlite", "'; DROP TABLE ratings; --", "{{7*7}}", "9" * 5000,
    "1e999", "NaN", "é" * 300, "\r\nSet-Cookie: a=b", "=1+1", "٣", "\N{RIGHT-TO-LEFT OVERRIDE}", "a/b", "%2e%2f", "%00",
)  # fmt: skip
"""Text that has broken programs."""

STRANGE_JSON = (
    *STRANGE[:1], None, True, 10**400, -(2**63), 2**31, 1e308, [], {}, [[["deep"]]], {"a": {"b": "c"}}, "4", 4.5,
    *STRANGE[1:],
)  # fmt: skip


@dataclass(frozen=True)
class Served:
    """A served study with people at every step of it."""

    url: str
    secret: str
    people: dict[str, Participant]

    @property
    def bearer(self) -> dict[str, str]:
        """What opens /admin."""
        return {"Authorization": f"Bearer {self.secret}"}


@pytest.fixture(scope="module", params=["sqlite", "postgres"])
def served_study(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    about = [{"name": name, "text": f"{name}?"} for name in (*ABOUT, "job")]  # free text
    survey = {"about": about, "checks": 1, "record": ["address", "browser"]}
    study = write_study(tmp_path_factory.mktemp("fuzz"), survey=survey)
    with contextlib.ExitStack() as stack:
        url = None
        if request.param == "postgres":
            url = stack.enter_context(request.getfixturevalue("postgres").new_database())
        app = create_app(study, database_url=url)
        for name in Limits.__dataclass_fields__:  # they would stop this, as they should
            getattr(app.state.site.limits, name).per_second = 1e9
        address = stack.enter_context(running(app))
        yield Served(address, app.state.site.admin_secret, at_every_step(address))


def order(address: tuple[str, str]) -> tuple[bool, tuple[str, str]]:
    """What ends sessions or lets nobody in comes last."""
    return address in [("post", "/s/{token}/withdraw"), ("post", "/admin/gate")], address


@pytest.mark.parametrize("count", COUNTS)
def test_every_operation_answers_as_announced(served_study: Served, count: int) -> None:
    api = schemathesis.openapi.from_url(f"{served_study.url}/openapi.json")
    operations = {(each.ok().method, each.ok().path): each.ok() for each in api.get_all_operations()}
    assert operations.keys() == ADDRESSES.keys()
    httpx.post(f"{served_study.url}/admin/gate", headers=served_study.bearer, data={"state": "open"})
    people = at_every_step(served_study.url, f"fuzz {count}")  # some of whom this withdraws
    tokens = st.sampled_from([person.here.removeprefix("/s/") for person in people.values()])
    seen: set[int] = set()
    for address in sorted(operations, key=order):
        operation = operations[address]
        for mode in GenerationMode if operation.body or operation.query else [GenerationMode.POSITIVE]:
            case = operation.as_strategy(generation_mode=mode)

            @given(case=case, token=tokens, accept=st.sampled_from(["text/html", "application/json"]))
            @settings(max_examples=count, deadline=None, suppress_health_check=list(HealthCheck), database=None)
            def answers_as_announced(case: Case, token: str, accept: str) -> None:
                if "token" in (case.path_parameters or {}):
                    case.path_parameters["token"] = token
                headers = {"Accept": accept} | (served_study.bearer if case.path.startswith("/admin") else {})
                response = case.call(headers=headers, allow_redirects=False)
                case.validate_response(response, checks=CHECKS, headers=headers)
                seen.add(response.status_code)

            answers_as_announced()
    httpx.post(f"{served_study.url}/admin/gate", headers=served_study.bearer, data={"state": "open"})
    assert seen >= {200, 303, 400, 404, 422}


def test_a_status_that_is_not_announced_is_noticed(served_study: Served) -> None:
    """The test above can fail."""
    api = schemathesis.openapi.from_url(f"{served_study.url}/openapi.json")
    del api.raw_schema["paths"]["/s/{token}"]["get"]["responses"]["404"]
    case = api["/s/{token}"]["GET"].Case(path_parameters={"token": "nobody"})
    with pytest.raises(BaseExceptionGroup) as found:
        case.call_and_validate(checks=CHECKS, headers=JSON)
    assert found.group_contains(UndefinedStatusCode)


def raw(url: str, method: str, path: str, body: bytes | None = None, headers: dict[str, str] | None = None) -> int:
    """The status of a request whose path is sent to the letter."""
    connection = http.client.HTTPConnection(urlsplit(url).netloc, timeout=60)
    try:
        connection.putrequest(method, path, skip_accept_encoding=True)
        for name, value in {**(headers or {}), "Content-Length": str(len(body or b""))}.items():
            connection.putheader(name, value)
        connection.endheaders(body)
        response = connection.getresponse()
        response.read()
        return response.status
    finally:
        connection.close()


def test_strange_values_at_every_step(served_study: Served) -> None:
    """In every field, as a form and as JSON; nobody is anywhere else afterwards than the server says."""
    with httpx.Client(base_url=served_study.url, headers=JSON) as client:
        for step, person in served_study.people.items():
            for value in STRANGE_JSON if step in ("consent", "about", "screen", "comments") else STRANGE_JSON[:2]:
                names = ("job", "comments", "language", "px_per_mm", "plate_1", "STUDY_ID", "SESSION_ID")
                fields = ABOUT | dict.fromkeys(names, value)
                body = json.dumps(fields).encode()
                address = f"{person.here}/{step}"
                reply = client.post(address, content=body, headers={"Content-Type": "application/json"})
                assert reply.status_code < 500, (step, value)
                form = {name: str(given).encode("utf-8", "surrogatepass") for name, given in fields.items()}
                assert client.post(address, data=form).status_code < 500, (step, value)
            assert client.get(person.here, params=person.state.get("external", {})).status_code == 200


def test_strange_answers(served_study: Served) -> None:
    """One field of a rating's body at a time."""
    person = served_study.people["trials"]
    sound = person.answers()
    for value in STRANGE_JSON:
        strange = [{**sound, name: value} for name in sound]
        strange += [{**sound, "answers": [{**sound["answers"][0], name: value}]} for name in sound["answers"][0]]
        strange += [{**sound, "display": {**sound["display"], name: value}} for name in sound["display"]]
        strange += [{**sound, str(value): value}]
        for body in strange:
            reply = person.client.post(
                f"{person.here}/ratings",
                content=json.dumps(body, allow_nan=True).encode(),
                headers={"Content-Type": "application/json"},
            )
            assert reply.status_code in (200, 400, 404, 409, 422), (body, reply.text)
            assert reply.status_code == 200 or reply.json()["error"]


KINDS = (
    "text/plain",
    "application/jsonp",
    "multipart/form-data",
    "multipart/form-data; boundary=x",
    "application/json; charset=x",
)
BODIES = (b"", b"{}", b"--x\r\n\r\nbroken", b"\xff\xfe", b"a=%00&b=%ff", b"[" * 5000)


def test_wrong_content_types(served_study: Served) -> None:
    for person in served_study.people.values():
        for step in ("consent", "ratings", "comments"):
            for number, body in enumerate(BODIES):
                headers = {"Content-Type": KINDS[number % len(KINDS)]}
                assert raw(served_study.url, "POST", f"{person.here}/{step}", body, headers) < 500


PLACES = ("/picture/{}.png", "/plate/{}.svg", "/admin/export/{}.csv", "/admin/report/{}", "/s/{}", "/static/{}", "/{}")
OUTSIDE = (
    "/static/../app.py", "/static/..%2fapp.py", "/static/%2e%2e/app.py", "//etc/passwd", "/picture/../ratings.sqlite",
    "/admin/report/../../ratings.sqlite", "/admin/report/%2e%2e/ratings.sqlite",
)  # fmt: skip


def test_paths_lead_nowhere_else(served_study: Served) -> None:
    """Table, picture, plate, token, step and report path, quoted and to the letter."""
    here = served_study.people["about"].here
    for value in STRANGE:
        text = value.encode("utf-8", "surrogatepass")
        spellings = {quote(text, safe=""), quote(text, safe="/.%{}*'+"), quote(text, safe="").replace(".", "%2E")}
        for place in (*PLACES, here + "/{}"):
            for spelling in spellings:
                status = raw(served_study.url, "GET", place.format(spelling), headers=served_study.bearer)
                assert status < 500, (place, value)
        for spelling in spellings:
            assert raw(served_study.url, "POST", f"{here}/{spelling}") < 500, value
    for path in OUTSIDE:
        assert raw(served_study.url, "GET", path, headers=served_study.bearer) in (404, 405)


METHODS = ("PUT", "PATCH", "DELETE", "OPTIONS", "TRACE", "HEAD", "PROPFIND")


def test_wrong_methods(served_study: Served) -> None:
    here = served_study.people["trials"].here
    for path in ("/", "/health", "/admin", "/admin/gate", "/openapi.json", here, f"{here}/ratings", f"{here}/withdraw"):
        for method in METHODS:
            status = raw(served_study.url, method, path, headers=served_study.bearer)
            assert status == 405 or (method == "HEAD" and status < 500)
