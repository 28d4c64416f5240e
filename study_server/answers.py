"""What the browser sends for one picture, and how it gets to disk: once, whatever happens on the way."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal

from pydantic import Field
from sqlalchemy import Connection, RowMapping, bindparam, insert, select, update

from fakesss.problem import Strict
from study_server.manifest import BuiltStudy
from study_server.sessions import Session, record
from study_server.settings import CHECK_NAME
from study_server.storage import schema
from study_server.wording.texts import N_

DAY_MS = 86_400_000.0
Milliseconds = Annotated[float, Field(ge=0, le=30 * DAY_MS)]
Pixels = Annotated[float, Field(ge=0, le=1e6)]
Sha256 = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]

presentations = schema.presentations.c

FIRST_ANSWERS = insert(schema.ratings)
SHOWN = update(schema.presentations).where(
    presentations.session == bindparam("of"), presentations.place == bindparam("at")
)


class Display(Strict):
    """How the picture stood on the screen."""

    device_pixel_ratio: Annotated[float, Field(gt=0, le=100)] = Field(description="device pixels per CSS pixel")
    zoom: Annotated[float, Field(gt=0, le=100)] = Field(description="estimated page zoom, 1 = 100%")
    drawn_width_px: Pixels = Field(description="the picture's width in device pixels")
    drawn_height_px: Pixels | None = Field(None, description="the picture's height in device pixels")
    window_width_px: Pixels = Field(description="CSS pixels")
    window_height_px: Pixels = Field(description="CSS pixels")
    focus_lost_ms: Milliseconds = Field(description="how long the page was hidden or not in front")
    gamut: Literal["srgb", "p3", "rec2020", ""] = Field("", description="the widest the screen covers; empty: not told")
    scaled: bool | None = Field(None, description="whether the picture was drawn in another size than its file's")


class Answer(Strict):
    """One question's answer."""

    question: Annotated[str, Field(max_length=60)]
    rating: Annotated[int, Field(strict=True)]
    rt_ms: Milliseconds = Field(description="from the picture's first frame to the last choice")


class Posted(Strict):
    """One picture's answers. Times are differences, because a participant's clock may be hours off."""

    place: Annotated[int, Field(ge=0, le=100_000)]
    submission: Annotated[str, Field(pattern="^[!-~]{8,64}$")] = Field(description="the same on every retry")
    stimulus_sha256: Sha256 = Field(description="computed in the browser from the bytes it drew")
    since_shown_ms: Milliseconds = Field(description="from the picture's first frame to this attempt to send")
    answers: Annotated[tuple[Answer, ...], Field(max_length=100)]
    display: Display


class Refused(Exception):
    """Answers that cannot be stored: HTTP status and one sentence for the participant, with what fills its {blanks}."""

    def __init__(self, http_status: int, sentence: str, **blanks: object) -> None:
        super().__init__(sentence.format(**blanks))
        self.http_status = http_status
        self.sentence = sentence
        self.blanks = blanks


def accepted(study: BuiltStudy, session: Session, near: Sequence[RowMapping], sent: Posted) -> RowMapping:
    """The presentation that `sent` answers, one of those `near` it: the one that is due, or one answered before.

    Raises `Refused` unless it was assigned, the picture drawn is the one assigned, and every question has an answer.
    """
    before, planned = at(near, sent.place - 1), at(near, sent.place)
    if session["step"] == "withdrawn":
        raise Refused(410, N_("You have withdrawn from this study; nothing is stored any more."))
    if planned is None:
        raise Refused(404, N_("There is no such picture in this session."))
    if planned["answered_at"] is None and not is_due(session, before, planned):
        raise Refused(409, N_("Another picture comes first."))
    if planned["stimulus_sha256"] != sent.stimulus_sha256:
        raise Refused(
            409, N_("The picture that was shown is not the one that belongs here; the answer was not stored.")
        )
    scales = scales_of(study, planned)
    if sorted(answer.question for answer in sent.answers) != sorted(scales):
        raise Refused(422, N_("Every question needs exactly one answer."))
    for answer in sent.answers:
        if not 1 <= answer.rating <= scales[answer.question]:
            raise Refused(422, N_("An answer must be between 1 and {scale}."), scale=scales[answer.question])
    return planned


def scales_of(study: BuiltStudy, planned: RowMapping) -> dict[str, int]:
    """What is asked under this picture, instructed item included, with its number of steps."""
    scales = {question.name: question.scale for question in study.settings.question}
    asked = {name: scales[name] for name in planned["questions"]}
    expected = planned["check_expected"]
    return asked if expected is None else asked | {CHECK_NAME: study.settings.checked_like(asked, expected).scale}


def at(near: Sequence[RowMapping], place: int) -> RowMapping | None:
    """The presentation at `place`, if there is one."""
    return next((row for row in near if row["place"] == place), None)


def is_due(session: Session, before: RowMapping | None, planned: RowMapping) -> bool:
    """Whether this presentation, not answered yet, is the one the participant is at.

    It is if the one `before` it is answered: nothing is ever answered out of turn.
    """
    step = "practice" if planned["practice"] else "trials"
    return session["step"] == step and (before is None or before["answered_at"] is not None)


def store(connection: Connection, planned: RowMapping, sent: Posted, now: float) -> list[dict[str, Any]]:
    """Bring the answers to disk and return them as they now stand, one for each question.

    The first answer to a question is a row of `ratings`; all those of a picture come together, and `answered_at` with
    them. The same one again changes nothing; another one is added to `revisions`. A retry is known by its `submission`,
    so a late one cannot undo a revision.
    """
    longest_ms = max((answer.rt_ms for answer in sent.answers), default=0.0)
    shown_at = now - max(sent.since_shown_ms, longest_ms) / 1000  # no answer was given after it was stored
    here = {"session": planned["session"], "place": planned["place"]}
    rows = [
        {
            **here,
            "question": answer.question,
            "rating": answer.rating,
            "rt_ms": answer.rt_ms,
            "shown_at": shown_at,
            "answered_at": shown_at + answer.rt_ms / 1000,
            "stored_at": now,
            "submission": sent.submission,
        }
        for answer in sent.answers
    ]
    if planned["answered_at"] is not None:
        return [revise(connection, planned, row) for row in rows]
    connection.execute(FIRST_ANSWERS, rows)
    facts = {"answered_at": now, "shown_at": shown_at, **sent.display.model_dump()}
    connection.execute(SHOWN, {"of": planned["session"], "at": planned["place"], **facts})
    return [{"question": row["question"], "rating": row["rating"], "revision": 0} for row in rows]


def revise(connection: Connection, planned: RowMapping, row: dict[str, Any]) -> dict[str, Any]:
    """An answer to a question that has one already; how it stands then."""
    history = history_of(connection, {name: row[name] for name in ("session", "place", "question")})
    stands, revision = history[-1]["rating"], len(history) - 1
    if row["submission"] not in {old["submission"] for old in history} and stands != row["rating"]:
        revision += 1
        connection.execute(insert(schema.revisions).values(row | {"revision": revision}))
        detail = {"trial": planned["trial"], "practice": planned["practice"], "question": row["question"]}
        change = {"from": stands, "to": row["rating"], "revision": revision}
        record(connection, row["session"], row["stored_at"], "revised", detail | change)
        stands = row["rating"]
    return {"question": row["question"], "rating": stands, "revision": revision}


def history_of(connection: Connection, key: Mapping[str, Any]) -> list[RowMapping]:
    """The first answer and its revisions, oldest first."""
    first = select(schema.ratings).filter_by(**key)
    later = select(schema.revisions).filter_by(**key).order_by(schema.revisions.c.revision)
    return [*connection.execute(first).mappings(), *connection.execute(later).mappings()]
