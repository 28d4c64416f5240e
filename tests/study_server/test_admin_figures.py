"""What the admin page says besides counts: times, refusals, withdrawals; and what it costs the database."""

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from sqlalchemy import event
from study_fixture import write_study
from survey_client import JSON, Participant

from study_server import admin, sessions
from study_server.app import admin_secret, create_app
from study_server.counts import balance
from study_server.serve import served
from study_server.site import Site
from study_server.storage import schema
from study_server.times import times


@pytest.fixture
def site(tmp_path: Path, database_url: str) -> Iterator[Site]:
    """A study of nine pictures and three questions, in each kind of database."""
    questions = [{"name": name, "text": name} for name in ("one", "two", "three")]
    study = write_study(tmp_path / "study", pictures=9, question=questions)
    opened: Site = create_app(study, database_url=database_url).state.site
    yield opened
    opened.database.close()


def fill(site: Site, people: int, seed: int = 1) -> list[tuple[int, str, float]]:
    """`people` who rated, each so many trials; gives (trial, stimulus, seconds to the last choice) of each trial."""
    random = np.random.default_rng(seed)
    now = time.time() - 4000
    timed = []
    with site.database.writing() as connection:
        for _ in range(people):
            visitor = sessions.Visitor(token=f"{people}-{random.integers(1 << 60)}", mode="live")
            session = sessions.start(connection, site.study, visitor, now)["id"]
            plan = sessions.unanswered(connection, session, 99)
            rows: list[dict[str, Any]] = []
            for planned in plan[: random.integers(2, len(plan) + 1)]:
                ms = random.lognormal(8, 0.5, 3)
                times_of = {"shown_at": now, "answered_at": now, "stored_at": now, "submission": "x"}
                key = {"session": session, "place": planned["place"]}
                rows += [
                    {**key, "question": question, "rating": 4, "rt_ms": float(rt), **times_of}
                    for question, rt in zip(planned["questions"], ms, strict=True)
                ]
                if not planned["practice"]:
                    timed.append((planned["trial"], planned["stimulus"], float(ms.max()) / 1000))
            connection.execute(schema.ratings.insert(), rows)
    return timed


@pytest.mark.parametrize("people", [1, 2, 3, 30])
def test_quartiles_are_those_of_numpy(site: Site, people: int) -> None:
    timed = fill(site, people)
    with site.database.reading() as connection:
        found = times(connection, site.study.identity, "live")
        assert times(connection, site.study.identity, "pilot") == {"trials": [], "stimuli": []}
    for table, key, column in (("trials", "trial", 0), ("stimuli", "stimulus", 1)):
        groups = sorted({row[column] for row in timed}, key=lambda name: name)  # type: ignore[arg-type,return-value]
        assert [row[key] for row in found[table]] == groups
        for row in found[table]:
            seconds = [each[2] for each in timed if each[column] == row[key]]
            assert row["answers"] == len(seconds)
            quartiles = [row["q1_s"], row["median_s"], row["q3_s"]]
            assert quartiles == pytest.approx(np.quantile(seconds, [0.25, 0.5, 0.75]), abs=0.051)


def test_the_page_asks_as_often_for_many_people_as_for_few(site: Site) -> None:
    """Nothing is asked for each person: the statements are the same, and none of them writes."""
    said: list[str] = []
    event.listen(site.database.engine, "before_cursor_execute", lambda *call: said.append(call[2]))
    counted = []
    for people in (2, 40):
        fill(site, people)
        said.clear()
        with site.database.reading() as connection:
            page = admin.figures(connection, site, time.time())
        counted.append(len(said))
        assert all(statement.lstrip().upper().startswith(("SELECT", "BEGIN")) for statement in said)
    assert page["started"] == 42
    assert counted[0] == counted[1] < 20


def test_refusals_and_withdrawals_are_told(study: Path, url: str) -> None:
    person = Participant(url).to_trials()
    assert person.send(person.answers(stimulus_sha256="0" * 64)).status_code == 409
    other = Participant(url).to_trials()
    other.rate()
    other.client.post(f"{other.here}/withdraw", json={"sure": "yes"})
    headers = {"Authorization": f"Bearer {admin_secret(study)}"}
    page = httpx.get(f"{url}/admin", headers={**JSON, **headers}).json()
    (refused,) = page["refusals"]
    assert refused["session"] == person.state["session"] and "not the one that belongs here" in refused["because"]
    assert [row["ratings_deleted"] for row in page["withdrawals"]] == [2]  # of real trials, as "ratings"
    assert "not the one that belongs here" in httpx.get(f"{url}/admin", headers=headers).text
    assert person.here.removeprefix("/s/") not in httpx.get(f"{url}/admin", headers=headers).text


def test_the_balance_in_a_sentence() -> None:
    assert balance([2, 2, 2]) == "Every row has 2: balanced exactly."
    assert balance([1, 3, 2]) == "Between 1 and 3 people a row: max - min is 2."


@pytest.mark.parametrize("mode", ["live", "pilot"])
def test_a_page_without_anybody(tmp_path: Path, database_url: str, mode: Any) -> None:
    study = write_study(tmp_path / "study")
    with served(study, database_url=database_url, mode=mode) as url:
        headers = {"Authorization": f"Bearer {admin_secret(study, database_url)}"}
        page = httpx.get(f"{url}/admin", headers={**JSON, **headers}).json()
        assert (page["started"], page["ratings"], page["median_minutes"]) == (0, 0, None)
        assert page["gate"] == {"state": "open", "meaning": "People can start, and go on.", "history": []}
        assert "Nobody is under way." in httpx.get(f"{url}/admin", headers=headers).text


def test_only_steps_where_somebody_is_under_way(study: Path, url: str) -> None:
    """Who sits at the comments has given every rating, and counts as finished."""
    person = Participant(url).to_trials()
    while person.state["step"] != "comments":
        person.rate()
    Participant(url).to_trials()
    headers = {**JSON, "Authorization": f"Bearer {admin_secret(study)}"}
    page = httpx.get(f"{url}/admin", headers=headers).json()
    assert (page["finished"], page["active"]) == (1, 1)
    assert page["steps"] == [{"step": "trials", "people": 1}]
