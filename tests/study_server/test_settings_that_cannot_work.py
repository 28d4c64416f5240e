"""Settings under which somebody could not go on, or would get what was not meant: refused, with the mend."""

from pathlib import Path
from typing import Any

import pytest
from study_fixture import write_study
from survey_client import Participant

from fakesss.problem import BadInput
from study_server.announcement import announcement
from study_server.answers import scales_of
from study_server.app import create_app
from study_server.manifest import load_study
from study_server.serve import served
from study_server.settings import check_survey
from study_server.storage.adoption import design_of
from study_server.wording.texts import CHECK

SCALES = [{"name": "a", "text": "A?", "scale": 7}, {"name": "b", "text": "B?", "scale": 3}]


def hand(*choices: str, **more: object) -> dict[str, object]:
    return {"about": [{"name": "hand", "text": "Hand?", "choices": list(choices), **more}]}


def german(*about: str, **lines: str) -> dict[str, object]:
    """Translated, all but what `lines` say otherwise."""
    told = {"title": "Scheiben", "The object looks red.": "Der Gegenstand wirkt rot."}
    return {**hand(*about), "translations": {"de": {**told, "Hand?": "Hand?", **lines}}}


@pytest.mark.parametrize(
    ("survey", "sentence"),
    [
        (hand("left", "right\nor both"), "a choice is one line with something to read on it"),
        (hand("left", " "), "a choice is one line with something to read on it"),
        (hand("left", "left "), 'the choice "left" is there twice; leave one out'),
        ({"checks": 1, "failed_checks": 2}, "failed_checks: 2: must be <= 1, the number of checks"),
        ({"prolific": {"failed_checks": "C4"}}, "nobody can get it without instructed items; set checks"),
        ({"prolific": {"screened_out": "C3"}}, "nobody can get it; name choices in a question's screen_out"),
        ({"completion_code": "https://app.prolific.com/submissions/complete?cc=C1"}, "write only the code"),
        ({"completion_code": " "}, "write the code alone"),
        ({"return_url": "https://x.org/?c={CODE}"}, "{CODE} is not filled in; choose among {code}"),
        ({"return_url": "www.x.org"}, "is no address; write it whole, as https://lab.example/thanks"),
        ({"frame_ancestors": ["https://x.org/page"]}, "write scheme and host alone, as https://lab.example"),
        ({"instructions": "Answer {question}."}, "choose among {questions}, {scale}, {keys}"),
        (german(**{CHECK: "Bitte {Antwort}."}), "must be those of the text, {answer}, not {Antwort}"),
        (german(**{CHECK: "Bitte."}), "must be those of the text, {answer}, not none"),
        (german("comments", comments="Sonst noch etwas?"), '"comments" is a key of translations; write it another way'),
    ],
)
def test_they_are_refused(survey: dict[str, object], sentence: str) -> None:
    study = {"title": "Discs", "question": [{"name": "red", "text": "The object looks red."}], "survey": survey}
    with pytest.raises(BadInput) as problem:
        check_survey(study, "study.toml")
    assert sentence in str(problem.value)
    assert "\n" not in str(problem.value)


def test_a_choice_with_blanks_around_it_can_be_chosen(tmp_path: Path) -> None:
    study = write_study(tmp_path, survey={**hand("left ", "right", required=True, screen_out=["right "])})
    with served(study) as url:
        person = Participant(url).consent()
        assert person.state["fields"][0]["choices"] == ["left", "right"]
        assert person.post("about", hand="left ")["step"] == "screen"


@pytest.mark.parametrize(("checks", "enough"), [(0, 2), (1, 1), (2, 2), (4, 2)])
def test_failed_checks_are_never_more_than_there_are(checks: int, enough: int) -> None:
    study: dict[str, Any] = {"question": SCALES, "survey": {"checks": checks}}
    assert check_survey(study, "study.toml").survey.failed_checks == enough


@pytest.mark.parametrize("blocks", ["together", "by-question"])
def test_an_instructed_item_has_the_scale_of_the_question_before_it(tmp_path: Path, blocks: str) -> None:
    study = load_study(write_study(tmp_path, 6, question=SCALES, survey={"checks": 3, "blocks": blocks}))
    steps = {"a": 7, "b": 3}
    checked = [trial for row in design_of(study).rows() for trial in row if trial.check is not None]
    for trial in checked:
        planned: Any = {"questions": trial.questions, "check_expected": trial.check}
        assert scales_of(study, planned)["check"] == steps[trial.questions[-1]]
        assert trial.check is not None and trial.check <= steps[trial.questions[-1]]
    assert {trial.questions[-1] for trial in checked} == ({"b"} if blocks == "together" else {"a", "b"})


def test_an_order_row_that_release_1_drew_can_still_be_passed(tmp_path: Path) -> None:
    study = load_study(write_study(tmp_path, question=SCALES, survey={"checks": 1, "blocks": "by-question"}))
    drawn: Any = {"questions": ["b"], "check_expected": 6}
    assert scales_of(study, drawn) == {"b": 3, "check": 7}


@pytest.mark.parametrize(("day", "is_past"), [("2020-02-29", True), ("2999-01-01", False)])
def test_a_date_of_deletion_that_is_past_is_said_at_the_start(tmp_path: Path, day: str, is_past: bool) -> None:
    site = create_app(write_study(tmp_path, survey={"retention_until": day})).state.site
    said = announcement(site, "http://127.0.0.1:1", "127.0.0.1", (), 1)
    assert (f"Warning: retention_until = {day} is past" in said) is is_past
