"""Bad input, said in one sentence: what is wrong, where it stands, how to mend it.

Every room raises `BadInput` for what a user can mend; the command line prints the sentence and exits with 2.
Importing this module needs neither OpenGL nor any other part of the renderer.
"""

import difflib
import json
from collections.abc import Iterable, Mapping, Sequence
from types import UnionType
from typing import Any, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, ConfigDict, ValidationError
from pydantic_core import ErrorDetails


class BadInput(ValueError):
    """Something a user can mend. `str(error)` is the one sentence to show."""


class Strict(BaseModel):
    """Base of every settings model: immutable, no unknown keys, no infinities or NaN."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


Model = TypeVar("Model", bound=BaseModel)
WORDS = (
    ("Input should be", "must be"),
    ("Tuple should have", "must have"),
    (" after validation", ""),
    ("String should have at least 1 character", "must not be empty; write a word"),
    ("a valid array", "a list"),
    ("an object", "a table"),
    ("greater than or equal to", ">="),
    ("less than or equal to", "<="),
    ("greater than", ">"),
    ("less than", "<"),
)
TAGS = ("float", "int", "str", "bool")


def nearest(name: str, names: Iterable[str]) -> str:
    """`; did you mean "..."?` for the closest of `names`, or the list of them when none is close."""
    names = sorted(names)
    close = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
    if close:
        return f'did you mean "{close[0]}"?'
    return "choose one of " + ", ".join(f'"{known}"' for known in names)


def validated(model: type[Model], data: Mapping[str, Any], source: str) -> Model:
    """`model` filled from `data`, or `BadInput` naming `source`, the key and the mend for the first thing wrong.

    Strict: no "1.5" or true for a number, no 1 for true. Read as JSON, since only there a list may fill a strict tuple.
    """
    try:
        return model.model_validate_json(json.dumps(data, default=as_json), strict=True)
    except ValidationError as error:
        raise BadInput(f"{source}: {first_sentence(error, model)}") from None


def as_json(value: Any) -> Any:
    """What JSON has no word for: numpy's numbers and arrays as Python's, anything else (a TOML date) as its text."""
    return value.tolist() if hasattr(value, "tolist") else str(value)


def first_sentence(error: ValidationError, model: type[BaseModel]) -> str:
    """The first of pydantic's complaints as `key: value: what to do`."""
    details = error.errors(include_url=False)
    # a misspelt required key is both unknown and missing; the misspelling is what helps
    detail = next((d for d in details if d["type"] == "extra_forbidden"), branch(details))
    where = tuple(part for part in detail["loc"] if not is_tag(part))
    if detail["type"] == "extra_forbidden":
        *above, key = detail["loc"]  # a key may be called as a tag is
        where = tuple(part for part in above if not is_tag(part))
        return f"{dotted((*where, key))}: unknown key; {nearest(str(key), fields_at(model, where))}"
    if detail["type"] == "missing":
        return f"{dotted(where)}: is missing; add it"
    shown = f"{detail['input']!r}: " if not isinstance(detail["input"], Mapping) else ""
    key = f"{dotted(where)}: " if where else ""
    return f"{key}{shown}{in_our_words(detail['msg'])}"


def branch(details: Sequence[ErrorDetails]) -> ErrorDetails:
    """The first complaint; of a table that may also be a number, what is wrong inside the table."""
    first = details[0]
    stem = first["loc"][:-1]
    inside = (d for d in details if d["loc"][: len(stem)] == stem and len(d["loc"]) > len(first["loc"]))
    return next(inside, first) if isinstance(first["input"], Mapping) and first["type"] != "missing" else first


def is_tag(part: int | str) -> bool:
    """Whether a part of a location is pydantic's name for a branch of a union ("constrained-float"), not a key."""
    return isinstance(part, str) and (part in TAGS or part.startswith(("constrained-", "dict[", "tuple[", "list[")))


def in_our_words(message: str) -> str:
    """One of pydantic's messages, in the words of our pages."""
    message = message.removeprefix("Value error, ")
    for words, ours in WORDS:
        message = message.replace(words, ours)
    return message


def dotted(where: Sequence[int | str]) -> str:
    """A pydantic location as a person writes it: `factor[2].levels` (the first entry is [1]), `lights.0.kind`.

    A light is counted as the scene's paths count it, from 0.
    """
    text = ""
    for before, part in zip(["", *where], where, strict=False):
        if isinstance(part, int):
            text += f".{part}" if before == "lights" else f"[{part + 1}]"
        else:
            text += f".{part}" if text else part
    return text


def fields_at(model: type[BaseModel], where: Sequence[int | str]) -> list[str]:
    """The field names (or aliases) that the model reached from `model` along `where` knows."""
    found: list[type[BaseModel]] = [model]
    for part in where:
        if isinstance(part, int):
            continue
        steps = [m.model_fields.get(part) or by_alias(m, part) for m in found]
        inner = [submodel for step in steps if step is not None for submodel in models_in(step.annotation)]
        # a union's own tag is part of the location: stay where we are
        found = inner or found
    return sorted({field.alias or name for m in found for name, field in m.model_fields.items()})


def by_alias(model: type[BaseModel], alias: str) -> Any:
    """The field of `model` that is written as `alias` in a file, or None."""
    return next((field for field in model.model_fields.values() if field.alias == alias), None)


def models_in(annotation: Any) -> list[type[BaseModel]]:
    """Every model class mentioned in a type annotation: `tuple[Factor, ...] | None` -> [Factor]."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    if get_origin(annotation) in (Union, UnionType, tuple, list, dict) or get_args(annotation):
        return [found for arg in get_args(annotation) for found in models_in(arg)]
    return []
