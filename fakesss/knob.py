"""What can be had faster and less exactly: each module of `fakesss.passes` declares its knobs, or that it has none.

A *knob* is a choice that changes how well something is computed, not what: its levels tend to one picture. What a
study varies on purpose (an exponent, a light) is no knob. `KNOBS = (Knob(...), ...)` stands in the module whose pass
approximates, `EXACT = "why this pass approximates nothing"` in every other; `fakesss tradeoff` measures what it finds.
"""

import importlib
import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any

from fakesss.scene import Scene

Value = int | str
Reason = Callable[[Scene], str]  # why a scene has no use for a knob, "" if it has


@dataclass(frozen=True)
class Level:
    """One position of a knob: a number where there is one to count (samples, rays, texels a side), else a word."""

    value: Value
    changes: Mapping[str, Any]  # scene path -> value


@dataclass(frozen=True)
class Knob:
    """A choice of accuracy, with what its error is measured against."""

    name: str
    levels: tuple[Level, ...]  # as a reader looks for them; what is faster or nearer is measured
    reference: Level  # what the levels tend to; one of them or beyond
    error: str  # what is wrong at a lower level, in words
    unused: Reason
    order: float | None = None  # expected p of an error that falls as value^-p; None where no such law is known
    beside: Value | None = None  # the level at which other knobs are measured; None: the reference
    baked: str = ""  # what it makes: once and kept, costing seconds before the picture and nothing in it

    @property
    def paths(self) -> tuple[str, ...]:
        """The scene fields that it sets."""
        return tuple(dict.fromkeys(path for level in (*self.levels, self.reference) for path in level.changes))

    @property
    def all_levels(self) -> tuple[Level, ...]:
        """Its levels and the reference, each once."""
        return self.levels if self.reference in self.levels else (*self.levels, self.reference)

    @property
    def besides(self) -> Level:
        """The level that it stays at while others are measured."""
        return self.reference if self.beside is None else self.level(self.beside)

    @property
    def best_place(self) -> int:
        """Of the most exact of its levels: the reference, or the last where that lies beyond."""
        return self.levels.index(self.reference) if self.reference in self.levels else len(self.levels) - 1

    def level(self, value: Value) -> Level:
        """The level of this value."""
        return next(level for level in self.all_levels if level.value == value)


def spread_order(dimensions: int) -> float:
    """p of an error N^-p of N samples spread evenly in so many dimensions, of something that jumps (Mitchell 1996)."""
    return 0.5 + 0.5 / dimensions


def levels(path: str, values: tuple[Value, ...]) -> tuple[Level, ...]:
    """Levels of a knob that is one scene field with these values."""
    return tuple(Level(value, {path: value}) for value in values)


def culled(node: str, changes: Mapping[str, Any] | None = None) -> Reason:
    """The reason why the picture of a scene, with `changes`, does without the pass `node`; "" where it needs it."""

    def why(scene: Scene) -> str:
        """Why the pass is not drawn in the scene; empty where it is."""
        from fakesss.pipeline import build, samples_of  # of the modules that declare knobs

        changed = scene.replace(changes) if changes else scene
        plan = build(changed, samples_of(changed), solid(changed.object)).compile(("image",))
        verdict = next(verdict for verdict in plan.verdicts if verdict.node.name == node)
        return "" if verdict.kept else verdict.because

    return why


@lru_cache(8)
def solid(name: str) -> bool:
    """Whether the object of this name is one (`fakesss.solidity`)."""
    from fakesss.shapes import load_object
    from fakesss.solidity import is_solid

    return is_solid(load_object(name))


def first_of(*reasons: Reason) -> Reason:
    """The first of these reasons that a scene gives."""
    return lambda scene: next((why for reason in reasons if (why := reason(scene))), "")


def modules() -> dict[str, Any]:
    """The modules of `fakesss.passes` by name."""
    from fakesss import passes  # whose modules import this one

    names = sorted(module.name for module in pkgutil.iter_modules(passes.__path__))
    return {name: importlib.import_module(f"fakesss.passes.{name}") for name in names}


@cache
def knobs() -> tuple[Knob, ...]:
    """All that are declared, in the order of their modules."""
    return tuple(knob for module in modules().values() for knob in getattr(module, "KNOBS", ()))
