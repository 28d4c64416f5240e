"""Posts that stop, stall, lie about their length or come in each other's wake (JATOS#303): no row, or one, and a retry.

Over bare sockets, and with simulated raters over a network that loses requests on the way and replies on the way back.
"""

import contextlib
import json
import select
import socket
import struct
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from faulty_network import faulty_network
from server_process import ServerProcess, server_process
from stored import sound
from study_fixture import write_study
from survey_client import Participant

from study_server.app import admin_secret
from study_server.guards import web_safety
from study_server.guards.web_safety import BODY_LIMIT
from study_server.manifest import load_study
from study_server.serve import served
from study_server.simulation.simulate import simulate
from study_server.storage.database import default_url


@pytest.fixture(scope="module")
def study_served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Path, ServerProcess]]:
    """A study and its server, shared; what is stored is judged, and the server has met nothing unforeseen."""
    folder = tmp_path_factory.mktemp("bodies")
    study = write_study(folder / "study")
    with server_process(study, folder / "server.log") as server:
        yield study, server
        assert server.unforeseen() == []
    sound(default_url(study))


@pytest.fixture
def person(study_served: tuple[Path, ServerProcess]) -> Participant:
    """Before the first picture."""
    return Participant(study_served[1].url).to_trials()


def head(person: Participant, *fields: str) -> bytes:
    """A post's first lines; `fields` say how long it is."""
    lines = [f"POST {person.here}/ratings HTTP/1.1", "Host: 127.0.0.1", "Accept: application/json"]
    return "\r\n".join([*lines, "Content-Type: application/json", *fields, "", ""]).encode()


def whole(person: Participant, body: dict[str, Any]) -> bytes:
    """A post as it should be."""
    content = json.dumps(body).encode()
    return head(person, f"Content-Length: {len(content)}") + content


@contextlib.contextmanager
def connected(person: Participant, sent: bytes = b"") -> Iterator[socket.socket]:
    """A connection over which `sent` has gone."""
    where = urlsplit(str(person.client.base_url))
    with socket.create_connection((where.hostname, where.port), timeout=30) as connection:
        connection.sendall(sent)
        yield connection


def received(connection: socket.socket) -> bytes:
    """Everything until the server closes."""
    pieces = []
    with contextlib.suppress(ConnectionResetError):
        while piece := connection.recv(65_536):
            pieces.append(piece)
    return b"".join(pieces)


def replies(connection: socket.socket, n: int) -> list[tuple[int, dict[str, Any]]]:
    """The next n replies: status and JSON."""
    found = []
    with connection.makefile("rb") as stream:
        for _ in range(n):
            status, length = int(stream.readline().split()[1]), 0
            while (line := stream.readline()) != b"\r\n":
                name, _, value = line.decode().partition(":")
                length = int(value) if name.lower() == "content-length" else length
            found.append((status, json.loads(stream.read(length))))
    return found


def saved(connection: socket.socket) -> list[dict[str, Any]]:
    """What the next reply, a 200, says it has stored."""
    [(status, data)] = replies(connection, 1)
    assert status == 200, data
    return list(data["saved"])


def answers_of(study: Path, person: Participant) -> list[list[int]]:
    """This person's answers to real trials, with their revisions, in order."""
    mine = sound(default_url(study)).answers[person.state["session"]]
    return [given for (place, _), given in sorted(mine.items()) if place > 0]  # 0 is practice


@pytest.mark.parametrize("ending", ["reset", "end", "silence"])
@pytest.mark.parametrize("share", [0.0, 0.5, 1.0], ids=["none", "half", "all but a byte"])
def test_half_a_body_is_no_row_and_its_retry_is_one(
    study_served: tuple[Path, ServerProcess], person: Participant, share: float, ending: str
) -> None:
    post = whole(person, person.answers(3))
    start = post.index(b"\r\n\r\n") + 4
    cut = min(start + int(share * (len(post) - start)), len(post) - 1)
    with connected(person, post[:cut]) as connection:
        if ending == "end":
            connection.shutdown(socket.SHUT_WR)
            assert b" 200 " not in received(connection)
        if ending == "reset":
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            connection.close()
        assert answers_of(study_served[0], person) == []
        for _ in range(2):
            with connected(person, post) as retry:
                assert [row["revision"] for row in saved(retry)] == [0, 0]
        assert answers_of(study_served[0], person) == [[3]] * 2


def test_a_body_shorter_than_announced_and_one_longer(
    study_served: tuple[Path, ServerProcess], person: Participant
) -> None:
    content = json.dumps(person.answers()).encode()
    with connected(person, head(person, f"Content-Length: {len(content) + 10}") + content) as connection:
        connection.shutdown(socket.SHUT_WR)
        assert b" 200 " not in received(connection)
    with connected(person, head(person, f"Content-Length: {len(content) - 10}") + content) as connection:
        assert connection.recv(12).startswith(b"HTTP/1.1 4")  # to the cut JSON, or to what seems another request
    assert answers_of(study_served[0], person) == []


@pytest.mark.parametrize("cut", [1, 100])
def test_a_body_in_chunks_arrives(study_served: tuple[Path, ServerProcess], person: Participant, cut: int) -> None:
    content = json.dumps(person.answers(6)).encode()
    pieces = [content[at : at + cut] for at in range(0, len(content), cut)]
    chunks = b"".join(b"%x\r\n%s\r\n" % (len(piece), piece) for piece in pieces)
    with connected(person, head(person, "Transfer-Encoding: chunked") + chunks) as connection:
        assert answers_of(study_served[0], person) == []  # the last chunk has not come
        connection.sendall(b"0\r\n\r\n")
        saved(connection)
    assert answers_of(study_served[0], person) == [[6]] * 2


def test_chunks_without_end_and_chunks_that_are_none(
    study_served: tuple[Path, ServerProcess], person: Participant
) -> None:
    chunk = b"1000\r\n" + b" " * 4096 + b"\r\n"
    with connected(person, head(person, "Transfer-Encoding: chunked")) as connection:
        for _ in range(4 * BODY_LIMIT // 4096):
            connection.sendall(chunk)
        assert replies(connection, 1)[0][0] == 413
    with connected(person, head(person, "Transfer-Encoding: chunked") + b"none\r\n") as connection:
        assert received(connection).startswith(b"HTTP/1.1 400")
    assert answers_of(study_served[0], person) == []


def test_a_body_that_comes_too_slowly_is_given_up(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each byte is in time, the whole is not."""
    monkeypatch.setattr(web_safety, "BODY_S", 0.3)
    with served(study) as url:
        person = Participant(url).to_trials()
        with connected(person, head(person, "Content-Length: 500")) as trickling:
            for _ in range(400):
                trickling.sendall(b" ")
                if select.select([trickling], [], [], 0.01)[0]:
                    break
            assert replies(trickling, 1)[0][0] == 408
        assert person.to_end()
    sound(default_url(study))


def test_slow_senders_hold_up_nobody_and_are_served_in_the_end(
    study_served: tuple[Path, ServerProcess], person: Participant
) -> None:
    """A hundred at once, more than there are threads, each a byte at a time, while others save their answers."""
    post = whole(person, person.answers(4))
    with contextlib.ExitStack() as stack:
        slow = [stack.enter_context(connected(person, post[:-10])) for _ in range(100)]
        other = Participant(study_served[1].url)
        slowest = 0.0
        for byte in range(10):
            begun = time.monotonic()
            if byte == 0:
                other.to_trials()
            elif other.state["step"] == "trials":
                other.rate()
            slowest = max(slowest, time.monotonic() - begun)
            for connection in slow:
                connection.sendall(post[len(post) - 10 + byte :][:1])
        assert other.to_end()
        assert slowest < 10  # not that it is fast: that it does not wait for them
        for connection in slow:
            assert [row["revision"] for row in saved(connection)] == [0, 0]
    assert answers_of(study_served[0], person) == [[4]] * 2


def test_posts_in_one_breath_are_answered_in_their_order(
    study_served: tuple[Path, ServerProcess], person: Participant
) -> None:
    first = person.answers(2)
    page = person.send(first).json()["next"]
    person.state = page
    second = person.answers(5)
    with connected(person, whole(person, first) + whole(person, second) * 3 + whole(person, first)) as connection:
        said = replies(connection, 5)
    assert [status for status, _ in said] == [200] * 5
    assert [reply["saved"][0]["rating"] for _, reply in said] == [2, 5, 5, 5, 2]
    assert {row["revision"] for _, reply in said for row in reply["saved"]} == {0}
    assert answers_of(study_served[0], person) == [[2], [2], [5], [5]]


@pytest.mark.parametrize("raters", [6, pytest.param(100, marks=pytest.mark.long)])
def test_requests_lost_on_the_way_and_replies_lost_on_the_way_back(tmp_path: Path, raters: int) -> None:
    study = write_study(tmp_path / "study")
    with served(study) as url, faulty_network(url) as network:
        saves, forms = "POST /s/[^/]+/ratings", "POST /s/"
        for _ in range(raters):  # one fault is due at a time: the first that fits
            network.truncate_next_request(where=saves)
            network.lose_next_response(where=saves)
            network.truncate_next_response(after_bytes=20, where=saves)
            network.truncate_next_request(after_bytes=0, where=forms)
            network.lose_next_response(where=forms)
        result = simulate(
            network.url, load_study(study), admin_secret(study), started=raters, completed=raters, progress=False
        )
        assert sum(network.happened.values()) == 5 * raters
    assert (result["completed"], result["lost"], result["duplicated"]) == (raters, 0, 0)
    stored = sound(default_url(study))
    assert [sum(stored.places_taken), len(stored.answers)] == [raters, raters]
    assert len({len(given) for given in stored.answers.values()}) == 1
