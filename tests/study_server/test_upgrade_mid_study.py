"""Server restart and upgrade in mid-study: what was accepted is finished, and pages of an earlier release go on.

What becomes of an earlier release's database is in test_upgrades.py.
"""

import shutil
import signal
import sqlite3
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path
from typing import Any

import httpx
import psycopg
import pytest
from load import strike, under_load
from server_process import server_process
from stored import sound
from study_fixture import write_study
from survey_client import Participant
from waiting import until

from study_server.serve import served
from study_server.storage.database import default_url
from study_server.storage.engines import parsed_url

RELEASE_1 = Path(__file__).parents[1] / "data" / "study_of_release_1"


@pytest.fixture
def old(tmp_path: Path) -> Path:
    """A study that release 1 served: `mid` has rated one picture with 3."""
    return Path(shutil.copytree(RELEASE_1, tmp_path / "study"))


class PageOfRelease1:
    """What the script of release 1's page sends, and what of a reply it reads; it keeps nothing else."""

    def __init__(self, person: Participant) -> None:
        self.client, self.here = person.client, person.here
        self.sent = 0
        self.follow(self.client.get(self.here).json())

    def follow(self, state: dict[str, Any]) -> None:
        """Everything of the state that the script looked at."""
        self.step = state["step"]
        if self.step in ("practice", "trials"):
            self.shown = (state["practice"], state["trial"], state["trials"], state["place"])
            self.picture = {name: state["picture"][name] for name in ("url", "sha256", "bytes", "width", "height")}

    def submit(self, rating: int) -> None:
        """Answers to both questions, as the form of release 1 had them under every picture."""
        self.sent += 1
        body = {
            "place": self.shown[3],
            "submission": f"{self.sent:032x}",
            "stimulus_sha256": self.picture["sha256"],
            "since_shown_ms": 4000.0,
            "answers": [{"question": name, "rating": rating, "rt_ms": 900.0} for name in ("translucent", "realistic")],
            "display": {
                "device_pixel_ratio": 1.25,
                "zoom": 1,
                "drawn_width_px": 96,
                "window_width_px": 1280,
                "window_height_px": 720,
                "focus_lost_ms": 0,
            },
        }
        reply = self.client.post(f"{self.here}/ratings", json=body)
        assert reply.status_code == 200, reply.text
        assert {row["rating"] for row in reply.json()["saved"]} == {rating}
        self.follow(reply.json()["next"])


def test_a_page_that_release_1_served_goes_on_at_this_one(old: Path) -> None:
    with served(old) as url:
        person = Participant(url, "?STUDY_ID=s&PROLIFIC_PID=mid")
        page = PageOfRelease1(person)
        assert page.shown == (False, 2, 3, 2)
        page.submit(6)
        page.submit(7)
        assert page.step == "comments"
        assert person.post("comments")["completion_code"]
    with closing(sqlite3.connect(old / "ratings.sqlite")) as database:
        mine = "session = (SELECT id FROM sessions WHERE external_participant = 'mid')"
        query = (
            f"SELECT device_pixel_ratio, drawn_height_px, gamut, scaled FROM presentations WHERE {mine} AND place > 1"
        )
        assert database.execute(query).fetchall() == [(1.25, None, "", None)] * 2
    sound(default_url(old))


def test_an_answer_of_release_1_sent_again_to_this_one_changes_nothing(old: Path) -> None:
    """Its reply was lost while the server went down for the upgrade."""
    with closing(sqlite3.connect(old / "ratings.sqlite")) as database:
        query = """SELECT place, submission, stimulus_sha256 FROM ratings JOIN presentations USING (session, place)
                   JOIN sessions ON id = session WHERE external_participant = 'mid' AND trial = 1 AND NOT practice"""
        place, submission, picture = database.execute(query).fetchone()
    before = sound(default_url(Path(shutil.copytree(old, old.parent / "copy")))).answers
    with served(old) as url:
        person = Participant(url, "?STUDY_ID=s&PROLIFIC_PID=mid")
        body = person.answers(3, place=place, submission=submission, stimulus_sha256=picture)
        reply = person.send(body)
        assert [(row["rating"], row["revision"]) for row in reply.json()["saved"]] == [(3, 0)] * 2
        assert reply.json()["next"]["trial"] == 2
    assert sound(default_url(old)).answers == before


@pytest.mark.parametrize("kind", ["sqlite", "two workers"])
def test_what_was_accepted_when_the_server_is_told_to_stop_is_finished(
    request: pytest.FixtureRequest, study: Path, tmp_path: Path, kind: str
) -> None:
    options: dict[str, Any] = {}
    if kind == "two workers":
        options = {"database_url": request.getfixturevalue("postgres_url"), "workers": 2}
    database = options.get("database_url", default_url(study))
    with (
        server_process(study, tmp_path / "server.log", **options) as server,
        httpx.Client(base_url=server.url) as idle,
        ThreadPoolExecutor(1) as pool,
    ):
        person = Participant(server.url).to_trials()
        idle.get("/health")  # a connection that is open and asks nothing holds up nobody
        with closing(locked(database)):
            save = pool.submit(person.send, person.answers(7))
            with pytest.raises(TimeoutError):
                save.result(0.3)
            assert server.process is not None
            server.process.send_signal(signal.SIGTERM)
            until(lambda: takes_nobody_more(server.url))
            with pytest.raises(TimeoutError):  # it is waited for
                save.result(0.5)
        assert save.result().status_code == 200
        assert server.process.wait(15) in (0, -signal.SIGTERM)
        server.stop()
        server.start()
        assert person.client.get(person.here).json()["trial"] == 2
        assert server.unforeseen() == []
    [session] = sound(database).answers
    assert list(sound(database).answers[session].values())[-2:] == [[7]] * 2


def locked(database: str) -> "sqlite3.Connection | psycopg.Connection[Any]":
    """Another program's transaction that keeps everybody from writing to the sessions."""
    if database.startswith("sqlite"):
        other = sqlite3.connect(str(parsed_url(database).database), isolation_level=None)
        other.execute("BEGIN IMMEDIATE")
        return other
    connection = psycopg.connect(database.replace("+psycopg", ""))
    connection.execute("LOCK TABLE sessions IN EXCLUSIVE MODE")
    return connection


def takes_nobody_more(url: str) -> bool:
    """Whether a newcomer is refused, or left waiting before the door."""
    try:
        httpx.get(f"{url}/static/icon.svg", timeout=2)
    except (httpx.ConnectError, httpx.ReadTimeout):
        return True
    except httpx.TransportError:
        return False
    return False


@pytest.mark.parametrize("restarts", [2, pytest.param(20, marks=[pytest.mark.long, pytest.mark.timeout(900)])])
def test_restarts_under_load_lose_nobody(tmp_path: Path, restarts: int) -> None:
    study = write_study(tmp_path / "study", 9)

    def restart() -> None:
        server.stop()
        server.start()

    with server_process(study, tmp_path / "log") as server, under_load(server, study, default_url(study)) as load:
        strike(load, default_url(study), [restart], restarts)
    assert server.unforeseen() == []
