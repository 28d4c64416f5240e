"""Pause, close and open again: what each means for who starts, who is under way and what arrives late."""

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from survey_client import ABOUT, JSON, Participant

from study_server.app import admin_secret


@pytest.fixture
def admin(study: Path, url: str) -> Iterator[httpx.Client]:
    """A program that knows the secret."""
    headers = {**JSON, "Authorization": f"Bearer {admin_secret(study)}"}
    with httpx.Client(base_url=url, headers=headers) as client:
        yield client


def health(url: str) -> str:
    """How the gate stands, as everybody may know."""
    return str(httpx.get(f"{url}/health").json()["gate"])


def test_paused_nobody_starts_and_who_is_under_way_goes_on(admin: httpx.Client, url: str) -> None:
    person = Participant(url).to_trials()
    reply = admin.post("/admin/gate", json={"state": "paused"})
    assert reply.status_code == 200 and reply.json()["state"] == "paused"
    assert health(url) == "paused"
    late = Participant(url)
    assert late.state["step"] == "paused"
    late.client.post(f"{late.here}/consent", json={})
    assert admin.get("/admin").json()["started"] == 1
    assert person.to_end()
    assert admin.post("/admin/gate", json={"state": "open"}).json()["state"] == "open"
    late.state = late.client.get(late.here).json()
    assert late.to_trials().to_end()


def test_closing_on_people_asks_once_more(admin: httpx.Client, url: str) -> None:
    person = Participant(url).to_trials()
    body = person.answers()
    asked = admin.post("/admin/gate", json={"state": "closed"})
    assert asked.status_code == 409
    assert (
        asked.json()["error"] == "1 person is under way and would be turned away; to close all the same, send sure=yes."
    )
    assert health(url) == "open"
    assert admin.post("/admin/gate", json={"state": "closed", "sure": "yes"}).status_code == 200
    assert health(url) == "closed"
    assert person.client.get(person.here).json()["step"] == "closed"
    late = person.send(body)  # given before
    assert late.status_code == 200 and late.json()["next"]["step"] == "closed"
    page = admin.get("/admin").json()
    assert (page["ratings"], page["active"]) == (2, 1)
    admin.post("/admin/gate", json={"state": "open"})
    person.state = person.client.get(person.here).json()
    assert person.state["trial"] == 2 and person.to_end()
    assert [row["state"] for row in admin.get("/admin").json()["gate"]["history"]] == ["open", "closed"]
    assert admin.post("/admin/gate", json={"state": "closed"}).status_code == 200  # nobody is under way


def test_closed_no_form_leads_on_and_withdrawing_still_does(admin: httpx.Client, url: str) -> None:
    person, other = Participant(url).consent(), Participant(url).consent()
    person.post("about", **ABOUT)
    admin.post("/admin/gate", json={"state": "closed", "sure": "yes"})
    assert person.post("screen")["step"] == "closed"
    assert other.post("withdraw", sure="yes")["step"] == "withdrawn"
    admin.post("/admin/gate", json={"state": "open"})
    assert person.client.get(person.here).json()["step"] == "screen"


def test_closed_who_gave_the_last_rating_may_comment_and_sees_the_code(admin: httpx.Client, url: str) -> None:
    person, late = Participant(url).to_trials(), Participant(url).to_trials()
    for _ in range(2):
        late.rate()
    last = late.answers()
    while person.state["step"] == "trials":
        person.rate()
    admin.post("/admin/gate", json={"state": "closed", "sure": "yes"})
    late.state = late.send(last).json()["next"]  # given before
    for finished in (person, late):
        assert finished.client.get(finished.here).json()["step"] == "comments"
        assert finished.post("comments", comments="Nice discs.")["step"] == "done"
        assert len(finished.state["completion_code"]) == 8


def test_by_form_from_the_page(study: Path, url: str) -> None:
    Participant(url).consent()
    with httpx.Client(base_url=url, headers={"Sec-Fetch-Site": "same-origin"}) as browser:
        browser.post("/admin/login", data={"secret": admin_secret(study)})
        asked = browser.post("/admin/gate", data={"state": "closed"})
        assert asked.status_code == 409 and "1 person is under way" in asked.text
        done = browser.post("/admin/gate", data={"state": "closed", "sure": "yes"})
        assert (done.status_code, done.headers["location"]) == (303, "/admin")
        assert "Nobody can start or go on" in browser.get("/admin").text


def test_another_site_a_stranger_and_a_misspelling_change_nothing(admin: httpx.Client, url: str) -> None:
    foreign = admin.post("/admin/gate", json={"state": "closed"}, headers={"Origin": "https://elsewhere.example"})
    assert foreign.status_code == 403
    assert httpx.post(f"{url}/admin/gate", json={"state": "closed"}, headers=JSON).status_code == 401
    for body in ({"state": "shut"}, {}, {"state": ["closed"]}):
        assert admin.post("/admin/gate", json=body).status_code == 422
    assert admin.get("/admin/gate").status_code == 303  # to the page
    assert health(url) == "open"


def test_the_same_state_again_is_no_change(admin: httpx.Client) -> None:
    for _ in range(3):
        admin.post("/admin/gate", json={"state": "paused"})
    assert len(admin.get("/admin").json()["gate"]["history"]) == 1
