"""The tables. What a participant did is only ever added; a withdrawal alone deletes, and leaves its row here.

Times are Unix seconds of the server's clock (float), so that both SQLite and PostgreSQL compare them as numbers;
the export writes ISO 8601 UTC.
"""

from sqlalchemy import (
    JSON,
    Boolean,
    Column,
    Double,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    Integer,
    MetaData,
    String,
    Table,
    Text,
    UniqueConstraint,
)

VERSION = "2"

tables = MetaData()

meta = Table(
    "meta",
    tables,
    Column("key", String, primary_key=True, comment="schema_version, admin_secret, signing_key, salt, health"),
    Column("value", String, nullable=False),
)

studies = Table(
    "studies",
    tables,
    Column("identity", String, primary_key=True, comment="SHA-256 over study.toml's hash and every picture's"),
    Column("sha256", String, nullable=False, comment="SHA-256 of study.toml"),
    Column("title", String, nullable=False),
    Column("settings", JSON, nullable=False, comment="questions and [survey] as they were"),
    Column("opened_at", Double, nullable=False, comment="the latest one is the study as it is now"),
)

order_rows = Table(
    "order_rows",
    tables,
    Column("study", ForeignKey("studies.identity"), primary_key=True),
    Column("row", Integer, primary_key=True),
    Column("trials", JSON, nullable=False, comment="assignment.Trial as dicts, in order of showing"),
)

gates = Table(
    "gates",
    tables,
    Column("id", Integer, primary_key=True, autoincrement=True),
    Column("study", ForeignKey("studies.identity"), nullable=False, index=True),
    Column("mode", String, nullable=False),
    Column("at", Double, nullable=False),
    Column("state", String, nullable=False, comment="open, paused or closed; the latest one counts, none is open"),
)

sessions = Table(
    "sessions",
    tables,
    Column("id", String, primary_key=True, comment="public: stands in the export; opens nothing"),
    Column("token", String, nullable=False, unique=True, comment="secret: the participant's address"),
    Column("study", String, nullable=False),
    Column("mode", String, nullable=False, comment="live, pilot or simulated"),
    Column("row", Integer, nullable=False, comment="order row reserved at start"),
    Column(
        "step",
        String,
        nullable=False,
        comment="about, screen, instructions, practice, ready, trials, comments, done, screened_out or withdrawn",
    ),
    Column("started_at", Double, nullable=False),
    Column("seen_at", Double, nullable=False, comment="last thing the participant sent"),
    Column("finished_at", Double, comment="when the last expected rating was stored"),
    Column("completion_code", String, comment="made with the last expected rating, never before"),
    Column("external_study", String),
    Column("external_participant", String),
    Column("external_session", String),
    Column("language", String, nullable=False, comment="en, de, es or fr"),
    Column("about", JSON, nullable=False, comment="answers about the participant"),
    Column("screen", JSON, nullable=False, comment="what the screen check found"),
    Column("client", JSON, nullable=False, comment="network address and browser, only if the study asks for them"),
    Column("comments", Text),
    ForeignKeyConstraint(["study", "row"], ["order_rows.study", "order_rows.row"]),
    UniqueConstraint("study", "mode", "external_study", "external_participant"),
    Index("sessions_by_row", "study", "mode", "row"),
)

presentations = Table(
    "presentations",
    tables,
    Column("session", ForeignKey("sessions.id"), primary_key=True),
    Column("place", Integer, primary_key=True, comment="0, 1, ... through practice, then trials"),
    Column("practice", Boolean, nullable=False),
    Column("trial", Integer, nullable=False, comment="1, 2, ... within practice or within the trials"),
    Column("presentation", Integer, nullable=False, comment="1, 2, ...: which showing of this picture's stimulus"),
    Column("stimulus", String, nullable=False),
    Column("stimulus_sha256", String, nullable=False, comment="the picture assigned; a rating must report the same"),
    Column("repeat_of", String),
    Column("questions", JSON, nullable=False, comment="names of the questions asked under this picture"),
    Column("check_expected", Integer, comment="the answer an instructed item asks for; NULL: there is none"),
    Column("answers_expected", Integer, nullable=False, comment="how many ratings belong to this presentation"),
    Column("answered_at", Double, comment="when all its ratings were stored"),
    Column("shown_at", Double),
    Column("device_pixel_ratio", Double),
    Column("zoom", Double),
    Column("drawn_width_px", Double),
    Column("drawn_height_px", Double),
    Column("window_width_px", Double),
    Column("window_height_px", Double),
    Column("focus_lost_ms", Double),
    Column("gamut", String),
    Column("scaled", Boolean, comment="whether the picture was drawn in another size than its file's"),
)


def rating_columns() -> list[Column]:  # type: ignore[type-arg]
    """What one answer to one question is, first or revised."""
    return [
        Column("rating", Integer, nullable=False),
        Column("rt_ms", Double, nullable=False, comment="from the picture's first frame to the (last) choice"),
        Column("shown_at", Double, nullable=False),
        Column("answered_at", Double, nullable=False),
        Column("stored_at", Double, nullable=False),
        Column("submission", String, nullable=False, comment="named by the browser, the same on every retry"),
    ]


def presentation_key() -> ForeignKeyConstraint:
    """Every rating belongs to a presentation that was assigned."""
    return ForeignKeyConstraint(["session", "place"], ["presentations.session", "presentations.place"])


ratings = Table(
    "ratings",
    tables,
    Column("session", String, primary_key=True),
    Column("place", Integer, primary_key=True),
    Column("question", String, primary_key=True),
    *rating_columns(),
    presentation_key(),
)

revisions = Table(
    "revisions",
    tables,
    Column("session", String, primary_key=True),
    Column("place", Integer, primary_key=True),
    Column("question", String, primary_key=True),
    Column("revision", Integer, primary_key=True, comment="1, 2, ...: the highest one counts"),
    *rating_columns(),
    presentation_key(),
)

events = Table(
    "events",
    tables,
    Column("id", Integer, primary_key=True, autoincrement=True),
    Column("session", ForeignKey("sessions.id"), nullable=False, index=True),
    Column("at", Double, nullable=False),
    Column("kind", String, nullable=False),
    Column("detail", JSON, nullable=False),
)

withdrawals = Table(
    "withdrawals",
    tables,
    Column("session", ForeignKey("sessions.id"), primary_key=True),
    Column("at", Double, nullable=False),
    Column("ratings_deleted", Integer, nullable=False),
)
