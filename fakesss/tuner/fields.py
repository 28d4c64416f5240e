"""What the scene's models say of a field: its kind, hard limits, choices and words. The panel repeats none of it."""

from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

from fakesss.lights import Light
from fakesss.scene import Scene

Kind = Literal["number", "colour", "triple", "choice", "switch", "size", "text"]


@dataclass(frozen=True)
class Limits:
    """Between which values a number is accepted; None: no limit on that side."""

    least: float | None
    most: float | None
    above: bool  # `least` itself is refused
    whole: bool
    multiple: float | None


@cache
def schema() -> dict[str, Any]:
    """The scene as a JSON schema, which has constraints in one form however a field is annotated."""
    return Scene.model_json_schema()


def field(path: str) -> dict[str, Any]:
    """The schema of the field at `path` ("material.backlight"), without the alternative of being empty.

    Raises KeyError for a path that is no field.
    """
    place: dict[str, Any] = schema()
    for part in path.split("."):
        name = place.get("$ref", "").removeprefix("#/$defs/")
        place = (schema()["$defs"][name] if name else place)["properties"][part]
    filled: dict[str, Any] = next((one for one in place.get("anyOf", ()) if one.get("type") != "null"), {})
    return {**place, **filled}


def may_be_empty(path: str) -> bool:
    """Whether the field may be left empty, for the program to settle it."""
    return any(one.get("type") == "null" for one in field(path).get("anyOf", ()))


def kind(path: str) -> Kind:
    """How the field is shown."""
    found = field(path)
    if "enum" in found:
        return "choice"
    if found["type"] == "array":
        if len(found["prefixItems"]) == 2:
            return "size"
        return "triple" if path.endswith("attenuation") else "colour"
    kinds: dict[str, Kind] = {"boolean": "switch", "string": "text"}
    return kinds.get(found["type"], "number")


def limits(path: str) -> Limits:
    """Of a number, or of each number of a colour or a size."""
    found = field(path)
    one = found["prefixItems"][0] if "prefixItems" in found else found
    least = one.get("minimum", one.get("exclusiveMinimum"))
    return Limits(least, one.get("maximum"), "exclusiveMinimum" in one, one["type"] == "integer", one.get("multipleOf"))


def light_defaults() -> dict[str, Any]:
    """Every field of a light that says nothing of itself."""
    return Light().model_dump(mode="json")
