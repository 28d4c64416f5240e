"""The object of a scene: a built-in one by name and number of faces, or a mesh file.

Solids are parametric; sculptures are distance fields cut into triangles. All are closed surfaces, and none needs a
download.
"""

from collections.abc import Callable
from pathlib import Path

from fakesss import cache, shape_figure, shape_hand, shape_head, shape_relief, shape_shell, solids
from fakesss.distance import Distance
from fakesss.mesh import Mesh, load_mesh, mesh_from_surface
from fakesss.problem import BadInput, nearest

DEFAULT_FACES = 60_000
FACES = (1_000, 1_000_000)  # fewest and most triangles that a built-in object is made with
VERSION = 8  # raised whenever a sculpture changes, so that cached ones are made again

FINE_SURFACE: cache.Shapes = {"positions": ("vertices", 3), "faces": ("triangles", 3)}
SCULPTURE: cache.Shapes = {**FINE_SURFACE, "normals": ("vertices", 3)}

Box = tuple[tuple[float, float, float], tuple[float, float, float]]

SCULPTURES: dict[str, tuple[Distance, Box]] = {
    "figure": (shape_figure.field, shape_figure.BOX),
    "head": (shape_head.field, shape_head.BOX),
    "hand": (shape_hand.field, shape_hand.BOX),
    "shell": (shape_shell.field, shape_shell.BOX),
    "relief": (shape_relief.field, shape_relief.BOX),
}
SOLIDS: dict[str, Callable[[int], solids.Surface]] = {
    "knot": solids.knot,
    "sphere": solids.sphere,
    "box": solids.box,
    "torus": solids.torus,
}


def names() -> tuple[str, ...]:
    """The built-in objects, the default first."""
    return (*SCULPTURES, *SOLIDS)


def load_object(name: str, folder: Path = Path()) -> Mesh:
    """The mesh that a scene's `object` names: "figure", "knot:60000" or a mesh file, relative to `folder`.

    Raises `BadInput` for a name that is neither a built-in object nor a file, a face count outside `FACES`, and
    whatever `load_mesh` cannot read.
    """
    return load_mesh(folder / name) if is_mesh_file(name) else built_in(*shape_and_faces(name))


def is_mesh_file(name: str) -> bool:
    """Whether a scene's `object` means a file: it is no built-in name and has a suffix or a folder in it."""
    return name.partition(":")[0] not in names() and (Path(name).suffix != "" or len(Path(name).parts) > 1)


def shape_and_faces(name: str) -> tuple[str, int]:
    """The shape and the number of faces that "figure" or "knot:60000" asks for; `BadInput` for anything else."""
    shape, _, count = name.partition(":")
    if shape not in names():
        raise BadInput(f'object "{name}": is neither a built-in object nor a file; {nearest(shape, names())}')
    return shape, face_count(name, count)


def face_count(name: str, count: str) -> int:
    """The number after the colon, or the default where there is none."""
    if ":" not in name:
        return DEFAULT_FACES
    low, high = FACES
    if not count.isascii() or not count.isdigit() or not low <= int(count) <= high:
        raise BadInput(f'object "{name}": "{count}" must be a whole number of faces, {low} to {high}')
    return int(count)


def built_in(shape: str, faces: int = DEFAULT_FACES) -> Mesh:
    """A built-in object of about `faces` triangles (within 5%); sculptures are made once and then kept in the cache."""
    if shape in SOLIDS:
        return mesh_from_surface(*SOLIDS[shape](faces))
    key = {"version": VERSION, "shape": shape, "faces": faces}
    arrays, _ = cache.cached("shapes", key, SCULPTURE, lambda: sculpture(shape, faces))
    return mesh_from_surface(arrays["positions"], arrays["normals"], arrays["faces"])


def sculpture(shape: str, faces: int) -> cache.Arrays:
    """Positions, normals and faces of a sculpture; the fine surface that coarse ones come from is cached too."""
    from fakesss import isosurface  # with all it imports, slow to load, and not needed for what is cached

    field, box = SCULPTURES[shape]
    cut = max(faces, isosurface.FINE_FACES)

    def make() -> cache.Arrays:
        vertices, triangles = isosurface.fine_surface(field, box, cut)
        return {"positions": vertices, "faces": triangles}

    fine, _ = cache.cached("shapes", {"version": VERSION, "shape": shape, "cut": cut}, FINE_SURFACE, make)
    vertices, triangles = fine["positions"], fine["faces"]
    if faces < cut:
        vertices, triangles = isosurface.simplified(field, vertices, triangles, faces)
    normals = isosurface.field_normals(field, vertices, triangles)
    return {"positions": vertices, "normals": normals, "faces": triangles}
