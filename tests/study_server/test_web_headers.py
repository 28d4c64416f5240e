"""What every answer carries, and what no page holds: a new address or a new page is looked at here by itself."""

from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path

import httpx
import pytest
from every_step import at_every_step
from study_fixture import write_study
from survey_client import Participant

from study_server.app import admin_secret, create_app
from study_server.openapi import ADDRESSES
from study_server.serve import running, served

REAL = {"{index}": "1", "{table}": "ratings", "{path}": "index.html", "{step}": "about"}
CACHED = {
    "/picture/": "public, max-age=31536000, immutable",
    "/plate/": "public, max-age=3600",
    "/static/": "no-cache",
}
UNLISTED = [
    ("get", "/openapi.json"),
    ("get", "/static/survey.css"),
    ("get", "/nothing"),
    ("put", "/"),
    ("options", "/"),
]


def headers_are_right(reply: httpx.Response, frames: str = "'none'") -> None:
    """Of any answer, refusals included."""
    headers, path = reply.headers, reply.request.url.path
    policy = headers["content-security-policy"]
    assert policy.startswith("default-src 'none'; script-src ")
    if not path.startswith("/admin/report/"):
        assert "unsafe" not in policy
        assert "form-action 'self'" in policy
    assert f"frame-ancestors {frames}" in policy
    assert "base-uri 'none'" in policy
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["referrer-policy"] == "same-origin"
    assert headers["x-robots-tag"] == "noindex, nofollow"
    assert headers["cross-origin-resource-policy"] == headers["cross-origin-opener-policy"] == "same-origin"
    expected = next((value for start, value in CACHED.items() if path.startswith(start)), "no-store")
    assert headers["cache-control"] == (expected if reply.status_code in (200, 304) else "no-store")
    assert not [name for name in headers if name.startswith("access-control-")]  # no other site may read it
    assert "server" not in headers
    assert "strict-transport-security" not in headers  # nobody said HTTPS


@pytest.mark.parametrize("origin", [None, "https://elsewhere.example"])
def test_every_address_answers_with_every_header(study: Path, origin: str | None) -> None:
    app = create_app(study)
    described = {(method, path) for path, methods in app.openapi()["paths"].items() for method in methods}
    assert described == set(ADDRESSES)
    assert {route.path for route in app.routes if hasattr(route, "path")} <= {"/static", "/openapi.json", "/health"}
    with running(app) as url:
        person = Participant(url).to_trials()
        real = {**REAL, "{token}": person.here[3:], "{sha256}": person.state["picture"]["sha256"]}
        with httpx.Client(base_url=url, headers={"Origin": origin} if origin else {}) as client:
            for method, template in [*sorted(ADDRESSES), *UNLISTED]:
                path = template
                for name, value in real.items():
                    path = path.replace(name, value)
                for secret in ("", admin_secret(study)):
                    bearer = {"Authorization": f"Bearer {secret}"} if secret else {}
                    reply = client.request(method, path, headers=bearer)
                    headers_are_right(reply)
                    refused = origin is not None and method not in ("get", "options")
                    assert (reply.status_code == 403) is refused, (method, path, reply.status_code)


class Page(HTMLParser):
    """What of a page would need a weaker policy, or would tell another site where it was linked from."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.wrong: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if tag in ("style", "base", "iframe", "object", "embed") or (tag == "script" and not given.get("src")):
            self.wrong.append(f"<{tag}>")
        self.wrong += [f"{tag} {name}" for name in given if name.startswith("on") or name in ("style", "srcdoc")]
        for name in ("src", "href", "action"):
            address = given.get(name) or ""
            if tag == "a" and address.startswith("http"):
                self.wrong += [] if "noreferrer" in (given.get("rel") or "") else [f"{tag} {address}"]
            elif ":" in address or address.startswith("//"):
                self.wrong.append(f"{tag} {name}={address}")


def test_the_reader_of_pages_sees_what_is_wrong() -> None:
    page = Page('<p onclick="x" style="y"><script>1</script><a href="https://a.example">b</a><img src="data:,">')
    assert page.wrong == ["p onclick", "p style", "<script>", "a https://a.example", "img src=data:,"]


def pages(study: Path, url: str) -> Iterator[tuple[str, str]]:
    """Every page there is: (name, HTML)."""
    people = at_every_step(url)
    html = {"Accept": "text/html"}
    with httpx.Client(base_url=url, headers=html, follow_redirects=True) as client:
        for step, person in people.items():
            yield step, client.get(person.here).text
        yield "ask to withdraw", client.get(f"{people['trials'].here}/withdraw").text
        yield "declined", client.post(f"{people['consent'].here}/declined", data={"STUDY_ID": "s"}).text
        yield "sorry", client.get("/nothing").text
        yield "login", client.get("/admin").text
        client.headers["Authorization"] = f"Bearer {admin_secret(study)}"
        yield "admin", client.get("/admin").text
        yield "ask to close", client.post("/admin/gate", data={"state": "closed"}).text
        client.post("/admin/gate", data={"state": "paused"})
        yield "paused", client.get("/").text
        client.post("/admin/gate", data={"state": "closed", "sure": "yes"})
        yield "closed", client.get(people["trials"].here).text


def test_no_page_needs_more_than_the_policy_allows(tmp_path: Path) -> None:
    survey = {"prolific": {"completed": "C1", "no_consent": "C2"}, "contact": "lab@example.org"}
    study = write_study(tmp_path, survey=survey)
    with served(study) as url:
        found = dict(pages(study, url))
    assert len(found) == 18
    assert {name: Page(text).wrong for name, text in found.items() if Page(text).wrong} == {}
    assert 'app.prolific.com/submissions/complete?cc=C1" rel="noreferrer" target="_top"' in found["done"]
    assert all("noindex" in text for text in found.values())


def test_a_study_names_the_sites_that_may_frame_it(tmp_path: Path) -> None:
    sites = ["https://lab.example", "https://*.example.org:8443"]
    with served(write_study(tmp_path, survey={"frame_ancestors": sites})) as url:
        headers_are_right(httpx.get(url), " ".join(sites))
        headers_are_right(httpx.get(f"{url}/s/nobody"), " ".join(sites))
        headers_are_right(httpx.get(f"{url}/admin"), "'none'")
        headers_are_right(httpx.get(f"{url}/admin/report/"), "'none'")


@pytest.mark.parametrize(
    "site", ["lab.example", "https://lab.example; script-src *", "*", "https://lab.example/path", ""]
)
def test_a_site_that_is_none_is_refused(tmp_path: Path, site: str) -> None:
    with pytest.raises(Exception, match="frame_ancestors"):
        create_app(write_study(tmp_path, survey={"frame_ancestors": [site]}))
