"""`[[question]]` and `[survey]` of study.toml: what is asked, of whom, in which order."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, Field, model_validator

from fakesss.problem import Strict, validated
from study_server.cells import FORMULA_STARTS

Text = Annotated[str, Field(min_length=1, max_length=20_000)]


def not_a_formula(name: str) -> str:
    """`name`, or `ValueError` if the export would have to put an apostrophe before it: it is a key of the tables."""
    if name.startswith(FORMULA_STARTS):
        raise ValueError(
            f"a spreadsheet would run a name that begins with {name[0]!r} as a formula; begin with a letter"
        )
    return name


Name = Annotated[str, Field(min_length=1, max_length=60), AfterValidator(not_a_formula)]

CONSENT = """In this study you will look at pictures of objects made by a computer and say how they look to you. \
There are no right or wrong answers.

Taking part is voluntary. You may stop at any time by closing this page, without giving a reason.

We store your answers and the time they took, the size of your window and how large each picture was drawn. We store \
neither your name nor your network address nor which browser you use."""

INSTRUCTIONS = """You will see one picture at a time, with {questions} under it. Look at the picture as long as you \
like, then say how much you agree.

Please sit as you usually do in front of your screen, and leave the page at its normal size (100% zoom).

You can answer with the mouse, by touch, or with the keys {keys}. When everything is answered, press Next or the \
Enter key. Answers are saved as you go: after an interruption, open this page again and you continue where you were."""


def refuse_twins(key: str, names: list[str]) -> None:
    """`ValueError` if a name occurs twice."""
    twins = sorted({name for name in names if names.count(name) > 1})
    if twins:
        raise ValueError(f'two {key} entries are named "{twins[0]}"; give each a name of its own')


class Question(Strict):
    """One rating scale under every picture: equal steps from `low` (1) to `high` (`scale`)."""

    name: Name = Field(description="short name, the `question` column of the ratings")
    text: Text = Field(description="the statement the participant judges")
    scale: Annotated[int, Field(ge=2, le=11)] = Field(7, description="number of steps, 2..11")
    low: Text = Field("completely disagree", description="what 1 means")
    high: Text = Field("completely agree", description="what the highest step means")


class AboutField(Strict):
    """One thing asked about the participant, before the first picture."""

    name: Name = Field(description="column `about_<name>` of participants.csv")
    text: Text = Field(description="the question as shown")
    choices: tuple[Text, ...] = Field((), description="one is chosen; empty: a line of free text")
    required: bool = Field(False, description="true: the page cannot be left without an answer")


ABOUT = (
    AboutField(
        name="age",
        text="How old are you?",
        choices=("under 18", "18-24", "25-34", "35-44", "45-54", "55-64", "65 or older", "rather not say"),
        required=True,
    ),
    AboutField(
        name="background",
        text="How much do you work with pictures (art, photography, design, computer graphics)?",
        choices=("not at all", "as a hobby", "as a student", "as a professional"),
        required=True,
    ),
    AboutField(
        name="vision",
        text="How is your eyesight at the screen, with glasses or lenses if you wear them?",
        choices=("normal", "blurred or otherwise impaired", "colour vision deficiency", "rather not say"),
        required=True,
    ),
)


class Survey(Strict):
    """The `[survey]` table. Every key has a default, so the table may be missing."""

    title: str = Field("", description="what participants see as the study's name; empty: the study's own title")
    consent: Text = Field(CONSENT, description="shown first; paragraphs are separated by an empty line")
    contact: str = Field("", description="whom participants can write to; shown under the consent text")
    retention: str = Field("", description="how long answers are kept; shown under the consent text")
    about: tuple[AboutField, ...] = Field(ABOUT, description="what is asked about the participant; [] asks nothing")
    instructions: Text = Field(
        INSTRUCTIONS, description="shown before practice; {questions}, {scale}, {keys}: filled in"
    )
    practice: Annotated[int, Field(ge=0, le=20)] = Field(1, description="number of practice trials")
    order: Literal["latin-square", "random"] = Field("latin-square", description="how the orders are made")
    comments: str = Field("Is there anything you would like to tell us?", description='last question; "": not asked')
    thanks: Text = Field("Thank you! All your answers are saved.", description="shown with the completion code")
    completion_code: str = Field("", description="the same code for everybody; empty: each gets a random one")
    release_after_minutes: Annotated[float, Field(gt=0, le=10_080)] = Field(
        60.0, description="a session silent for so long counts as dropped out, and its order row is given again"
    )

    @model_validator(mode="after")
    def distinct_names(self) -> Self:
        """No two about-fields of one name."""
        refuse_twins("about", [field.name for field in self.about])
        return self


class SurveySettings(Strict):
    """The tables of study.toml that the survey owns."""

    question: tuple[Question, ...] = Field(min_length=1)
    survey: Survey = Survey()

    @model_validator(mode="after")
    def distinct_names(self) -> Self:
        """No two questions of one name: it is part of a rating's key."""
        refuse_twins("question", [question.name for question in self.question])
        return self


def check_survey(study_table: Mapping[str, Any], source: str) -> SurveySettings:
    """The survey's part of a whole study.toml; other tables are left to their owners.

    Raises `BadInput` naming `source`, the key and the nearest valid name.
    """
    owned = {key: study_table[key] for key in ("question", "survey") if key in study_table}
    return validated(SurveySettings, owned, source)
