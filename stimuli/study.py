"""The picture half of `study.toml`: what is drawn, what varies and by which design.

The tables that concern participants and statistics (`[[question]]`, `[survey]`, `[analysis]`) are carried along unread.
"""

import hashlib
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from fakesss.problem import BadInput, Strict, validated
from fakesss.scene import Scene, check_path, read_toml
from stimuli.changes import ONE_SIZE, check_opaque
from stimuli.compare import Compare
from stimuli.control import Control
from stimuli.levels import MUST_BE, Level, is_level, written

FORMULA = tuple("=+-@\t\r")


class Factor(Strict):
    """One thing the study varies: a scene field and the levels it takes."""

    name: Annotated[str, Field(min_length=1)]
    path: Annotated[str, Field(description="a scene field, for example material.backlight")]
    levels: tuple[Level, ...]


class Design(Strict):
    """How levels are combined into pictures.

    one-at-a-time: each factor runs through its levels while the others keep the base scene's value, one row of pictures
    a factor. full-factorial: every combination of levels.
    """

    kind: Literal["one-at-a-time", "full-factorial"] = "one-at-a-time"
    repeats: Annotated[int, Field(ge=0)] = 0
    identical: Literal["show-each", "show-once"] = "show-each"


class Study(Strict):
    """`study.toml`, checked. `Study.load` is the way in; `sha256` is of the file's bytes."""

    title: Annotated[str, Field(min_length=1)]
    seed: Annotated[int, Field(ge=0, lt=2**63)] = 2011
    scene: Scene = Scene()
    factor: tuple[Factor, ...] = ()
    design: Design = Design()
    compare: tuple[Compare, ...] = ()
    control: tuple[Control, ...] = ()
    question: tuple[dict[str, Any], ...] = ()
    survey: dict[str, Any] = Field(default_factory=dict)
    analysis: dict[str, Any] = Field(default_factory=dict)

    @classmethod
    def load(cls, folder: Path) -> Self:
        """The study in `folder/study.toml`, or `BadInput` in one sentence."""
        path = study_file(folder)
        return cls.of(read_toml(path), path.name)

    @classmethod
    def of(cls, tables: Mapping[str, Any], source: str) -> Self:
        """The study that a file's tables describe; errors name `source`."""
        check_levels_are_values(tables, source)
        study = validated(cls, tables, source)
        check_opaque(study.scene, f"{source}: scene.alpha")
        for factor in study.factor:
            check_factor(factor, study.scene, source)
        for entry in study.beside:
            entry.scene(study.scene)
        return study

    @property
    def beside(self) -> tuple[Compare | Control, ...]:
        """What is shown beside the design's pictures."""
        return (*self.compare, *self.control)

    @model_validator(mode="after")
    def _names_are_unique(self) -> Self:
        names = {"factor name": [factor.name for factor in self.factor]}
        names["factor path"] = [factor.path for factor in self.factor]
        names["control label"] = [control.label for control in self.control]
        names["compare label"] = [entry.name for entry in self.compare]
        for what, given in names.items():
            twice = {name for name in given if given.count(name) > 1}
            if twice:
                raise ValueError(f'{what} "{sorted(twice)[0]}" is used twice; give each its own')
        for what, given in names.items():
            formula = next((name for name in given if name.startswith(FORMULA)), None)
            if formula is not None:
                raise ValueError(f'{what} "{formula}" would be a formula in a spreadsheet; begin it with a letter')
        if not (self.factor or self.compare or self.control):
            raise ValueError("nothing to show: add a [[factor]] or a [[compare]] picture")
        return self


def study_file(folder: Path) -> Path:
    """`folder/study.toml`; `BadInput` when there is none."""
    path = folder / "study.toml"
    if not path.is_file():
        raise BadInput(f"{folder}: no study.toml here; make one with `fakesss new {folder}`")
    return path


def study_sha256(folder: Path) -> str:
    """SHA-256 of the study file's bytes: the name of this version of the study."""
    return hashlib.sha256(study_file(folder).read_bytes()).hexdigest()


def check_levels_are_values(tables: Mapping[str, Any], source: str) -> None:
    """`BadInput` for a level that no field could have, in our words: pydantic would name every branch of a union."""
    factors = tables.get("factor")
    for number, factor in enumerate(factors if isinstance(factors, list) else [], 1):
        if not isinstance(factor, Mapping) or "levels" not in factor:
            continue  # said by the model
        name, levels = factor.get("name"), factor["levels"]
        where = f'{source}: factor "{name}"' if isinstance(name, str) else f"{source}: factor[{number}]"
        if not isinstance(levels, list) or not levels:
            raise BadInput(f"{where}: levels {written(levels)}: must be a list of at least one, for example [0.8, 1.2]")
        for level in levels:
            if not is_level(level):
                raise BadInput(f"{where}: level {written(level)}: {MUST_BE}")


def check_factor(factor: Factor, base: Scene, source: str) -> None:
    """Every level of `factor` gives a valid scene, or `BadInput` naming factor, level and mend."""
    where = f'{source}: factor "{factor.name}"'
    check_path(factor.path, where, len(base.lights))
    if factor.path == "size":
        raise BadInput(f'{where}: path "size": {ONE_SIZE}')
    seen: list[Any] = []
    for level in factor.levels:
        place = f"{where}: level {written(level)}"
        try:
            scene = base.replace({factor.path: level}, place)
        except BadInput as error:
            raise BadInput(without_the_level(str(error), place, factor.path)) from None
        check_opaque(scene, place)
        value = scene.at(factor.path)
        if value in seen:
            raise BadInput(f"{place} stands twice; remove one")
        seen.append(value)


def without_the_level(sentence: str, place: str, path: str) -> str:
    """The sentence about a level, which `place` names already, with no second mention of it or of the factor's path."""
    about = re.match(rf"{re.escape(f'{place}: {path}: ')}(?:.*?: )(?=must )", sentence)
    return f"{place}: {sentence[about.end() :]}" if about else sentence
