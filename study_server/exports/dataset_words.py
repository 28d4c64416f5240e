"""README.md, CHANGES.md and the description of a Psych-DS dataset: what the study is, in words."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.metadata import version
from typing import Any

from study_server.counts import STATES
from study_server.exports.cells import iso
from study_server.exports.export_rows import Source
from study_server.manifest import BuiltStudy

HOLDS = {
    "trials": "one row for each rating that was expected of a session, answered or not",
    "participants": "one row for each session: status, answers about the person, comments",
    "displays": "one row for each picture that was rated: how it stood on the screen",
    "events": "starts, finishes, changed answers, refused answers",
    "stimuli": "one row for each picture: file, hash, size, levels of the factors",
}

CHANGES = "# Changes\n"


@dataclass(frozen=True)
class Figures:
    """How many sessions of each state, how many ratings, when the first and last began, and when this was counted."""

    mode: str
    states: Mapping[str, int]
    ratings: int
    begun: tuple[float, float] | None
    now: float

    @property
    def sessions(self) -> int:
        """All of them."""
        return sum(self.states.values())

    @property
    def coverage(self) -> dict[str, str]:
        """The days of the first and last start, as schema.org has it; nothing if nobody came."""
        return {"temporalCoverage": "/".join(map(day, self.begun))} if self.begun else {}

    @property
    def people(self) -> str:
        """44 sessions (38 finished, 6 dropped)."""
        parts = ", ".join(f"{self.states[state]} {state}" for state in STATES if self.states.get(state))
        return f"{self.sessions} {self.mode} session{'s' * (self.sessions != 1)}" + (f" ({parts})" if parts else "")


def counted(source: Source) -> Figures:
    """The dataset's figures, from the query of the admin page."""
    states: Counter[str] = Counter()
    ratings, begun = 0, None
    for person in source.people():
        states[person["status"]] += 1
        ratings += person["ratings"]
        begun = (begun[0] if begun else person["started_at"], person["started_at"])
    return Figures(source.mode, states, ratings, begun, source.now)


def day(seconds: float) -> str:
    """Unix seconds as a date of UTC."""
    return datetime.fromtimestamp(seconds, UTC).date().isoformat()


def description_of(study: BuiltStudy, figures: Figures) -> str:
    """The study in two sentences."""
    asked = "; ".join(f'{q.name}: "{q.text}" 1 ({q.low}) to {q.scale} ({q.high})' for q in study.settings.question)
    return (
        f"Ratings of {len(study.stimuli)} pictures by {figures.people}, recorded in their browsers. "
        f"Each picture was rated on: {asked}."
    )


def readme_text(study: BuiltStudy, figures: Figures, files: Mapping[str, str], manifest: Mapping[str, Any]) -> bytes:
    """README.md. `files`: name of a data file -> which one it is."""
    listed = "\n".join(f"- `data/{name}`: {HOLDS[what]}" for name, what in files.items())
    questions = "\n".join(f"- `{q.name}`: {q.text} 1 = {q.low}, {q.scale} = {q.high}" for q in study.settings.question)
    software = "\n".join(f"- {name}: {value}" for name, value in manifest.get("software", {}).items())
    return f"""# {study.title}

{len(study.stimuli)} pictures were rated by {figures.people}; {figures.ratings} ratings are stored.

## What was asked under each picture

{questions}

An instructed item ("choose 2 here") is a row whose `question` is `check`: `check_expected` is what was asked for,
`check_passed` whether it was done. Nobody was left out for it.

## Files

{listed}
- `documentation/codebook.csv`: every column of these files with type, unit, values and what an empty cell means;
  `variableMeasured` in `dataset_description.json` says the same
- `materials/`: the study: `stimuli/manifest.json` with scene, levels and SHA-256 of every picture, the pictures, and
  `study.toml`. Completion codes are left out, and with them a study.toml that holds some.

The files are joined by `session` and `stimulus`; `participant` is one person, who may have several sessions.

## Missing values

An empty cell is a missing value; the codebook says for each column what it means. An empty `rating` was expected and
not given. Sessions that were withdrawn or screened out have no rows in trials. A text that begins with = + - @, a tab
or a line feed has an apostrophe before it, so that no spreadsheet runs it.

## Privacy

`participant` is a keyed hash, whose key is not in this dataset. Network addresses and browser names are left out, also
where the study stores them. `comments` and free answers (`about_...`) stand as
they were typed: read them before you publish. This dataset has no license and no authors until you add them to
`dataset_description.json`, where they stay.

## How it was made

- written at {iso(figures.now)} by fakesss {version("fakesss")}; an export into the same folder replaces this file
- SHA-256 of study.toml: {study.sha256}
- SHA-256 over that and every picture's: {study.identity}
{software}
""".encode()


def changes_text(figures: Figures, before: str) -> bytes:
    """CHANGES.md: this export on top of those `before`."""
    entry = f"## {iso(figures.now)}\n\n{figures.people}, {figures.ratings} ratings.\n"
    return "\n".join(part for part in (CHANGES, entry, before.removeprefix(CHANGES).strip()) if part).encode()
