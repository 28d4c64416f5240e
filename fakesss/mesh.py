"""A surface as the renderer draws it: in the unit sphere, welded, repaired, with normals, and every repair said.

The file's coordinates are recentred and scaled in float64 before anything becomes float32, so an object a million
times its own size away from the origin keeps its detail.
"""

import hashlib
import io
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss import mesh_repair, polygons, vertex_normals
from fakesss.mesh_slivers import without_slivers
from fakesss.problem import BadInput
from fakesss.space_order import in_space_order

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Faces = NDArray[np.int32]

EXTENSIONS = ("obj", "ply", "stl", "glb")
LARGEST = 1e307  # of any coordinate: the sphere around such an object has a centre and a radius in float64


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles in the world frame. The arrays are read-only; equal content gives an equal `sha256`.

    A vertex on a crease appears once for each side, so `faces` is what the GPU draws; `watertight` was decided
    before that split, on positions alone.
    """

    positions: Floats32  # (V, 3), in radii of the bounding sphere, which is centred at the origin
    normals: Floats32  # (V, 3), unit length
    faces: Faces  # (F, 3), counter-clockwise seen from outside
    watertight: bool  # closed and consistently wound: every edge is walked as often forwards as backwards
    repairs: tuple[str, ...] = ()  # one sentence each
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)  # of the bounding sphere, in the file's units
    radius: float = 1.0  # of the bounding sphere, in the file's units
    sha256: str = field(init=False)  # of positions, normals and faces

    def __post_init__(self) -> None:
        digest = hashlib.sha256()
        for array in (self.positions, self.normals, self.faces):
            array.setflags(write=False)
            digest.update(repr(array.shape).encode())
            digest.update(np.ascontiguousarray(array).data)
        object.__setattr__(self, "sha256", digest.hexdigest())


def load_mesh(path: str | Path) -> Mesh:
    """The mesh in an OBJ, PLY, STL or GLB file, in the world frame.

    A file of several parts is taken as one object, each part where the file's transforms put it. Materials and stored
    normals are not read, nor is any other file. Raises `BadInput` if the file is missing, of another kind,
    unreadable, has a corner that is not finite or not there or a polygon that cannot be cut, or holds no triangle.
    """
    path = Path(path)
    kind = path.suffix.lower().removeprefix(".")
    if kind not in EXTENSIONS:
        known = ", ".join(EXTENSIONS).upper()
        raise BadInput(f'{path}: "{path.suffix}" is no mesh format that can be read; convert it to one of {known}')
    if not path.is_file():
        raise BadInput(f"{path}: no such mesh file; check the path")
    positions, faces = read_triangles(path, kind)
    return mesh_from_triangles(positions, faces, str(path))


def read_triangles(path: Path, kind: str) -> tuple[Floats, NDArray[np.int64]]:
    """Vertices (V, 3) and triangles (F, 3) of a mesh file as they stand in it, parts concatenated."""
    try:
        content = path.read_bytes()
        cut = polygons.cut_obj(content) if kind == "obj" else None
        positions, faces = cut or read_by_library(content, kind)
        polygons.check_vertices(positions, faces)
    except OSError as error:
        raise BadInput(f"{path}: cannot be read ({error.strerror}); it must be a readable file") from None
    except polygons.UnfitPolygons as error:
        raise BadInput(f"{path}: {error}") from None
    except Exception as error:  # the readers raise whatever a malformed file makes them trip over
        said = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise BadInput(f"{path}: is not a valid {kind.upper()} file ({said}); export it again in triangles") from None
    if not len(faces):
        raise BadInput(f"{path}: holds no triangles; export the object as a triangle mesh")
    return positions, faces


def read_by_library(content: bytes, kind: str) -> tuple[Floats, NDArray[np.int64]]:
    """`read_triangles` through trimesh, which raises what it likes."""
    import trimesh  # slow to import, and built-in objects do not need it

    # no resolver: a mesh file must not make us read another one
    scene = trimesh.load_scene(io.BytesIO(content), file_type=kind, resolver=None, process=False, skip_materials=True)
    parts: list[Any] = [part for part in scene.dump() if isinstance(part, trimesh.Trimesh) and len(part.faces)]
    if kind == "ply" and parts and (cut := polygons.cut_ply(parts[0].metadata["_ply_raw"])):
        return cut
    if not parts:
        return np.zeros((0, 3)), np.zeros((0, 3), np.int64)
    offsets = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    positions = [np.asarray(part.vertices, np.float64) for part in parts]
    faces = [np.asarray(part.faces, np.int64) + start for part, start in zip(parts, offsets, strict=True)]
    return np.concatenate(positions), np.concatenate(faces)


def mesh_from_triangles(positions: Floats, faces: NDArray[np.integer[Any]], source: str) -> Mesh:
    """A `Mesh` from raw triangles: (V, 3) vertices in any unit, possibly not finite, and (F, 3) vertex indices.

    Cleans, scales into the unit sphere, welds, makes the winding consistent and outward, and computes normals;
    errors name `source`.
    """
    repairs: list[str] = []
    faces = mesh_repair.drop_collapsed_faces(positions, faces, repairs)
    lost = np.unique(faces[~np.isfinite(positions[faces]).all(axis=2)])
    if len(lost):  # dropping their triangles would tear holes into the shape that is studied
        count = mesh_repair.counted(len(lost), "vertex is", "vertices are")
        raise BadInput(f"{source}: {count} not finite (NaN or infinity); repair the mesh or export it again")
    if not len(faces):
        raise BadInput(f"{source}: no triangle with an extent is left; repair the mesh or export it again")
    if np.abs(positions[faces]).max() > LARGEST:
        raise BadInput(f"{source}: has coordinates beyond {LARGEST:g}; export it in a larger unit")
    scaled, centre, radius = into_unit_sphere(positions, faces)
    single, faces32 = mesh_repair.weld(scaled, faces, repairs)
    if not len(faces32):
        raise BadInput(f"{source}: every triangle is smaller than the object's rounding error; export it again")
    faces32 = mesh_repair.orient(single, faces32, repairs)
    faces32 = without_slivers(single, faces32, repairs)
    if not len(faces32):
        raise BadInput(f"{source}: all corners lie on lines, so there is no surface; export it again")
    single, faces32 = in_space_order(single, faces32)
    watertight = mesh_repair.is_closed(faces32)
    if not watertight:
        repairs.append("The surface is open or not orientable; it is drawn by the policy for open surfaces.")
    single, normals, faces32 = vertex_normals.with_creases(single, faces32)
    return Mesh(single, normals, faces32, watertight, tuple(repairs), centre, radius)


def mesh_from_surface(positions: Floats, normals: Floats, faces: NDArray[np.integer[Any]]) -> Mesh:
    """A `Mesh` from a surface that is right as it stands (a built-in object): only moved into the unit sphere."""
    scaled, centre, radius = into_unit_sphere(positions, faces)
    single = scaled.astype(np.float32)
    drawn = np.ascontiguousarray(faces, np.int32)
    watertight = mesh_repair.is_closed(mesh_repair.weld(scaled, drawn, [])[1])
    return Mesh(single, vertex_normals.normalised(normals).astype(np.float32), drawn, watertight, (), centre, radius)


def into_unit_sphere(
    positions: Floats, faces: NDArray[np.integer[Any]]
) -> tuple[Floats, tuple[float, float, float], float]:
    """Positions relative to the bounding sphere, its centre and its radius.

    The sphere is centred on the centre of the bounding box of the vertices that `faces` use and reaches to the
    farthest of them. Vertices that no face uses are moved too, but do not count.
    """
    used = np.zeros(len(positions), bool)
    used[faces] = True
    low, high = positions[used].min(axis=0), positions[used].max(axis=0)
    centre = low + (high - low) / 2
    scaled = np.where(used[:, None], positions, centre) - centre
    # divided first by the largest coordinate, so that squares neither overflow nor vanish
    extent = np.abs(scaled).max()
    scaled /= extent
    reach = np.sqrt((scaled**2).sum(axis=1).max())
    scaled /= reach
    return scaled, (float(centre[0]), float(centre[1]), float(centre[2])), float(extent * reach)
