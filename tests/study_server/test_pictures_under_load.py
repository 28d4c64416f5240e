"""30 starters who fetch every picture at once (jsPsych#605, #1393, #1934), and readers so slow that they never end."""

import contextlib
import hashlib
import http.client
import json
import socket
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from random import Random
from urllib.parse import urlsplit

import httpx
import pytest
from PIL import Image
from server_process import ServerProcess, server_process
from stored import sound
from study_fixture import write_study
from survey_client import Participant

from study_server.storage.database import default_url

STARTERS = 30


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Three pictures of noise, of 3 MB each: more than a socket holds, so that a reader who stops is waited for."""
    folder = write_study(tmp_path / "study")
    manifest = folder / "stimuli" / "manifest.json"
    data = json.loads(manifest.read_text())
    for number, entry in enumerate(data["stimuli"]):
        path = folder / "stimuli" / entry["file"]
        noise = Random(number).randbytes(1000 * 1000 * 3)
        Image.frombytes("RGB", (1000, 1000), noise).save(path, compress_level=0)
        facts = {"sha256": hashlib.sha256(path.read_bytes()).hexdigest(), "width": 1000, "height": 1000}
        entry |= facts
    manifest.write_text(json.dumps(data))
    return folder


@pytest.fixture
def server(study: Path, tmp_path: Path) -> Iterator[ServerProcess]:
    with server_process(study, tmp_path / "server.log") as process:
        yield process
        assert process.unforeseen() == []


def pictures(study: Path) -> dict[str, str]:
    """Address -> SHA-256."""
    manifest = json.loads((study / "stimuli" / "manifest.json").read_text())
    return {f"/picture/{entry['sha256']}.png": entry["sha256"] for entry in manifest["stimuli"]}


def test_thirty_starters_get_every_picture_whole_and_ask_for_it_once(study: Path, server: ServerProcess) -> None:
    wanted = pictures(study)

    def starter(_: int) -> None:
        with contextlib.closing(http.client.HTTPConnection(urlsplit(server.url).netloc, timeout=60)) as connection:
            for path, sha256 in wanted.items():
                connection.request("GET", path)
                response = connection.getresponse()
                data = response.read()
                assert response.status == 200
                assert int(response.headers["Content-Length"]) == len(data)
                assert hashlib.sha256(data).hexdigest() == sha256
                assert response.headers["Cache-Control"] == "public, max-age=31536000, immutable"
                connection.request("GET", path, headers={"If-None-Match": response.headers["ETag"]})
                again = connection.getresponse()
                assert (again.status, again.read()) == (304, b"")
                assert again.headers["Cache-Control"] == response.headers["Cache-Control"]

    with ThreadPoolExecutor(STARTERS) as pool:
        list(pool.map(starter, range(STARTERS)))
    assert Participant(server.url).to_trials().to_end()
    sound(default_url(study))


def test_readers_who_stop_in_the_middle_of_a_picture_hold_up_nobody(study: Path, server: ServerProcess) -> None:
    """More of them than the server has threads; everybody else goes on, and so does who reads on."""
    [(path, sha256), *_] = pictures(study).items()
    where = urlsplit(server.url)
    with contextlib.ExitStack() as stack:
        stopped = []
        for _ in range(60):
            connection = stack.enter_context(socket.socket())
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            connection.settimeout(60)
            connection.connect((where.hostname, where.port))
            connection.sendall(f"GET {path} HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n".encode())
            assert connection.recv(100).startswith(b"HTTP/1.1 200")
            stopped.append(connection)
        person = Participant(server.url).to_trials()
        assert person.to_end()
        assert httpx.get(f"{server.url}/health").status_code == 200
        stopped[0].setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1_000_000)
        rest = b"".join(iter(lambda: stopped[0].recv(1_000_000), b""))
        assert hashlib.sha256(rest[rest.index(b"\r\n\r\n") + 4 :]).hexdigest() == sha256
    assert Participant(server.url).to_trials().to_end()
    sound(default_url(study))
