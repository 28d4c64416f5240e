"""What a quality would make of the fields that a scene leaves alone, for the page to show before it asks."""

from typing import Any

from fakesss.problem import BadInput
from fakesss.quality import from_quality, presets
from fakesss.scene import Scene

Knobs = list[dict[str, Any]]  # each the fields that are set together, path -> value


def qualities(base: Scene) -> dict[str, Knobs]:
    """The knobs that each quality fills of `base`, by its name; under "" all knobs as they are without one.

    A quality that `base` cannot have is left out.
    """
    named = [name for name in presets() if name != "measured"]
    knobs = {tuple(knob) for name in named for knob in presets()[name]["settings"].values() if knob}
    found: dict[str, Knobs] = {}
    for name in ("", *named):
        try:
            scene = base if (base.quality or "") == name else base.replace({"quality": name or None})
        except BadInput:
            continue
        filled = from_quality(scene) if name else {path: scene.at(path) for knob in knobs for path in knob}
        found[name] = [{path: filled[path] for path in knob} for knob in sorted(knobs) if filled.keys() >= set(knob)]
    return found
