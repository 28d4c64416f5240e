"""The sentences of the page of `fakesss tradeoff`."""

from collections.abc import Mapping, Sequence
from typing import Any

from fakesss.accuracy.page_curves import Curve
from fakesss.accuracy.page_numbers import duration, rounded


def lead(document: Mapping[str, Any]) -> str:
    """What was measured, of what, on what."""
    knobs: Sequence[Mapping[str, Any]] = document["knobs"]
    return (
        f"Every approximation that this scene uses has a knob: {and_list([str(knob['name']) for knob in knobs])}. Each "
        "was set to all its levels; what a picture then costs stands beside what it is off by."
    )


def findings(document: Mapping[str, Any]) -> list[str]:
    """What each preset costs and is off by, beside the one that is the most exact."""
    presets: Mapping[str, Mapping[str, Any]] = document["presets"]
    best = presets["reference"]["ms"]
    return [
        f"{name}: {duration(preset['ms'] / 1e3)} a picture{speed_up(best / preset['ms'])}. Against the exact picture "
        f"its mean FLIP is {rounded(preset['flip'])}, its RMSE {rounded(preset['rmse'])} in linear radiance, and FLIP "
        f"in 99.9 % of the pixels {rounded(preset['flip_everywhere'])}; that against the preset reference’s picture is "
        f"{rounded(preset['from_reference']['flip_everywhere'])}."
        for name, preset in presets.items()
    ]


def speed_up(ratio: float) -> str:
    """How many times as fast as the preset `reference`; nothing for that one itself."""
    return "" if ratio == 1 else f", {rounded(ratio, 2)} times as fast as the preset reference"


def knob_sentences(knob: Mapping[str, Any], curve: Curve) -> list[str]:
    """What is wrong at a lower level, which one is recommended and why, and how fast the error falls."""
    said = [
        f"What it is off by: {knob['error']}.",
        f"The reference is {curve.reference}; recommended is {curve.recommended}, {knob['because']}.",
    ]
    if knob["order"]:
        said.append(order_sentence(knob["order"]))
    return said


def order_sentence(order: Mapping[str, Any]) -> str:
    """The fitted order beside the expected one, with its interval if there is one."""
    interval = f" (95 % interval {order['low']:.2f} to {order['high']:.2f})" if "low" in order else ""
    return (
        f"Its RMSE falls as N to the power of −{order['fitted']:.2f}{interval}, N being its number; "
        f"−{order['expected']:.2f} is expected{missed(order)}."
    )


def missed(order: Mapping[str, Any]) -> str:
    """On which side the interval leaves the expected order out; nothing where it holds it."""
    if order.get("high", order["expected"]) < order["expected"]:
        return ", and not reached: the interval ends below"
    return ", and surpassed: the interval begins above" if order.get("low", 0) > order["expected"] else ""


def and_list(words: Sequence[str]) -> str:
    """a, b and c."""
    return " and ".join([", ".join(words[:-1]), words[-1]]) if len(words) > 1 else "".join(words)


def measured_on(document: Mapping[str, Any]) -> dict[str, str]:
    """When, and on what machine."""
    machine = {str(name).replace("_", " "): str(value) for name, value in document["machine"].items()}
    return {"date": str(document["date"]), **machine}


def counted(number: int, word: str) -> str:
    """1 knob, 2 knobs."""
    return f"{number:,} {word}" + ("" if number == 1 else "s")
