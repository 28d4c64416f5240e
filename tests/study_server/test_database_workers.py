"""Several processes on one PostgreSQL database: who serves is left to the system, what is stored is not."""

import os
import signal
import socket
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx
import pytest
from server_process import server_process
from survey_client import JSON, Participant
from waiting import until

from fakesss.problem import BadInput
from study_server.app import admin_secret
from study_server.exports.export import export_ratings
from study_server.manifest import load_study
from study_server.serve import serve
from study_server.simulation.simulate import simulate


def is_free(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) != 0


def test_two_workers_store_every_answer_once_and_a_dead_one_is_replaced(
    study: Path, tmp_path: Path, postgres_url: str
) -> None:
    with server_process(study, tmp_path / "log", database_url=postgres_url, workers=2) as server:
        secret = admin_secret(study, postgres_url)
        until(lambda: len(server.workers()) == 2)
        with ThreadPoolExecutor(1) as pool:
            load = pool.submit(
                simulate, server.url, load_study(study), secret, started=30, completed=26, progress=False
            )
            first = server.workers()[0]
            os.kill(first, signal.SIGKILL)
            result = load.result()
        until(lambda: len(server.workers()) == 2 and first not in server.workers())
        assert (result["started"], result["completed"]) == (30, 26)
        assert (result["lost"], result["duplicated"]) == (0, 0)
        assert result["stored"] >= result["acknowledged"] >= 26 * 6
        assert server.process is not None
        server.process.send_signal(signal.SIGTERM)  # to the parent alone, as systemd and a shell's kill do
        assert server.process.wait(30) in (0, -signal.SIGTERM)
        until(lambda: is_free(server.port))
    assert "Traceback" not in server.said()
    assert "processes     2" in server.said()
    assert "survey:***@" in server.said()


def test_equal_posts_at_once_to_several_workers_are_stored_once(study: Path, tmp_path: Path, postgres_url: str) -> None:
    with server_process(study, tmp_path / "log", database_url=postgres_url, workers=2) as server:
        until(lambda: len(server.workers()) == 2)
        people = [Participant(server.url).to_trials() for _ in range(2)]

        def send(person: Participant) -> tuple[int, str]:
            with httpx.Client(base_url=server.url, headers=JSON, timeout=60) as client:  # a connection of its own
                reply = client.post(f"{person.here}/ratings", json=person.answers(5))
                return reply.status_code, str(reply.json()["saved"])

        with ThreadPoolExecutor(10) as pool:
            for person in people:
                assert len(set(pool.map(send, [person] * 10))) == 1
    files = export_ratings(study, tmp_path / "out", database_url=postgres_url)
    ratings = next(path for path in files if path.name == "ratings.csv").read_text().splitlines()
    sessions = Counter(line for line in ratings if any(person.state["session"] in line for person in people))
    answered = [line for line in sessions if ",5," in line]
    assert len(answered) == 2 * 2  # two people, one picture each, two questions
    assert set(sessions.values()) == {1}


def test_a_parent_that_is_killed_leaves_no_worker_behind(study: Path, tmp_path: Path, postgres_url: str) -> None:
    with server_process(study, tmp_path / "log", database_url=postgres_url, workers=2) as server:
        until(lambda: len(server.workers()) == 2)
        workers = server.workers()
        assert server.process is not None
        server.process.kill()
        server.process.wait()
        until(lambda: is_free(server.port))
        until(lambda: not any(Path(f"/proc/{pid}/fd").exists() for pid in workers))


def test_sqlite_has_one_worker(study: Path) -> None:
    with pytest.raises(BadInput, match="--workers 2: SQLite has one writer; give a PostgreSQL database"):
        serve(study, port=0, workers=2)


@pytest.mark.parametrize("proxy", ["*", "nginx", "10.0.0.1/8"])
def test_a_proxy_is_an_address_or_a_network(study: Path, proxy: str) -> None:
    with pytest.raises(BadInput, match="--proxy"):
        serve(study, port=0, proxies=[proxy])


@pytest.mark.parametrize(("proxies", "believed"), [([], False), (["10.0.0.1"], False), (["127.0.0.0/8"], True)])
def test_forwarded_headers_are_believed_from_stated_proxies_only(
    study: Path, tmp_path: Path, proxies: list[str], believed: bool
) -> None:
    with server_process(study, tmp_path / "log", proxies=proxies) as server:
        secret = admin_secret(study)
        headers = {"X-Forwarded-Proto": "https", "X-Forwarded-For": "203.0.113.9"}
        reply = httpx.post(f"{server.url}/admin/login", json={"secret": secret}, headers=headers)
        assert reply.status_code == 303
        assert ("secure" in reply.headers["set-cookie"].lower()) is believed
        assert (f"believed from {', '.join(proxies)}" if proxies else "are not believed") in server.said()


def test_a_secret_from_the_environment_is_not_printed(
    study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FAKESSS_ADMIN_SECRET", "a-secret-of-somebody")
    with server_process(study, tmp_path / "log") as server:
        assert "a-secret-of-somebody" not in server.said()
        assert "the one in FAKESSS_ADMIN_SECRET" in server.said()
