"""Two tabs, first hits, the last picture, many starts, many writers: whatever comes at the same moment.

Which of two different answers counts is stated: the one that was stored later, whichever was given first; the other
stays as history, and a late repetition of either changes nothing.
"""

import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from random import Random
from typing import Any

import httpx
import pytest
from at_once import Sent, at_once
from running_survey import Running
from stored import sound
from survey_client import JSON, Participant

QUESTIONS = ("translucent", "realistic")


def in_two_tabs(person: Participant, first: int, second: int) -> list[Sent]:
    """Different answers to the picture that is due."""
    place = person.state["place"]
    bodies = [person.answers(rating, submission=f"tab-of-{rating}-{place}") for rating in (first, second)]
    return [(f"{person.here}/ratings", body) for body in bodies]


KEY_REPEATS_PER_SECOND = 33  # at most: see rate_limit.py


@pytest.mark.parametrize("people", [3, pytest.param(60, marks=pytest.mark.long)])
def test_of_two_tabs_answers_the_one_stored_later_counts(running: Running, people: int) -> None:
    """formr v0.25.7: 18 people were given a page twice by two tabs that raced."""
    random = Random(people)
    for _ in range(people):
        person = Participant(running.url).to_trials()
        history: dict[int, list[int]] = {}
        while person.state["step"] == "trials":
            tabs = in_two_tabs(person, *random.sample(range(1, 8), 2))
            with reading(f"{running.url}{person.here}") as pages:
                replies = at_once(running.url, tabs)
            assert [reply.status for reply in replies] == [200, 200]
            said = {reply.data["saved"][0]["revision"]: reply.data["saved"] for reply in replies}
            assert sorted(said) == [0, 1]  # each tab is told its own answer, and one that it came second
            for (_, body), reply in zip(tabs, replies, strict=True):
                assert {row["rating"] for row in reply.data["saved"]} == {body["answers"][0]["rating"]}
            history[person.state["place"]] = [said[0][0]["rating"], said[1][0]["rating"]]
            late = at_once(running.url, tabs)
            assert [reply.data["saved"] for reply in late] == [said[1]] * 2
            assert {page["step"] for page in pages} <= {"trials", "comments"}
            person.state = late[0].data["next"]
        session = person.state["session"]
        stored = sound(running.database)
        for place, given in history.items():
            assert [stored.answers[session][place, question] for question in QUESTIONS] == [given] * 2
        assert stored.events[session]["finished"] == 1
        assert stored.events[session]["revised"] == 2 * len(history)


@contextmanager
def reading(url: str) -> Iterator[list[dict[str, Any]]]:
    """A third tab that reloads its page as long as the block runs, as a key held down does; every page that it got."""
    pages: list[dict[str, Any]] = []
    enough = threading.Event()

    def reload() -> None:
        with httpx.Client(headers=JSON, timeout=60) as client:
            while not enough.is_set() or not pages:
                response = client.get(url)
                assert response.status_code == 200
                pages.append(response.json())
                enough.wait(1 / KEY_REPEATS_PER_SECOND)

    with ThreadPoolExecutor(1) as pool:
        tab = pool.submit(reload)
        try:
            yield pages
        finally:
            enough.set()
    tab.result()


def test_the_last_picture_answered_in_many_tabs_makes_one_code(running: Running) -> None:
    person = Participant(running.url).to_trials()
    while person.state["trial"] < 3:
        person.rate()
    tabs = [tab for ratings in ((1, 2), (3, 4), (5, 6)) for tab in in_two_tabs(person, *ratings)]
    replies = at_once(running.url, tabs * 2)
    assert [reply.status for reply in replies] == [200] * 12
    assert {reply.data["next"]["step"] for reply in replies} == {"comments"}
    session = person.state["session"]
    code = sound(running.database).sessions[session]["completion_code"]
    at_once(running.url, [(f"{person.here}/comments", {"comments": ""})] * 5 + tabs)
    stored = sound(running.database)
    assert stored.events[session]["finished"] == 1
    assert person.client.get(person.here).json()["completion_code"] == code
    assert stored.sessions[session]["completion_code"] == code
    assert len(stored.answers[session][person.state["place"], "realistic"]) == 6


@pytest.mark.parametrize("people", [2, pytest.param(30, marks=pytest.mark.long)])
def test_thirty_first_hits_of_one_person_are_one_session(running: Running, people: int) -> None:
    """deliberate-lab#571: one recruit, several sessions."""
    before = sum(sound(running.database).places_taken)
    for number in range(people):
        name = {"PROLIFIC_PID": f"person {number}", "STUDY_ID": "one posting", "SESSION_ID": "x"}
        links = links_opened(running.url, 30, name)
        assert len(set(links)) == 1
        replies = at_once(running.url, [(f"{link}/consent", name) for link in links])
        assert {(reply.status, reply.location) for reply in replies} == {(303, links[0])}
        assert sum(sound(running.database).places_taken) == before + number + 1


def links_opened(url: str, n: int, query: dict[str, str]) -> list[str]:
    """The link of the study opened n times at once: the addresses that are given out."""
    unlimited = httpx.Limits()  # an idle connection closed for a limit may be one that another thread just took
    with httpx.Client(base_url=url, timeout=60, limits=unlimited) as client, ThreadPoolExecutor(n) as pool:
        replies = [pool.submit(client.get, "/", params=query) for _ in range(n)]
    return [reply.result().headers["location"].partition("?")[0] for reply in replies]


def test_a_hundred_simultaneous_starts_are_spread_over_the_rows(running: Running) -> None:
    before = sum(sound(running.database).places_taken)
    links = links_opened(running.url, 100, {})
    replies = at_once(running.url, [(f"{link}/consent", {}) for link in links])
    assert {reply.status for reply in replies} == {303}
    taken = sound(running.database).places_taken
    assert sum(taken) == before + 100
    assert max(taken) - min(taken) <= 1
