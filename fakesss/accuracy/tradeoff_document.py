"""The contract's `tradeoff` document, and the same as CSV and as a person reads it.

Of each scene:

    {"scene": name, "fields": {...}, "machine": {...}, "date", "command", "method": [sentences], "warnings": [...],
     "just_noticeable": FLIP, "baseline": {"settings": {path: value}, "ms"},
     "knobs": [{"name", "sets": [paths], "reference": value, "error": words, "baked": bool,
                "order": {"fitted", "low", "high", "expected"} | null,
                "points": [{"value", "settings": {path: value}, "ms", "ms_low", "ms_high", "ratio", "ratio_low",
                            "ratio_high", "bake_seconds" (baked knobs), "rmse", "max_abs", "flip", "flip_everywhere",
                            "total": {the four errors, against the exact picture}}],
                "pareto": [values], "recommended": value, "because": words,
                "published": {"source", "points": [{"value", "ms", "offline_s"}]} (where a seed printed a table)}],
     "unused": [{"name", "because"}],
     "combinations": [{"values": {knob: value}, "settings": {path: value}, times, errors, "front": bool,
                       "beside": {the four errors, against the picture with every knob at its reference}}],
     "presets": {"interactive" | "survey" | "reference": {a combination's keys, "because", "met": bool}}}

Errors of combinations and presets are against the exact picture.
"""

import csv
import datetime
import io
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from fakesss.accuracy.errors import JUST_NOTICEABLE, PIXELS_PER_DEGREE
from fakesss.accuracy.measuring_combinations import Combination
from fakesss.accuracy.pareto import non_dominated
from fakesss.accuracy.tradeoff import Found
from fakesss.bench import machine

PUBLISHED = {
    "screen-space samples": {
        "source": "Papanikolaou, Physically-principled character lighting and shading in real-time, 2013, sec. 7.1",
        "points": [
            {"value": samples, "ms": ms, "offline_s": seconds}
            for samples, ms, seconds in ((16, 3.0, 1), (32, 3.7, 2), (64, 5.2, 3), (128, 8.3, 5), (256, 14.2, 9))
        ],
    }
}
COLUMNS = ("ms", "ms_low", "ms_high", "ratio", "ratio_low", "ratio_high", "bake_seconds")
ERRORS = ("rmse", "max_abs", "flip", "flip_everywhere")


def documents(found: Found, names: Sequence[str], command: str) -> list[dict[str, Any]]:
    """One of each scene, `names` being what they were called on the command line."""
    return [document(found, number, name, command) for number, name in enumerate(names)]


def document(found: Found, number: int, name: str, command: str) -> dict[str, Any]:
    """Of one scene."""
    place, scene = found.places[number], found.scenes[number]
    here = [alone(one, number) for one in found.measured]
    best = set(non_dominated([one.costs[:2] for one in here]))
    return {
        "scene": name,
        "fields": scene.model_dump(mode="json"),
        **measured_by(command),
        "method": method(found),
        "warnings": warnings(found),
        "just_noticeable": JUST_NOTICEABLE,
        "baseline": {"settings": changed(scene, place.rig.scene), "ms": place.baseline_ms},
        "knobs": [
            {**curve.facts(), **({"published": PUBLISHED[name]} if name in PUBLISHED else {})}
            for name, curve in place.curves.items()
        ],
        "unused": [
            {"name": knob.name, "because": knob.unused(scene)} for knob in found.asked if knob.name not in place.curves
        ],
        "combinations": [{**one.facts(), "front": rank in best} for rank, one in enumerate(here)],
        "presets": {
            name: replace(preset, combination=alone(preset.combination, number)).facts()
            for name, preset in found.presets.items()
        },
    }


def alone(combination: Combination, number: int) -> Combination:
    """As measured in one of the scenes."""
    return replace(
        combination,
        timings=(combination.timings[number],),
        errors=(combination.errors[number],),
        beside=(combination.beside[number],),
    )


def measured_by(command: str) -> dict[str, Any]:
    """On what, when, and how to do it again."""
    load = {"load": round(os.getloadavg()[0], 1)} if hasattr(os, "getloadavg") else {}
    today = datetime.datetime.now(datetime.UTC).date().isoformat()
    return {"machine": {**machine(), **load}, "date": today, "command": command}


def changed(scene: Any, other: Any) -> dict[str, Any]:
    """The fields, by path, in which `other` is not `scene`."""
    before, after = dict(flat(scene.model_dump(mode="json"))), dict(flat(other.model_dump(mode="json")))
    return {path: value for path, value in after.items() if before.get(path) != value}


def flat(data: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Paths and values of nested tables."""
    for name, value in data.items():
        if isinstance(value, Mapping):
            yield from flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value


def method(found: Found) -> list[str]:
    """What the numbers are."""
    return [
        f"A picture's time is that of processor and GPU until it is finished, not read back. Each level and a fixed "
        f"baseline are drawn in turn, {found.effort.rounds} rounds in one run; the ratio to the baseline is the "
        "median over rounds, its band holds the true median with 95% confidence, and milliseconds are the ratio times "
        "the baseline's median.",
        "While one knob is measured the others are at their reference, except supersampling and screen-space samples, "
        "which multiply all other costs and stay at 3 and 64.",
        "A knob's own error is the difference from the same picture with the knob at its reference; errors of "
        "combinations and presets, and `total`, are against the exact picture: sight, thickness, softening, occlusion "
        "and shadows by rays, 8 x 8 samples a pixel.",
        "RMSE and the largest error are of linear radiance over covered pixels. FLIP is of the displayed 8-bit picture "
        f"at {PIXELS_PER_DEGREE:.0f} pixels per degree; {JUST_NOTICEABLE:.3f} counts as just noticeable, and "
        '"everywhere" means in 99.9% of the covered pixels.',
        "What is baked is told in seconds without any cache; in a picture it costs nothing, so its recommended level "
        "stays below a third of the just noticeable FLIP, and leaves room to what does cost.",
        f"Combinations: Pareto local search, at most {found.effort.combinations} looked at; what nothing beats was "
        "measured again in turn. Baked knobs stay at their recommended level. `beside` is against the picture with "
        "every knob at its reference, which the preset survey is held to: what no knob mends, it need not mend.",
    ]


def warnings(found: Found) -> list[str]:
    """What a reader should know before trusting the presets."""
    return [f"{name}: {preset.because}." for name, preset in found.presets.items() if not preset.met]


def as_csv(document: Mapping[str, Any]) -> str:
    """One row a level: knob, value, reference, times, its own errors and the total ones."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["knob", "value", "reference", *COLUMNS, *ERRORS, *(f"total_{name}" for name in ERRORS)])
    for knob in document["knobs"]:
        for point in knob["points"]:
            numbers = [*(point.get(name, "") for name in COLUMNS), *(point[name] for name in ERRORS)]
            total = [point["total"][name] for name in ERRORS]
            writer.writerow([knob["name"], point["value"], knob["reference"], *numbers, *total])
    return out.getvalue()


def as_text(document: Mapping[str, Any]) -> str:
    """What a terminal shows."""
    return "\n".join([*(line for knob in document["knobs"] for line in knob_lines(knob)), *preset_lines(document)])


def knob_lines(knob: Mapping[str, Any]) -> Iterator[str]:
    """A knob's table."""
    order = f", order {knob['order']['fitted']:.2f}" if knob["order"] else ""
    yield f"{knob['name'].upper()}  against {knob['reference']}{order}; recommended: {knob['recommended']}"
    cost = "bake s" if knob["baked"] else "ms"
    yield f"  {'':12}{cost:>10}{'ratio':>8}{'95% band':>16}{'RMSE':>10}{'largest':>9}{'FLIP':>9}{'everywhere':>12}"
    for point in knob["points"]:
        time = point["bake_seconds"] if knob["baked"] else point["ms"]
        band = f"{point['ratio_low']:.2f} to {point['ratio_high']:.2f}"
        numbers = (
            f"{point['rmse']:>10.2g}{point['max_abs']:>9.2g}{point['flip']:>9.4f}{point['flip_everywhere']:>12.3f}"
        )
        yield f"  {point['value']!s:12}{time:>10.2f}{point['ratio']:>8.2f}{band:>16}{numbers}"


def preset_lines(document: Mapping[str, Any]) -> Iterator[str]:
    """The presets' settings, and what they are."""
    for name, preset in document["presets"].items():
        figures = f"{preset['ms']:.1f} ms, FLIP {preset['flip']:.4f}, everywhere {preset['flip_everywhere']:.3f}"
        yield f"{name.upper()}  {figures}: {preset['because']}"
        yield "  " + ", ".join(f"{knob} {value}" for knob, value in preset["values"].items())
