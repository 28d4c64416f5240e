"""What the web may bring: other sites, huge bodies, text that looks like HTML, a disk that is full."""

import contextlib
import os
import sqlite3
import time
from collections.abc import Callable
from pathlib import Path

import httpx
import pytest
from sqlalchemy import Connection, event
from study_fixture import write_study
from survey_client import JSON, Participant
from waiting import until

from study_server.app import create_app
from study_server.guards.web_safety import BODY_LIMIT, TooLarge
from study_server.health import REMEMBERED_S
from study_server.serve import running, served
from study_server.storage import schema


@pytest.mark.parametrize("path", ["/health", "/admin", "/nothing", "/static/survey.css"])
def test_every_answer_carries_the_policy(url: str, path: str) -> None:
    headers = httpx.get(f"{url}{path}").headers
    assert "script-src 'self'" in headers["content-security-policy"]
    assert "unsafe" not in headers["content-security-policy"]
    assert headers["x-content-type-options"] == "nosniff"
    assert "server" not in headers


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Sec-Fetch-Site": "cross-site"}, 403),
        ({"Sec-Fetch-Site": "same-site"}, 403),
        ({"Origin": "https://elsewhere.example"}, 403),
        ({"Origin": "null"}, 403),
        ({"Sec-Fetch-Site": "same-origin"}, 303),
        ({}, 303),
    ],
)
def test_posts_come_from_our_own_pages(url: str, headers: dict[str, str], status: int) -> None:
    here = Participant(url).here
    assert httpx.post(f"{url}{here}/consent", headers=headers).status_code == status


def test_a_huge_body_is_refused_however_it_comes(url: str) -> None:
    here = Participant(url).consent().here
    assert httpx.post(f"{url}{here}/about", data={"age": "x" * BODY_LIMIT}).status_code == 413
    pieces = (b"age=" + b"x" * 8192 for _ in range(20))
    form = {"Content-Type": "application/x-www-form-urlencoded"}
    assert httpx.post(f"{url}{here}/about", content=pieces, headers=form).status_code == 413
    for step in ("about", "ratings"):
        response = httpx.post(f"{url}{here}/{step}", json={"x": "x" * BODY_LIMIT}, headers=JSON)
        assert (response.status_code, response.json()) == (413, response.json() | {"error": TooLarge().detail})


@pytest.mark.parametrize("step", ["about", "ratings", "withdraw"])
@pytest.mark.parametrize(
    "body", [b'{"a": "x\\ud800"}', b'{"x\\udfff": "a"}', b"[" * 60_000, b'{"a":' * 10_000, b"{", b"\xff"]
)
def test_json_that_is_none_is_refused_without_a_crash(url: str, step: str, body: bytes) -> None:
    here = Participant(url).consent().here
    headers = {**JSON, "Content-Type": "application/json"}
    response = httpx.post(f"{url}{here}/{step}", content=body, headers=headers)
    assert response.status_code in (400, 422)
    assert response.json()["error"]


def test_the_studys_text_is_text(tmp_path: Path) -> None:
    evil = "<script>alert(1)</script>"
    study = write_study(tmp_path, title=evil, survey={"consent": evil, "contact": evil})
    with served(study) as url:
        page = httpx.get(f"{url}/?STUDY_ID=s&PROLIFIC_PID=%22%3E{evil}", follow_redirects=True).text
    assert "<script>alert" not in page
    assert page.count("&lt;script&gt;alert") >= 4


def test_a_full_disk_gives_503_and_leaves_nothing_half_done(
    study: Path, csv_rows: Callable[..., list[dict[str, str]]]
) -> None:
    app = create_app(study)
    room = [0]

    @event.listens_for(app.state.site.database.engine, "begin")
    def limit(connection: Connection) -> None:
        pages = connection.exec_driver_sql("PRAGMA page_count").scalar_one()
        connection.exec_driver_sql(f"PRAGMA max_page_count={pages + room[0]}")

    with running(app) as url, httpx.Client(base_url=url, headers=JSON) as client:
        started = 0
        while True:  # until SQLite says that the database or disk is full
            here = client.get("/", follow_redirects=True).json()["here"]
            response = client.post(f"{here}/consent")
            if response.status_code != 303:
                break
            started += 1
        assert response.status_code == 503
        assert "could not be saved" in response.json()["error"]
        assert len(csv_rows(study, url, "participants")) == started
        room[0] = 1000
        assert client.post(f"{here}/consent").status_code == 303
        assert len(csv_rows(study, url, "participants")) == started + 1
        assert len(csv_rows(study, url, "ratings")) == 6 * (started + 1)


def test_health_turns_red_when_nothing_can_be_written(study: Path, url: str) -> None:
    assert httpx.get(f"{url}/health").json()["status"] == "ok"
    app = create_app(study)
    with app.state.site.database.writing() as connection:
        schema.meta.drop(connection)
    app.state.site.database.engine.dispose()
    until(lambda: httpx.get(f"{url}/health").status_code == 503, 10 * REMEMBERED_S)


def test_asking_for_health_over_and_over_writes_once_a_second(study: Path) -> None:
    app = create_app(study)
    writes: list[str] = []
    with running(app) as url, httpx.Client(base_url=url) as client:
        event.listen(app.state.site.database.engine, "commit", lambda _: writes.append("commit"))
        before = time.monotonic()
        asked = [client.get("/health").status_code for _ in range(100)]
        took_s = time.monotonic() - before
        assert asked == [200] * 100
        assert len(writes) <= 1 + took_s / REMEMBERED_S
        app.state.site.health.doubt()  # as a save that failed does
        written = len(writes)
        client.get("/health")
        assert len(writes) == written + 1


def test_a_save_that_failed_turns_health_red_at_once(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("study_server.health.REMEMBERED_S", 3600)
    app = create_app(study)
    with running(app) as url, httpx.Client(base_url=url, headers=JSON) as client:
        person = Participant(url).to_trials()
        assert client.get("/health").status_code == 200

        @event.listens_for(app.state.site.database.engine, "begin")
        def limit(connection: Connection) -> None:
            connection.exec_driver_sql("PRAGMA query_only = ON")

        assert client.get("/health").status_code == 200  # remembered
        assert person.send(person.answers(4)).status_code == 503
        assert client.get("/health").status_code == 503


def test_new_files_are_their_owners_alone(study: Path) -> None:
    """Whatever the umask: the database holds secrets and what people said."""
    umask = os.umask(0)
    try:
        with served(study) as url:
            Participant(url).consent()
            files = sorted(study.glob("ratings.sqlite*"))
            assert [path.suffix for path in files] == [".sqlite", ".sqlite-shm", ".sqlite-wal"]
            assert {oct(path.stat().st_mode & 0o777) for path in files} == {"0o600"}
    finally:
        os.umask(umask)


def test_one_session_leaves_only_so_many_refusals(study: Path, url: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("study_server.participant.MOST_REFUSALS", 3)
    person = Participant(url).to_trials()
    for _ in range(5):
        assert person.send(person.answers(stimulus_sha256="0" * 64)).status_code == 409
    with contextlib.closing(sqlite3.connect(study / "ratings.sqlite")) as database:
        assert database.execute("SELECT count(*) FROM events WHERE kind = 'refused'").fetchone() == (3,)
    person.rate()
