"""`quality` in a scene: the measured settings of `fakesss/presets.toml`, for every knob that the scene leaves alone.

A knob of which the scene sets any field itself stays as the scene has it. The presets hold what `fakesss tradeoff`
found on one machine for three scenes, with the command that makes them again; what a preset does not name keeps its
default.
"""

import tomllib
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel

from fakesss.problem import BadInput

if TYPE_CHECKING:
    from fakesss.scene import Scene

PRESETS = Path(__file__).with_name("presets.toml")


@cache
def presets() -> Mapping[str, Any]:
    """The shipped presets by name; `measured` says by whom."""
    return tomllib.loads(PRESETS.read_text(encoding="utf-8"))


def explicit(model: BaseModel, prefix: str = "") -> Iterator[str]:
    """Paths of the fields that were given, as against those that have a default."""
    for name in model.model_fields_set:
        value = getattr(model, name)
        yield f"{prefix}{name}"
        if isinstance(value, BaseModel):
            yield from explicit(value, f"{prefix}{name}.")


def wanted(scene: "Scene") -> dict[str, dict[str, Any]]:
    """The settings (path -> value) of each knob that the quality of `scene` names; none without one."""
    found: dict[str, dict[str, Any]] = presets()[scene.quality]["settings"] if scene.quality else {}
    return found


def from_quality(scene: "Scene") -> dict[str, Any]:
    """The settings that `scene` takes from its quality."""
    own = set(explicit(scene))
    return {path: value for knob in wanted(scene).values() if own.isdisjoint(knob) for path, value in knob.items()}


def forget(scene: "Scene", data: dict[str, Any]) -> None:
    """Drop from `data`, the settings given to `scene`, what its quality filled before the scene was written to a file.

    A manifest's scene has every field, so that what somebody set cannot be told from what its quality gave. There, a
    knob that is as the quality has it counts as the quality's.
    """
    named = wanted(scene)
    if from_quality(scene):
        return  # still knows what was given
    for knob in named.values():
        if all(scene.at(path) == value for path, value in knob.items()):
            for path in knob:
                *parents, leaf = path.split(".")
                place = data
                for parent in parents:
                    place = place[parent]
                del place[leaf]


def check_fills(scene: "Scene", source: str) -> None:
    """`BadInput` where a quality was asked for that changes nothing, since the scene sets every knob itself."""
    if scene.quality and not from_quality(scene):
        raise BadInput(
            f'{source}: quality "{scene.quality}" has nothing to fill: the scene sets every knob itself, as a '
            "manifest's scenes do; leave quality out and change the knobs one by one"
        )


def provenance(scene: "Scene") -> dict[str, dict[str, Any]]:
    """Every setting that the quality names: its value, and whether "quality" or the "scene" gave it."""
    taken = from_quality(scene)
    paths = [path for knob in wanted(scene).values() for path in knob]
    return {path: {"value": scene.at(path), "from": "quality" if path in taken else "scene"} for path in paths}


def fill(scene: "Scene") -> None:
    """Give `scene`, which is being made, the settings of its quality; they do not count as given."""
    for path, value in from_quality(scene).items():
        *parents, leaf = path.split(".")
        place: BaseModel = scene
        for parent in parents:
            # defaults are shared between scenes: what is changed must be the scene's own
            own = getattr(place, parent)
            object.__setattr__(place, parent, own.model_construct(own.model_fields_set, **dict(own)))
            place = getattr(place, parent)
        object.__setattr__(place, leaf, value)
