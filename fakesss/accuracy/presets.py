"""Three settings of all knobs that are worth their time: `interactive`, `survey`, `reference`.

- `interactive`: the smallest mean FLIP within a budget of time for a picture.
- `survey`: the cheapest whose FLIP against `reference` stays below a just noticeable difference everywhere, that is in
  99.9% of the pixels (`errors.JUST_NOTICEABLE`, `errors.Errors.flip_everywhere`).
- `reference`: the best of every knob. How far that is from the exact picture no knob changes.

Of combinations whose times cannot be told apart the more exact is taken. Where nothing keeps the budget or the limit,
the nearest to it is taken, and the preset says so.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import tomli_w

from fakesss.accuracy.errors import JUST_NOTICEABLE
from fakesss.accuracy.measuring_combinations import Combination
from fakesss.accuracy.measuring_knobs import ERRORS, NEARER
from fakesss.knob import Knob

BUDGET_MS = 33.0  # thirty pictures a second
HEAD = """# Settings worth their time, for `quality` in a scene: written by the command below, not by hand.
# Of each preset: what it was measured to cost and to be off by, in the worst of the scenes; then the fields it sets.
"""


@dataclass(frozen=True)
class Preset:
    """A combination, and why it was taken."""

    combination: Combination
    because: str
    met: bool  # whether it keeps what it promises

    def facts(self) -> dict[str, Any]:
        """An entry of the document's `presets`."""
        return {**self.combination.facts(), "because": self.because, "met": self.met}


def chosen(measured: Sequence[Combination], reference: Combination, budget_ms: float) -> dict[str, Preset]:
    """The three presets among what was measured."""
    return {
        "interactive": interactive(measured, budget_ms),
        "survey": survey(measured),
        "reference": Preset(reference, "the best of every knob", True),
    }


def interactive(measured: Sequence[Combination], budget_ms: float) -> Preset:
    """The smallest error within the budget."""
    within = [one for one in measured if one.worst.ms <= budget_ms]
    if within:
        best = min(within, key=lambda one: (one.error("flip"), one.worst.ms))
        return Preset(best, f"the smallest mean FLIP within {budget_ms:g} ms a picture", True)
    fastest = min(measured, key=lambda one: one.worst.ms)
    return Preset(fastest, f"the fastest; nothing keeps within {budget_ms:g} ms a picture", False)


def survey(measured: Sequence[Combination]) -> Preset:
    """The cheapest that is not noticeably off; of what cannot be told to be slower the nearest to the reference."""
    limit = f"a FLIP of {JUST_NOTICEABLE:.3f} from the reference, just noticeable, in 99.9% of the pixels"
    below = [one for one in measured if one.noticed < JUST_NOTICEABLE]
    if below:
        cheapest = min(below, key=lambda one: one.worst.ms)
        alike = [one for one in below if not cheapest.faster(one)]
        nearest = min(alike, key=lambda one: (one.noticed, one.error("flip")))
        return Preset(nearest, f"the cheapest below {limit}" + (NEARER if nearest is not cheapest else ""), True)
    nearest = min(measured, key=lambda one: (one.noticed, one.worst.ms))
    return Preset(nearest, f"the nearest to the reference; nothing stays below {limit}", False)


def as_toml(presets: Mapping[str, Preset], knobs: Sequence[Knob], measured: Mapping[str, Any]) -> str:
    """The text of a presets file: `measured` says of what machine, when, by which command."""
    return HEAD + tomli_w.dumps(
        {"measured": dict(measured), **{name: entry(preset, knobs) for name, preset in presets.items()}}
    )


def entry(preset: Preset, knobs: Sequence[Knob]) -> dict[str, Any]:
    """A preset's table. A knob whose field is empty (all faces) has none: TOML knows no empty value."""
    combination, by_name = preset.combination, {knob.name: knob for knob in knobs}
    levels = {name: by_name[name].level(value).changes for name, value in combination.values.items()}
    return {
        "because": preset.because,
        "ms": round(combination.worst.ms, 1),
        "ratio": round(combination.worst.ratio, 3),
        **{name: round(combination.error(name), 5) for name in ERRORS},
        "flip_everywhere_from_reference": round(combination.noticed, 5),
        "settings": {
            name: {path: value for path, value in changes.items() if value is not None}
            for name, changes in levels.items()
        },
    }
