"""Presets as text to copy into a scene's file."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import tomli_w

from fakesss.accuracy.page_numbers import duration, rounded


@dataclass(frozen=True)
class PresetText:
    """A preset's name, what it is for and costs, and its settings as TOML."""

    name: str
    words: str
    toml: str


def presets_of(document: Mapping[str, Any]) -> list[PresetText]:
    """All of the document's `presets`, in its order."""
    return [preset_of(name, entry) for name, entry in document["presets"].items()]


def flip_text(entry: Mapping[str, Any]) -> str:
    """From the exact picture, and from that of the preset `reference`."""
    pairs = (("the exact picture", entry), ("the preset reference’s", entry["from_reference"]))
    return "; from ".join(
        f"{what}: mean {rounded(found['flip'])}, in 99.9 % of the pixels at most {rounded(found['flip_everywhere'])}"
        for what, found in pairs
    )


def preset_of(name: str, entry: Mapping[str, Any]) -> PresetText:
    """One of them; a setting that is empty (None) is its default, which TOML cannot write."""
    nested: dict[str, Any] = {}
    for path, value in entry["settings"].items():
        *parents, leaf = path.split(".")
        place = nested
        for parent in parents:
            place = place.setdefault(parent, {})
        if value is not None:
            place[leaf] = value
    cost = f"{duration(entry['ms'] / 1e3)} a picture. FLIP from {flip_text(entry)}."
    because = str(entry.get("because", "")).strip()
    words = f"{because[0].upper()}{because[1:].rstrip('.')}. " if because else ""
    # tables that hold nothing but an empty setting say nothing
    return PresetText(name, words + cost, tomli_w.dumps({key: value for key, value in nested.items() if value != {}}))
