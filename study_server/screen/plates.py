"""Pseudo-isochromatic plates: discs of dots in which a red-green deficient eye finds no number.

Figure and ground differ in the excitation of one cone type alone, so a dichromat without that type gets the same
signals from both: a confusion line, as in Ishihara's plates. Where the dots lie does not depend on the number, and
each dot has a luminance of its own, so that neither texture nor brightness gives it away.

What it is not: a diagnosis. Screens differ from sRGB, people's lenses and cones differ from the standard observer,
and nobody controls the room's light. Blue-yellow (tritan) deficiency is not looked for: inherited it is rarer than
1 in 10,000.
"""

from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from fastapi import APIRouter, Request, Response

from study_server.site import sorry

router = APIRouter()

Array = np.ndarray[Any, np.dtype[np.float64]]

# IEC 61966-2-1: linear sRGB to CIE 1931 XYZ.
XYZ_FROM_RGB = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])

# Smith and Pokorny's (1975) cone fundamentals as in Vienot, Brettel and Mollon 1999, "Digital video colourmaps for
# checking the legibility of displays by dichromats", Color Research & Application 24 (4), 243-252; L + M = Y.
LMS_FROM_XYZ = np.array([[0.15514, 0.54312, -0.03286], [-0.15514, 0.45684, 0.03286], [0.0, 0.0, 0.01608]])

LMS_FROM_RGB: Array = LMS_FROM_XYZ @ XYZ_FROM_RGB

MEAN_RGB = np.array([0.33, 0.30, 0.20])
"""Linear sRGB half-way between figure and ground: a greyish yellow, near the middle of what screens can show."""

RED_STEP = 0.16
"""Half the difference between figure and ground in linear sRGB red; CIELAB difference about 40."""

NOISE = (0.5, 1.5)
"""Each dot's luminance is its colour's times a factor from here; figure and ground have the same ones, shuffled."""

RADIUS = 160.0
"""Of a plate, in its own units, at which it is also shown: CSS px."""

DOT_RADII = (7.0, 6.0, 5.0, 4.2, 3.5, 2.8)
GAP = 0.8
TRIES = 4000
"""How often a place is drawn for a dot of each radius."""

DIGIT_HEIGHT = 150.0
DIGIT_GAP = 36.0
STROKE = 16.0
"""Half the width of a digit's stroke."""

# Strokes in a box of width 0.6 and height 1, y downwards.
DIGITS: dict[str, list[tuple[float, float]]] = {
    "1": [(0.12, 0.22), (0.36, 0.0), (0.36, 1.0)],
    "2": [(0.04, 0.26), (0.1, 0.1), (0.3, 0.0), (0.5, 0.1), (0.56, 0.28), (0.46, 0.5), (0.04, 1.0), (0.6, 1.0)],
    "3": [(0.05, 0.1), (0.3, 0.0), (0.5, 0.1), (0.54, 0.26), (0.45, 0.42), (0.26, 0.47), (0.48, 0.55), (0.58, 0.74),
          (0.5, 0.92), (0.3, 1.0), (0.04, 0.9)],
    "4": [(0.46, 1.0), (0.46, 0.0), (0.0, 0.68), (0.6, 0.68)],
    "5": [(0.56, 0.0), (0.12, 0.0), (0.08, 0.44), (0.3, 0.37), (0.5, 0.48), (0.58, 0.68), (0.5, 0.9), (0.3, 1.0),
          (0.03, 0.92)],
    "7": [(0.0, 0.0), (0.58, 0.0), (0.22, 1.0)],
}  # fmt: skip


@dataclass(frozen=True)
class Plate:
    """One plate. `cone`: 0 L (protan), 1 M (deutan), or None for the control, which differs in brightness too."""

    number: str
    cone: int | None


PLATES = (Plate("12", None), Plate("47", 0), Plate("53", 1), Plate("25", 1), Plate("74", 0))
"""In the order of showing; the first one is for everybody, and who cannot read it did not look or cannot see it."""


@dataclass(frozen=True)
class Dots:
    """Centres (n, 2) and radii (n,) in plate units from the plate's middle; `figure` (n,) which belong to the number;
    `rgb` (n, 3) linear sRGB, 0..1."""

    centres: Array
    radii: Array
    figure: np.ndarray[Any, np.dtype[np.bool_]]
    rgb: Array


@router.get("/plate/{index}.svg")
def plate(request: Request, index: str) -> Response:
    """Plate 1, 2, ... as SVG; 404 for any other."""
    known = {str(place): place for place in range(1, len(PLATES) + 1)}
    if index not in known:
        return sorry(request, 404, "There is no such plate.")
    return Response(svg(known[index]), media_type="image/svg+xml", headers={"Cache-Control": "public, max-age=3600"})


def colours(cone: int | None) -> tuple[Array, Array]:
    """Figure's and ground's linear sRGB: equal in the other two cones' excitations; for the control, orange on blue."""
    if cone is None:
        return np.array([0.75, 0.45, 0.12]), np.array([0.12, 0.18, 0.32])
    alone = np.linalg.inv(LMS_FROM_RGB)[:, cone]  # the change of linear RGB that this cone type alone notices
    step = RED_STEP * alone / alone[0]
    return MEAN_RGB + step, MEAN_RGB - step


@cache
def dots(index: int) -> Dots:
    """Plate `index` (1, 2, ...), the same at every call."""
    plate = PLATES[index - 1]
    random = np.random.default_rng([1917, index])  # the year of Ishihara's plates
    centres, radii = packed(random)
    figure = distance_to_number(plate.number, centres) < STROKE
    of_figure, of_ground = colours(plate.cone)
    rgb = np.where(figure[:, None], of_figure, of_ground)
    for part in (figure, ~figure):
        rgb[part] *= random.permutation(np.linspace(*NOISE, int(part.sum())))[:, None]
    return Dots(centres, radii, figure, np.clip(rgb, 0, 1))


def packed(random: np.random.Generator) -> tuple[Array, Array]:
    """Dots that do not touch, large ones first, thrown until there is hardly room: centres (n, 2) and radii (n,)."""
    centres, radii = np.empty((0, 2)), np.empty(0)
    for radius in DOT_RADII:
        for x, y in random.uniform(-RADIUS, RADIUS, (TRIES, 2)):
            inside = np.hypot(x, y) + radius < RADIUS
            if inside and np.all(np.hypot(*(centres - (x, y)).T) > radii + radius + GAP):
                centres, radii = np.vstack([centres, (x, y)]), np.append(radii, radius)
    return centres, radii


def distance_to_number(number: str, points: Array) -> Array:
    """Distance (n,) of `points` (n, 2) to the middle of the nearest stroke, the number centred on the plate."""
    width = 0.6 * DIGIT_HEIGHT
    left = -(len(number) * width + (len(number) - 1) * DIGIT_GAP) / 2
    nearest = np.full(len(points), np.inf)
    for place, digit in enumerate(number):
        corner = np.array([left + place * (width + DIGIT_GAP), -DIGIT_HEIGHT / 2])
        for start, end in pairwise(np.array(DIGITS[digit]) * DIGIT_HEIGHT + corner):
            along = np.clip((points - start) @ (end - start) / np.sum((end - start) ** 2), 0, 1)
            nearest = np.minimum(nearest, np.hypot(*(points - start - along[:, None] * (end - start)).T))
    return nearest


def srgb_bytes(rgb: Array) -> np.ndarray[Any, np.dtype[np.uint8]]:
    """Linear sRGB 0..1 as 8-bit sRGB (IEC 61966-2-1)."""
    encoded = np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * np.maximum(rgb, 0.0031308) ** (1 / 2.4) - 0.055)
    return np.round(255 * encoded).astype(np.uint8)


@cache
def svg(index: int) -> str:
    """Plate `index` (1, 2, ...) as a picture without a word in it."""
    drawn = dots(index)
    circles = "".join(
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:g}" fill="#{bytes(colour).hex()}"/>'
        for (x, y), radius, colour in zip(drawn.centres, drawn.radii, srgb_bytes(drawn.rgb), strict=True)
    )
    size = f"{-RADIUS:g} {-RADIUS:g} {2 * RADIUS:g} {2 * RADIUS:g}"
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{size}">{circles}</svg>'
