"""X-Forwarded-*: believed from stated proxies, from nobody else; what depends on it is looked at where it ends."""

import sqlite3
from pathlib import Path
from typing import Any

import httpx
import pytest
from server_process import server_process
from study_fixture import write_study
from survey_client import JSON, Participant

from study_server.app import admin_secret

FORGED = {
    "X-Forwarded-For": "203.0.113.9",
    "X-Forwarded-Proto": "https",
    "X-Forwarded-Host": "evil.example",
    "Forwarded": "for=203.0.113.9;proto=https;host=evil.example",
    "X-Real-IP": "203.0.113.9",
}
TRUSTED = [([], False), (["10.0.0.1", "fd00::/8"], False), (["127.0.0.1"], True), (["10.0.0.1", "127.0.0.0/8"], True)]


def stored_addresses(study: Path) -> list[str]:
    """What the database holds of visitors' network addresses."""
    with sqlite3.connect(study / "ratings.sqlite") as database:
        return [row[0] for row in database.execute("SELECT json_extract(client, '$.address') FROM sessions")]


@pytest.mark.parametrize(("proxies", "believed"), TRUSTED)
def test_whom_the_server_believes(tmp_path: Path, proxies: list[str], believed: bool) -> None:
    study = write_study(tmp_path / "study", survey={"record": ["address"]})
    with server_process(study, tmp_path / "log", proxies=proxies) as server:
        with httpx.Client(base_url=server.url, headers=FORGED, follow_redirects=True) as client:
            here = client.get("/", headers=JSON).json()["here"]
            page = client.post(f"{here}/consent")
            login = client.post("/admin/login", json={"secret": admin_secret(study)}, follow_redirects=False)
        assert ("strict-transport-security" in page.headers) is believed
        assert ("; secure" in login.headers["set-cookie"].lower()) is believed
        for flag in ("httponly", "samesite=strict", "path=/admin"):
            assert flag in login.headers["set-cookie"].lower()
        assert login.headers["location"] == "/admin"  # no host in it that somebody could forge
        # a host that is forwarded is nobody's word: the Host header alone says where a post must come from
        posts = [("http://evil.example", 403), ("https://evil.example", 403), (server.url, 303)]
        for origin, status in posts:
            reply = httpx.post(f"{server.url}{here}/consent", headers={**FORGED, "Origin": origin})
            assert reply.status_code == status
    assert stored_addresses(study) == ["203.0.113.9" if believed else "127.0.0.1"]


def test_of_several_addresses_the_one_that_the_proxy_saw(tmp_path: Path) -> None:
    """A visitor may send X-Forwarded-For too; the proxy appends the true address, and that one counts."""
    study = write_study(tmp_path / "study", survey={"record": ["address"]})
    with server_process(study, tmp_path / "log", proxies=["127.0.0.1"]) as server:
        for number, told in enumerate(("198.51.100.7, 203.0.113.9", "127.0.0.1, 203.0.113.9", "nonsense, 203.0.113.9")):
            person = Participant(server.url, f"?STUDY_ID=s&PROLIFIC_PID={number}")
            names = person.state["external"]
            reply: Any = person.client.post(f"{person.here}/consent", json=names, headers={"X-Forwarded-For": told})
            assert reply.status_code == 200
    assert stored_addresses(study) == ["203.0.113.9"] * 3


def test_posts_behind_a_proxy_that_ends_https(study: Path, tmp_path: Path) -> None:
    """The proxy passes Host on; Origin says https although this server speaks http."""
    with server_process(study, tmp_path / "log", proxies=["127.0.0.1"]) as server:
        here = Participant(server.url).here
        behind = {"Host": "survey.example", "X-Forwarded-Proto": "https", "X-Forwarded-For": "203.0.113.9"}
        for headers, status in (
            ({"Origin": "https://survey.example"}, 303),
            ({"Origin": "https://survey.example", "Sec-Fetch-Site": "same-origin"}, 303),
            ({"Origin": "https://elsewhere.example"}, 403),
            ({"Origin": "https://elsewhere.example", "Sec-Fetch-Site": "cross-site"}, 403),
            ({"Origin": "https://sub.survey.example", "Sec-Fetch-Site": "same-site"}, 403),
        ):
            assert httpx.post(f"{server.url}{here}/consent", headers={**behind, **headers}).status_code == status
