"""The object of a scene: a built-in one by name and number of faces, or a mesh file.

`sphere`, `box`, `torus` and `knot` are parametric; the others are distance fields cut into triangles. All are closed
surfaces, and none needs a download.
"""

from collections.abc import Callable
from pathlib import Path

from fakesss import cache, shape_figure, shape_hand, shape_head, shape_relief, shape_shell, solids
from fakesss.mesh import EXTENSIONS, Mesh, load_mesh, mesh_from_surface
from fakesss.problem import BadInput, nearest

DEFAULT_FACES = 60_000
FACES = (1_000, 1_000_000)  # fewest and most triangles that a built-in object is made with
VERSION = 3  # raised whenever a built-in object changes, so that cached ones are made again

BUILT_IN: dict[str, Callable[[int], solids.Surface]] = {
    "figure": shape_figure.figure,
    "head": shape_head.head,
    "hand": shape_hand.hand,
    "knot": solids.knot,
    "shell": shape_shell.shell,
    "relief": shape_relief.relief,
    "sphere": solids.sphere,
    "box": solids.box,
    "torus": solids.torus,
}


def load_object(name: str, folder: Path = Path()) -> Mesh:
    """The mesh that a scene's `object` names: "figure", "knot:60000" or a mesh file, relative to `folder`.

    Raises `BadInput` for a name that is neither a built-in object nor a file, a face count outside `FACES`, and
    whatever `load_mesh` cannot read.
    """
    shape, _, count = name.partition(":")
    if shape in BUILT_IN:
        return built_in(shape, face_count(name, count))
    path = folder / name
    if path.is_file() or Path(name).suffix.lower().removeprefix(".") in EXTENSIONS or len(Path(name).parts) > 1:
        return load_mesh(path)
    raise BadInput(f'object "{name}": is neither a built-in object nor a file; {nearest(shape, BUILT_IN)}')


def face_count(name: str, count: str) -> int:
    """The number after the colon, or the default where there is none."""
    if name.find(":") < 0:
        return DEFAULT_FACES
    low, high = FACES
    if not count.isascii() or not count.isdigit() or not low <= int(count) <= high:
        raise BadInput(f'object "{name}": "{count}" must be a whole number of faces, {low} to {high}')
    return int(count)


def built_in(shape: str, faces: int = DEFAULT_FACES) -> Mesh:
    """A built-in object of about `faces` triangles (within 5%), made once and then kept in the cache."""

    def make() -> cache.Arrays:
        positions, normals, triangles = BUILT_IN[shape](faces)
        return {"positions": positions, "normals": normals, "faces": triangles}

    key = {"version": VERSION, "shape": shape, "faces": faces}
    arrays, _ = cache.cached("shapes", key, make)
    return mesh_from_surface(arrays["positions"], arrays["normals"], arrays["faces"])


def names() -> tuple[str, ...]:
    """The built-in objects."""
    return tuple(BUILT_IN)
