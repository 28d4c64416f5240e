"""Participants at every step of a session, by the step's name."""

from collections.abc import Callable
from typing import Any

from survey_client import ABOUT, Participant


def rate_all(step: str) -> Callable[[Participant], None]:
    """Answers every picture of this step."""

    def rate(person: Participant) -> None:
        while person.state["step"] == step:
            person.rate()

    return rate


WAY: list[Callable[[Participant], Any]] = [
    Participant.consent,
    lambda person: person.post("about", **ABOUT),
    lambda person: person.post("screen"),
    lambda person: person.post("instructions"),
    rate_all("practice"),
    lambda person: person.post("ready"),
    rate_all("trials"),
    lambda person: person.post("comments", comments="None."),
    lambda person: person.post("withdraw", sure="yes"),
]


def at_every_step(url: str, study: str = "s") -> dict[str, Participant]:
    """One participant at each, from the service's `study`; with a screen check, practice and comments."""
    people = {}
    for steps in range(len(WAY) + 1):
        person = Participant(url, f"?STUDY_ID={study}&PROLIFIC_PID=p{steps}")
        for step in WAY[:steps]:
            step(person)
        people[person.state["step"]] = person
    assert len(people) == len(WAY) + 1
    return people
