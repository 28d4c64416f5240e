"""A field of the scene on the tuner's panel.

A slider covers what one usually wants (`low` to `high`); a typed number may go to the field's own limits, which come
from the scene's models, as do kinds, choices and descriptions (`fields`).
"""

import json
import re
from dataclasses import dataclass
from typing import Any

from fakesss.tuner.fields import Kind, field, kind, light_defaults, limits, may_be_empty
from fakesss.tuner.wishes import OFF, ON


@dataclass(frozen=True)
class Need:
    """A field does something only while another, at `path`, is one of `values`; `otherwise` is said if it is not."""

    path: str
    values: tuple[str | bool, ...]
    otherwise: str


def overriding(path: str) -> str:
    """The effect that sets the field when it is switched by hand, or ""."""
    if path == "light.shadows":
        return "shadows"
    return next((name for name in OFF if path in {**OFF[name], **ON.get(name, {})}), "")


@dataclass(frozen=True)
class Control:
    """One field on the panel. `low`, `high` and `step` of a slider are in the field's unit; `log`: by ratios."""

    path: str
    label: str
    low: float = 0.0
    high: float = 1.0
    step: float = 0.01
    log: bool = False
    symbol: str = ""  # of equation 3.6, a subscript after the first letter
    equation: str = ""
    unit: str = ""
    needs: tuple[Need, ...] = ()
    parts: tuple[str, ...] = ("R", "G", "B")  # of a colour, a triple or a size

    @property
    def kind(self) -> Kind:
        return kind(self.path)

    @property
    def id(self) -> str:
        return self.path.replace(".", "-")

    @property
    def choices(self) -> tuple[Any, ...]:
        """What may be chosen; None first where the field may be left empty."""
        return (*([None] if may_be_empty(self.path) else []), *field(self.path).get("enum", ()))

    @property
    def tip(self) -> str:
        """Description, equation and the field's name in a scene file."""
        cited = f" Equation {self.equation}." if self.equation else ""
        return f"{field(self.path)['description']}.{cited} Scene field {self.path}."

    @property
    def data(self) -> dict[str, str]:
        """The `data-` attributes of the control's element, which scripts read; `""` where there is nothing to say."""
        facts: dict[str, Any] = {"path": self.path, "kind": self.kind, "label": self.label}
        if effect := overriding(self.path):
            facts["effect"] = effect
        if self.needs:
            facts["needs"] = json.dumps([[need.path, need.values, need.otherwise] for need in self.needs])
        if self.path.startswith("light."):
            facts["default"] = json.dumps(light_defaults()[self.path.removeprefix("light.")])
        if may_be_empty(self.path):
            facts["empty"] = ""
        if self.kind in ("number", "colour", "triple", "size"):
            facts |= {"low": self.low, "high": self.high, "step": self.step, "log": "" if self.log else None}
            found = limits(self.path)
            facts |= {"least": found.least, "most": found.most, "above": "" if found.above else None}
            facts |= {"whole": "" if found.whole else None, "multiple": found.multiple}
        return {name: str(value) for name, value in facts.items() if value is not None}


@dataclass(frozen=True)
class Group:
    """Controls that belong together, under a heading."""

    title: str
    controls: tuple[Control, ...]
    note: str = ""

    @property
    def id(self) -> str:
        return re.sub(r"\W+", "-", self.title.lower())
