"""Designs: a study's factors turned into an ordered list of pictures to make. Pure; nothing is drawn here."""

import itertools
import random
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

from fakesss.offline.settings import PathTracing
from fakesss.problem import BadInput
from fakesss.scene import Scene
from stimuli.levels import Level, written
from stimuli.study import Factor, Study

Role = Literal["factor", "compare", "control", "repeat"]


@dataclass(frozen=True)
class Stimulus:
    """One picture to show: a scene (or a file made elsewhere) and its place in the design.

    `path_tracing`: how the scene is path-traced; None: our renderer draws it.
    """

    id: str
    label: str
    role: Role
    scene: Scene | None = None
    image: str | None = None
    path_tracing: PathTracing | None = None
    factors: tuple[tuple[str, Level], ...] = ()
    rows: tuple[str, ...] = ()
    same_picture_as: str | None = None


def stimuli_of(study: Study) -> list[Stimulus]:
    """Every stimulus of the study in presentation-neutral order: factor rows, comparison pictures, controls, repeats.

    Identities follow the published numbering (`img01` is the thesis's image 1). With `identical = "show-once"` a
    picture that several rows share is listed once and belongs to all of them.
    """
    drawn = list(one_at_a_time(study) if study.design.kind == "one-at-a-time" else full_factorial(study))
    if study.design.identical == "show-once":
        drawn = share_identical(drawn)
    of_other_origin = [
        Stimulus("", entry.name, "compare", entry.scene(study.scene), entry.image, entry.path_tracing)
        for entry in study.compare
    ]
    controls = [Stimulus("", entry.label, "control", entry.scene(study.scene)) for entry in study.control]
    entries = [*drawn, *of_other_origin, *controls]
    numbered = number(entries, width=max(2, len(str(len(entries)))))
    return [*numbered, *repeats(numbered, study)]


def one_at_a_time(study: Study) -> Iterator[Stimulus]:
    """A row of pictures a factor, every other factor at the base scene's value (thesis table 4.3)."""
    base = {factor.name: base_level(factor, study.scene) for factor in study.factor}
    for factor in study.factor:
        for level in factor.levels:
            yield stimulus(study, {**base, factor.name: level}, [factor])


def full_factorial(study: Study) -> Iterator[Stimulus]:
    """Every combination of levels, the last factor varying fastest."""
    names = [factor.name for factor in study.factor]
    if not names:
        return
    for levels in itertools.product(*(factor.levels for factor in study.factor)):
        yield stimulus(study, dict(zip(names, levels, strict=True)), study.factor)


def stimulus(study: Study, levels: dict[str, Level], rows: list[Factor] | tuple[Factor, ...]) -> Stimulus:
    """The picture at `levels`, shown for the comparison of each factor in `rows`."""
    place = "study.toml: " + ", ".join(f'factor "{name}" level {written(level)}' for name, level in levels.items())
    scene = study.scene.replace({factor.path: levels[factor.name] for factor in study.factor}, place)
    label = ", ".join(f"{factor.name} {shown(levels[factor.name])}" for factor in rows)
    names = tuple(factor.name for factor in rows)
    return Stimulus("", label, "factor", scene, factors=tuple(levels.items()), rows=names)


def share_identical(drawn: list[Stimulus]) -> list[Stimulus]:
    """One stimulus for each distinct scene, belonging to every row that has it."""
    first: dict[Scene, Stimulus] = {}
    for entry in drawn:
        assert entry.scene is not None
        seen = first.get(entry.scene)
        if seen is None:
            first[entry.scene] = entry
        else:
            rows = tuple(dict.fromkeys([*seen.rows, *entry.rows]))
            first[entry.scene] = replace(seen, rows=rows, label=f"{seen.label} = {entry.label}")
    return list(first.values())


def number(entries: list[Stimulus], width: int) -> list[Stimulus]:
    """Identities img01, img02, ...; a picture whose scene came before names the earlier one."""
    seen: dict[tuple[Scene, PathTracing | None], str] = {}
    numbered = []
    for index, entry in enumerate(entries, 1):
        identity = f"img{index:0{width}d}"
        same = None if entry.scene is None else seen.setdefault((entry.scene, entry.path_tracing), identity)
        numbered.append(replace(entry, id=identity, same_picture_as=None if same == identity else same))
    return numbered


def repeats(entries: list[Stimulus], study: Study) -> list[Stimulus]:
    """`design.repeats` pictures drawn by lot (seeded), to be shown a second time for test-retest."""
    candidates = [entry for entry in entries if entry.same_picture_as is None]
    if study.design.repeats > len(candidates):
        raise BadInput(
            f"study.toml: design.repeats: {study.design.repeats}: must be <= {len(candidates)}, the different pictures"
        )
    chosen = random.Random(study.seed).sample(candidates, study.design.repeats)
    return [
        replace(
            entry, id=f"{entry.id}r", role="repeat", rows=(), same_picture_as=entry.id, label=f"{entry.label} (again)"
        )
        for entry in sorted(chosen, key=lambda entry: entry.id)
    ]


def base_level(factor: Factor, scene: Scene) -> Level:
    """The base scene's value of the factor's field, written as the study writes it (25, not 25.0)."""
    value = scene.at(factor.path)
    return next((level for level in factor.levels if level == value), value)


def shown(level: Level) -> str:
    """A level as it stands in labels: 25, 1.2, true, (1, 0, 0)."""
    if isinstance(level, bool):
        return str(level).lower()
    if isinstance(level, tuple):
        return "(" + ", ".join(shown(part) for part in level) + ")"
    return f"{level:.12g}" if isinstance(level, float) else str(level)
