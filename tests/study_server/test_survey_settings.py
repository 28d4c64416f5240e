"""What study.toml may say about the survey, and the sentence when it says something else."""

from pathlib import Path

import pytest
from study_fixture import write_study

from fakesss.problem import BadInput
from study_server.manifest import load_study
from study_server.pages import instructions
from study_server.settings import check_survey
from study_server.wording.language import words as words_of

QUESTION = {"name": "translucent", "text": "The object looks translucent."}


def test_the_survey_table_may_be_missing() -> None:
    settings = check_survey({"title": "T", "design": {}, "question": [QUESTION]}, "study.toml")
    assert (settings.question[0].scale, settings.question[0].low) == (7, "completely disagree")
    assert [field.name for field in settings.survey.about] == ["age", "background", "vision"]
    assert settings.survey.order == "latin-square"


@pytest.mark.parametrize(
    ("tables", "sentence"),
    [
        ({"survey": {"consnt": "x"}}, 'study.toml: survey.consnt: unknown key; did you mean "consent"?'),
        ({"question": [{**QUESTION, "scael": 5}]}, 'study.toml: question[1].scael: unknown key; did you mean "scale"?'),
        ({"question": [{**QUESTION, "scale": 12}]}, "study.toml: question[1].scale: 12: must be <= 11"),
        ({"question": [QUESTION, QUESTION]}, 'two question entries are named "translucent"'),
        ({"question": [{"name": "a"}]}, "study.toml: question[1].text: is missing; add it"),
        ({"survey": {"order": "latin"}}, "study.toml: survey.order: 'latin': must be"),
        ({"survey": {"about": [{"name": "a", "text": "?", "choces": []}]}}, "survey.about[1].choces: unknown key; did"),
        ({"question": [{**QUESTION, "name": "-x"}]}, "study.toml: question[1].name: '-x': a spreadsheet would run"),
        ({"title": "a\0b"}, r"study.toml: title: holds the character NUL (\u0000), which is no text; leave it out"),
        ({"question": [{**QUESTION, "text": "\0"}]}, "study.toml: question[1].text: holds the character NUL"),
        ({"survey": {"translations": {"de": {"\0": "x"}}}}, "study.toml: survey.translations.de: holds the character"),
        ({"question": [{**QUESTION, "name": "\nx"}]}, "a spreadsheet would run a name that begins with '\\n'"),
        ({"survey": {"about": [{"name": "=age", "text": "?"}]}}, "begins with '=' as a formula; begin with a letter"),
        ({"survey": {"release_after_minutes": float("nan")}}, "survey.release_after_minutes"),
    ],
)
def test_errors_name_the_key_and_the_mend(tables: dict[str, object], sentence: str) -> None:
    with pytest.raises(BadInput) as problem:
        check_survey({"question": [QUESTION], **tables}, "study.toml")
    assert sentence in str(problem.value)
    assert "\n" not in str(problem.value)


@pytest.mark.parametrize(
    ("scales", "words"),
    [
        ([2], "1 to 2"),
        ([7, 7], "1 to 7"),
        ([9], "1 to 9"),
        ([10], "1 to 9, and 0 for 10"),
        ([11], "1 to 9, and 0 for 10 (11 has no key)"),
        ([5, 7], "1 to 7, as far as each question's scale goes"),
    ],
)
def test_the_keys_in_the_instructions_exist(tmp_path: Path, scales: list[int], words: str) -> None:
    questions = [{**QUESTION, "name": f"q{number}", "scale": scale} for number, scale in enumerate(scales)]
    study = load_study(write_study(tmp_path, question=questions))
    text = " ".join(instructions(study, words_of(study.settings, "en")))
    assert f"or with the keys {words}. When" in text
    assert "{" not in text


def test_a_study_without_questions_is_refused() -> None:
    with pytest.raises(BadInput, match=r"study\.toml: question: is missing"):
        check_survey({}, "study.toml")
