"""What a search for power found, as a document and as a table to read."""

from collections.abc import Sequence
from dataclasses import asdict
from math import ceil
from typing import Any

import pandas as pd

from analysis.power import FEWEST, Power, Search
from analysis.wording import counted, no_zero

DESCRIBED = ("title", "question", "name", "kind", "alpha", "difference", "margin")
ENDS = {"": "share", "_low": "low", "_high": "high"}


def found_rows(search: Search, asked: Sequence[int], completing: float) -> list[dict[str, Any]]:
    """A row per test: what `PlannedTest` says of it, and what was found.

    `people`: the smallest number with the target power, between `people_low` and `people_high` (None: more than was
    searched); `start`: how many must begin for so many to complete; `power`, `power_low`, `power_high`: there;
    `with`: the power with each number in `asked`; `note`: why there is no number, else empty.
    """
    return [found_row(search, place, asked, completing) for place in range(len(search.simulation.tests))]


def found_row(search: Search, place: int, asked: Sequence[int], completing: float) -> dict[str, Any]:
    """The row of the test at index `place`."""
    simulation = search.simulation
    people, low, high = (smallest(search, place, bound) for bound in ("share", "high", "low"))
    there = None if people is None else simulation.power(place, people)
    simulated = [size for size in dict.fromkeys(asked) if size in simulation.sizes(place)]
    return {
        **{name: getattr(simulation.tests[place], name) for name in DESCRIBED},
        "people": people,
        "people_low": low,
        "people_high": high,
        "start": None if people is None else ceil(people / completing),
        **{f"power{end}": there and getattr(there, name) for end, name in ENDS.items()},
        "with": [{"people": size, **asdict(simulation.power(place, size))} for size in simulated],
        "note": why_none(search, place) if people is None else "",
    }


def smallest(search: Search, place: int, bound: str) -> int | None:
    """The number of people, or a limit of it, where it is known."""
    found = search.bracket(place, bound)
    if search.simulation.tests[place].hopeless or not found.closed:
        return None
    return (found.below or FEWEST - 1) + 1 if bound == "high" else found.enough


def why_none(search: Search, place: int) -> str:
    """Why a test has no number of people."""
    if hopeless := search.simulation.tests[place].hopeless:
        sizes = search.simulation.sizes(place)
        return hopeless + (valueless(search, place, max(sizes)) if sizes else "")
    below = search.bracket(place, "share").below
    if below is None:
        return "stopped before it was known"
    reached = f"power {no_zero(search.simulation.power(place, below).share, 2)}"
    people, without = counted(below, "participant"), valueless(search, place, below)
    if below == search.most:
        return f"not reached with {people}: {reached}{without}"
    return f"stopped before it was known: {reached} with {people}{without}"


def valueless(search: Search, place: int, people: int) -> str:
    """In how many studies the test has no value; empty where it has one in all."""
    without, studies = search.simulation.found[people][place].without, search.simulation.studies
    if not without:
        return ""
    many = f"all {studies}" if without == studies else f"{without} of the {studies}"
    why = "nothing varies that it could be tested against"
    if search.simulation.tests[place].difference is None:
        why += ", or the best picture is also one of those named"
    return f"; in {many} studies with {counted(people, 'participant')} it has no value: {why}"


def as_frame(rows: Sequence[dict[str, Any]]) -> pd.DataFrame:
    """A line per test, for a CSV file: columns of power for each number of people asked for."""
    flat = []
    for row in rows:
        line = {name: value for name, value in row.items() if name not in ("with", "note")}
        for entry in row["with"]:
            line |= {f"power_with_{entry['people']}{end}": entry[name] for end, name in ENDS.items()}
        flat.append({**line, "note": row["note"]})
    return pd.DataFrame(flat).astype(dict.fromkeys(("people", "people_low", "people_high", "start"), "Int64"))


def as_text(rows: Sequence[dict[str, Any]], target: float, completing: float, most: int) -> str:
    """The table in columns, and below it why a test has no number of people."""
    head = ["", "difference", f"people for {100 * target:g}%", "to start", "power there"]
    lines = [[*head, *(f"with {entry['people']}" for entry in rows[0]["with"])], *(cells(row, most) for row in rows)]
    if completing == 1:
        lines = [[*line[:3], *line[4:]] for line in lines]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    table = ["  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines]
    return "\n".join([*table, *reasons(rows)])


def cells(row: dict[str, Any], most: int) -> list[str]:
    """A row's texts."""
    number, start, there = "none", "none", ""
    if row["people"] is not None:
        number = f"{row['people']} ({row['people_low']} to {row['people_high'] or f'over {most}'})"
        start, there = str(row["start"]), share(Power(row["power"], row["power_low"], row["power_high"]))
    difference = "" if row["difference"] is None else f"{row['difference']:.2f}"
    asked = [share(Power(*(entry[name] for name in ENDS.values()))) for entry in row["with"]]
    return [row["title"], difference, number, start, there, *asked]


def reasons(rows: Sequence[dict[str, Any]]) -> list[str]:
    """A sentence for each reason why tests have no number of people."""
    notes = dict.fromkeys(row["note"] for row in rows if row["note"])
    said = [f"{'; '.join(row['title'] for row in rows if row['note'] == note)}: {note}." for note in notes]
    return ["", *said] if said else []


def share(power: Power) -> str:
    """.81 (.79 to .83)."""
    return f"{no_zero(power.share, 2)} ({no_zero(power.low, 2)} to {no_zero(power.high, 2)})"
