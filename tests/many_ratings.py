"""A database with as many sessions as a test wants, written straight into its tables: thousands a second."""

from pathlib import Path

from sqlalchemy import insert

from study_server.manifest import load_study
from study_server.storage import schema
from study_server.storage.adoption import adopt_study
from study_server.storage.database import default_url, open_database

BEGIN = 1_700_000_000.0
AT_ONCE = 200


def fill(study_folder: Path, sessions: int, *, database_url: str | None = None) -> int:
    """`sessions` finished ones, each with a revision; gives the number of ratings stored."""
    study = load_study(study_folder)
    database = open_database(database_url or default_url(study_folder))
    adopt_study(database, study, "test")
    questions = [question.name for question in study.settings.question]
    for first in range(0, sessions, AT_ONCE):
        people = range(first, min(first + AT_ONCE, sessions))
        with database.writing() as connection:
            connection.execute(insert(schema.sessions), [session(study.identity, number) for number in people])
            shown = [
                presentation(number, place, stimulus.id, stimulus.sha256, questions)
                for number in people
                for place, stimulus in enumerate(study.stimuli)
            ]
            connection.execute(insert(schema.presentations), shown)
            given = [answer(row, question) for row in shown for question in questions]
            connection.execute(insert(schema.ratings), given)
            changed = [{**row, "revision": 1, "rating": 7} for row in given if row["place"] == 0]
            connection.execute(insert(schema.revisions), changed)
    database.close()
    return sessions * len(study.stimuli) * len(questions)


def session(study: str, number: int) -> dict[str, object]:
    """One who finished."""
    return {
        "id": f"s{number:07d}", "token": f"t{number}", "study": study, "mode": "live", "row": 0, "step": "done",
        "started_at": BEGIN + number, "seen_at": BEGIN + number + 300, "finished_at": BEGIN + number + 300,
        "completion_code": "C", "language": "en", "screen": {}, "client": {},
        "about": {"age": "25-34", "background": "as a hobby", "vision": "normal"}, "comments": "a comment " * 10,
    }  # fmt: skip


def presentation(number: int, place: int, stimulus: str, sha256: str, questions: list[str]) -> dict[str, object]:
    """One picture, rated."""
    shown_at = BEGIN + number + place
    return {
        "session": f"s{number:07d}", "place": place, "practice": False, "trial": place + 1, "presentation": 1,
        "stimulus": stimulus, "stimulus_sha256": sha256, "questions": questions, "answers_expected": len(questions),
        "answered_at": shown_at + 3, "shown_at": shown_at, "device_pixel_ratio": 1.0, "zoom": 1.0,
        "drawn_width_px": 512.0, "drawn_height_px": 512.0, "window_width_px": 1280.0, "window_height_px": 720.0,
        "focus_lost_ms": 0.0, "gamut": "srgb", "scaled": False,
    }  # fmt: skip


def answer(shown: dict[str, object], question: str) -> dict[str, object]:
    """One rating."""
    return {
        "session": shown["session"], "place": shown["place"], "question": question, "rating": 4, "rt_ms": 1234.5,
        "shown_at": shown["shown_at"], "answered_at": shown["answered_at"], "stored_at": shown["answered_at"],
        "submission": "submission",
    }  # fmt: skip
