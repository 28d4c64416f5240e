"""Who comes from Prolific keeps their name on every way to the start, and is led back with the code agreed upon."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import urljoin

import httpx
import pytest
from study_fixture import write_study
from survey_client import JSON, Participant

from study_server.gates import Gate, set_gate
from study_server.guards import tokens
from study_server.guards.tokens import External, belongs_to, is_valid, make_token
from study_server.manifest import load_study
from study_server.serve import served
from study_server.storage.database import default_url, open_database

Rows = Callable[..., list[dict[str, str]]]

LINK = "?PROLIFIC_PID=p1&STUDY_ID=s1&SESSION_ID=x1"
BROWSER = {"Accept": "text/html", "Sec-Fetch-Site": "same-origin"}


def who(study: Path) -> list[tuple[str, str, str]]:
    """(study, participant, session) that each stored session came with."""
    asked = "SELECT external_study, external_participant, external_session FROM sessions"
    with open_database(default_url(study)).reading() as connection:
        return [tuple(row) for row in connection.exec_driver_sql(asked)]


def turn(study: Path, state: Gate) -> None:
    with open_database(default_url(study)).writing() as connection:
        set_gate(connection, load_study(study).identity, "live", state, 0.0)


def form_action(page: httpx.Response, step: str) -> str:
    """Where the form of the page that leads to `step` is sent, as a browser reads it."""
    action = page.text.split(f"/{step}")[1].split('"')[0].replace("&amp;", "&")
    return urljoin(str(page.url), f"{page.url.path.removesuffix('/declined')}/{step}{action}")


def test_a_pause_before_the_click_makes_nobody_nameless(study: Path, url: str) -> None:
    with httpx.Client(base_url=url, headers=BROWSER, follow_redirects=True) as browser:
        page = browser.get(f"/{LINK}")
        turn(study, "paused")
        paused = browser.post(form_action(page, "consent"))
        assert "A short break" in paused.text
        turn(study, "open")
        again = browser.get(paused.url)
        assert "About you" in browser.post(form_action(again, "consent")).text
    assert who(study) == [("s1", "p1", "x1")]


def test_a_change_of_mind_makes_nobody_nameless(study: Path, url: str) -> None:
    with httpx.Client(base_url=url, headers=BROWSER, follow_redirects=True) as browser:
        declined = browser.post(form_action(browser.get(f"/{LINK}&language=en"), "declined"))
        assert "You do not take part" in declined.text
        again = browser.get(declined.url)  # the address bar, reloaded by hand
        browser.post(form_action(again, "consent"))
    assert who(study) == [("s1", "p1", "x1")]


def test_an_address_without_its_names_starts_nothing(study: Path, url: str) -> None:
    person = Participant(url, LINK)
    for response in (
        person.client.get(person.here),
        person.client.post(f"{person.here}/consent", json={}),
        person.client.post(f"{person.here}/declined", json={}),
    ):
        assert response.status_code == 404
        assert response.json()["error"].startswith("This address is only a part of your link")
    assert who(study) == []
    assert person.consent().client.get(person.here).json()["step"] == "about"  # once begun, the address is enough


@pytest.mark.parametrize(
    ("query", "name"),
    [
        ("?PROLIFIC_PID=p1", "STUDY_ID"),
        ("?STUDY_ID=s1&PROLIFIC_PID=", "PROLIFIC_PID"),
        ("?PROLIFIC_PID={{%PROLIFIC_PID%}}&STUDY_ID={{%STUDY_ID%}}", "STUDY_ID"),
        ("?STUDY_ID=s1&PROLIFIC_PID=%7B%7B%25PROLIFIC_PID%25%7D%7D", "PROLIFIC_PID"),
    ],
)
def test_a_link_that_was_not_filled_in_is_told_so(url: str, query: str, name: str) -> None:
    response = httpx.get(f"{url}/{query}", headers=JSON)
    assert response.status_code == 404
    assert response.json()["error"] == (
        f"This link does not say who you are ({name}); please tell the people who gave it to you."
    )


@pytest.mark.parametrize(("address", "status"), [("/", 303), ("/health", 200)])
def test_what_only_looks_whether_we_are_there(url: str, address: str, status: int) -> None:
    response = httpx.head(f"{url}{address}")
    assert (response.status_code, response.content) == (status, b"")


def test_tokens_say_whether_they_are_somebodys(monkeypatch: pytest.MonkeyPatch) -> None:
    person, other = External("s1", "p1"), External("s1", "p2")
    mine, anybodys = make_token("key", person), make_token("key", None)
    assert is_valid("key", mine) and is_valid("key", anybodys)
    assert not is_valid("other", mine) and not is_valid("other", anybodys)
    assert belongs_to("key", mine, person) and not belongs_to("key", mine, other) and not belongs_to("key", mine, None)
    assert belongs_to("key", anybodys, None) and not belongs_to("key", anybodys, person)
    monkeypatch.setattr(tokens, "ANONYMOUS", b"")  # as release 1 made them
    assert make_token("key", person) == mine


def test_an_address_that_release_1_gave_somebody_without_a_name_goes_on(
    study: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as release_1:
        release_1.setattr(tokens, "ANONYMOUS", b"")
        with served(study) as url:
            person = Participant(url).consent()
    with served(study) as url:
        assert httpx.get(f"{url}{person.here}", headers=JSON).json()["step"] == "about"


CODES = {"completed": "C1", "no_consent": "C2", "screened_out": "C3", "failed_checks": "C4"}
MINORS = {"name": "age", "text": "?", "choices": ["under 18", "older"], "screen_out": ["under 18"]}
AWAY = "https://app.prolific.com/submissions/complete?cc="


def short_study(folder: Path, **survey: Any) -> Path:
    """Of nine pictures, one question about the person and four instructed items."""
    least = {"about": [MINORS], "screen_check": [], "practice": 0, "checks": 4, "comments": ""}
    return write_study(folder, 9, survey={**least, **survey})


def finished(url: str, query: str, failing: int = 0) -> Participant:
    """Somebody at the last page, who overlooked so many instructed items."""
    person = Participant(url, query).consent()
    person.post("about", age="older")
    person.post("instructions")
    while person.state["step"] == "trials":
        body = person.answers()
        for asked, given in zip(person.state["questions"], body["answers"], strict=True):
            if asked["name"] == "check":
                wanted = int(re.findall("[0-9]+", asked["text"])[0])
                given["rating"] = wanted if failing <= 0 else 8 - wanted
                failing -= 1
        person.state = person.send(body).json()["next"]
    return person


@pytest.mark.parametrize(("failing", "code"), [(0, "C1"), (1, "C1"), (2, "C4")])
def test_prolifics_codes_are_for_who_came_from_there(tmp_path: Path, failing: int, code: str) -> None:
    with served(short_study(tmp_path, completion_code="CLASS", prolific=CODES)) as url:
        recruit, student = finished(url, LINK, failing), finished(url, "", failing)
    assert (recruit.state["completion_code"], recruit.state["return_url"]) == (code, AWAY + code)
    assert (student.state["completion_code"], student.state["return_url"]) == ("CLASS", "")


def test_who_declines_or_is_screened_out_gets_a_code_only_at_prolific(tmp_path: Path) -> None:
    ends = {}
    with served(short_study(tmp_path, prolific=CODES)) as url:
        for query in (LINK, ""):
            person = Participant(url, query)
            declined = person.post("declined", **person.state["external"])
            out = Participant(url, query).consent().post("about", age="under 18")
            ends[query] = [(end["completion_code"], end["return_url"]) for end in (declined, out)]
    assert ends == {LINK: [("C2", AWAY + "C2"), ("C3", AWAY + "C3")], "": [("", ""), ("", "")]}


def test_prolific_is_sent_no_code_that_it_does_not_know(tmp_path: Path) -> None:
    with served(short_study(tmp_path, prolific={"no_consent": "C2"})) as url:
        recruit = finished(url, LINK)
        out = Participant(url, LINK.replace("p1", "p2")).consent().post("about", age="under 18")
    assert len(recruit.state["completion_code"]) == 8 and recruit.state["return_url"] == ""
    assert (out["step"], out["completion_code"], out["return_url"]) == ("screened_out", "", "")


def test_a_code_stands_when_an_answer_is_changed_after_the_end(tmp_path: Path, csv_rows: Rows) -> None:
    """The later answer is kept and counts in the export; the code that was shown may be in use already."""
    study = short_study(tmp_path, prolific=CODES, failed_checks=1)
    with served(study) as url:
        person = Participant(url, LINK).consent()
        person.post("about", age="older")
        person.post("instructions")
        changed = []
        while person.state["step"] == "trials":
            body = person.answers(rating=4)  # never asked for: it is the middle
            if person.state["questions"][-1]["name"] == "check":
                right = int(re.findall("[0-9]+", person.state["questions"][-1]["text"])[0])
                changed.append(person.answers(rating=right, submission=f"changed-{body['place']}"))
            person.state = person.send(body).json()["next"]
        assert person.state["completion_code"] == "C4"
        for body in changed:
            assert person.send(body).json()["next"]["completion_code"] == "C4"
        [row] = csv_rows(study, url, "participants")
    assert row["checks_failed"] == "0"
