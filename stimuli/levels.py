"""What a factor's level and a field set otherwise may be: a finite number, true, false, a word, a list of numbers."""

import json
import math
from collections.abc import Iterator, Mapping
from typing import Any

Level = str | bool | int | float | tuple[float | int, ...]
MUST_BE = "must be a finite number, true or false, a word, or a list of numbers"


def is_number(value: Any) -> bool:
    """Whether `value` is a finite number; true and false are none."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def is_list_of_numbers(value: Any) -> bool:
    """Whether `value` is a list of at least one finite number."""
    return isinstance(value, list) and len(value) > 0 and all(map(is_number, value))


def is_level(value: Any) -> bool:
    """Whether a scene's field could have that value: a finite number, true, false, a word, a list of numbers."""
    return is_number(value) or isinstance(value, str | bool) or is_list_of_numbers(value)


def leaves(table: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """(dotted path, value) of everything in a table and the tables within."""
    for name, value in table.items():
        if isinstance(value, Mapping):
            yield from leaves(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value


def written(level: Any) -> str:
    """A level as it stands in study.toml: -3, true, "spot", [1, 1]."""
    if isinstance(level, list | tuple):
        return "[" + ", ".join(map(written, level)) + "]"
    return json.dumps(level, ensure_ascii=False) if isinstance(level, str | bool) else str(level)
