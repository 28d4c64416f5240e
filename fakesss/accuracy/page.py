"""The page of `fakesss tradeoff`: what each knob of a scene costs and what it is off by, and the settings worth it."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fakesss.accuracy.drawings import Drawing
from fakesss.accuracy.drawings_knob import knob_drawing
from fakesss.accuracy.drawings_maps import SIDE, Thumbnail, frame_of, picture_thumbnail
from fakesss.accuracy.page_curves import curve_of
from fakesss.accuracy.page_front import Front, front_of
from fakesss.accuracy.page_gallery import REFERENCE, Gallery, Pictures, gallery
from fakesss.accuracy.page_parts import Table, signed_scale, write_files
from fakesss.accuracy.page_presets import presets_of
from fakesss.accuracy.page_tables import overview, points_table, published_table
from fakesss.accuracy.page_words import counted, findings, knob_sentences, lead, measured_on


@dataclass(frozen=True)
class KnobPart:
    """What the page says of one knob."""

    name: str
    anchor: str
    sets: Sequence[str]  # scene paths
    sentences: Sequence[str]
    drawing: Drawing
    table: Table
    published: Table | None
    gallery: Gallery | None


def write_page(document: Mapping[str, Any], folder: Path, pictures: Pictures) -> Path:
    """`folder`/index.html and figures/ from the document of `fakesss tradeoff` (docs/accuracy.md); the page's path.

    `pictures`: (H, W, 4) float32, linear RGB and coverage, by knob and value as text; the reference of a knob under its
    own value, or of all knobs under ("", "reference"). A level without a picture stands in figure and table only.
    Equal input gives equal bytes. Raises `BadInput` where `folder` cannot be written.
    """
    parts = [knob_part(knob, pictures) for knob in document["knobs"]]
    front = front_of(document)
    context = {
        "title": f"What accuracy costs in time: {document['scene']}",
        "kicker": "Accuracy and time",
        "byline": byline(document),
        "contents": contents(parts, front),
        "lead": lead(document),
        "findings": findings(document),
        "remarks": document["warnings"],
        "overview": overview(document),
        "front": front,
        "presets": presets_of(document),
        "knobs": parts,
        "unused": document["unused"],
        "exact": exact_shot(pictures),
        "signed": signed_scale("reference"),
        "side": SIDE,
        "method": document["method"],
        "session": {"scene": document["scene"], **measured_on(document)},
        "command": document["command"],
    }
    drawings = [*([front.drawing] if front else []), *(part.drawing for part in parts)]
    return write_files(folder, "tradeoff.html", drawings, context)


def knob_part(knob: Mapping[str, Any], pictures: Pictures) -> KnobPart:
    """Figure, table and pictures of one of the document's `knobs`."""
    curve = curve_of(knob)
    name = slug(curve.name)
    return KnobPart(
        curve.name,
        f"knob-{name}",
        knob["sets"],
        knob_sentences(knob, curve),
        knob_drawing(curve, f"figure-{name}", knob["order"]),
        points_table(curve, f"table-{name}"),
        published_table(curve, knob["published"], f"published-{name}") if "published" in knob else None,
        gallery(curve, pictures),
    )


def exact_shot(pictures: Pictures) -> Thumbnail | None:
    """The exact picture, if it was handed over."""
    exact = pictures.get(("", REFERENCE))
    return None if exact is None else picture_thumbnail(exact, frame_of(exact))


def byline(document: Mapping[str, Any]) -> str:
    """How much was measured, where and when, at one glance."""
    levels = sum(len(knob["points"]) for knob in document["knobs"])
    parts = ((len(document["knobs"]), "knob"), (levels, "level"), (len(document["combinations"]), "combination"))
    said = [counted(number, word) for number, word in parts]
    return " · ".join([*said, str(document["machine"]["gl_renderer"]), str(document["date"])])


def contents(parts: Sequence[KnobPart], front: Front | None) -> list[tuple[str, str, bool]]:
    """Anchor, name and whether it lies within the one above, for every heading."""
    return [
        ("results", "Results first", False),
        *([("combinations", "Combinations", False)] if front else []),
        ("presets", "Presets", False),
        ("knobs", "Knob by knob", False),
        *((part.anchor, part.name, True) for part in parts),
        ("method", "What the numbers are", False),
        ("session", "Machine and command", False),
    ]


def slug(name: str) -> str:
    """A name as part of an address: "AO rays" -> "ao-rays"."""
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")
