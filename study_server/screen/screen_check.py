"""The screen check: what a participant's page may tell about the screen, checked, stored and exported.

Nothing here is compulsory and nothing is an error: what is missing or out of its range is left out, and the column
is empty. How each figure is come by is in templates/screen.html and static/screen_*.js.
"""

import math
import re
from collections.abc import Collection, Mapping
from typing import Any

import numpy as np
from sqlalchemy import Connection, RowMapping

from study_server.exports.columns import Column, flag
from study_server.manifest import BuiltStudy
from study_server.screen.plates import PLATES
from study_server.sessions import advance

CARD_MM = (85.60, 53.98)
"""A bank card: ISO/IEC 7810, size ID-1."""

DARK_STEPS = (2, 4, 6, 9, 13, 18, 25, 35)
"""sRGB values of the patches on black (0)."""

LIGHT_STEPS = (254, 253, 252, 251, 249, 247, 243, 239)
"""sRGB values of the patches on white (255)."""

MATCHES = (25, 50, 75)
"""Percent of the pattern's lines that are white (255), the others black (0)."""

UNTOLD = "not told by the browser, or withdrawn"
UNMADE = "left out, or withdrawn"
NOTHING = "nothing"
NUMBER = re.compile(r"[0-9]{1,6}(\.[0-9]{1,9})?")
ANSWER = re.compile(rf"[0-9]{{1,2}}|{NOTHING}")


def measured(description: str, unit: str, low: float, high: float, missing: str = UNTOLD) -> Column:
    """A number by the browser or the participant's hand."""
    return Column(description, "number", unit, low, high, missing=missing)


def counted(description: str, low: int, high: int, unit: str = "", missing: str = UNMADE) -> Column:
    """A whole number."""
    return Column(description, "integer", unit, low, high, missing=missing)


FACTS = {
    "width_px": counted("width of the screen, as the browser tells it", 1, 100_000, "CSS pixel", UNTOLD),
    "height_px": counted("height of the screen, as the browser tells it", 1, 100_000, "CSS pixel", UNTOLD),
    "device_width_px": measured("screen_width_px x screen_device_pixel_ratio: right at 100% page zoom, where browsers "
                                "agree", "device pixel", 0, 2_000_000),
    "device_height_px": measured("screen_height_px x screen_device_pixel_ratio", "device pixel", 0, 2_000_000),
    "window_width_px": counted("width of the window at the screen check", 1, 100_000, "CSS pixel", UNTOLD),
    "window_height_px": counted("height of the window at the screen check", 1, 100_000, "CSS pixel", UNTOLD),
    "device_pixel_ratio": measured("device pixels per CSS pixel at the screen check, zoom included", "", 0.1, 20),
    "zoom": measured("estimated page zoom at the screen check, 1 = 100%", "", 0.05, 20),
    "color_depth": counted("bits for one pixel's colour", 1, 128, "bit", UNTOLD),
    "gamut": Column("the widest gamut that the screen covers, as the browser tells it",
                    values=("srgb", "p3", "rec2020"), missing=UNTOLD),
    "dynamic_range_high": flag("1 if browser and screen show high dynamic range, 0 if not", UNTOLD),
}  # fmt: skip

CARD = {
    "card": Column("measured: a card was held to the screen and the rectangle made as large; unmoved: the rectangle "
                   "was left as it was; none: no card at hand", values=("measured", "unmoved", "none"), missing=UNMADE),
    "px_per_mm": measured("by hand: CSS pixels per millimetre of the screen", "CSS pixel / mm", 0.5, 15, UNMADE),
    "device_px_per_mm": measured("screen_px_per_mm x screen_device_pixel_ratio", "device pixel / mm", 0, 300, UNMADE),
}  # fmt: skip

WEDGE = {
    "dark_steps": counted(f"how many of the patches {', '.join(map(str, DARK_STEPS))} (sRGB) could be told from black",
                          0, len(DARK_STEPS)),
    "light_steps": counted(f"how many of the patches {', '.join(map(str, LIGHT_STEPS))} (sRGB) could be told from "
                           "white", 0, len(LIGHT_STEPS)),
    **{f"match_{percent}": counted(f"sRGB value that looked as bright as a pattern of {percent}% white and "
                                   f"{100 - percent}% black lines", 1, 254) for percent in MATCHES},
    "gamma": measured("ln 0.5 / ln(screen_match_50 / 255): exponent of the screen's response, estimated by eye; "
                      "sRGB: 2.2", "", 0, 200, UNMADE),
}  # fmt: skip

PLATE_COLUMNS = {
    f"plate_{index}{ending}": column
    for index, plate in enumerate(PLATES, 1)
    for ending, column in (
        ("", Column(f"the number read on colour plate {index} (it is {plate.number}), or {NOTHING}", missing=UNMADE)),
        ("_right", flag(f"1 if plate {index} was read rightly, 0 if not", UNMADE)),
    )
} | {"plates_right": counted("how many colour plates were read rightly; empty if no plate was answered",
                             0, len(PLATES))}  # fmt: skip

PARTS = {"facts": FACTS, "card": CARD, "wedge": WEDGE, "plates": PLATE_COLUMNS}
"""In the order of the page and of the columns. `facts` are told by the browser without asking anybody."""

DERIVED = {"device_width_px", "device_height_px", "device_px_per_mm", "gamma"} | {
    name for name in PLATE_COLUMNS if name.endswith("_right")
}
"""Computed here from what was posted; posting them is of no use."""


def asked(parts: Collection[str]) -> dict[str, Column]:
    """Everything that is known after a check of these parts, without the prefix `screen_`; nothing without a check."""
    chosen = [part for part in PARTS if parts and (part == "facts" or part in parts)]
    return {name: column for part in chosen for name, column in PARTS[part].items()}


def columns(parts: Collection[str]) -> dict[str, Column]:
    """The columns that a study's `screen_check` adds to participants.csv, whoever did it."""
    return {f"screen_{name}": column for name, column in asked(parts).items()}


def accepted(column: Column, text: str) -> str | float | None:
    """A posted value as it is stored; None if it is none, or out of its range."""
    if column.type == "text":
        return text if (text in column.values if column.values else ANSWER.fullmatch(text)) else None
    if not NUMBER.fullmatch(text):
        return None
    value = float(text)
    low, high = column.minimum, column.maximum
    fits = text in column.values if column.values else (low is None or low <= value) and (high is None or value <= high)
    if not fits or (column.type == "integer" and not value.is_integer()):
        return None
    return int(value) if column.type == "integer" else value


def found(values: Mapping[str, str], parts: Collection[str]) -> dict[str, Any]:
    """What is stored of a posted form: the known values of these parts, and what follows from them."""
    told: dict[str, Any] = {}
    for name, column in asked(parts).items():
        value = None if name in DERIVED else accepted(column, values.get(name, "").strip())
        if value is not None:
            told[name] = value
    return told | derived(told)


def derived(told: Mapping[str, Any]) -> dict[str, Any]:
    """What follows from posted values."""
    follows: dict[str, Any] = {}
    ratio = told.get("device_pixel_ratio")
    for name in ("width_px", "height_px", "px_per_mm"):
        if ratio and name in told:
            follows[f"device_{name}"] = round(told[name] * ratio, 4)
    if "match_50" in told:
        follows["gamma"] = round(gamma(told["match_50"]), 4)
    right = {
        f"plate_{index}_right": int(told[f"plate_{index}"].lstrip("0") == plate.number)
        for index, plate in enumerate(PLATES, 1)
        if f"plate_{index}" in told
    }
    return follows | right | ({"plates_right": sum(right.values())} if right else {})


def gamma(value: float, share: float = 0.5) -> float:
    """The exponent for which sRGB value `value` (1..254) has `share` (0..1) of the luminance of 255."""
    return math.log(share) / math.log(value / 255)


def page(parts: Collection[str]) -> dict[str, Any]:
    """What the page shows: which parts, and their patches and plates."""
    return {
        "parts": [part for part in PARTS if part in parts],
        "dark_steps": DARK_STEPS,
        "light_steps": LIGHT_STEPS,
        "matches": MATCHES,
        "plates": len(PLATES),
    }


def leave_screen(
    connection: Connection, study: BuiltStudy, session: RowMapping, values: Mapping[str, str], now: float
) -> None:
    """Keeps what the screen check found, and leads on whatever that is."""
    told = found(values, study.settings.survey.screen_check)
    advance(connection, session, now, step="instructions", screen=told)


def simulated(random: np.random.Generator, parts: Collection[str]) -> dict[str, str]:
    """What a simulated participant posts: an ordinary screen; one in twenty reads no red-green plate."""
    exponent = random.normal(2.2, 0.15)
    reads_all = random.random() > 0.05
    told = {
        "width_px": 1920, "height_px": 1080, "window_width_px": 1280, "window_height_px": 800,
        "device_pixel_ratio": 1, "zoom": 1, "color_depth": 24, "gamut": "srgb", "dynamic_range_high": 0,
        "card": "measured", "px_per_mm": round(random.normal(3.7, 0.3), 3),
        "dark_steps": random.integers(4, 9), "light_steps": random.integers(5, 9),
        **{f"match_{percent}": round(255 * (percent / 100) ** (1 / exponent)) for percent in MATCHES},
        **{f"plate_{index}": plate.number if reads_all or plate.cone is None else NOTHING
           for index, plate in enumerate(PLATES, 1)},
    }  # fmt: skip
    return {name: str(told[name]) for name in asked(parts) if name in told}
