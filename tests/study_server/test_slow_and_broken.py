"""Requests that never end, that are larger than any, and errors that nobody foresaw."""

import logging
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import pytest
from survey_client import JSON, Participant

from study_server import prompt
from study_server.app import create_app
from study_server.guards import web_safety
from study_server.serve import running, served

SOON_S = 0.3


@contextmanager
def connection(url: str) -> Iterator[socket.socket]:
    """A bare connection."""
    address = urlsplit(url)
    with socket.create_connection((address.hostname, address.port), timeout=30) as opened:
        yield opened


def all_of(opened: socket.socket) -> bytes:
    """Everything until the server closes."""
    received = b""
    while piece := opened.recv(65_536):
        received += piece
    return received


@pytest.mark.parametrize("step", ["about", "ratings"])
@pytest.mark.parametrize("length", ["Content-Length: 100", "Transfer-Encoding: chunked"])
def test_a_body_that_never_comes(study: Path, monkeypatch: pytest.MonkeyPatch, step: str, length: str) -> None:
    monkeypatch.setattr(web_safety, "BODY_S", SOON_S)
    with served(study) as url, connection(url) as opened:
        here = Participant(url).here
        head = f"POST {here}/{step} HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n{length}\r\n\r\n"
        opened.sendall(head.encode())
        if length.startswith("T"):
            opened.sendall(b"2\r\n{}\r\n")  # and no last chunk
        reply = all_of(opened)
    assert reply.startswith(b"HTTP/1.1 408 ")
    assert b"content-security-policy" in reply
    assert b"took more than" in reply


@pytest.mark.parametrize("sent", [b"", b"GET / HTT", b"GET / HTTP/1.1\r\nHost: x\r\nX-A"])
def test_a_head_that_never_ends(study: Path, monkeypatch: pytest.MonkeyPatch, sent: bytes) -> None:
    monkeypatch.setattr(prompt, "HEAD_S", SOON_S)
    with served(study) as url, connection(url) as opened:
        opened.sendall(sent)
        assert all_of(opened) == b""


def test_a_second_head_has_its_own_time(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(prompt, "HEAD_S", SOON_S)
    with served(study) as url, connection(url) as opened:
        for _ in range(3):  # each in time, together not
            opened.sendall(b"GET /health HTTP/1.1\r\nHost: x\r\n\r\n")
            reply = b""
            while not reply.endswith(b"}"):  # head and body may come apart
                reply += opened.recv(65_536)
            assert reply.startswith(b"HTTP/1.1 200")
            time.sleep(SOON_S / 2)
        opened.sendall(b"GET /health HT")
        assert b"HTTP/1.1" not in all_of(opened)


def test_a_slow_answer_is_not_cut_off(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The limits are on what comes in."""
    monkeypatch.setattr(prompt, "HEAD_S", SOON_S)
    monkeypatch.setattr(web_safety, "BODY_S", SOON_S)
    app = create_app(study)
    app.get("/slow")(lambda: time.sleep(3 * SOON_S))
    with running(app) as url:
        assert httpx.get(f"{url}/slow").status_code == 200


def test_a_head_larger_than_any(url: str) -> None:
    with connection(url) as opened:
        opened.sendall(b"GET / HTTP/1.1\r\nHost: x\r\nX-Long: " + b"a" * 70_000)
        assert opened.recv(100).startswith(b"HTTP/1.1 400")


@pytest.mark.parametrize("origin", ["http://[", "null", "x", "//", "http://[::1", "https://é"])
def test_an_origin_that_is_none(url: str, origin: str) -> None:
    here = Participant(url).here
    assert httpx.post(f"{url}{here}/consent", headers={"Origin": origin.encode()}).status_code == 403


def test_an_error_that_nobody_foresaw(study: Path, caplog: pytest.LogCaptureFixture) -> None:
    """A 500 with every header, and a log that says where and of what kind, not what it was about."""
    app = create_app(study)
    with running(app) as url:
        person = Participant(url).to_trials()
        app.state.site.study.by_id.clear()  # KeyError: 'img01'
        with caplog.at_level(logging.ERROR):
            reply = httpx.get(f"{url}{person.here}", headers=JSON)
    assert reply.status_code == 500
    assert "content-security-policy" in reply.headers
    assert reply.json() == {"error": "Something went wrong here; please try again."}
    assert "KeyError" in caplog.text
    assert 'pages.py", line' in caplog.text
    assert "img0" not in caplog.text
    assert person.here[3:] not in caplog.text


def test_who_leaves_in_the_middle_of_a_body_is_no_error(study: Path, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO), served(study) as url:
        here = Participant(url).here
        for step in ("about", "ratings"):
            with connection(url) as opened:
                opened.sendall(f"POST {here}/{step} HTTP/1.1\r\nHost: x\r\nContent-Length: 100\r\n\r\n{{".encode())
        assert httpx.get(f"{url}/health").status_code == 200
    assert [record for record in caplog.records if record.levelno >= logging.WARNING] == []
