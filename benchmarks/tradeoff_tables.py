"""The tables of docs/accuracy.md about several scenes, from what `fakesss tradeoff SCENE SCENE... -o FOLDER` wrote.

python benchmarks/tradeoff_tables.py FOLDER > tables.md
"""

import argparse
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

Document = Mapping[str, Any]
Entry = Mapping[str, Any]


def main() -> None:
    """Prints the tables of knobs, then of presets, then the front of the slowest scene."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="with a tradeoff.json in each of its folders")
    places = sorted(parser.parse_args().folder.glob("*/tradeoff.json"))
    documents = [json.loads(place.read_text(encoding="utf-8")) for place in places]
    names = dict.fromkeys(knob["name"] for document in documents for knob in document["knobs"])
    blocks = [*(knob_table(documents, name) for name in names), presets(documents), front(documents)]
    print("\n\n".join("\n".join(block) for block in blocks))


def label(document: Document) -> str:
    """The scene's name as a column head."""
    return Path(document["scene"]).stem.replace("_", " ")


def row(cells: Sequence[str]) -> str:
    """A line of a Markdown table."""
    return f"| {' | '.join(cells)} |"


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """A Markdown table."""
    yield row(head)
    yield "|" + "---|" * len(head)
    yield from map(row, rows)


def number(value: float) -> str:
    """Two digits that count; 0 as it is."""
    if value == 0:
        return "0"
    return f"{value:.2g}" if abs(value) >= 1e-4 else f"{value:.0e}".replace("e-0", "e-")


def knob_table(documents: Sequence[Document], name: str) -> Iterator[str]:
    """One knob in every scene that uses it: time beside the common picture (or the bake's), errors to its reference."""
    found = [(label(document), knob) for document in documents for knob in document["knobs"] if knob["name"] == name]
    first = found[0][1]
    recommended = ", ".join(f"{knob['recommended']} ({scene})" for scene, knob in found)
    orders = [
        f"{order['fitted']:.2f} ({scene}; {order['low']:.2f} to {order['high']:.2f})"
        for scene, knob in found
        if (order := knob["order"])
    ]
    order = f" Order: {', '.join(orders)}." if orders else ""
    yield f"**{name[0].upper()}{name[1:]}**, against {first['reference']}. Recommended: {recommended}.{order}"
    yield ""
    time = "bake, s" if first["baked"] else "time"
    head = ["level", *(cell for scene, _ in found for cell in (f"{scene}: {time}", "RMSE", "FLIP", "99.9 %"))]
    rows = [
        [str(point["value"]), *(cell for _, knob in found for cell in cells(knob, place))]
        for place, point in enumerate(first["points"])
    ]
    yield from table([*head, *published_head(first)], [[*cells, *published(first, cells[0])] for cells in rows])


def cells(knob: Entry, place: int) -> Iterator[str]:
    """Of one level: its time and errors."""
    point = knob["points"][place]
    yield f"{point['bake_seconds']:.2f}" if knob["baked"] else f"{point['ratio']:.2f}"
    yield from (number(point[error]) for error in ("rmse", "flip", "flip_everywhere"))


def published_head(knob: Entry) -> tuple[str, ...]:
    """The columns of a table that stands in the literature."""
    return ("ours to the first", "published, ms", "to the first", "ray traced, s") if "published" in knob else ()


def published(knob: Entry, value: str) -> tuple[str, ...]:
    """Ours as a ratio to the first level, and the literature's row."""
    if "published" not in knob:
        return ()
    mine = {str(point["value"]): point["ms"] for point in knob["points"]}
    theirs = {str(point["value"]): point for point in knob["published"]["points"]}
    first, there = next(iter(mine)), theirs.get(value)
    if there is None:
        return (f"{mine[value] / mine[first]:.2f}", "", "", "")
    ratio = there["ms"] / theirs[first]["ms"]
    return f"{mine[value] / mine[first]:.2f}", f"{there['ms']:g}", f"{ratio:.2f}", f"{there['offline_s']:g}"


def settings(values: Mapping[str, Any]) -> str:
    """The levels of a combination in words."""
    return ", ".join(f"{knob} {value}" for knob, value in values.items())


def presets(documents: Sequence[Document]) -> Iterator[str]:
    """Milliseconds in each scene, errors in the worst of them, and the levels."""
    head = ["preset", *(f"{label(document)}: ms" for document in documents), "FLIP", "99.9 %", "kept", "settings"]
    rows = []
    for name, preset in documents[0]["presets"].items():
        here = [document["presets"][name] for document in documents]
        worst = [max(one["flip"] for one in here), max(one["from_reference"]["flip_everywhere"] for one in here)]
        kept = "yes" if preset["met"] else "no"
        times = [f"{one['ms']:.0f}" for one in here]
        rows.append([f'"{name}"', *times, *(f"{each:.3f}" for each in worst), kept, settings(preset["values"])])
    yield from table(head, rows)


def front(documents: Sequence[Document]) -> Iterator[str]:
    """What nothing beats in the slowest scene."""
    slowest = max(documents, key=lambda document: document["baseline"]["ms"])
    best = {knob["name"]: knob["reference"] for knob in slowest["knobs"]}
    yield f"The front, in the slowest scene ({label(slowest)}): milliseconds, FLIP from the exact picture, FLIP in"
    yield '99.9 % of the pixels from "reference", what is not at its reference.'
    yield ""
    rows = [
        [
            f"{one['ms']:.0f}",
            f"{one['ratio']:.2f}",
            f"{one['flip']:.3f}",
            f"{one['from_reference']['flip_everywhere']:.3f}",
            settings({knob: value for knob, value in one["values"].items() if best.get(knob) != value}) or "none",
        ]
        for one in sorted(slowest["combinations"], key=lambda one: one["ms"])
        if one["front"]
    ]
    yield from table(["ms", "ratio", "FLIP", "99.9 %", "settings"], rows)


if __name__ == "__main__":
    main()
