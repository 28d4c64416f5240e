"""Order rows are given out evenly, whoever comes at once and whoever leaves."""

import asyncio
import time
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx
import pytest
from study_fixture import write_study
from survey_client import JSON

from study_server import sessions
from study_server.app import create_app
from study_server.guards.tokens import make_token
from study_server.serve import served


async def begin(client: httpx.AsyncClient) -> None:
    here = (await client.get("/")).json()["here"]
    assert (await client.post(f"{here}/consent", json={})).json()["step"] == "about"


async def everybody(url: str, n: int) -> None:
    limits = httpx.Limits(max_connections=n)
    async with httpx.AsyncClient(
        base_url=url, headers=JSON, follow_redirects=True, limits=limits, timeout=60
    ) as client:
        await asyncio.gather(*(begin(client) for _ in range(n)))


def start_at_once(url: str, n: int) -> None:
    """`n` people start in one moment. In a thread: the browser tests' driver keeps a running loop in this one."""
    with ThreadPoolExecutor(1) as pool:
        pool.submit(lambda: asyncio.run(everybody(url, n))).result()


@pytest.mark.parametrize("pictures", [3, pytest.param(9, marks=pytest.mark.long)])
def test_a_hundred_at_once_leave_no_row_two_ahead(
    tmp_path: Path, pictures: int, csv_rows: Callable[..., list[dict[str, str]]]
) -> None:
    study = write_study(tmp_path, pictures)
    with served(study) as url:
        start_at_once(url, 100)
        people = csv_rows(study, url, "participants")
    held = Counter(int(person["order_row"]) for person in people)
    assert sum(held.values()) == 100
    assert set(held) == set(range(1, 2 * pictures + 1))
    assert max(held.values()) - min(held.values()) <= 1


def test_a_row_is_given_again_after_silence_and_kept_by_who_finished(study: Path) -> None:
    site = create_app(study).state.site
    silence = sessions.release_s(site.study) + 1
    now = time.time()

    def start(at: float) -> int:
        with site.database.writing() as connection:
            token = make_token(site.signing_key, None)
            return int(sessions.start(connection, site.study, sessions.Visitor(token, "live"), at)["row"])

    first = [start(now) for _ in range(6)]
    assert sorted(first) == list(range(6))
    with site.database.writing() as connection:  # the one in row 0 finishes, all others fall silent
        finisher = next(p for p in connection.execute(sessions.schema.sessions.select()).mappings() if p["row"] == 0)
        sessions.advance(connection, finisher, now, finished_at=now)
    later = [start(now + silence) for _ in range(5)]
    assert sorted(later) == [1, 2, 3, 4, 5]


def test_pilots_take_no_rows_from_the_live_study(study: Path, csv_rows: Callable[..., list[dict[str, str]]]) -> None:
    with served(study, mode="pilot") as url:
        start_at_once(url, 4)
        assert {row["mode"] for row in csv_rows(study, url, "ratings")} == {"pilot"}
    with served(study) as url:
        assert csv_rows(study, url, "participants") == csv_rows(study, url, "ratings") == []
        start_at_once(url, 1)
        [person] = csv_rows(study, url, "participants")
    assert (person["order_row"], person["mode"]) == ("1", "live")
