"""What the analysis needs to know of a study: read from the manifest (or guessed from ratings: `analysis.levels`)."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from analysis.plan import AnalysisPlan, check_analysis
from analysis.ratings import DEFAULT_SCALE
from fakesss.problem import BadInput


@dataclass(frozen=True)
class Factor:
    """A field of the scene that was varied, with its levels in the order of the design."""

    name: str
    levels: tuple[Any, ...]


@dataclass(frozen=True)
class Question:
    """What was asked of every picture; answers are 1..scale, or any number where `scale` is None."""

    name: str
    text: str = ""
    scale: int | None = DEFAULT_SCALE
    low: str = ""
    high: str = ""


@dataclass(frozen=True)
class Picture:
    """A stimulus: its levels, the rows it is compared in, its image cues, and the file to show beside numbers."""

    id: str
    label: str
    role: str = "factor"
    levels: tuple[tuple[str, Any], ...] = ()
    rows: tuple[str, ...] = ()
    same_picture_as: str | None = None
    file: Path | None = None
    cues: tuple[tuple[str, float | None], ...] = ()  # of a manifest that has them


@dataclass(frozen=True)
class StudyInfo:
    """Title, design, questions and pictures of a study."""

    title: str
    design: str
    factors: tuple[Factor, ...]
    questions: tuple[Question, ...]
    pictures: tuple[Picture, ...]
    plan: AnalysisPlan
    seed: int | None = None
    sha256: str | None = None

    def picture(self, identity: str) -> Picture:
        """The picture of that id; one that the manifest does not list is known by its id alone."""
        return next((p for p in self.pictures if p.id == identity), Picture(identity, identity, role="unlisted"))

    def question(self, name: str) -> Question:
        """The question of that name."""
        return next((q for q in self.questions if q.name == name), Question(name))

    def number_of(self, identity: str) -> int:
        """1-based place among the listed pictures: the number in the captions."""
        return [p.id for p in self.pictures].index(identity) + 1


def read_manifest(path: Path) -> StudyInfo:
    """The study described by `manifest.json`; `BadInput` when it is none or lacks a part."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        return from_manifest(data, path)
    except FileNotFoundError:
        raise BadInput(f"{path}: no such file; run fakesss build first") from None
    except (OSError, UnicodeDecodeError, json.JSONDecodeError) as error:
        raise BadInput(f"{path}: cannot be read as JSON ({error}); run fakesss build again") from None
    except (KeyError, TypeError, AttributeError) as error:
        raise BadInput(f"{path}: not a manifest this version reads (near {error}); run fakesss build again") from None


def from_manifest(data: dict[str, Any], path: Path) -> StudyInfo:
    """`StudyInfo` out of the manifest's tables; file names are relative to the manifest."""
    study = data["study"]
    design = study["design"]
    return StudyInfo(
        title=study["title"],
        design=design["kind"] if isinstance(design, dict) else design,
        factors=tuple(Factor(entry["name"], tuple(entry["levels"])) for entry in study["factors"]),
        questions=tuple(read_question(entry) for entry in study["question"]),
        pictures=tuple(read_picture(entry, path.parent) for entry in data["stimuli"]),
        plan=check_analysis(study, str(path)),
        seed=study.get("seed"),
        sha256=study.get("sha256"),
    )


def read_question(entry: dict[str, Any]) -> Question:
    """One `[[question]]` table."""
    known = {key: entry[key] for key in ("text", "scale", "low", "high") if entry.get(key) is not None}
    return Question(entry["name"], **known)


def read_picture(entry: dict[str, Any], folder: Path) -> Picture:
    """One element of the manifest's `stimuli`."""
    return Picture(
        id=entry["id"],
        label=entry.get("label") or entry["id"],
        role=entry["role"],
        levels=tuple((entry.get("factors") or {}).items()),
        rows=tuple(entry.get("rows") or ()),
        same_picture_as=entry.get("same_picture_as"),
        file=folder / entry["file"],
        cues=tuple((entry.get("cues") or {}).items()),
    )
