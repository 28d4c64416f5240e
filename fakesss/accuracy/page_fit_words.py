"""Sentences and tables of the page of `fakesss fit`."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import tomli_w

from fakesss.accuracy.page_numbers import duration, rounded
from fakesss.accuracy.page_parts import Table
from fakesss.accuracy.page_words import measured_on
from fakesss.scene import Material

PREFIX = "material."
WHERE = {"thickness": "where the object is {} to {} sphere diameters thick", "n_dot_l": "where N·L is {} to {}"}


def parameters_table(document: Mapping[str, Any]) -> Table:
    """Every fitted field beside what it started from, with its bounds and standard error; a colour by channels."""
    rows = []
    for path, entry in document["parameters"].items():
        name = path.removeprefix(PREFIX)
        several = isinstance(entry["fitted"], list)
        for place in range(3) if several else [None]:
            values = {key: value if place is None or value is None else value[place] for key, value in entry.items()}
            rows.append([name if place is None else f"{name}, {'RGB'[place]}", symbol(name), *row_of(values)])
    thickness = document["thickness"]
    rows.append(["thickness", "t", thickness["start"], thickness["fitted"], "", ""])
    return Table(
        "table-parameters", "Parameters of the shader, equation 3.6",
        ["parameter", "symbol", "start", "fitted", "standard error", "bounds"], rows, text_columns=2,
        note="The standard error is what another rendering of the target, with as many samples, would change; a "
        "parameter without one was held, ended at a bound, or is not in the picture.",
    )  # fmt: skip


def row_of(values: Mapping[str, Any]) -> list[str]:
    """Start, fitted, standard error and bounds of one number."""
    error = "" if values["standard_error"] is None else f"± {rounded(values['standard_error'], 2)}"
    bounds = f"{rounded(values['low'])} to {rounded(values['high'])}"
    return [rounded(values["start"], 4), rounded(values["fitted"], 4), error, bounds]


def symbol(name: str) -> str:
    """The one of equation 3.6 for a field of the material, as its description has it."""
    found = re.search(r"\[(\w+)\]", Material.model_fields[name].description or "")
    return found[1] if found else ""


def findings(document: Mapping[str, Any]) -> list[str]:
    """The one sentence; how near, beside the start and the noise; where the rest lies."""
    start, noise = document["start_errors"], document["noise"]
    near = (
        f"The fitted picture is {rounded(document['rmse'])} in RMSE and {rounded(document['flip'])} in mean FLIP from "
        f"the path-traced one; the start was {rounded(start['rmse'])} and {rounded(start['flip'])}. The target’s noise "
        f"alone makes {rounded(noise['rmse'])} and {rounded(noise['flip'])}: an RMSE of "
        f"{rounded(noise['misfit_rmse'])} is what no parameters match."
    )
    return [document["sentence"], near, *left_over(document["leftover"])]


def left_over(leftover: Mapping[str, Sequence[Mapping[str, Any]]]) -> list[str]:
    """Where most of the error is, beside how much of the picture that is; nothing where there is none."""
    said = []
    for name, words in WHERE.items():
        known = [each for each in leftover.get(name, ()) if each["share"] is not None]
        if known:
            worst = max(known, key=lambda each: each["share"] - each["pixels"])
            where = words.format(rounded(worst["from"]), rounded(worst["to"]))
            said.append(f"{worst['share']:.0%} {where}, in {worst['pixels']:.0%} of the pixels")
    return [f"Of the squared error that is left: {'; '.join(said)}."] if said else []


def leftover_table(name: str, title: str, bins: Sequence[Mapping[str, Any]]) -> Table:
    """Every stretch of one quantity: shares, and the mean error by channel."""
    rows = [
        [f"{rounded(each['from'])} to {rounded(each['to'])}", f"{each['pixels']:.1%}",
         "" if each["share"] is None else f"{each['share']:.1%}", *(rounded(value) for value in each["mean_error"])]
        for each in bins
    ]  # fmt: skip
    return Table(
        f"table-{name.replace('_', '-')}", f"What is left, by {title}",
        [title, "of the pixels", "of the squared error", "mean error, R", "G", "B"], rows,
        note="Errors are signed, positive where the shader is too bright. A share just below 0 is within the noise.",
    )  # fmt: skip


def starts_table(starts: Sequence[Mapping[str, Any]]) -> Table:
    """Where each start ended."""
    names = ("thickness_exponent", "backlight", "diffuse_contribution", "ambient")
    rows = [
        [str(number), each["thickness"], rounded(each["start"][names[0]]),
         *(rounded(each["ended"][name]) for name in names),
         " ".join(rounded(value, 2) for value in each["ended"]["diffuse"]), rounded(each["rmse"], 4),
         str(each["evaluations"]), "converged" if each["converged"] else "stopped"]
        for number, each in enumerate(starts, 1)
    ]  # fmt: skip
    least = min(range(len(starts)), key=lambda number: starts[number]["rmse"])
    return Table(
        "table-starts", "Starts, and where each ended",
        ["start", "thickness", "r before", "r", "wb", "wd", "ka", "Kd", "RMSE", "evaluations", "ended"], rows,
        text_columns=2, chosen=least,
        note="The first start of each kind of thickness is derived from the medium; the others are spread.",
    )  # fmt: skip


def times_table(document: Mapping[str, Any]) -> Table:
    """Seconds of the shader, of the target, and of path tracing that is as near to the target."""
    seconds, equal = document["seconds"], document["matched"]
    samples = f"{document['noise']['samples']:,.0f} samples a pixel"
    as_near = f"{equal['bound']} {equal['samples']:,.0f} samples a pixel".strip()
    rows = [
        ["the fitted shader", "", duration(seconds["shader"]), "1"],
        ["path tracing, as near to the target", as_near, duration(equal["seconds"]), rounded(equal["speed_up"])],
        ["path tracing, the target", samples, duration(seconds["path_traced"]), rounded(document["speed_up"])],
        ["finding the parameters, once", "", duration(seconds["fit"]), rounded(seconds["fit"] / seconds["shader"])],
    ]
    return Table("table-times", "Times", ["what", "with", "time", "times the shader’s"], rows, text_columns=2)


def material_toml(document: Mapping[str, Any]) -> str:
    """The fitted material as a scene's file has it."""
    fitted = {path.removeprefix(PREFIX): entry["fitted"] for path, entry in document["parameters"].items()}
    return tomli_w.dumps({"material": {**fitted, "thickness": document["thickness"]["fitted"]}})


def session(document: Mapping[str, Any]) -> dict[str, str]:
    """Scene, medium and what traced and drew it."""
    target = document["target"]
    scattering, absorption = (" ".join(map(rounded, target[name])) for name in ("sigma_s_prime", "sigma_a"))
    return {
        "scene": f"{document['scene']}, {document['width']} × {document['height']} pixels",
        "medium": f"{document['medium']}, σs′ = {scattering}, σa = {absorption} per mm (RGB)",
        "size": f"{rounded(document['size_mm'])} mm across the bounding sphere",
        "path tracer": f"Mitsuba {target['mitsuba']}, {target['variant']}, {target['samples']:,} samples a pixel, "
        f"relative noise {rounded(document['noise']['relative'])}, seed {target['seed']}",
        "left out of the target": "; ".join(target["leaves_out"]),
        **measured_on(document),
    }
