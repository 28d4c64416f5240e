"""A knob or combination of `fakesss tradeoff`'s document as its page needs it: its time with a band, its errors."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Point:
    """One level of a knob or one combination: what it costs, in which band, and how far off it is."""

    text: str  # its value
    number: float | None  # None: a kind, which has no number
    cost: float
    low: float | None
    high: float | None
    rmse: float  # linear radiance
    max_abs: float
    flip: float  # mean over the object
    flip_everywhere: float | None  # not exceeded in 99.9 % of its pixels
    coverage: float | None = None  # how often such a band holds the true median, 0..1


@dataclass(frozen=True)
class Curve:
    """A knob's points in the document's order, and what its time is."""

    name: str
    baked: bool  # then its time is that of the bake, in seconds, spent once; else of every picture, in milliseconds
    points: tuple[Point, ...]
    recommended: str
    reference: str

    @property
    def unit(self) -> str:
        """Of its points' cost."""
        return "s" if self.baked else "ms"

    @property
    def numbered(self) -> list[Point]:
        """The points with a number, in its order: these may be joined by a line."""
        return sorted((point for point in self.points if point.number is not None), key=lambda p: p.number or 0.0)


def curve_of(knob: Mapping[str, Any]) -> Curve:
    """The curve of one of the document's `knobs`: of a baked one the seconds count, as its pictures cost the same."""
    baked = bool(knob["points"]) and all("bake_seconds" in point for point in knob["points"])
    return Curve(
        name=str(knob["name"]),
        baked=baked,
        points=tuple(point_of(point, str(point["value"]), baked) for point in knob["points"]),
        recommended=str(knob["recommended"]),
        reference=str(knob["reference"]),
    )


def band_name(points: Sequence[Point]) -> str:
    """With how often it holds the true median, where that is known: 96.5 % band."""
    found = {f"{100 * point.coverage:.1f} %" for point in points if point.coverage is not None}
    return " ".join([*sorted(found)[:1], "band"])


def point_of(entry: Mapping[str, Any], text: str, baked: bool = False) -> Point:
    """One of a knob's `points`, or one of `combinations` under a name of its own."""
    value = entry.get("value")
    return Point(
        text=text,
        number=float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None,
        cost=float(entry["bake_seconds"] if baked else entry["ms"]),
        low=None if baked else entry.get("ms_low"),
        high=None if baked else entry.get("ms_high"),
        rmse=float(entry["rmse"]),
        max_abs=float(entry["max_abs"]),
        flip=float(entry["flip"]),
        flip_everywhere=entry.get("flip_everywhere"),
        coverage=None if baked else entry.get("coverage"),
    )
