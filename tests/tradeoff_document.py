"""A small document as `fakesss tradeoff` writes it, of real pictures, with made-up times."""

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss import Scene, render
from fakesss.accuracy.errors import errors

Picture = NDArray[np.float32]
SCENE = Scene.from_dict({"object": "figure:4000", "size": [64, 64], "supersampling": 2}, "test")
SAMPLES = {1: 4.0, 2: 6.5, 3: 10.0, 4: 16.0, 8: 55.0}  # level -> ms
KINDS = {"none": ({"blur.enabled": False}, 5.0), "5x5": ({"blur.enabled": True}, 6.5)}

ORDER = {"fitted": 1.07, "expected": 1.0, "low": 0.9, "high": 1.2}
PUBLISHED = {"source": "somebody", "points": [{"value": n, "ms": 2.0 * n, "offline_s": 1.0} for n in (1, 2, 16)]}


def point(value: int | str, ms: float, picture: Picture, reference: Picture, **settings: Any) -> dict[str, Any]:
    """A level of a knob, as the document holds it."""
    found = errors(picture, reference)
    return {
        "value": value, "settings": settings, "ms": ms, "ms_low": 0.95 * ms, "ms_high": 1.06 * ms, "rmse": found.rmse,
        "max_abs": found.max_abs, "flip": found.flip, "flip_everywhere": found.flip_everywhere, "coverage": 0.965,
    }  # fmt: skip


def knob(name: str, points: list[dict[str, Any]], recommended: int | str, **more: Any) -> dict[str, Any]:
    """A knob whose last level is the reference."""
    values = [each["value"] for each in points]
    return {
        "name": name, "sets": list(points[0]["settings"]), "reference": values[-1], "error": "edges", "points": points,
        "pareto": values, "recommended": recommended, "because": "cheapest that nobody tells apart", "order": None,
        **more,
    }  # fmt: skip


@cache
def small() -> tuple[dict[str, Any], dict[tuple[str, str], Picture]]:
    """The document of two knobs, and its pictures."""
    drawn = {n: render(SCENE.replace({"supersampling": n})) for n in SAMPLES}
    kinds = {name: render(SCENE.replace(settings)) for name, (settings, _) in KINDS.items()}
    samples = [point(n, ms, drawn[n], drawn[8], supersampling=n) for n, ms in SAMPLES.items()]
    blurs = [point(name, ms, kinds[name], kinds["5x5"], **settings) for name, (settings, ms) in KINDS.items()]
    combinations = [
        {**{key: value for key, value in each.items() if key != "value"},
         "values": {"supersampling": each["value"], "blur kernel": "5x5"},
         "settings": {"supersampling": each["value"], "blur.enabled": True, "layers.faces": None}, "front": True,
         "from_reference": {key: each[key] / 2 for key in ("rmse", "max_abs", "flip", "flip_everywhere")}}
        for each in samples[:-1]
    ]  # fmt: skip
    document = {
        "scene": "figure:4000",
        "knobs": [
            knob(
                "supersampling",
                samples,
                3,
                order=ORDER,
                published=PUBLISHED,
            ),
            knob("blur kernel", blurs, "5x5"),
        ],
        "combinations": combinations,
        "presets": {
            name: {**entry, "because": why, "met": True}
            for name, entry, why in zip(
                ("interactive", "survey", "reference"), combinations[1:], ("fast", "alike", "best"), strict=True
            )
        },
        "machine": {"gl_renderer": "a renderer", "processor": "a processor", "cores": 2},
        "date": "2026-11-22",
        "method": ["15 rounds."],
        "warnings": ["Only two knobs."],
        "unused": [{"name": "shadow taps", "because": "shadow.enabled is false"}],
        "command": "fakesss tradeoff figure:4000 -o out",
    }
    pictures = {("supersampling", str(n)): picture for n, picture in drawn.items()}
    pictures["", "reference"] = drawn[8]
    return document, pictures | {("blur kernel", name): picture for name, picture in kinds.items()}
