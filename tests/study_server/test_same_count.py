"""The same count everywhere: the admin page, the exported files, and the tables counted by other means."""

import csv
import io
import random
import sqlite3
import statistics
from collections import Counter
from collections.abc import Iterator
from contextlib import closing, contextmanager
from datetime import datetime
from pathlib import Path
from typing import Any

import httpx
import psycopg
import pytest
from study_fixture import QUESTIONS, write_study
from survey_client import ABOUT, JSON, Participant

from study_server.app import admin_secret
from study_server.counts import STATES
from study_server.serve import served
from study_server.storage.engines import parsed_url

ABOUT_FIELDS = [
    {"name": "age", "text": "Age?", "choices": ["under 18", "25-34"], "required": True, "screen_out": ["under 18"]},
]
SURVEY = {"checks": 2, "practice": 1, "about": ABOUT_FIELDS, "release_after_minutes": 60}
DAY_S = 86_400.0


@contextmanager
def tables(database_url: str) -> Iterator[Any]:
    """The database as any other program sees it, without our code; `execute` takes SQL."""
    if database_url.startswith("sqlite"):
        with closing(sqlite3.connect(str(parsed_url(database_url).database), timeout=30, isolation_level=None)) as file:
            yield file
    else:
        with psycopg.connect(database_url.replace("+psycopg", ""), autocommit=True) as connection:
            yield connection


def history(url: str, people: int, lots: random.Random) -> list[str]:
    """People come, rate, revise, finish, stop or withdraw, or are sent away; gives the sessions of who stopped."""
    silent = []
    for _ in range(people):
        person = Participant(url)
        if lots.random() < 0.1:
            continue  # looked at the first page only
        person.consent()
        fate = lots.choice(["finishes", "finishes", "stops", "stops", "withdraws", "is too young", "goes on"])
        if fate == "is too young":
            person.post("about", age="under 18")
            continue
        walk(person, lots, 99 if fate == "finishes" else lots.randint(0, 5))
        if fate == "stops" and "session" in person.state:
            silent.append(person.state["session"])
        if fate == "withdraws":
            person.client.post(f"{person.here}/withdraw", json={"sure": "yes"})
    return silent


def walk(person: Participant, lots: random.Random, steps: int) -> None:
    """So many steps on, some answers changed afterwards, some instructed items answered otherwise than asked."""
    for _ in range(steps):
        step = person.state["step"]
        if step == "done":
            return
        if step not in ("practice", "trials"):
            person.post(step, **({"age": ABOUT["age"]} if step == "about" else {}))
            continue
        body = person.answers(lots.randint(1, 7), submission=f"the-first-{person.state['place']}")
        response = person.send(body)
        assert response.status_code == 200, response.text
        if lots.random() < 0.5:
            person.send(person.answers(lots.randint(1, 7), submission=f"once-more-{person.state['place']}"))
        person.state = person.client.get(person.here).json()


def table(url: str, secret: str, name: str, mode: str) -> list[dict[str, str]]:
    """A table of the export."""
    headers = {"Authorization": f"Bearer {secret}"}
    response = httpx.get(f"{url}/admin/export/{name}.csv", headers=headers, params={"mode": mode}, timeout=60)
    assert response.status_code == 200
    return list(csv.DictReader(io.StringIO(response.text)))


def by_page(url: str, secret: str) -> dict[str, Any]:
    """The figures of the page."""
    page: dict[str, Any] = httpx.get(f"{url}/admin", headers={**JSON, "Authorization": f"Bearer {secret}"}).json()
    counted = {name: page[name] for name in ("started", "ratings", "checks_failed", "displays_scaled")}
    assert page["started"] == sum(page[state.replace("-", "_")] for state in STATES)
    assert sum(row["people"] for row in page["steps"]) == page["active"]
    return counted | {
        "states": {state: page[state.replace("-", "_")] for state in STATES},
        "dropped_at": {row["trials"]: row["people"] for row in page["dropped_at"] if row["people"]},
        "rows": {row["row"]: row["people"] for row in page["rows"] if row["people"]},
        "median_minutes": page["median_minutes"],
    }


def by_export(url: str, secret: str, mode: str) -> dict[str, Any]:
    """The same counted in the exported files."""
    people = table(url, secret, "participants", mode)
    ratings = table(url, secret, "ratings", mode)
    displays = table(url, secret, "displays", mode)
    given = [row for row in ratings if row["rating"]]
    assert sum(int(person["ratings"]) for person in people) == len(given)
    states = Counter(person["status"] for person in people)
    minutes = [
        minutes_between(person["started_at"], person["finished_at"]) for person in people if person["finished_at"]
    ]
    return {
        "started": len(people),
        "ratings": len(given),
        "checks_failed": sum(row["check_passed"] == "0" for row in ratings),
        "displays_scaled": sum(row["scaled"] == "1" for row in displays),
        "states": {state: states[state] for state in STATES},
        "dropped_at": dict(Counter(int(p["trials_answered"]) for p in people if p["status"] == "dropped")),
        "rows": dict(Counter(int(p["order_row"]) for p in people if p["status"] in ("active", "finished"))),
        "median_minutes": round(statistics.median(minutes), 1) if minutes else None,
    }


def minutes_between(first: str, last: str) -> float:
    """Minutes between two times of the export."""
    return (datetime.fromisoformat(last) - datetime.fromisoformat(first)).total_seconds() / 60


def by_tables(database: Any, mode: str) -> dict[str, Any]:
    """The same counted row by row from the bare tables."""
    sessions = database.execute("SELECT id, step, finished_at, started_at, seen_at, row, mode FROM sessions").fetchall()
    mine = [session for session in sessions if session[6] == mode]
    shown = database.execute(
        "SELECT session, place, answered_at, scaled, check_expected FROM presentations WHERE NOT practice"
    ).fetchall()
    given = {(s, p, q): r for s, p, q, r in database.execute("SELECT session, place, question, rating FROM ratings")}
    later = "SELECT session, place, question, rating FROM revisions ORDER BY revision"
    stands = given | {(s, p, q): r for s, p, q, r in database.execute(later)}
    expected = {(session, place): check for session, place, _, _, check in shown}
    names = {session[0] for session in mine}
    newest = max((session[4] for session in mine), default=0.0)
    states, dropped, rows = Counter[str](), Counter[int](), Counter[int]()
    for name, step, finished_at, _, seen_at, row, _ in mine:
        ended = {"withdrawn": "withdrawn", "screened_out": "screened-out"}.get(step)
        state = ended or ("finished" if finished_at else "active" if seen_at > newest - DAY_S / 2 else "dropped")
        states[state] += 1
        dropped[sum(s == name and at is not None for s, _, at, _, _ in shown)] += state == "dropped"
        rows[row + 1] += state in ("active", "finished")
    minutes = [(session[2] - session[3]) / 60 for session in mine if session[2]]
    real = [key for key in given if key[0] in names and key[:2] in expected]
    return {
        "started": len(mine),
        "ratings": len(real),
        "checks_failed": sum(stands[key] != expected[key[:2]] for key in real if key[2] == "check"),
        "displays_scaled": sum(bool(scaled) for name, _, _, scaled, _ in shown if name in names),
        "states": {state: states[state] for state in STATES},
        "dropped_at": {trials: people for trials, people in dropped.items() if people},
        "rows": {row: people for row, people in rows.items() if people},
        "median_minutes": round(statistics.median(minutes), 1) if minutes else None,
    }


@pytest.mark.parametrize("people", [20, pytest.param(200, marks=pytest.mark.long)])
def test_the_same_count_everywhere(tmp_path: Path, database_url: str, people: int) -> None:
    """After any history, with a pilot beside the live study in one database."""
    study = write_study(tmp_path / "study", pictures=4, question=QUESTIONS, survey=SURVEY)
    lots = random.Random(people)
    with (
        served(study, database_url=database_url) as live,
        served(study, database_url=database_url, mode="pilot") as pilot,
        tables(database_url) as database,
    ):
        secret = admin_secret(study, database_url)
        silent = history(live, people, lots) + history(pilot, people // 4, lots)
        mark = "?" if database_url.startswith("sqlite") else "%s"
        for session in silent:  # by the clock: they have said nothing for a day
            database.execute(f"UPDATE sessions SET seen_at = seen_at - {DAY_S} WHERE id = {mark}", (session,))
        some = database.execute("SELECT session, place FROM presentations WHERE answered_at IS NOT NULL").fetchall()
        for session, place in some[::3]:
            where = f"WHERE session = {mark} AND place = {mark}"
            database.execute(f"UPDATE presentations SET scaled = {mark} {where}", (True, session, place))
        for mode, url in (("live", live), ("pilot", pilot)):
            page = by_page(url, secret)
            assert page["started"] > 0
            assert page == by_export(live, secret, mode)
            assert page == by_tables(database, mode)
        seen = by_page(live, secret)
        assert all(seen["states"].values()), "a history in which something never happens shows nothing of it"
        assert seen["checks_failed"] and seen["displays_scaled"] and seen["dropped_at"]
