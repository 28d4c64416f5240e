"""The tables of the page of `fakesss tradeoff`, and a line of numbers for a level."""

from collections.abc import Mapping, Sequence
from typing import Any

from fakesss.accuracy.page_curves import Curve, Point, band_name, curve_of
from fakesss.accuracy.page_numbers import rounded
from fakesss.accuracy.page_parts import Table

ERRORS = ("RMSE", "largest", "FLIP, mean", "FLIP in 99.9 %")


def overview(document: Mapping[str, Any]) -> Table:
    """A line a knob: the recommended level beside the knob's reference."""
    rows = []
    for knob in document["knobs"]:
        curve = curve_of(knob)
        chosen = next(point for point in curve.points if point.text == curve.recommended)
        best = next((point for point in curve.points if point.text == curve.reference), None)
        rows.append([curve.name, chosen.text, time_text(curve, chosen), *errors_text(chosen), curve.reference,
                     time_text(curve, best) if best else ""])  # fmt: skip
    return Table(
        "table-overview", "Every knob at its recommended level",
        ["knob", "recommended", "time", *ERRORS, "reference", "its time"], rows, text_columns=2,
        note="Errors are against the picture of the knob’s own reference, all else being equal. Seconds are those of a "
        "bake, spent once; milliseconds are those of every picture. A reference without a time was not timed.",
    )  # fmt: skip


def points_table(curve: Curve, anchor: str) -> Table:
    """Every level of a knob."""
    texts = [point.text for point in curve.points]
    times = ["bake, s"] if curve.baked else ["time, ms", band_name(curve.points)]
    rows = [
        [f"{point.text} (reference)" if point.text == curve.reference else point.text, rounded(point.cost),
         *([] if curve.baked else [band_text(point)]), *errors_text(point)]
        for point in curve.points
    ]  # fmt: skip
    return Table(
        anchor, f"Levels of {curve.name}", [curve.name, *times, *ERRORS], rows,
        chosen=texts.index(curve.recommended) if curve.recommended in texts else None,
    )  # fmt: skip


def published_table(curve: Curve, published: Mapping[str, Any], anchor: str) -> Table:
    """Somebody's printed times beside ours, each also as a multiple of that at the first level of both."""
    ours = {point.text: point.cost for point in curve.points}
    theirs = {str(each["value"]): float(each["ms"]) for each in published["points"]}
    offline = {str(each["value"]): rounded(each["offline_s"]) for each in published["points"]}
    first = next(value for value in theirs if value in ours)
    rows = [
        [value, *multiple(ours.get(value), ours[first]), *multiple(theirs[value], theirs[first]), offline[value]]
        for value in theirs
    ]
    head = [curve.name, "ours, ms", f"ours / at {first}", "published, ms", f"published / at {first}", "offline, s"]
    return Table(
        anchor, f"{curve.name} beside published times", head, rows,
        note=f"Published: {published['source']}, of another scene on another machine; how times grow compares.",
    )  # fmt: skip


def multiple(time: float | None, first: float) -> tuple[str, str]:
    """A time, and how many times the first it is; nothing of a level that was not measured."""
    return ("", "") if time is None else (rounded(time), rounded(time / first, 2))


def errors_text(point: Point) -> list[str]:
    """In the order of ERRORS."""
    everywhere = "" if point.flip_everywhere is None else rounded(point.flip_everywhere)
    return [rounded(point.rmse), rounded(point.max_abs), rounded(point.flip), everywhere]


def band_text(point: Point) -> str:
    """The band of a time."""
    return f"{rounded(point.low)}–{rounded(point.high)}" if point.low and point.high else ""


def time_text(curve: Curve, point: Point) -> str:
    """With its unit."""
    return f"{rounded(point.cost)} {curve.unit}"


def numbers_line(curve: Curve, point: Point | None) -> str:
    """Cost and errors in one line; nothing where a level was not timed."""
    if point is None:
        return ""
    rmse, largest, flip, everywhere = errors_text(point)
    flip = f"FLIP {flip}" + (f" (99.9 %: {everywhere})" if everywhere else "")
    return " · ".join([time_text(curve, point), flip, f"RMSE {rmse}", f"largest {largest}"])


def combinations_table(
    best: Mapping[str, Any], entries: Sequence[Mapping[str, Any]], marks: Sequence[str], points: Sequence[Point]
) -> Table:
    """By rising time, with the levels that are not those of `best`, by knob; `marks` name the presets."""
    rows = [
        [rounded(point.cost), band_text(point), *errors_text(point), mark, otherwise(entry["values"], best)]
        for entry, mark, point in zip(entries, marks, points, strict=True)
    ]  # fmt: skip
    return Table(
        "table-combinations", "Combinations that were measured well, by rising time",
        ["time, ms", band_name(points), *ERRORS, "preset", "other than the preset reference"], rows,
        note="Errors are against the exact picture: all that every knob is off by.",
    )  # fmt: skip


def otherwise(values: Mapping[str, Any], best: Mapping[str, Any]) -> str:
    """The knobs that are not at their best level, with theirs."""
    return "; ".join(f"{name} {value}" for name, value in values.items() if value != best[name]) or "none"
