"""The picture half of `study.toml`: what is drawn, what varies and by which design.

The tables that concern participants and statistics (`[[question]]`, `[survey]`, `[analysis]`) are carried along unread.
"""

import hashlib
import math
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, field_validator, model_validator

from fakesss.problem import BadInput, Strict, validated
from fakesss.scene import Scene, check_path, read_toml

Level = str | bool | int | float | tuple[float | int, ...]
PLAIN = (str, bool, int, float)


class Factor(Strict):
    """One thing the study varies: a scene field and the levels it takes."""

    name: Annotated[str, Field(min_length=1)]
    path: Annotated[str, Field(description="a scene field, for example material.backlight")]
    levels: tuple[Level, ...]

    @field_validator("levels", mode="before")
    @classmethod
    def _levels_are_values(cls, given: Any) -> Any:
        """Said in our words: pydantic would name every branch of the union."""
        if not isinstance(given, list | tuple) or not given:
            raise ValueError("must be a list of at least one level, for example [0.8, 1.2]")
        for level in given:
            parts = level if isinstance(level, list | tuple) and level else [level]
            numbers = [part for part in parts if isinstance(part, float)]
            if not all(isinstance(part, PLAIN) for part in parts) or not all(map(math.isfinite, numbers)):
                raise ValueError(
                    f"level {level!r} must be a finite number, true or false, a word, or a list of numbers"
                )
        return tuple(tuple(level) if isinstance(level, list) else level for level in given)


class Design(Strict):
    """How levels are combined into pictures.

    one-at-a-time: each factor runs through its levels while the others keep the base scene's value, one row of pictures
    a factor. full-factorial: every combination of levels.
    """

    kind: Literal["one-at-a-time", "full-factorial"] = "one-at-a-time"
    repeats: Annotated[int, Field(ge=0)] = 0
    identical: Literal["show-each", "show-once"] = "show-each"


class Compare(Strict):
    """A picture made elsewhere, rated beside ours: an 8-bit sRGB file of the study's picture size."""

    image: Annotated[str, Field(min_length=1, description="file, relative to study.toml")]
    label: str = Field("", description="name in tables; empty: the file's name")


class Study(Strict):
    """`study.toml`, checked. `Study.load` is the way in; `sha256` is of the file's bytes."""

    title: Annotated[str, Field(min_length=1)]
    seed: Annotated[int, Field(ge=0, lt=2**63)] = 2011
    scene: Scene = Scene()
    factor: tuple[Factor, ...] = ()
    design: Design = Design()
    compare: tuple[Compare, ...] = ()
    question: tuple[dict[str, Any], ...] = ()
    survey: dict[str, Any] = Field(default_factory=dict)
    analysis: dict[str, Any] = Field(default_factory=dict)

    @classmethod
    def load(cls, folder: Path) -> Self:
        """The study in `folder/study.toml`, or `BadInput` in one sentence."""
        path = study_file(folder)
        study = validated(cls, read_toml(path), path.name)
        check_opaque(study.scene, f"{path.name}: scene.alpha")
        for factor in study.factor:
            check_factor(factor, study.scene, path.name)
        return study

    @model_validator(mode="after")
    def _names_are_unique(self) -> Self:
        for what, names in (
            ("factor name", [factor.name for factor in self.factor]),
            ("factor path", [factor.path for factor in self.factor]),
        ):
            twice = {name for name in names if names.count(name) > 1}
            if twice:
                raise ValueError(f'{what} "{sorted(twice)[0]}" is used twice; give each factor its own')
        spreadsheet = next((f.name for f in self.factor if f.name[0] in "=+-@\t\r"), None)
        if spreadsheet is not None:
            raise ValueError(f'factor name "{spreadsheet}" would be a formula in a spreadsheet; begin it with a letter')
        if not self.factor and not self.compare:
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


def check_opaque(scene: Scene, where: str) -> None:
    """`BadInput` naming the place if the picture would have no background of its own."""
    if scene.alpha:
        raise BadInput(f"{where}: a browser would show its page through the picture; set alpha = false")


def check_factor(factor: Factor, base: Scene, source: str) -> None:
    """Every level of `factor` gives a valid scene, or `BadInput` naming factor, level and mend."""
    where = f'{source}: factor "{factor.name}"'
    check_path(factor.path, where, len(base.lights))
    seen: list[Any] = []
    for level in factor.levels:
        try:
            value = base.replace({factor.path: level}).at(factor.path)
        except BadInput as error:
            mend = str(error).rsplit(": ", 1)[-1]
            raise BadInput(f"{where}: level {level!r}: {mend}") from None
        check_opaque(base.replace({factor.path: level}), f"{where}: level {level!r}")
        if value in seen:
            raise BadInput(f"{where}: level {level!r} stands twice; remove one")
        seen.append(value)
