"""The same post several times at once (LimeSurvey PR 5213, formr#270): one row, the same reply to each, no revision."""

from random import Random

import pytest
from at_once import at_once
from running_survey import Running
from stored import sound
from survey_client import Participant

GROUPS = [10, pytest.param(570, marks=[pytest.mark.long, pytest.mark.timeout(900)])]
"""Of 2 to 10 equal posts each: 60, or 3,400, on each kind of server."""

QUESTIONS = ("translucent", "realistic")


@pytest.mark.parametrize("groups", GROUPS)
def test_equal_answers_at_once_are_one(running: Running, groups: int) -> None:
    random = Random(groups)
    given: dict[tuple[str, int], int] = {}
    sent = 0
    while len(given) < groups:
        person = Participant(running.url).to_trials()
        while person.state["step"] == "trials":
            body = person.answers(random.randint(1, 7))
            replies = at_once(running.url, [(f"{person.here}/ratings", body)] * random.randint(2, 10))
            sent += len(replies)
            assert [reply.status for reply in replies] == [200] * len(replies)
            assert all(reply.data == replies[0].data for reply in replies)
            rating = body["answers"][0]["rating"]
            assert [(row["rating"], row["revision"]) for row in replies[0].data["saved"]] == [(rating, 0)] * 2
            given[person.state["session"], body["place"]] = rating
            person.state = replies[0].data["next"]
            late = person.send(body)  # once more, when the next picture is due
            assert (late.status_code, late.json()) == (200, replies[0].data)
        assert person.to_end()
    stored = sound(running.database)
    assert sent >= 5 * groups
    for (session, place), rating in given.items():
        assert [stored.answers[session][place, question] for question in QUESTIONS] == [[rating]] * 2
        assert stored.events[session]["revised"] == 0


def test_equal_forms_at_once_are_one(running: Running) -> None:
    person = Participant(running.url)
    forms = [("consent", {}), ("about", {"age": "25-34", "background": "as a hobby", "vision": "normal"})]
    forms += [("screen", {}), ("instructions", {})]
    for step, fields in forms:
        replies = at_once(running.url, [(f"{person.here}/{step}", fields)] * 10)
        assert {(reply.status, reply.location) for reply in replies} == {(303, person.here)}
    person.state = person.client.get(person.here).json()
    assert person.state["step"] == "practice"
    person.rate()
    person.post("ready")
    while person.state["step"] == "trials":
        person.rate()
    replies = at_once(running.url, [(f"{person.here}/comments", {"comments": f"tab {tab}"}) for tab in range(10)])
    assert {reply.status for reply in replies} == {303}
    session = sound(running.database).sessions[person.state["session"]]
    assert session["step"] == "done"
    assert session["comments"].startswith("tab ")
