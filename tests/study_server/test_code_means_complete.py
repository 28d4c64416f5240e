"""Random histories (hypothesis): a completion code exactly when every expected row is stored, whatever came before.

People start, answer, correct themselves, repeat themselves, send what was refused before, jump ahead, name a wrong
picture, post forms out of turn and withdraw, in any order. A plain account of what should be stored goes beside.
"""

import json
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, ClassVar

import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, precondition, rule, run_state_machine_as_test
from stored import sound
from study_fixture import write_study
from survey_client import ABOUT, Participant

from study_server.serve import served
from study_server.storage.database import default_url

FORMS: dict[str, Mapping[str, str]] = {"about": ABOUT, "screen": {}, "instructions": {}, "ready": {}}
DESIGNS: dict[str, dict[str, Any]] = {
    "plain": {},
    "blocks and instructed items": {"blocks": "by-question", "checks": 2, "practice": 0},
    "repeats and practice": {"checks": 1, "practice": 2, "comments": ""},
}


class Person:
    """One participant, and what the server should hold of them."""

    def __init__(self, url: str) -> None:
        self.client = Participant(url).consent()
        self.session = self.client.state["session"]
        self.given: dict[tuple[int, str], list[int]] = {}
        self.sent: list[dict[str, Any]] = []
        self.trials_answered: set[int] = set()
        self.trials = 0

    @property
    def step(self) -> str:
        """Where the server said they are."""
        return str(self.client.state["step"])

    def to_pictures(self) -> None:
        """Past every form on the way."""
        while self.step in FORMS:
            self.client.post(self.step, **FORMS[self.step])

    def arrived(self, state: dict[str, Any]) -> None:
        """The page that the server sent, judged: past the trials exactly if all are answered; a code only then."""
        self.client.state = state
        if state["step"] == "trials":
            self.trials = state["trials"]
        if state["step"] != "withdrawn":
            is_complete = 0 < self.trials == len(self.trials_answered)
            assert (state["step"] in ("comments", "done")) == is_complete
            assert ("completion_code" in state) <= is_complete

    def reload(self) -> None:
        """The page again."""
        self.arrived(self.client.client.get(self.client.here).json())

    def send(self, body: dict[str, Any]) -> int:
        """Post answers; the account is kept as the promise says. The status."""
        due = self.client.state
        reply = self.client.send(body)
        if reply.status_code == 200:
            is_new = body["submission"] not in {old["submission"] for old in self.sent}
            for answer in body["answers"] if is_new else ():
                history = self.given.setdefault((body["place"], answer["question"]), [])
                history += [answer["rating"]] if history[-1:] != [answer["rating"]] else []
            if due["step"] == "trials" and body["place"] == due["place"]:
                self.trials_answered.add(body["place"])
            self.sent += [body] if is_new else []
            for row in reply.json()["saved"]:
                assert row["rating"] == self.given[body["place"], row["question"]][-1]
            self.arrived(reply.json()["next"])
        return reply.status_code


class Histories(RuleBasedStateMachine):
    """Any order of events for up to three people at once."""

    url = ""
    database = ""
    seen: ClassVar[Counter[str]]

    def __init__(self) -> None:
        super().__init__()
        self.people: list[Person] = []

    @rule()
    @precondition(lambda self: len(self.people) < 3)
    def somebody_starts(self) -> None:
        self.people.append(Person(self.url))

    def one(self, who: int) -> Person:
        """Somebody who is there."""
        return self.people[who % len(self.people)]

    @rule(who=st.integers(0, 2), pictures=st.integers(1, 5), rating=st.integers(1, 7))
    @precondition(lambda self: self.people)
    def answers(self, who: int, pictures: int, rating: int) -> None:
        person = self.one(who)
        for number in range(pictures):
            person.to_pictures()
            if person.step not in ("practice", "trials"):
                break
            name = f"answer-{len(person.sent)}"
            assert person.send(person.client.answers(1 + (rating + number) % 7, submission=name)) == 200
            self.seen["finished"] += person.step in ("comments", "done")

    @rule(who=st.integers(0, 2), which=st.integers(0, 20), rating=st.integers(1, 7), is_new=st.booleans())
    @precondition(lambda self: any(person.sent for person in self.people))
    def sends_again(self, who: int, which: int, rating: int, is_new: bool) -> None:
        """An earlier answer once more, or another one to the same picture."""
        person = self.one(who)
        if person.sent:
            body = person.sent[which % len(person.sent)]
            if is_new:
                changed = [{**answer, "rating": rating} for answer in body["answers"]]
                body = {**body, "answers": changed, "submission": f"answer-{len(person.sent)}"}
            assert person.send(body) == (410 if person.step == "withdrawn" else 200)
            self.seen["corrected" if is_new else "repeated"] += 1

    @rule(who=st.integers(0, 2), wrong=st.sampled_from(["picture", "place", "half", "off the scale", "nothing"]))
    @precondition(lambda self: self.people)
    def sends_what_is_refused(self, who: int, wrong: str) -> None:
        person = self.one(who)
        person.to_pictures()
        if person.step not in ("practice", "trials"):
            return
        body = person.client.answers(4, submission="refused-1")
        answers = body["answers"]
        body |= {
            "picture": {"stimulus_sha256": "0" * 64},
            "place": {"place": body["place"] + 1},
            "half": {"answers": answers[1:]},
            "off the scale": {"answers": [{**answer, "rating": 8} for answer in answers]},
            "nothing": {"answers": []},
        }[wrong]
        assert person.send(body) in (404, 409, 422)
        self.seen["refused"] += 1
        person.reload()

    @rule(who=st.integers(0, 2), step=st.sampled_from([*FORMS, "comments", "consent"]))
    @precondition(lambda self: self.people)
    def posts_a_form_out_of_turn(self, who: int, step: str) -> None:
        person = self.one(who)
        before = person.step
        person.client.post(step, **FORMS.get(step, {}))
        assert person.step == before or before == step
        person.arrived(person.client.state)

    @rule(who=st.integers(0, 2), is_sure=st.booleans())
    @precondition(lambda self: self.people)
    def withdraws(self, who: int, is_sure: bool) -> None:
        person = self.one(who)
        person.client.post("withdraw", sure="yes" if is_sure else "")
        if is_sure:
            assert person.step == "withdrawn"
            person.given.clear()
            self.seen["withdrew"] += 1

    def teardown(self) -> None:
        """What is stored is sound, and exactly what the account says."""
        stored = sound(self.database)
        for person in self.people:
            assert stored.answers[person.session] == person.given


@pytest.fixture(scope="module", params=DESIGNS)
def machine(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[type[Histories]]:
    """The histories of one design's study, which is served."""
    study = write_study(tmp_path_factory.mktemp("study"), 3, survey=DESIGNS[request.param])
    if request.param.startswith("repeats"):
        repeat_first(study)
    with served(study) as url:
        found = Counter[str]()
        yield type("Histories", (Histories,), {"url": url, "database": default_url(study), "seen": found})
        assert set(found) == {"finished", "repeated", "corrected", "refused", "withdrew"}


def repeat_first(study: Path) -> None:
    """Adds a second showing of the first picture."""
    manifest = study / "stimuli" / "manifest.json"
    data = json.loads(manifest.read_text())
    first = data["stimuli"][0]
    data["stimuli"].append({**first, "id": "again", "role": "repeat", "same_picture_as": first["id"]})
    manifest.write_text(json.dumps(data))


def test_a_code_means_that_every_row_is_there(machine: type[Histories]) -> None:
    examples = settings.default.max_examples // 10  # 10, or 200 in the long run
    how = settings(
        max_examples=examples,
        stateful_step_count=25,
        derandomize=examples < 100,  # few as they are, they must do everything that `seen` counts
        suppress_health_check=list(HealthCheck),
    )
    run_state_machine_as_test(machine, settings=how)
