"""`[[question]]` and `[survey]` of study.toml: what is asked, of whom, in which order."""

import datetime
from collections.abc import Collection, Iterator, Mapping
from difflib import get_close_matches
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, Field, model_validator

from fakesss.problem import BadInput, Strict, validated
from study_server.exports.cells import FORMULA_STARTS
from study_server.ordering.assignment import Blocks, Order
from study_server.wording import sayings, texts

Text = Annotated[str, Field(min_length=1, max_length=20_000)]


def not_a_formula(name: str) -> str:
    """`name`, or `ValueError` if the export would have to put an apostrophe before it: it is a key of the tables."""
    if name.startswith(FORMULA_STARTS):
        raise ValueError(
            f"a spreadsheet would run a name that begins with {name[0]!r} as a formula; begin with a letter"
        )
    return name


CHECK_NAME = "check"
"""The `question` of an instructed item's row in the ratings."""

TEXT_KEYS = ("consent", "contact", "retention", "instructions", "comments", "thanks")
"""The keys of [survey] that participants read, besides the title."""

Language = Literal["en", "de", "es", "fr"]
Recorded = Literal["address", "browser"]
ScreenPart = Literal["card", "wedge", "plates"]
Code = Annotated[str, Field(max_length=100), AfterValidator(sayings.code)]
Origin = Annotated[str, AfterValidator(sayings.origin)]
Name = Annotated[str, Field(min_length=1, max_length=60), AfterValidator(not_a_formula)]
Choice = Annotated[Text, AfterValidator(sayings.choice)]


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
    low: Text = Field(texts.LOW, description="what 1 means")
    high: Text = Field(texts.HIGH, description="what the highest step means")


class AboutField(Strict):
    """One thing asked about the participant, before the first picture."""

    name: Name = Field(description="column `about_<name>` of participants.csv")
    text: Text = Field(description="the question as shown")
    choices: tuple[Choice, ...] = Field((), description="one is chosen; empty: a line of free text")
    required: bool = Field(False, description="true: the page cannot be left without an answer")
    screen_out: tuple[Choice, ...] = Field(
        (), description="choices after which the participant is thanked and sent away"
    )

    @model_validator(mode="after")
    def known_choices(self) -> Self:
        """Each choice is there once, and only what can be chosen can screen out."""
        twins = sorted({choice for choice in self.choices if self.choices.count(choice) > 1})
        if twins:
            raise ValueError(f'the choice "{twins[0]}" is there twice; leave one out')
        for choice in self.screen_out:
            if choice not in self.choices:
                raise ValueError(f'screen_out "{choice}" is none of the choices; write it as it stands there')
        return self


ABOUT = (
    AboutField(name="age", text=texts.AGE, choices=texts.AGES, required=True),
    AboutField(name="background", text=texts.BACKGROUND, choices=texts.BACKGROUNDS, required=True),
    AboutField(name="vision", text=texts.VISION, choices=texts.VISIONS, required=True),
)


class Prolific(Strict):
    """Completion codes agreed with Prolific, for who came from there. Where one is left empty no link leads back."""

    completed: Code = Field("", description="every rating is stored")
    no_consent: Code = Field("", description="the participant did not agree to take part")
    screened_out: Code = Field("", description="an answer about the participant is among a question's `screen_out`")
    failed_checks: Code = Field("", description="as many instructed items failed as `failed_checks` says")


class Survey(Strict):
    """The `[survey]` table. Every key has a default, so the table may be missing."""

    title: str = Field("", description="what participants see as the study's name; empty: the study's own title")
    language: Language = Field("en", description="the language this file's texts are written in: en, de, es or fr")
    translations: dict[Language, dict[str, Text]] = Field(
        {}, description="per further language: text or key = its translation; the browser's language chooses"
    )
    consent: str = Field("", description="shown first, paragraphs separated by an empty line; empty: our own words")
    contact: str = Field("", description="whom participants can write to; shown under the consent text")
    retention: str = Field("", description="how long answers are kept; shown under the consent text")
    retention_until: datetime.date | None = Field(
        None, description="date until which answers are kept; shown under the consent text, and to you when it is past"
    )
    record: tuple[Recorded, ...] = Field(
        (), description='what is stored about the visitor besides: "address", "browser"; [] nothing'
    )
    about: tuple[AboutField, ...] = Field(ABOUT, description="what is asked about the participant; [] asks nothing")
    screen_check: tuple[ScreenPart, ...] = Field(
        ("card", "wedge"),
        description='"card" (size), "wedge" (brightness), "plates" (colour vision); []: none',
    )
    instructions: Annotated[str, AfterValidator(sayings.instructions)] = Field(
        "", description="shown before practice; {questions}, {scale}, {keys}: filled in; empty: our own words"
    )
    practice: Annotated[int, Field(ge=0, le=20)] = Field(1, description="number of practice trials")
    order: Order = Field("latin-square", description='how the orders are made: "latin-square" or "random"')
    blocks: Blocks = Field(
        "together", description='"together": all questions under one picture; "by-question": a block for each question'
    )
    checks: Annotated[int, Field(ge=0, le=20)] = Field(0, description='number of instructed items ("choose 2 here")')
    failed_checks: Annotated[int, Field(ge=1, le=20)] = Field(
        default_factory=lambda given: 1 if given.get("checks") == 1 else 2,
        description="from so many failed instructed items on the code is the one for failed checks; 2, or 1 of 1",
    )
    scaled_pictures: Literal["flag", "refuse"] = Field(
        "flag", description="a picture that does not fit the window: shown smaller and flagged, or not shown"
    )
    phones: Literal["allow", "refuse"] = Field("allow", description="whether small touch screens may take part")
    unsaved_ahead: Annotated[int, Field(ge=0, le=20)] = Field(
        3, description="how many answers a participant may be ahead of what is saved, while the network is slow"
    )
    comments: str = Field(texts.COMMENTS, description='last question; "": not asked')
    thanks: Text = Field(texts.THANKS, description="shown with the completion code")
    completion_code: Code = Field("", description="the same code for everybody; empty: each gets a random one")
    return_url: Annotated[str, AfterValidator(sayings.return_url)] = Field(
        "", description="where the last page leads, {code} filled in; empty: to Prolific for who came from there"
    )
    frame_ancestors: tuple[Origin, ...] = Field(
        (), description='sites that may show the survey in a frame of theirs, as "https://lab.example"; []: none'
    )
    prolific: Prolific = Field(Prolific(), description="separate completion codes for those who come from Prolific")
    release_after_minutes: Annotated[float, Field(gt=0, le=10_080)] = Field(
        60.0, description="a session silent for so long counts as dropped out, and its order row is given again"
    )

    @model_validator(mode="after")
    def codes_that_can_be_given(self) -> Self:
        """No code for what cannot happen."""
        if self.checks and self.failed_checks > self.checks:
            raise ValueError(f"failed_checks: {self.failed_checks}: must be <= {self.checks}, the number of checks")
        if self.prolific.failed_checks and not self.checks:
            raise ValueError(
                "prolific.failed_checks: nobody can get it without instructed items; set checks, or leave it out"
            )
        if self.prolific.screened_out and not any(field.screen_out for field in self.about):
            raise ValueError(
                "prolific.screened_out: nobody can get it; name choices in a question's screen_out, or leave it out"
            )
        return self

    @model_validator(mode="after")
    def distinct_names(self) -> Self:
        """No two about-fields of one name; no translation into the language that is translated from."""
        refuse_twins("about", [field.name for field in self.about])
        if self.language in self.translations:
            raise ValueError(f'translations.{self.language}: is the language of the texts themselves; see "language"')
        return self


class SurveySettings(Strict):
    """The tables of study.toml that the survey owns, and the study's title, which participants read."""

    title: str = ""
    question: tuple[Question, ...] = Field(min_length=1)
    survey: Survey = Survey()

    @model_validator(mode="after")
    def distinct_names(self) -> Self:
        """No two questions of one name, which is part of a rating's key; none of the instructed items' name."""
        refuse_twins("question", [question.name for question in self.question])
        if self.survey.checks and any(question.name == CHECK_NAME for question in self.question):
            raise ValueError(f'a question is named "{CHECK_NAME}", as instructed items are; give it another name')
        return self

    @model_validator(mode="after")
    def translated(self) -> Self:
        """Every translation holds every text of this file, and no other: better one language than two on a page."""
        needed = {text: key for key, text in self.texts()}
        for language in self.survey.translations:
            known = self.own_words(language)
            for text, key in needed.items():
                if key not in self.named() and self.named().get(text):
                    raise ValueError(
                        f'{key}: "{text}" is a key of translations; write it another way, as with a capital'
                    )
                if text not in known:
                    line = key if key in self.named() else f'"{text[:60]}"'
                    raise ValueError(f'survey.translations.{language}: {key} is missing; add a line {line} = "..."')
            for text, translation in known.items():
                wrong = sayings.other_blanks(text, translation)
                if wrong:
                    raise ValueError(f'survey.translations.{language}: "{text[:60]}": {wrong}')
                if text not in needed and text not in texts.OURS:
                    meant = get_close_matches(text, needed, n=1)
                    mend = f'did you mean "{meant[0][:60]}"?' if meant else "write the text as it stands in this file"
                    raise ValueError(f'survey.translations.{language}: "{text[:60]}" is no text of this file; {mend}')
        return self

    def named(self) -> dict[str, str]:
        """The texts that translations may call by their key; long ones would make unwieldy keys themselves."""
        return {"title": self.survey.title or self.title, **{key: getattr(self.survey, key) for key in TEXT_KEYS}}

    def own_words(self, language: str) -> dict[str, str]:
        """This file's translations into `language`: text -> its translation."""
        named = self.named()
        written: dict[str, str] = self.survey.translations.get(language, {})  # type: ignore[call-overload]
        return {named.get(key) or key: text for key, text in written.items()}

    def checked_like(self, asked: Collection[str], expected: int) -> Question:
        """The question whose scale an instructed item has: the last one of those `asked` with it.

        Release 1 drew the answer asked for from the first question's scale, and its order rows stay as they are: where
        the last one's has no such step, the item has the first one's.
        """
        last = [question for question in self.question if question.name in asked][-1]
        return last if expected <= last.scale else self.question[0]

    def texts(self) -> Iterator[tuple[str, str]]:
        """(key, text) of everything a participant reads that stands in this file and is none of our own words."""
        found = list(self.named().items())
        for asked in self.question:
            found += [(f"question.{asked.name}", text) for text in (asked.text, asked.low, asked.high)]
        for field in self.survey.about:
            found += [(f"about.{field.name}", text) for text in (field.text, *field.choices)]
        yield from ((key, text) for key, text in found if is_words(text) and text not in texts.OURS)


def is_words(text: str) -> bool:
    """Whether there is anything to translate: in "18-24" there is not."""
    return any(map(str.isalpha, text))


def refuse_nul(value: object, where: str) -> None:
    """`BadInput` naming the place of a text with NUL in it: PostgreSQL cannot hold one."""
    if isinstance(value, str) and "\0" in value:
        raise BadInput(f"{where}: holds the character NUL (\\u0000), which is no text; leave it out")
    if isinstance(value, Mapping):
        for key, part in value.items():
            refuse_nul(key, where)
            refuse_nul(part, f"{where}.{key}")
    elif isinstance(value, list):
        for number, part in enumerate(value, 1):
            refuse_nul(part, f"{where}[{number}]")


def check_survey(study_table: Mapping[str, Any], source: str) -> SurveySettings:
    """The survey's part of a whole study.toml; other tables are left to their owners.

    Raises `BadInput` naming `source`, the key and the nearest valid name.
    """
    owned = {key: study_table[key] for key in ("title", "question", "survey") if key in study_table}
    for key, value in owned.items():
        refuse_nul(value, f"{source}: {key}")
    return validated(SurveySettings, owned, source)
