"""A scene as the text of a TOML file: what differs from the defaults, each field with its unit beside it.

`Scene.load` of the file gives the scene again. What a `quality` fills is left to it, and what the scene sets itself of
a knob that the quality names is written even where it is the default, since the quality would fill it otherwise.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import tomli_w
from pydantic import BaseModel

from fakesss.lights import Light
from fakesss.quality import from_quality, wanted
from fakesss.scene import Scene, scene_paths

HEAD = "# A scene of fakesss: `fakesss render` draws it, docs/scene.md lists every field and its default.\n\n"
ALWAYS = ("object", "size")  # without which a file would say little
WIDTH = 120
COMMENTS_AT = 34  # column, where the entries of a table are shorter

Entry = tuple[str, str]  # `backlight = 0.8`, and what it is


def scene_toml(scene: Scene, folder: Path | None = None) -> str:
    """The text of a scene's file that is to stand in `folder`, or anywhere; a mesh is named so that it is found."""
    named = scene.model_copy(update={"object": object_from(folder, scene.object)})
    return HEAD + scene_tables(named)


def object_from(folder: Path | None, name: str) -> str:
    """A scene's `object` as a file in `folder` has to name it: relative if it lies within, otherwise absolute."""
    from fakesss.shapes import is_mesh_file  # slow to import, and most scenes are of built-in objects

    if not is_mesh_file(name):
        return name
    path = Path(name).resolve()
    within = folder.resolve() if folder else None
    relative = path.relative_to(within).as_posix() if within and path.is_relative_to(within) else ""
    return relative if is_mesh_file(relative) else path.as_posix()  # a file called sphere would be the built-in one


def scene_tables(scene: Scene, prefix: str = "") -> str:
    """The fields of `scene` that a file has to name, as TOML; `prefix` "scene": as the `[scene]` table of a study."""
    left_out = contradicted(scene)
    scene = plain(scene) if left_out else scene
    said = set(said_paths(scene))
    blocks = [block(f"[{prefix}]" if prefix else "", entries(scene, said, ""))]
    for name, value in scene:
        if name == "lights":
            blocks += [block(f"[[{dotted(prefix, name)}]]", light_entries(light)) for light in value]
        elif isinstance(value, BaseModel) and (lines := entries(value, said, f"{name}.")):
            blocks.append(block(f"[{dotted(prefix, name)}]", lines))
    return left_out + "\n".join(blocks)


def said_paths(scene: Scene) -> Iterator[str]:
    """Paths of the fields that have to be written for the scene to be read again; lights have entries of their own."""
    filled = from_quality(scene)
    own = {path for knob in wanted(scene).values() for path in knob} - filled.keys()
    usual = Scene()
    for path in scene_paths():
        value = scene.at(path)
        is_said = path in own or path in ALWAYS or value != usual.at(path)
        if path != "lights" and path not in filled and value is not None and is_said:
            yield path


def contradicted(scene: Scene) -> str:
    """Why `quality` cannot stand in the file, as a comment; "" if it can. TOML has no word for an empty field."""
    filled, said = from_quality(scene), set(said_paths(scene))
    for knob in wanted(scene).values():
        if knob and filled.keys().isdisjoint(knob) and said.isdisjoint(knob):
            what = ", ".join(knob)
            return f'# quality "{scene.quality}" is written out field by field: it would fill {what}, empty here.\n'
    return ""


def plain(scene: Scene) -> Scene:
    """The same picture without a `quality`: every field that it filled counts as the scene's own."""
    return Scene.from_dict(scene.model_dump() | {"quality": None}, "scene")


def entries(model: BaseModel, said: set[str], prefix: str) -> list[Entry]:
    """The entries of a table: those fields of `model` whose paths are `said`."""
    values = {name: value for name, value in model if f"{prefix}{name}" in said}
    return [entry(type(model), name, value) for name, value in values.items()]


def light_entries(light: Light) -> list[Entry]:
    """The entries of a further light: what differs from a light that says nothing."""
    usual = dict(Light())
    return [entry(Light, name, value) for name, value in light if value != usual[name]]


def entry(model: type[BaseModel], name: str, value: Any) -> Entry:
    """One field and its description, which names its unit."""
    return f"{name} = {toml_value(value)}", model.model_fields[name].description or ""


def toml_value(value: Any) -> str:
    """A value as TOML writes it, a list on one line."""
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    return tomli_w.dumps({"value": value}).removeprefix("value = ").rstrip("\n")


def block(header: str, lines: list[Entry]) -> str:
    """A table: its header and its entries, their comments in a column; one that is too long stands above its entry."""
    column = max([COMMENTS_AT, *(len(text) + 2 for text, _ in lines if len(text) < WIDTH // 2)])
    text = f"{header}\n" if header else ""
    for setting, about in lines:
        beside = f"{setting:{column - 1}} # {about}"
        text += beside + "\n" if len(beside) <= WIDTH else f"# {about}\n{setting}\n"
    return text


def dotted(prefix: str, name: str) -> str:
    """`scene.material`, or `material` in a scene's own file."""
    return f"{prefix}.{name}" if prefix else name
