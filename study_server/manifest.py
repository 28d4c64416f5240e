"""A built study as the survey sees it: stimuli/manifest.json and its pictures, checked before anyone is let in."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from fakesss.problem import BadInput
from study_server.ordering.assignment import most_checks
from study_server.settings import SurveySettings, check_survey


@dataclass(frozen=True)
class Stimulus:
    """One picture: where it lies, its SHA-256 and bytes, its size in pixels, and the design's facts about it."""

    id: str
    path: Path
    sha256: str
    bytes: int
    width: int
    height: int
    facts: Mapping[str, Any]

    @property
    def repeat_of(self) -> str | None:
        """The stimulus that this one shows again, if it is there to measure test-retest agreement."""
        return self.facts.get("same_picture_as") if self.facts.get("role") == "repeat" else None


@dataclass(frozen=True)
class BuiltStudy:
    """Title, seed, settings and stimuli of one built study."""

    folder: Path
    title: str
    seed: int
    sha256: str
    settings: SurveySettings
    stimuli: tuple[Stimulus, ...]
    factors: tuple[Mapping[str, Any], ...]

    @cached_property
    def by_id(self) -> dict[str, Stimulus]:
        """Stimuli by their id."""
        return {stimulus.id: stimulus for stimulus in self.stimuli}

    @cached_property
    def by_hash(self) -> dict[str, Stimulus]:
        """Stimuli by SHA-256 of the file (twins share one)."""
        return {stimulus.sha256: stimulus for stimulus in self.stimuli}

    @cached_property
    def identity(self) -> str:
        """SHA-256 over study.toml's hash and every picture's: two studies are one only if both agree."""
        parts = [self.sha256, *(f"{stimulus.id}={stimulus.sha256}" for stimulus in self.stimuli)]
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def load_study(folder: Path) -> BuiltStudy:
    """The study in `folder`; every picture is read and its hash compared.

    Raises `BadInput` if the study is not built, or a picture is missing or not the one that was built.
    """
    path = folder / "stimuli" / "manifest.json"
    mend = f"run `fakesss build {folder}`"
    try:
        manifest = json.loads(path.read_text(encoding="utf-8"))
        if manifest["format"] != 1:
            raise ValueError(f"format {manifest['format']!r}")
        study = manifest["study"]
        stimuli = tuple(read_stimulus(path.parent, entry, mend) for entry in manifest["stimuli"])
        built = BuiltStudy(
            folder=folder,
            title=str(study["title"]),
            seed=int(study["seed"]),
            sha256=str(study["sha256"]),
            settings=check_survey(study, str(path)),
            stimuli=stimuli,
            factors=tuple(study.get("factors", ())),
        )
    except FileNotFoundError:
        raise BadInput(f"{path}: no such file; {mend}") from None
    except BadInput:
        raise
    except (OSError, json.JSONDecodeError, UnicodeDecodeError) as error:
        raise BadInput(f"{path}: cannot be read ({error}); {mend}") from None
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise BadInput(f"{path}: is not a manifest of format 1 ({error!r}); {mend}") from None
    return checked(built, path, mend)


def study_changed(study: BuiltStudy) -> bool:
    """Whether the folder's study.toml is another one than the pictures were built from. Without one: False."""
    try:
        return hashlib.sha256((study.folder / "study.toml").read_bytes()).hexdigest() != study.sha256
    except FileNotFoundError:
        return False


def read_stimulus(folder: Path, entry: Mapping[str, Any], mend: str) -> Stimulus:
    """One entry of the manifest, with its picture's bytes compared against `sha256`."""
    path = folder / entry["file"]
    if not path.resolve().is_relative_to(folder.resolve()):
        raise BadInput(f'{folder / "manifest.json"}: file "{entry["file"]}" lies outside the folder; {mend}')
    try:
        data = path.read_bytes()
    except OSError as error:
        raise BadInput(f"{path}: cannot be read ({error.strerror}); {mend}") from None
    if hashlib.sha256(data).hexdigest() != entry["sha256"]:
        raise BadInput(f"{path}: is not the picture that was built (its SHA-256 differs); {mend}")
    return Stimulus(
        id=str(entry["id"]),
        path=path,
        sha256=str(entry["sha256"]),
        bytes=len(data),
        width=int(entry["width"]),
        height=int(entry["height"]),
        facts=entry,
    )


def checked(built: BuiltStudy, path: Path, mend: str) -> BuiltStudy:
    """`built`, or `BadInput` if nobody could be shown anything or two stimuli share an id."""
    if not built.stimuli:
        raise BadInput(f"{path}: holds no stimuli; {mend}")
    if len(built.by_id) != len(built.stimuli):
        raise BadInput(f"{path}: two stimuli share an id; {mend}")
    check_repeats(built, path, mend)
    check_number_of_checks(built.settings, len(built.stimuli), "study.toml")
    return built


def check_repeats(built: BuiltStudy, path: Path, mend: str) -> None:
    """`BadInput` if a repeat shows none of the study's other pictures, or one that is repeated already."""
    repeated: set[str] = set()
    for stimulus in built.stimuli:
        original = built.by_id.get(stimulus.repeat_of) if stimulus.repeat_of else None
        if stimulus.repeat_of and (original is None or original.repeat_of or original.id in repeated):
            raise BadInput(f'{path}: "{stimulus.id}" repeats "{stimulus.repeat_of}", which cannot be repeated; {mend}')
        repeated.update({original.id} if original else ())


def check_number_of_checks(settings: SurveySettings, pictures: int, source: str) -> None:
    """`BadInput` if there are more instructed items than find a place among so many pictures."""
    blocks = len(settings.question) if settings.survey.blocks == "by-question" else 1
    most = most_checks(pictures * blocks)
    if settings.survey.checks > most:
        raise BadInput(
            f"{source}: survey.checks: {settings.survey.checks}: must be <= {most}, half of the pictures shown"
        )
