"""`stimuli/manifest.json`: what was built, from what, by what. Read by the survey and the analysis."""

import hashlib
import json
from pathlib import Path
from typing import Any

from fakesss.output import write_atomically
from fakesss.problem import BadInput
from stimuli.design import Stimulus
from stimuli.study import Study, study_sha256

FORMAT = 1
ENTRY = {"id", "file", "sha256", "width", "height", "scene", "passes", "warnings", "build_key"}


def manifest_path(folder: Path) -> Path:
    """Where the manifest of the study in `folder` stands."""
    return folder / "stimuli" / "manifest.json"


def study_entry(study: Study, folder: Path) -> dict[str, Any]:
    """The manifest's `study` table: the study file as read, without the base scene, and its hash."""
    table = study.model_dump(mode="json", exclude={"scene", "factor", "compare", "control"})
    table["factors"] = [factor.model_dump(mode="json") for factor in study.factor]
    return {**table, "sha256": study_sha256(folder)}


def stimulus_entry(stimulus: Stimulus, drawn: dict[str, Any]) -> dict[str, Any]:
    """One element of the manifest's `stimuli`: the design's side from `stimulus`, the picture's side from `drawn`."""
    return {
        "id": stimulus.id,
        "file": f"{stimulus.id}.png",
        "sha256": drawn["sha256"],
        "width": drawn["width"],
        "height": drawn["height"],
        "scene": None if stimulus.scene is None else stimulus.scene.model_dump(mode="json"),
        "factors": dict(stimulus.factors),
        "rows": list(stimulus.rows),
        "same_picture_as": stimulus.same_picture_as,
        "role": stimulus.role,
        "label": stimulus.label,
        "origin": drawn["origin"],
        "passes": drawn["passes"],
        "gpu_ms": None,
        "warnings": drawn["warnings"],
        "cues": drawn["cues"],
        "cues_missing": drawn["cues_missing"],
        "build_key": drawn["build_key"],
    }


def write_manifest(folder: Path, manifest: dict[str, Any]) -> None:
    """The manifest on disk, whole or not at all, in a folder that is there."""
    write_atomically(manifest_path(folder), (json.dumps(manifest, indent=1, ensure_ascii=False) + "\n").encode())


def read_manifest(folder: Path) -> dict[str, Any]:
    """The manifest of a built study, or `BadInput` saying to build it."""
    path = manifest_path(folder)
    try:
        manifest: dict[str, Any] = json.loads(path.read_bytes())
    except FileNotFoundError:
        raise BadInput(f"{path}: no such file; run `fakesss build {folder}` first") from None
    except (OSError, ValueError) as error:
        raise BadInput(f"{path}: cannot be read ({error}); run `fakesss build {folder}`") from None
    entries = manifest.get("stimuli") if isinstance(manifest, dict) else None
    if not isinstance(entries, list) or not all(isinstance(e, dict) and e.keys() >= ENTRY for e in entries):
        raise BadInput(f"{path}: is no manifest; run `fakesss build {folder}`")
    if manifest.get("format") != FORMAT:
        raise BadInput(f"{path}: format {manifest.get('format')!r}, this version reads {FORMAT}; build the study again")
    return manifest


def sha256(content: bytes) -> str:
    """SHA-256 of `content` in hexadecimal."""
    return hashlib.sha256(content).hexdigest()
