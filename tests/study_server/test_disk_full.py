"""Disk full, failing or read-only: 503, nothing half, no code, /health red; once it is freed all goes on by itself.

On a real small disk whose kernel says ENOSPC; a disk that fails is a real process whose writes the kernel refuses.
"""

import resource
import subprocess
import sys
from collections.abc import Iterator
from itertools import cycle
from pathlib import Path
from typing import Any

import httpx
import pytest
from full_disk import SmallDisk, small_disk
from server_process import ROOT, ServerProcess, server_process
from stored import sound, sound_copy
from study_fixture import write_study
from survey_client import Participant

from study_server.storage.database import default_url

NOT_SAVED = "This could not be saved just now; please try again in a moment."
PAGE = 4096


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[SmallDisk]:
    """With a built study on it."""
    with small_disk(tmp_path / "disk", copy_of=write_study(tmp_path / "study"), size=16_000_000) as mounted:
        yield mounted


@pytest.fixture
def server(disk: SmallDisk, tmp_path: Path) -> Iterator[ServerProcess]:
    """Of the study on the disk."""
    with server_process(disk.path, tmp_path / "server.log", prefix=disk.prefix) as process:
        yield process
        assert process.unforeseen() == []


def refused(person: Participant, path: str, body: dict[str, Any]) -> None:
    """503 with our sentence, as JSON and as a page."""
    reply = person.client.post(f"{person.here}/{path}", json=body)
    assert (reply.status_code, reply.json()["error"]) == (503, NOT_SAVED)
    page = person.client.post(f"{person.here}/{path}", json=body, headers={"Accept": "text/html"})
    assert page.status_code == 503
    assert NOT_SAVED in page.text or path == "ratings"


def test_on_a_full_disk_nothing_is_half_and_freed_it_goes_on(disk: SmallDisk, server: ServerProcess) -> None:
    finisher = Participant(server.url).to_trials()
    finisher.rate(1)
    finisher.rate(2)
    half_way = Participant(server.url).to_trials()
    half_way.rate(3)
    newcomer = Participant(server.url)
    before = sound_copy(disk.seen)
    disk.fill()
    for person in (finisher, half_way):
        refused(person, "ratings", person.answers(7))
        refused(person, "withdraw", {"sure": "yes"})
        assert person.client.get(person.here).json()["step"] == "trials"
    refused(newcomer, "consent", {})
    assert newcomer.client.get(newcomer.here).json()["step"] == "consent"
    assert httpx.get(f"{server.url}/health").status_code == 503
    assert sound_copy(disk.seen) == before
    disk.free()
    assert httpx.get(f"{server.url}/health").status_code == 200
    for person in (finisher, half_way):
        reply = person.send(person.answers(7))
        assert [(row["rating"], row["revision"]) for row in reply.json()["saved"]] == [(7, 0)] * 2
        person.state = reply.json()["next"]
    assert finisher.state["step"] == "comments"
    assert finisher.to_end() and half_way.to_end()
    assert newcomer.to_trials().to_end()
    assert len(sound_copy(disk.seen).answers) == 3


@pytest.mark.parametrize("people", [4, pytest.param(60, marks=pytest.mark.long)])
def test_with_any_number_of_bytes_left_an_answer_is_there_or_not_at_all(
    disk: SmallDisk, server: ServerProcess, people: int
) -> None:
    """The disk is full at another point of the transaction each time, of the last picture's too."""
    pages_left = cycle((0, 20, 4, 16, 8, 12, 40))  # an answer takes some ten
    outcomes = set()
    for _ in range(people):
        person = Participant(server.url).to_trials()
        while person.state["step"] == "trials":
            last = person.state["trial"] == 3
            disk.fill(leave=next(pages_left) * PAGE)
            body = person.answers(5)
            status = person.send(body).status_code
            outcomes.add((status, last))
            disk.free()
            there = {place for place, _ in sound_copy(disk.seen).answers[person.state["session"]]}
            assert (body["place"] in there) == (status == 200)
            reply = person.send(body)
            assert [row["revision"] for row in reply.json()["saved"]] == [0, 0]
            person.state = reply.json()["next"]
        assert person.to_end()
    assert outcomes == {(status, last) for status in (200, 503) for last in (True, False)}


def test_a_disk_that_fails_while_the_server_runs(study: Path, tmp_path: Path) -> None:
    """As one that the kernel makes read-only after an error: every write is refused, and is not for want of room."""
    with server_process(study, tmp_path / "server.log") as server:
        person = Participant(server.url).to_trials()
        person.rate(2)
        assert server.process is not None
        resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
        refused(person, "ratings", person.answers(5))
        refused(Participant(server.url), "consent", {})
        assert httpx.get(f"{server.url}/health").status_code == 503
        assert person.client.get(person.here).json()["trial"] == 2
        everything = (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
        resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, everything)
        assert httpx.get(f"{server.url}/health").status_code == 200
        person.rate(5)
        assert person.to_end()
    assert server.unforeseen() == []
    sound(default_url(study))


@pytest.mark.parametrize("begun", [False, True], ids=["new", "begun"])
@pytest.mark.parametrize("trouble", ["full", "read-only"])
def test_a_start_without_room_says_so_in_a_sentence(disk: SmallDisk, tmp_path: Path, begun: bool, trouble: str) -> None:
    if begun:
        with server_process(disk.path, tmp_path / "server.log", prefix=disk.prefix) as server:
            Participant(server.url).to_trials()
    disk.fill() if trouble == "full" else disk.read_only()
    command = [*disk.prefix, "env", f"PYTHONPATH={ROOT}", sys.executable, "-m", "fakesss", "serve", str(disk.path)]
    said = subprocess.run([*command, "--port", "0"], capture_output=True, text=True, timeout=60)
    assert said.returncode == 2, said.stderr
    assert said.stderr.startswith("fakesss: sqlite:///")
    assert "ratings.sqlite: cannot be" in said.stderr
    assert said.stderr.count("\n") == 1
