"""Every column of every exported table: what it holds, its type, unit, allowed values, and what an empty cell means."""

from dataclasses import dataclass, replace
from typing import Literal

Kind = Literal["text", "integer", "number", "time", "json"]


@dataclass(frozen=True)
class Column:
    """One column as the codebook has it. `time`: ISO 8601 UTC with milliseconds, 2026-11-22T14:50:38.000Z."""

    description: str
    type: Kind = "text"
    unit: str = ""
    minimum: float | None = None
    maximum: float | None = None
    values: tuple[str, ...] = ()
    """All values there are; (): not a list."""
    missing: str = ""
    """What an empty cell means; "": there is none."""

    def but(self, description: str, missing: str | None = None) -> "Column":
        """The same with other words."""
        return replace(self, description=description, missing=self.missing if missing is None else missing)


def flag(description: str, missing: str = "") -> Column:
    """A column of ones and zeros."""
    return Column(description, "integer", values=("0", "1"), missing=missing)


UNANSWERED = "not answered"
FORGOTTEN = "or deleted by `fakesss forget`"
SHOWN = "of the first showing, also where a revision counts"
MODES = ("live", "pilot", "simulated")

SHARED = {
    "session": Column("public name of the session; one person's visit"),
    "participant": Column("pseudonym of the person: the same for all sessions of one recruiting-service participant"),
    "mode": Column("live, pilot, or simulated (answered by `fakesss simulate`)", values=MODES),
    "started_at": Column("when the participant agreed to take part", "time"),
    "study_sha256": Column("SHA-256 of study.toml"),
    "trial": Column("1, 2, ...: place of the picture in this session's order", "integer", minimum=1),
    "stimulus": Column("id of the picture in stimuli.csv"),
}

SCREEN = {
    "device_pixel_ratio": Column("device pixels per CSS pixel, zoom included", "number", minimum=0),
    "zoom": Column("estimated page zoom, 1 = 100%", "number", minimum=0),
    "drawn_width_px": Column(
        "width of the picture on screen; equals the file's width if it was not scaled", "number", "device pixel", 0
    ),
    "window_width_px": Column("width of the browser's viewport", "number", "CSS pixel", 0),
    "window_height_px": Column("height of the browser's viewport", "number", "CSS pixel", 0),
    "focus_lost_ms": Column(
        "time of the trial during which the page was hidden, not in front or gone, or the picture covered",
        "number",
        "ms",
        0,
    ),
}
"""How a picture stood on the screen."""

RATINGS = {
    "session": SHARED["session"],
    "participant": SHARED["participant"],
    "mode": SHARED["mode"],
    "started_at": SHARED["started_at"],
    "trial": SHARED["trial"],
    "presentation": Column(
        "1, 2, ...: which showing of this picture to this person (2: shown again for test-retest)", "integer", minimum=1
    ),
    "stimulus": SHARED["stimulus"],
    "question": Column('name of the question in study.toml; "check": an instructed item ("choose 2 here")'),
    "rating": Column(
        "the step chosen: 1 .. number of steps of the question",
        "integer",
        minimum=1,
        missing="not answered; if shown_at is empty too, no answer under this picture ever reached the server, and "
        "step and trials_answered in participants.csv tell whether the picture was due when the person left",
    ),
    "rt_ms": Column(
        "from the first frame with the picture to the (last) choice of this answer", "number", "ms", 0,
        missing=UNANSWERED,
    ),
    "shown_at": Column(
        "when the picture came on screen, by the server's clock; of the answer in this row", "time", missing=UNANSWERED
    ),
    "answered_at": Column("when the answer was chosen, by the server's clock", "time", missing=UNANSWERED),
    "revision": Column(
        "0: the first answer; n: the n-th different answer sent afterwards, which counts (earlier: events.csv)",
        "integer", minimum=0, missing=UNANSWERED,
    ),
    "repeat_of": Column("id of the stimulus that this one shows again", missing="no repeat"),
    "check_expected": Column(
        "the answer that an instructed item asks for; its row is no rating of the picture", "integer", minimum=1,
        missing="an ordinary question",
    ),
    "check_passed": flag(
        "1: the instructed answer was given; 0: another one", "an ordinary question, or a check not answered"
    ),
    **{name: column.but(f"{column.description}; {SHOWN}", UNANSWERED) for name, column in SCREEN.items()},
    "study_sha256": SHARED["study_sha256"],
    "stimulus_sha256": Column("SHA-256 of the picture's file, checked in the browser before it was shown"),
}  # fmt: skip

PARTICIPANTS = {
    "session": SHARED["session"],
    "participant": SHARED["participant"],
    "mode": SHARED["mode"],
    "status": Column(
        "finished (every rating stored), active, dropped (silent for longer than the study allows), screened-out "
        "(an answer about the person ended it), or withdrawn",
        values=("finished", "active", "dropped", "screened-out", "withdrawn"),
    ),
    "step": Column(
        "the page where the participant is or left; at trials the picture of trial trials_answered + 1 was due, later "
        "ones were never due",
        values=("about", "screen", "instructions", "practice", "ready", "trials", "comments", "done", "screened_out",
                "withdrawn"),
    ),
    "started_at": SHARED["started_at"],
    "finished_at": Column("when the last expected rating was stored", "time", missing="not finished, or withdrawn"),
    "last_seen_at": Column("when the participant last sent something", "time"),
    "order_row": Column("1, 2, ...: row of the order design", "integer", minimum=1),
    "trials": Column("number of trials to be rated", "integer", minimum=1),
    "trials_answered": Column("number of trials rated", "integer", minimum=0),
    "ratings": Column("number of ratings stored, instructed items among them", "integer", minimum=0),
    "checks_failed": Column(
        "number of instructed items answered otherwise than asked, as answers now stand", "integer", minimum=0
    ),
    "language": Column("language of the pages", values=("en", "de", "es", "fr")),
    "comments": Column(
        "what the participant wrote at the end", missing=f"nothing written, not asked, withdrawn, {FORGOTTEN}"
    ),
    "study_sha256": SHARED["study_sha256"],
}  # fmt: skip

CLIENT = {
    "address": Column(
        "network address of the visitor; only if the study asks for it",
        missing=f"withdrawn, {FORGOTTEN}",
    ),
    "browser": Column(
        "how the browser names itself; only if the study asks for it",
        missing=f"not told, withdrawn, {FORGOTTEN}",
    ),
}

NOT_TOLD = "the browser did not tell"
DISPLAYS = {
    "session": SHARED["session"],
    "mode": SHARED["mode"],
    "trial": SHARED["trial"],
    "stimulus": SHARED["stimulus"],
    "shown_at": Column("when the picture first came on screen, by the server's clock", "time"),
    "device_pixel_ratio": SCREEN["device_pixel_ratio"],
    "zoom": SCREEN["zoom"],
    "drawn_width_px": SCREEN["drawn_width_px"],
    "drawn_height_px": Column("height of the picture on screen", "number", "device pixel", 0, missing=NOT_TOLD),
    "scaled": flag("1: the picture was drawn in another size than its file's; 0: pixel by pixel", NOT_TOLD),
    "gamut": Column(
        "the widest gamut that the browser says the screen covers", values=("srgb", "p3", "rec2020"), missing=NOT_TOLD
    ),
    "window_width_px": SCREEN["window_width_px"],
    "window_height_px": SCREEN["window_height_px"],
    "focus_lost_ms": SCREEN["focus_lost_ms"],
}

EVENTS = {
    "session": SHARED["session"],
    "mode": SHARED["mode"],
    "at": Column("when it happened, by the server's clock", "time"),
    "kind": Column(
        "what happened: the session started or finished, an answer was changed (revised) or not stored (refused); "
        "practice left out",
        values=("started", "finished", "revised", "refused"),
    ),
    "detail": Column("what exactly", "json"),
}

STIMULI = {
    "stimulus": Column("id of the picture"),
    "file": Column("name of the file in the folder stimuli"),
    "sha256": Column("SHA-256 of the file"),
    "width": Column("width of the picture", "integer", "pixel", 1),
    "height": Column("height of the picture", "integer", "pixel", 1),
    "role": Column("what the picture is in the design", values=("factor", "compare", "control", "repeat")),
    "label": Column("the picture in words", missing="none given"),
    "rows": Column("the factors whose comparison this picture belongs to, separated by |", missing="none"),
    "same_picture_as": Column("id of the earlier stimulus with the same picture", missing="none"),
}

CODEBOOK = {
    "table": Column("file of the export"),
    "column": Column("name of the column"),
    "description": Column("what it holds"),
    "type": Column("text, integer, number, time (ISO 8601 UTC) or json", values=("text", "integer", "number", "time",
                   "json")),
    "unit": Column("unit of a number", missing="none"),
    "minimum": Column("the least there can be", "number", missing="no limit, or no number"),
    "maximum": Column("the most there can be", "number", missing="no limit, or no number"),
    "values": Column("all values there are, separated by |", missing="not a list"),
    "missing": Column("what an empty cell means", missing="there is none"),
}  # fmt: skip
