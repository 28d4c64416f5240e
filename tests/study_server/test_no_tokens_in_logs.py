"""What the server writes while everything goes wrong, on standard output and error, names nobody and no answer.

Real processes; the database fails, pictures are damaged, bodies are broken, an error comes that nobody foresaw, and at
the end somebody presses Ctrl-C in the middle of a request.
"""

import contextlib
import hashlib
import signal
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from server_process import ServerProcess, server_process
from sqlalchemy import create_engine, text
from survey_client import ABOUT, Participant

from study_server.app import admin_secret
from study_server.storage.database import default_url
from study_server.storage.engines import DRIVERS

BOTH_STREAMS = ["sh", "-c", 'exec "$@" 1>&2', "sh"]
ADDRESS = "203.0.113.9"
PRIVATE = {
    "PROLIFIC_PID": "pid-5e1f00000000000000000001",
    "STUDY_ID": "study-60aa0000000000000000002",
    "SESSION_ID": "session-61bb0000000000000003",
}
COMMENT = "a comment that concerns nobody else"
BROWSER = "a browser of somebody"


@contextlib.contextmanager
def broken(url: str, *statements: str) -> Iterator[None]:
    """The database at `url` after each statement but the last, which mends it."""
    engine = create_engine(url.replace("postgresql://", f"{DRIVERS['postgresql']}://"))
    with engine.begin() as connection:
        for statement in statements[:-1]:
            connection.execute(text(statement))
    yield
    with engine.begin() as connection:
        connection.execute(text(statements[-1]))
    engine.dispose()


def bad_requests(client: httpx.Client, here: str, secret: str) -> None:
    """What is refused: strangers, other sites, broken and huge bodies, wrong secrets."""
    token = here.removeprefix("/s/")
    json = {"Content-Type": "application/json"}
    for path in (f"{here}x", f"/s/{token[:-1]}", f"/nothing/{token}", f"{here}/nonsense", f"/picture/{token}.png"):
        client.get(path)
        client.post(path, data=PRIVATE | {"comments": COMMENT})
    client.post(f"{here}/consent", data=PRIVATE, headers={"Origin": "https://elsewhere.example"})
    for body in (COMMENT.encode(), b'{"comments": "' + COMMENT.encode() + b'\\ud800"}', b"x" * 70_000, b"[" * 5000):
        client.post(f"{here}/ratings", content=body, headers=json)
        client.post(f"{here}/about", content=body, headers=json)
    client.post(f"{here}/about", content=b"--x\r\n" + COMMENT.encode(), headers={"Content-Type": "multipart/form-data"})
    client.post("/admin/login", json={"secret": f"{secret}x"})
    client.get("/admin", headers={"Authorization": f"Bearer {secret}x"})
    client.get("/admin", headers={"Authorization": f"Bearer {secret}"})
    assert client.post("/admin/login", json={"secret": secret}).cookies
    for _ in range(300):
        if client.get(f"{here}/about").status_code == 429:
            break


def raw_requests(server: ServerProcess, here: str) -> None:
    """What is no HTTP, and what breaks off."""
    for sent in (f"GET {here}\r\n\r\n", f"GET {here} HTTP/1.1\r\nbroken\r\n\r\n", f"\x16\x03\x01 {here}\r\n\r\n"):
        with socket.create_connection(("127.0.0.1", server.port)) as connection:
            connection.sendall(sent.encode())
            connection.recv(1000)
    with socket.create_connection(("127.0.0.1", server.port)) as connection:
        connection.sendall(f"POST {here}/about HTTP/1.1\r\nHost: x\r\nContent-Length: 99\r\n\r\n{COMMENT}".encode())
    upgrade = f"GET {here} HTTP/1.1\r\nHost: x\r\nConnection: upgrade\r\nUpgrade: websocket\r\n\r\n"
    with socket.create_connection(("127.0.0.1", server.port)) as connection:
        connection.sendall(upgrade.encode())
        connection.recv(1000)


def database_fails(database: str, client: httpx.Client, person: Participant, body: dict[str, Any], secret: str) -> None:
    """At a save, at reading a page, and in the midst of one, with the private words in what fails."""
    with broken(database, "ALTER TABLE ratings RENAME TO away", "ALTER TABLE away RENAME TO ratings"):
        assert person.send(body).status_code == 503
    with broken(database, "ALTER TABLE sessions RENAME TO away", "ALTER TABLE away RENAME TO sessions"):
        assert client.get(person.here).status_code == 503
        assert client.post(f"{person.here}/consent", data=PRIVATE).status_code == 503
        assert client.get("/admin", headers={"Authorization": f"Bearer {secret}"}).status_code == 503
    swap = "UPDATE presentations SET stimulus = "
    with broken(database, f"{swap}'{COMMENT}' || stimulus", f"{swap}replace(stimulus, '{COMMENT}', '')"):
        assert client.get(person.here).status_code == 500  # KeyError: 'a comment ...'


def pictures_fail(study: Path, client: httpx.Client) -> None:
    """A picture's file is away, then damaged."""
    picture = study / "stimuli" / "img01.png"
    address = f"/picture/{sha256_of(picture)}.png"
    picture.unlink()
    assert client.get(address).status_code == 503
    picture.write_bytes(b"damaged")
    assert client.get(address).status_code == 503


@pytest.mark.parametrize(("kind", "workers"), [("sqlite", 1), ("postgres", 2)])
def test_nobody_is_named(request: pytest.FixtureRequest, study: Path, tmp_path: Path, kind: str, workers: int) -> None:
    database = default_url(study) if kind == "sqlite" else str(request.getfixturevalue("postgres_url"))
    query = "?" + "&".join(f"{name}={value}" for name, value in PRIVATE.items())
    headers = {
        "X-Forwarded-For": ADDRESS,
        "X-Forwarded-Proto": "https",
        "User-Agent": BROWSER,
        "Referer": f"https://x/{query}",
    }
    options = {"database_url": database, "proxies": ["127.0.0.1"], "workers": workers}
    with server_process(study, tmp_path / "log", prefix=BOTH_STREAMS, **options) as server:
        secret = admin_secret(study, database)
        person = Participant(server.url, query)
        person.client.headers.update(headers)
        person.to_trials()
        other = Participant(server.url).consent()
        body = person.answers()
        with httpx.Client(base_url=server.url, headers=headers, timeout=60) as client:
            bad_requests(client, other.here, secret)
            raw_requests(server, other.here)
            database_fails(database, client, person, body, secret)
            pictures_fail(study, client)
            assert person.send(body).status_code == 200
            assert person.post("about", **ABOUT)["step"] == "trials"
            with socket.create_connection(("127.0.0.1", server.port)) as unfinished:
                unfinished.sendall(
                    f"POST {person.here}/comments HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\na".encode()
                )
                assert server.process is not None
                server.process.send_signal(signal.SIGINT)
            server.process.wait(60)
        said = server.said()
    announced, _, log = said.partition("proxies ")
    assert announced.count(secret) == 1
    assert secret not in log
    for line in ("the database failed", "img01.png", "KeyError", "Invalid HTTP request received."):
        assert line in log
    private = [person.here[3:], other.here[3:], other.here[3:-1], *PRIVATE.values(), COMMENT, BROWSER, ADDRESS]
    private += [person.state["session"], "fakesss_admin", body["submission"]]
    for word in private:
        assert word not in said, f"{word} in {said}"
    assert "127.0.0.1" not in log.partition("\n")[2]
    if "postgresql" in database:
        assert database not in said  # it may hold a password


def sha256_of(path: Path) -> str:
    """The name under which a picture is served."""
    return hashlib.sha256(path.read_bytes()).hexdigest()
