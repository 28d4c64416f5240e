"""Where a report comes from: hashes of what was read, versions of what computed it, the date of the last answer."""

import hashlib
import platform
from importlib.metadata import version
from pathlib import Path

import pandas as pd

from analysis.study import StudyInfo

SOFTWARE = ("fakesss", "numpy", "scipy", "pandas", "statsmodels", "pingouin", "krippendorff", "matplotlib")


def provenance(ratings: Path, frame: pd.DataFrame, study: StudyInfo, command: str) -> dict[str, str]:
    """What stands in the session block. Nothing depends on the clock or the machine's paths."""
    lines = {
        "command": command,
        "ratings": ratings.name,
        "SHA-256 of the ratings": sha256(ratings),
        "SHA-256 of the study": study.sha256 or "no study given",
        "seed of the study": "none" if study.seed is None else str(study.seed),
        "last answer": last_answer(frame),
        "Python": platform.python_version(),
    }
    return lines | {name: version(name) for name in SOFTWARE}


def sha256(path: Path) -> str:
    """Of the file's bytes, read in pieces."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def last_answer(frame: pd.DataFrame) -> str:
    """The latest `answered_at`, as it stands in the file (ISO 8601 sorts as text)."""
    if "answered_at" not in frame or not (frame["answered_at"] != "").any():
        return "not recorded"
    return str(frame["answered_at"].max())
