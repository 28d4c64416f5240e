"""The page of `fakesss fit`: how near the empirical shader comes to a path-traced medium, and what it cannot match."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.accuracy.drawings_fit import leftover_drawing, profile_drawing, starts_drawing, time_drawing
from fakesss.accuracy.drawings_maps import (
    Frame,
    Thumbnail,
    difference_thumbnail,
    flip_thumbnail,
    frame_of,
    picture_thumbnail,
    scale_end,
)
from fakesss.accuracy.errors import flip_map
from fakesss.accuracy.page_fit_words import (
    findings,
    leftover_table,
    material_toml,
    parameters_table,
    session,
    starts_table,
    times_table,
)
from fakesss.accuracy.page_gallery import BRIGHTEST
from fakesss.accuracy.page_numbers import power_of_two
from fakesss.accuracy.page_parts import flip_scale, signed_scale, write_files

Picture = NDArray[np.float32]  # (H, W, 4), linear RGB and coverage
SHOWN = {"start": "the shader as it started", "fitted": "the shader, fitted"}
LEFTOVER = {"thickness": "thickness, sphere diameters", "n_dot_l": "N·L"}
CONTENTS = (
    ("results", "Results first", False),
    ("pictures", "Pictures", False),
    ("parameters", "Parameters", False),
    ("leftover", "What is left", False),
    ("times", "Times", False),
    ("starts", "Starts", False),
    ("method", "What the numbers are", False),
    ("session", "Machine and command", False),
)


@dataclass(frozen=True)
class Shown:
    """A picture of the shader beside the target: itself, signed difference and FLIP, each with words."""

    name: str
    picture: Thumbnail
    difference: Thumbnail
    gain: str
    flip: Thumbnail


def write_fit_page(document: Mapping[str, Any], folder: Path, pictures: Mapping[str, Picture]) -> Path:
    """`folder`/index.html and figures/ from the document of `fakesss fit` (docs/accuracy.md); the page's path.

    `pictures`: "target", "fitted" and "start", (H, W, 4) float32, linear RGB and coverage. Equal input gives equal
    bytes. Raises `BadInput` where `folder` cannot be written.
    """
    figures = {
        "profiles": profile_drawing(pictures),
        "leftover": leftover_drawing(document["leftover"]),
        "times": time_drawing(document),
        "starts": starts_drawing(document["starts"]),
    }
    frame = frame_of(pictures["target"])
    maps = {name: flip_map(pictures[name], pictures["target"]) for name in SHOWN}
    most = scale_end(max(float(np.percentile(each, BRIGHTEST)) for each in maps.values()))
    context = {
        "title": f"The shader fitted to {document['medium']}",
        "kicker": "Model error",
        "byline": byline(document),
        "contents": CONTENTS,
        "findings": findings(document),
        "remarks": document["notes"],
        "target": picture_thumbnail(pictures["target"], frame),
        "shown": [shown(name, pictures, maps[name], most, frame) for name in SHOWN],
        "signed": signed_scale("target"),
        "flip": flip_scale(most),
        "figures": figures,
        "parameters": parameters_table(document),
        "toml": material_toml(document),
        "left": [leftover_table(name, title, document["leftover"][name]) for name, title in LEFTOVER.items()],
        "times": times_table(document),
        "starts": starts_table(document["starts"]),
        "method": document["method"],
        "session": session(document),
        "command": document["command"],
    }
    return write_files(folder, "fit.html", list(figures.values()), context)


def byline(document: Mapping[str, Any]) -> str:
    """Which object of which size, and how well the target was traced."""
    return f"{document['scene']} · {document['size_mm']:g} mm · {document['noise']['samples']:,.0f} samples a pixel"


def shown(name: str, pictures: Mapping[str, Picture], values: NDArray[Any], most: float, frame: Frame) -> Shown:
    """One of the shader's pictures."""
    difference, gain = difference_thumbnail(pictures[name], pictures["target"], frame)
    said = "no difference" if gain is None else power_of_two(gain)
    return Shown(
        SHOWN[name], picture_thumbnail(pictures[name], frame), difference, said, flip_thumbnail(values, most, frame)
    )
