"""Makes the path-traced pictures that are shipped with a template again: `python -m stimuli.rebuild_offline`.

The shipped ones took 62 minutes of tracing on two busy cores; 28 minutes of processor time, so about 14 on two free
ones (computed). What is traced is kept: interrupt it and start it again, it goes on. A lower `noise` in the template
goes on from the light that is there. Each picture is written as soon as it is ready, with its record.
"""

import json
import os
import platform
import re
import sys
import tempfile
from pathlib import Path
from typing import Any

from fakesss.offline.path_tracing import path_traced
from fakesss.output import make_folder, write_atomically
from stimuli.design import Stimulus, stimuli_of
from stimuli.manifest import sha256
from stimuli.offline import asked_for, encoded
from stimuli.shipped import SHELF, shown
from stimuli.study import Study
from stimuli.template import write_template

COMMAND = "python -m stimuli.rebuild_offline"


def asked_by(template: str) -> list[Stimulus]:
    """The template's path-traced pictures."""
    with tempfile.TemporaryDirectory() as folder:
        write_template(Path(folder), template)
        return [each for each in stimuli_of(Study.load(Path(folder))) if each.path_tracing is not None]


def rebuild(stimulus: Stimulus) -> tuple[bytes, dict[str, Any]]:
    """PNG and record of a picture, traced as far as it is not yet."""
    scene, settings = asked_for(stimulus)
    result = path_traced(scene, settings)
    drawn = encoded(result)
    made_on = {
        "seconds": round(result.seconds),
        "cores": os.cpu_count(),
        "processor": platform.processor() or platform.machine(),
    }
    record = {
        "sha256": sha256(drawn.png),
        "command": COMMAND,
        "provenance": {**(drawn.origin or {}), **made_on},
        "warnings": list(drawn.warnings),
        "shows": shown(scene, settings),
    }
    return drawn.png, record


def file_name(label: str) -> str:
    """marble-lit-from-behind-denoised"""
    return re.sub(r"[^a-z0-9]+", "-", label.lower()).strip("-")


def main(template: str = "thesis") -> None:
    """Every picture of the template on its shelf; those that it no longer asks for are removed with their records."""
    stimuli = asked_by(template)  # before anything is written: there may be no such template
    folder = SHELF / template
    make_folder(folder)
    for stimulus in stimuli:
        png, record = rebuild(stimulus)
        name = file_name(stimulus.label)
        write_atomically(folder / f"{name}.png", png)
        write_atomically(folder / f"{name}.json", (json.dumps(record, indent=1) + "\n").encode())
        made = record["provenance"]
        print(f"{name}: {made['samples']} samples, noise {made['noise']:.1%}, traced for {made['seconds']} s")
    names = {file_name(stimulus.label) for stimulus in stimuli}
    for path in folder.glob("*.json"):
        if path.stem not in names and is_record(path):
            path.with_suffix(".png").unlink(missing_ok=True)
            path.unlink()


def is_record(path: Path) -> bool:
    """Whether this program wrote it, beside a picture."""
    try:
        return bool(json.loads(path.read_text(encoding="utf-8"))["command"] == COMMAND)
    except (ValueError, KeyError, TypeError):
        return False


if __name__ == "__main__":
    main(*sys.argv[1:])
