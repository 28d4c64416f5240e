"""A study with everything that an export can trip over, and people in every state."""

import json
from pathlib import Path
from typing import Any

from study_fixture import write_study
from survey_client import Participant

from study_server.storage.database import default_url, open_database

COMMENT = '=HYPERLINK("http://x"), "quoted",\r\nsecond line; déjà vu 半透明'
JOB = "@home\rEVIL,x,live,finished"
"""A bare carriage return, which no form sends and any program can."""
QUESTIONS = [
    {"name": "looks, \"soft\"", "text": "The object looks soft, or \"soft\".", "scale": 5},
    {"name": "translucent", "text": "The object looks translucent."},
]  # fmt: skip
ASKED = [
    {"name": "age", "text": "How old are you?", "choices": ["under 18", "25-34"], "screen_out": ["under 18"]},
    {"name": "job", "text": "What do you do?"},
]


def write_hostile_study(folder: Path, **survey: Any) -> Path:
    """Four pictures and two repeats, two questions with odd names, two instructed items, codes; nothing is easy."""
    settings = {"checks": 2, "practice": 1, "about": ASKED, "record": ["address", "browser"], **survey}
    study = write_study(folder, 4, question=QUESTIONS, survey=settings, title='Wie "durchscheinend" ist Grün, 100%?')
    path = study / "stimuli" / "manifest.json"
    manifest = json.loads(path.read_text(encoding="utf-8"))
    for shown in manifest["stimuli"][:2]:
        again = {"id": f"{shown['id']}r", "role": "repeat", "rows": [], "same_picture_as": shown["id"]}
        manifest["stimuli"].append({**shown, **again, "label": "=1+1"})
    path.write_text(json.dumps(manifest), encoding="utf-8")
    return study


def nobody_came(study: Path, database_url: str | None = None) -> Path:
    """The study, as if it had been served and nobody had come: its database is there."""
    open_database(database_url or default_url(study)).close()
    return study


def people(url: str) -> None:
    """One who finishes, one who stops after two pictures, one before the first, one sent away, one who withdraws."""
    finished = Participant(url)
    to_trials(finished, age="25-34", job=JOB)
    while finished.state["step"] == "trials":
        finished.rate(2)
    finished.post("comments", comments=COMMENT)
    stopped = Participant(url)
    to_trials(stopped, age="25-34")
    stopped.rate(1)
    stopped.rate(3)
    Participant(url).consent()
    Participant(url).consent().post("about", age="under 18")
    gone = Participant(url)
    to_trials(gone, age="25-34", job="somebody")
    gone.rate(5)
    gone.client.post(f"{gone.here}/withdraw", json={"sure": "yes"})


def to_trials(person: Participant, **about: str) -> None:
    """Up to the first picture that counts."""
    person.consent()
    person.post("about", **about)
    for step in ("screen", "instructions"):
        if person.state["step"] == step:
            person.post(step)
    while person.state["step"] == "practice":
        person.rate(1)
    person.post("ready")
    assert person.state["step"] == "trials"
