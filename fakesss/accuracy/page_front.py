"""The front of combinations, as the page shows it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from fakesss.accuracy.drawings import Drawing
from fakesss.accuracy.drawings_front import front_drawing
from fakesss.accuracy.page_curves import point_of
from fakesss.accuracy.page_parts import Table
from fakesss.accuracy.page_tables import combinations_table


@dataclass(frozen=True)
class Front:
    """A figure and a table of what nothing beats, and a sentence on the search."""

    lead: str
    drawing: Drawing
    table: Table


def front_of(document: Mapping[str, Any]) -> Front | None:
    """None where no combinations were measured."""
    entries = sorted(document.get("combinations", ()), key=lambda entry: float(entry["ms"]))
    if not entries:
        return None
    marks = [preset_at(entry, document["presets"]) for entry in entries]
    points = [point_of(entry, mark) for entry, mark in zip(entries, marks, strict=True)]
    best = [place for place, entry in enumerate(entries) if entry["front"]]
    return Front(
        f"All knobs at once, against the exact picture: the {len(entries)} combinations that were measured well. No "
        "other that was looked at is both faster, as far as that can be told, and nearer to it in mean FLIP than those "
        "on the line.",
        front_drawing(points, best),
        combinations_table(document["presets"]["reference"]["values"], entries, marks, points),
    )


def preset_at(entry: Mapping[str, Any], presets: Mapping[str, Mapping[str, Any]]) -> str:
    """Names of the presets that are this combination."""
    return ", ".join(name for name, preset in presets.items() if dict(preset["settings"]) == dict(entry["settings"]))
