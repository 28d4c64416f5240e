"""The contract's `tradeoff` document, and the same as CSV and as a person reads it.

Of each scene:

    {"scene": name, "fields": {...}, "machine": {...}, "date", "command", "method": [sentences], "warnings": [...],
     "just_noticeable": FLIP, "baseline": {"settings": {path: value}, "ms"},
     "knobs": [{"name", "sets": [paths], "reference": value, "error": words, "baked": bool,
                "order": {"fitted", "low", "high", "expected"} | null,
                "points": [{"value", "settings": {path: value}, "ms", "ms_low", "ms_high", "ratio", "ratio_low",
                            "ratio_high", "coverage", "bake_seconds" (baked knobs), the four errors "rmse", "max_abs",
                            "flip", "flip_everywhere",
                            "total": {the four errors, against the exact picture}}],
                "pareto": [values], "recommended": value, "because": words,
                "published": {"source", "points": [{"value", "ms", "offline_s"}]} (where a seed printed a table)}],
     "unused": [{"name", "because"}],
     "combinations": [{"values": {knob: value}, "settings": {path: value}, times, errors, "front": bool,
                       "from_reference": {the four errors, against the picture with every knob at its reference}}],
     "presets": {"interactive" | "survey" | "reference": {a combination's keys, "because", "met": bool}}}

Errors of combinations and presets are against the exact picture. The band from `ms_low` to `ms_high` holds the true
median as often as `coverage` says, 0 to 1.
"""

import csv
import datetime
import io
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from fakesss.accuracy.errors import JUST_NOTICEABLE, PIXELS_PER_DEGREE
from fakesss.accuracy.measuring import coverage, load_now
from fakesss.accuracy.measuring_combinations import LOOKS, Combination
from fakesss.accuracy.measuring_knobs import ERRORS
from fakesss.accuracy.pareto import unbeaten
from fakesss.accuracy.tradeoff import Effort, Found
from fakesss.accuracy.tradeoff_search import ALIKE
from fakesss.bench import machine
from fakesss.knob import Knob

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


def documents(found: Found, names: Sequence[str], command: str) -> list[dict[str, Any]]:
    """One of each scene, `names` being what they were called on the command line."""
    return [document(found, number, name, command) for number, name in enumerate(names)]


def document(found: Found, number: int, name: str, command: str) -> dict[str, Any]:
    """Of one scene."""
    place, scene = found.places[number], found.scenes[number]
    here = [alone(one, number) for one in found.measured]
    best = set(unbeaten([(one.error("flip"),) for one in here], lambda a, b: here[a].faster(here[b])))
    return {
        "scene": name,
        "fields": scene.model_dump(mode="json"),
        **measured_by(command, found.load),
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
        from_reference=(combination.from_reference[number],),
    )


def measured_by(command: str, load: float | None = None) -> dict[str, Any]:
    """On what, under which `load` (that of now, where none is given), when, and how to do it again."""
    load = load_now() if load is None else load
    under = {} if load is None else {"load": load}
    today = datetime.datetime.now(datetime.UTC).date().isoformat()
    return {"machine": {**machine(), **under}, "date": today, "command": command}


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
        *times_of(found.effort),
        others_of(found.combinations.knobs),
        "A knob's own error is the difference from the same picture with the knob at its reference; errors of "
        "combinations and presets, and `total`, are against the exact picture: sight, thickness, softening, occlusion "
        "and shadows by rays, 8 x 8 samples a pixel.",
        "RMSE and the largest error are of linear radiance over covered pixels. FLIP is of the displayed 8-bit picture "
        f"at {PIXELS_PER_DEGREE:.0f} pixels per degree; {JUST_NOTICEABLE:.3f} counts as just noticeable, and "
        '"everywhere" means in 99.9% of the covered pixels.',
        "What is baked is told in seconds without any cache; in a picture it costs nothing, so its recommended level "
        "stays below a third of the just noticeable FLIP, and leaves room to what does cost.",
        f"Combinations: Pareto local search, {found.effort.combinations} looked at, and what is cheaper than the "
        f"cheapest that is not noticeably off; in {LOOKS} rounds, so times within {ALIKE - 1:.0%} of each other count "
        "as equal. What nothing beats was measured again in turn. Baked knobs stay at their recommended level. "
        "`from_reference` is against the picture with every knob at its reference, which the preset survey is held to: "
        "what no knob mends, it need not mend.",
    ]


def times_of(effort: Effort) -> list[str]:
    """How times were measured, and how sure they are."""
    return [
        "A picture's time is that of processor and GPU until it is finished, not read back. In each round every level "
        "is drawn once, in an order of the round's own, between two pictures of a fixed baseline; what counts is the "
        "ratio to their mean, its median over rounds, and milliseconds are that times the baseline's median.",
        f"Levels of a knob were drawn in {effort.rounds} rounds, so that bands hold the true median in "
        f"{coverage(effort.rounds):.1%} of all cases; combinations in {effort.again}, {coverage(effort.again):.1%}. "
        "Two times count as different if such a band of their ratios, round by round, excludes 1; else the smaller "
        "error decides.",
    ]


def others_of(knobs: Sequence[Knob]) -> str:
    """Where the others stand while one knob is measured."""
    elsewhere = [f"{knob.name} ({knob.beside})" for knob in knobs if knob.beside is not None]
    rest = f", except {' and '.join([', '.join(elsewhere[:-1])] * (len(elsewhere) > 1) + elsewhere[-1:])}"
    return f"While one knob is measured the others are at their references{rest if elsewhere else ''}."


def warnings(found: Found) -> list[str]:
    """What a reader should know before trusting the presets."""
    return [f"{name}: {preset.because}." for name, preset in found.presets.items() if not preset.met]


def as_csv(document: Mapping[str, Any]) -> str:
    """One row a level and a preset: knob, value, reference, times, errors against that reference and the total ones.

    The reference of a preset is the picture of the preset `reference`; total errors are against the exact picture.
    """
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["knob", "value", "reference", *COLUMNS, *ERRORS, *(f"total_{name}" for name in ERRORS)])
    for knob in document["knobs"]:
        for point in knob["points"]:
            numbers = [*(point.get(name, "") for name in COLUMNS), *(point[name] for name in ERRORS)]
            total = [point["total"][name] for name in ERRORS]
            writer.writerow([knob["name"], point["value"], knob["reference"], *numbers, *total])
    for name, preset in document["presets"].items():
        numbers = [*(preset.get(column, "") for column in COLUMNS), *preset["from_reference"].values()]
        writer.writerow(["preset", name, "reference", *numbers, *(preset[error] for error in ERRORS)])
    return out.getvalue()


def as_text(document: Mapping[str, Any]) -> str:
    """What a terminal shows."""
    return "\n".join([*(line for knob in document["knobs"] for line in knob_lines(knob)), *preset_lines(document)])


def knob_lines(knob: Mapping[str, Any]) -> Iterator[str]:
    """A knob's table."""
    order = ", order {fitted:.2f} ({expected:.2f} expected)".format(**knob["order"]) if knob["order"] else ""
    yield f"{knob['name'].upper()}  against {knob['reference']}{order}; recommended: {knob['recommended']}"
    cost = "bake s" if knob["baked"] else "ms"
    band = f"{knob['points'][0]['coverage']:.1%} band"  # how often it holds the true median
    yield f"  {'':12}{cost:>10}{'ratio':>8}{band:>16}{'RMSE':>10}{'largest':>9}{'FLIP':>9}{'everywhere':>12}"
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
        yield f"{name.upper()}  {preset['ms']:.1f} ms: {preset['because']}"
        for what, found in (("exact picture", preset), ("reference preset", preset["from_reference"])):
            yield f"  from the {what}: FLIP {found['flip']:.4f}, everywhere {found['flip_everywhere']:.3f}"
        yield "  " + ", ".join(f"{knob} {value}" for knob, value in preset["values"].items())
