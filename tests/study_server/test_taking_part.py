"""One participant against a real server and a real database: nothing lost, nothing doubled, no wrong picture."""

import sqlite3
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path
from string import ascii_lowercase, ascii_uppercase, digits

import httpx
import pytest
from study_fixture import write_study
from survey_client import ABOUT, JSON, Participant

from study_server.serve import served

Exported = Callable[..., list[dict[str, str]]]
LETTERS = f"{ascii_uppercase}{ascii_lowercase}{digits}-_"


def test_the_whole_way(url: str, exported: Exported) -> None:
    person = Participant(url)
    assert person.state["step"] == "consent"
    assert exported("participants") == []  # opening the link stores nothing
    person.to_trials()
    given = {}
    for rating in (2, 5, 7):
        stimulus = person.state["picture"]["sha256"]
        reply = person.rate(rating)
        assert {row["rating"] for row in reply["saved"]} == {rating}
        given[stimulus] = rating
    assert person.state["step"] == "comments"
    person.post("comments", comments="Nice.")
    assert len(person.state["completion_code"]) == 8
    rows = exported()
    assert {(row["stimulus_sha256"], int(row["rating"])) for row in rows} == set(given.items())
    assert len({(row["trial"], row["question"]) for row in rows}) == len(rows) == 6
    [who] = exported("participants")
    assert (who["status"], who["comments"], who["about_age"], who["ratings"]) == ("finished", "Nice.", "25-34", "6")


def test_times_are_the_servers_clock(url: str, exported: Exported) -> None:
    Participant(url).to_trials().rate()
    row = exported()[0]
    assert row["shown_at"] < row["answered_at"]
    assert float(row["rt_ms"]) == 1000.0
    assert row["shown_at"].endswith("Z")


def test_ten_identical_posts_at_once_make_one_row(url: str, exported: Exported) -> None:
    person = Participant(url).to_trials()
    body = person.answers(6)
    with ThreadPoolExecutor(10) as pool:
        replies = list(
            pool.map(lambda _: httpx.post(f"{url}{person.here}/ratings", json=body, headers=JSON), range(10))
        )
    assert [reply.status_code for reply in replies] == [200] * 10
    assert len({str(reply.json()["saved"]) for reply in replies}) == 1
    answered = [row for row in exported() if row["rating"]]
    assert [(row["rating"], row["revision"]) for row in answered] == [("6", "0")] * 2


def test_a_different_answer_is_a_revision_and_history_stays(url: str, exported: Exported) -> None:
    person = Participant(url).to_trials()
    first = person.answers(2)
    person.send(first)
    display = {**first["display"], "zoom": 2, "drawn_width_px": 40}
    person.send(person.answers(5, submission="another-tab", display=display))
    person.send(first)  # a late retry of the first one must not undo the second
    answered = [row for row in exported() if row["rating"]]
    assert [(row["rating"], row["revision"]) for row in answered] == [("5", "1")] * 2
    assert [(row["zoom"], row["drawn_width_px"]) for row in answered] == [("1", "96")] * 2  # as the codebook says
    described = {row["column"]: row["description"] for row in exported("codebook") if row["table"] == "ratings.csv"}
    for column in first["display"]:
        assert described[column].endswith("of the first showing, also where a revision counts")
    revised = [event for event in exported("events") if event["kind"] == "revised"]
    assert len(revised) == 2
    assert '"from": 2' in revised[0]["detail"]


def test_an_answer_to_another_picture_is_refused_and_noted(url: str, exported: Exported) -> None:
    person = Participant(url).to_trials()
    response = person.send(person.answers(stimulus_sha256="0" * 64))
    assert response.status_code == 409
    assert "not the one that belongs here" in response.json()["error"]
    assert not any(row["rating"] for row in exported())
    assert [event["kind"] for event in exported("events")] == ["started", "refused"]


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({"place": 2}, 409),
        ({"place": 99}, 404),
        ({"answers": []}, 422),
        ({"answers": [{"question": "translucent", "rating": 4, "rt_ms": 1}] * 2}, 422),
        ({"since_shown_ms": -1}, 422),
        ({"since_shown_ms": "soon"}, 422),
        ({"surplus": 1}, 422),
    ],
)
def test_half_and_early_answers_are_refused(
    url: str, exported: Exported, changes: dict[str, object], status: int
) -> None:
    person = Participant(url).to_trials()
    assert person.send(person.answers(**changes)).status_code == status
    assert not any(row["rating"] for row in exported())


@pytest.mark.parametrize("rating", [0, 8, 3.5, "4", True, None])
def test_ratings_off_the_scale_are_refused(url: str, exported: Exported, rating: object) -> None:
    person = Participant(url).to_trials()
    assert person.send(person.answers(rating)).status_code == 422  # type: ignore[arg-type]
    assert not any(row["rating"] for row in exported())


def test_not_a_number_is_refused_without_a_crash(url: str) -> None:
    person = Participant(url).to_trials()
    body = '{"place": NaN, "since_shown_ms": Infinity}'
    response = person.client.post(f"{person.here}/ratings", content=body, headers={"Content-Type": "application/json"})
    assert response.status_code == 422


def test_no_code_before_every_row_is_stored(url: str) -> None:
    person = Participant(url).to_trials()
    for _ in range(2):
        person.rate()
        person.post("comments")
        assert person.state["step"] == "trials"
        assert "completion_code" not in person.state
    person.rate()
    assert person.state["step"] == "comments"
    assert "completion_code" not in person.state
    assert person.to_end()


def test_a_form_sent_twice_or_late_changes_nothing(url: str) -> None:
    person = Participant(url).consent()
    person.post("about", **ABOUT)
    person.post("about", **ABOUT)
    assert person.state["step"] == "screen"
    person.post("consent")
    person.post("screen")
    assert person.state["step"] == "instructions"
    person.post("instructions")
    person.post("instructions")
    assert person.state["step"] == "practice"


def test_about_needs_its_required_fields_and_known_choices(url: str) -> None:
    person = Participant(url).consent()
    for told, why in (
        ({"age": "25-34"}, {"background": "Please answer this question.", "vision": "Please answer this question."}),
        ({**ABOUT, "age": "<script>"}, {"age": "Please choose one of these answers."}),
    ):
        refused = person.client.post(f"{person.here}/about", json=told)
        assert refused.status_code == 422
        page = refused.json()
        assert page["step"] == "about" and page["error"].startswith("Nothing was saved yet")
        assert {field["name"]: field["problem"] for field in page["fields"] if field["problem"]} == why
        assert {field["name"]: field["given"] for field in page["fields"] if field["given"]} == told
        shown = person.client.post(f"{person.here}/about", data=told, headers={"Accept": "text/html"}).text
        assert all(sentence in shown for sentence in (page["error"], *why.values()))
        assert "<script>" not in shown.split("<main>")[1]
        assert shown.count(" checked") == sum(value != "<script>" for value in told.values())
    assert person.post("about", **ABOUT)["step"] == "screen"


def test_first_hits_of_one_person_may_race(url: str, exported: Exported) -> None:
    query = "?STUDY_ID=s1&PROLIFIC_PID=p1&SESSION_ID=x"
    with ThreadPoolExecutor(8) as pool:
        people = list(pool.map(lambda _: Participant(url, query).consent(), range(8)))
    assert len({person.here for person in people}) == 1
    assert len(exported("participants")) == 1
    assert "p1" not in str(exported("participants"))
    assert Participant(url, query).state["step"] == "about"  # the same link later: where they were


def test_nobody_takes_part_under_another_persons_name(url: str) -> None:
    person = Participant(url)
    stolen = {"STUDY_ID": "s1", "PROLIFIC_PID": "p1", "SESSION_ID": ""}
    assert person.client.post(f"{person.here}/consent", json=stolen).status_code == 404


@pytest.mark.parametrize("path", ["/s/x", "/s/" + "A" * 43, "/s/..%2F..%2Fetc", "/picture/..%2F..%2Fmanifest.json.png"])
def test_addresses_that_are_nobodys(url: str, path: str) -> None:
    response = httpx.get(f"{url}{path}", headers=JSON)
    assert response.status_code == 404
    assert "error" in response.json()


def test_an_address_has_one_spelling(url: str, exported: Exported) -> None:
    person = Participant(url).consent()
    token = person.here.removeprefix("/s/")
    last = LETTERS[LETTERS.index(token[-1]) + 1]  # differs in bits that belong to no byte
    for alias in (f"{token}!", f"!{token}", f"{token[:9]}%0A{token[9:]}", f"{token}=", f"{token}==", token[:-1] + last):
        assert httpx.get(f"{url}/s/{alias}", headers=JSON).status_code == 404
        assert httpx.post(f"{url}/s/{alias}/consent", headers=JSON).status_code == 404
    assert len(exported("participants")) == 1


def test_a_withdrawal_deletes_and_leaves_its_mark(url: str, exported: Exported) -> None:
    person = Participant(url).to_trials()
    person.rate()
    assert "withdraw" in person.client.get(f"{person.here}/withdraw").json()["step"]
    person.post("withdraw")  # without being sure
    assert person.state["step"] == "trials"
    late = person.answers()
    person.post("withdraw", sure="yes")
    assert person.state["step"] == "withdrawn"
    assert person.send(late).status_code == 410
    assert exported() == []
    [who] = exported("participants")
    assert (who["status"], who["ratings"], who["about_age"]) == ("withdrawn", "0", "")


def test_who_finished_and_withdrew_is_not_among_the_finished(url: str, study: Path, exported: Exported) -> None:
    person = Participant(url).to_trials()
    code = person.to_end()
    assert exported("participants")[0]["finished_at"]
    person.post("withdraw", sure="yes")
    assert person.state["step"] == "withdrawn"
    assert person.client.get(person.here).json()["step"] == "withdrawn"
    [who] = exported("participants")
    assert (who["status"], who["finished_at"]) == ("withdrawn", "")
    with closing(sqlite3.connect(study / "ratings.sqlite")) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    assert code.encode() not in (study / "ratings.sqlite").read_bytes()


def test_one_person_in_two_postings_is_one_participant_with_two_sessions(url: str, exported: Exported) -> None:
    for posting in ("first", "second"):
        Participant(url, f"?STUDY_ID={posting}&PROLIFIC_PID=p1").to_trials().to_end()
    for table in ("ratings", "participants"):
        visits = {(row["started_at"], row["session"]) for row in exported(table)}
        assert len(visits) == len({started for started, _ in visits}) == 2
        assert len({row["participant"] for row in exported(table)}) == 1


def test_who_withdrew_is_forgotten_but_cannot_begin_again(url: str, study: Path, exported: Exported) -> None:
    query = "?STUDY_ID=s1&PROLIFIC_PID=a-name-to-forget&SESSION_ID=x"
    person = Participant(url, query).to_trials()
    person.post("withdraw", sure="yes")
    assert Participant(url, query).state["step"] == "withdrawn"
    assert len(exported("participants")) == 1
    with closing(sqlite3.connect(study / "ratings.sqlite")) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    assert b"a-name-to-forget" not in (study / "ratings.sqlite").read_bytes()


def test_nothing_asked_but_the_pictures(tmp_path: Path) -> None:
    survey = {"about": [], "screen_check": [], "practice": 0, "comments": "", "completion_code": "THANKS"}
    with served(write_study(tmp_path, survey=survey)) as url:
        person = Participant(url).consent()
        person.post("instructions")
        assert person.to_end() == "THANKS"


def test_pictures_are_cached_for_good(url: str) -> None:
    person = Participant(url).to_trials()
    first = person.client.get(person.state["picture"]["url"])
    assert "immutable" in first.headers["cache-control"]
    assert len(first.content) == person.state["picture"]["bytes"]
    again = person.client.get(person.state["picture"]["url"], headers={"If-None-Match": first.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")


def test_a_picture_changed_on_disk_is_not_sent(study: Path, url: str) -> None:
    person = Participant(url).to_trials()
    for path in (study / "stimuli").glob("*.png"):
        path.write_bytes(path.read_bytes()[:-1] + b"x")
    response = person.client.get(person.state["picture"]["url"])
    assert response.status_code == 503
    assert "damaged" in response.json()["error"]


def test_participants_read_the_title_that_is_meant_for_them(tmp_path: Path) -> None:
    study = write_study(tmp_path / "study", survey={"title": "How does this object look?"})
    with served(study) as url:
        person = Participant(url)
        person.consent()
        assert person.state["title"] == "How does this object look?"
