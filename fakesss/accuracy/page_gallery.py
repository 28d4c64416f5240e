"""Every level of a knob as it looks: its picture, how it differs from the reference, and FLIP."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fakesss.accuracy.drawings_maps import (
    Frame,
    Thumbnail,
    difference_thumbnail,
    flip_thumbnail,
    frame_of,
    picture_thumbnail,
    scale_end,
)  # fmt: skip
from fakesss.accuracy.errors import flip_map
from fakesss.accuracy.page_curves import Curve, Point
from fakesss.accuracy.page_numbers import power_of_two, rounded
from fakesss.accuracy.page_parts import Scale, flip_scale
from fakesss.accuracy.page_tables import numbers_line

Picture = NDArray[np.float32]  # (H, W, 4), linear RGB and coverage
Pictures = Mapping[tuple[str, str], Picture]
REFERENCE = "reference"
BRIGHTEST = 99.9
"""Percentile of FLIP that ends its scale: a single pixel shall not darken all others."""


@dataclass(frozen=True)
class Shots:
    """One level: thumbnails with what they show in words, and its numbers."""

    name: str
    numbers: str
    chosen: bool
    picture: Thumbnail
    picture_alt: str
    picture_label: str
    difference: Thumbnail | None = None
    difference_alt: str = ""
    gain: str = ""
    flip: Thumbnail | None = None
    flip_alt: str = ""


@dataclass(frozen=True)
class Gallery:
    """The reference and every level, and the scale of the FLIP maps that they share."""

    levels: tuple[Shots, ...]
    scale: Scale


def gallery(curve: Curve, pictures: Pictures) -> Gallery | None:
    """What `pictures` hold of a knob, by its name and its values' text; None without a picture of its reference.

    The reference is the knob's own, or the one of all knobs, named ("", "reference").
    """
    own = ((curve.name, curve.reference), (curve.name, REFERENCE), ("", REFERENCE))
    reference = next((pictures[key] for key in own if key in pictures), None)
    if reference is None:
        return None
    frame = frame_of(reference)
    shown = [p for p in curve.points if (curve.name, p.text) in pictures and p.text != curve.reference]
    maps = {point.text: flip_map(pictures[curve.name, point.text], reference) for point in shown}
    most = scale_end(max((float(np.percentile(each, BRIGHTEST)) for each in maps.values()), default=0.0))
    levels = [
        shots(curve, point, pictures[curve.name, point.text], reference, maps[point.text], most, frame)
        for point in shown
    ]
    return Gallery((reference_shot(curve, reference, frame), *levels), flip_scale(most))


def reference_shot(curve: Curve, reference: Picture, frame: Frame) -> Shots:
    """What the others are compared with."""
    name = f"{curve.reference}: the reference"
    return Shots(
        name, numbers_line(curve, next((p for p in curve.points if p.text == curve.reference), None)),
        curve.recommended == curve.reference, picture_thumbnail(reference, frame),
        f"The reference, {curve.name} {curve.reference}", "picture",
    )  # fmt: skip


def shots(
    curve: Curve, point: Point, picture: Picture, reference: Picture, values: NDArray[np.float32], most: float,
    frame: Frame,
) -> Shots:  # fmt: skip
    """One level beside the reference."""
    difference, gain = difference_thumbnail(picture, reference, frame)
    said = "no difference" if gain is None else power_of_two(gain)
    what = f"{curve.name} {point.text}"
    return Shots(
        name=point.text,
        numbers=numbers_line(curve, point),
        chosen=point.text == curve.recommended,
        picture=picture_thumbnail(picture, frame),
        picture_alt=f"Picture at {what}",
        picture_label="picture",
        difference=difference,
        difference_alt=f"Signed difference from the reference at {what}: {said}",
        gain=said,
        flip=flip_thumbnail(values, most, frame),
        flip_alt=f"FLIP map at {what}, mean {rounded(point.flip)}",
    )
