"""A study written from a scene and what is to vary in it: how the tuner ends. Commented, to be edited by hand."""

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from importlib.resources import files
from math import prod
from pathlib import Path
from string import Template
from typing import Any

from fakesss.output import check_writable, make_folder, reason, write_new
from fakesss.problem import BadInput
from fakesss.scene import Scene
from fakesss.scene_toml import scene_tables, toml_value
from fakesss.shapes import is_mesh_file
from stimuli.design import stimuli_of
from stimuli.study import Study, check_levels_are_values

NAME = "study.toml"
MOST_PICTURES = 10_000  # every one of them is made up in memory, so that what is wrong is said before they are drawn
HASH = re.compile(r"^[0-9a-f]{64}\.")  # what the name of a file that was brought to the tuner is: it says nothing


def write_sweep(scene: Scene, title: str, folder: Path, factors: Sequence[Mapping[str, Any]]) -> Path:
    """`folder/study.toml`: every combination of the levels of `factors` (name, path, levels) around `scene`.

    Mesh files are copied beside it. The same arguments give the same bytes. `BadInput` in one sentence for what is
    wrong with a factor, before anything is written, and for a study or a mesh of that name that is there already.
    """
    path = folder / NAME
    if path.exists():
        raise BadInput(f"{path}: exists already; choose another folder or edit it")
    check_words(title, factors)
    check_number(factors)
    meshes = names_beside([scene.object, *(level for factor in factors for level in objects(factor))])
    text = study_text(scene, title, factors, meshes)
    stimuli_of(Study.of(tomllib.loads(text), NAME))  # whatever is wrong is said here
    contents = {folder / name: content_of(Path(source)) for source, name in meshes.items()}
    make_folder(folder)
    check_writable(path)
    for target, content in contents.items():
        put_mesh(target, content)
    write_new(path, text.encode())
    return path


def check_words(title: str, factors: Sequence[Mapping[str, Any]]) -> None:
    """`BadInput` for what TOML cannot hold, before it is written as TOML."""
    words = [("title", title), *(("factor name", factor["name"]) for factor in factors)]
    for what, text in words:
        if not text.strip() or not text.isprintable():
            raise BadInput(f"{NAME}: {what} {text!r}: must be words on one line")
    check_levels_are_values({"factor": list(factors)}, NAME)


def check_number(factors: Sequence[Mapping[str, Any]]) -> None:
    """`BadInput` for more combinations than anybody draws; four factors of 100 levels are 10^8."""
    pictures = pictures_of(factors)
    if pictures > MOST_PICTURES:
        raise BadInput(f"{NAME}: {pictures} pictures: must be <= {MOST_PICTURES}; vary less, or in fewer steps")


def pictures_of(factors: Sequence[Mapping[str, Any]]) -> int:
    """How many combinations of levels there are."""
    return prod(len(factor["levels"]) for factor in factors)


def study_text(scene: Scene, title: str, factors: Sequence[Mapping[str, Any]], meshes: Mapping[str, str]) -> str:
    """The text of study.toml; `meshes` gives each mesh file's name beside it."""
    base = scene.model_copy(update={"object": meshes.get(scene.object, scene.object)})
    template = Template((files("stimuli") / "templates" / "sweep.txt").read_text(encoding="utf-8"))
    return template.substitute(
        title=title,
        quoted_title=toml_value(title),
        pictures=pictures_of(factors),
        scene=scene_tables(base, "scene"),
        factors="\n".join(factor_text(factor, scene, meshes) for factor in factors),
    )


def factor_text(factor: Mapping[str, Any], scene: Scene, meshes: Mapping[str, str]) -> str:
    """A `[[factor]]` table."""
    beside = [meshes.get(level, level) if isinstance(level, str) else level for level in factor["levels"]]
    levels = beside if factor["path"] == "object" else factor["levels"]
    lines = {"name": factor["name"], "path": factor["path"], "levels": levels}
    return "[[factor]]\n" + "".join(f"{name} = {toml_value(value)}\n" for name, value in lines.items())


def objects(factor: Mapping[str, Any]) -> list[str]:
    """The objects that a factor's levels name."""
    return [level for level in factor["levels"] if isinstance(level, str)] if factor["path"] == "object" else []


def names_beside(objects: Sequence[str]) -> dict[str, str]:
    """The name that each mesh file among `objects` gets beside the study: its own, numbered where two have the same."""
    found: dict[str, str] = {}
    for source in dict.fromkeys(filter(is_mesh_file, objects)):
        plain = re.sub(r"[^\w.-]", "-", HASH.sub("object.", Path(source).name))
        found[source] = next(name for name in numbered(plain) if name not in found.values())
    return found


def numbered(name: str) -> Iterator[str]:
    """`bunny.ply`, `bunny-2.ply`, `bunny-3.ply`, ..."""
    yield name
    stem, suffix = Path(name).stem, Path(name).suffix
    number = 2
    while True:
        yield f"{stem}-{number}{suffix}"
        number += 1


def content_of(source: Path) -> bytes:
    """A mesh file's bytes, or `BadInput`."""
    try:
        return source.read_bytes()
    except OSError as error:
        raise BadInput(f"{source}: cannot be read ({reason(error)}); load the object again") from None


def put_mesh(target: Path, content: bytes) -> None:
    """The mesh at `target`, unless it lies there already; another file of its name is left alone, and refused."""
    if not (target.is_file() and target.read_bytes() == content):
        write_new(target, content)
