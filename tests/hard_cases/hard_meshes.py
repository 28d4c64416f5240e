"""Surfaces that are hard to draw, and the bytes of the mesh files that hold them.

A surface is positions (V, 3) float64 in any unit and triangles (F, 3); shapes are about 2 units across.
"""

import struct

import numpy as np
import trimesh
from numpy.typing import NDArray

from fakesss import solids

Floats = NDArray[np.float64]
Surface = tuple[Floats, NDArray[np.int64]]

CORNERS = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)


def corners_of(triangles: str) -> NDArray[np.int64]:
    """Triangles (F, 3) from one word each."""
    return np.array([[int(corner) for corner in word] for word in triangles.split()])


CUBE = corners_of("013 032 475 467 051 045 237 276 026 064 157 173")
OTHER_DIAGONALS = corners_of("012 132 465 567 041 145 236 376 024 264 153 357")
SQUARE = np.array([(0, 1, 2), (0, 2, 3)])


def ball(faces: int = 1280, radius: float = 1.0, centre: tuple[float, float, float] = (0, 0, 0)) -> Surface:
    positions, _, triangles = solids.sphere(faces)
    return radius * positions + centre, np.asarray(triangles, np.int64)


def ring(faces: int = 4000) -> Surface:
    """A torus that leans towards the viewer."""
    positions, _, triangles = solids.torus(faces)
    return turned(positions, 60, 15), np.asarray(triangles, np.int64)


def cube(half: tuple[float, float, float] = (1, 1, 1), centre: tuple[float, float, float] = (0, 0, 0)) -> Surface:
    return CORNERS * half + centre, CUBE


def sheet() -> Surface:
    """An open square facing +z."""
    return np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float), SQUARE


def needle(width: float) -> Surface:
    """A spindle of length 2 and the given width, upright and leaning a little."""
    around = 2 * np.pi * np.arange(6) / 6
    waist = np.stack([np.cos(around), np.zeros(6), np.sin(around)], axis=1) * width / 2
    i, j = np.arange(6), (np.arange(6) + 1) % 6
    faces = np.concatenate([np.stack([np.full(6, 6), j, i], 1), np.stack([np.full(6, 7), i, j], 1)])
    return turned(np.concatenate([waist, [(0, 1, 0), (0, -1, 0)]]), 10, 0, 30), faces


def moebius(sections: int = 60) -> Surface:
    """A band with one side."""
    turn = 2 * np.pi * np.arange(sections) / sections
    across = np.array([-0.35, 0.35])[:, None]
    reach = 1 + across * np.cos(turn / 2)
    points = np.stack([reach * np.cos(turn), reach * np.sin(turn), across * np.sin(turn / 2)], axis=-1)
    i = np.arange(sections - 1)
    n = sections
    strip = [np.stack([i, i + 1, i + n], 1), np.stack([i + 1, i + 1 + n, i + n], 1)]
    closing = np.array([(n - 1, n, 2 * n - 1), (n, 0, 2 * n - 1)])
    return points.reshape(-1, 3), np.concatenate([*strip, closing])


def fins(number: int = 3) -> Surface:
    """Squares around one shared edge, as pages around a book's spine."""
    around = 2 * np.pi * (np.arange(number) + 0.25) / number
    edges = [(np.cos(a), y, np.sin(a)) for a in around for y in (-1, 1)]
    pages = [(0, 2 + 2 * k, 3 + 2 * k) for k in range(number)] + [(0, 3 + 2 * k, 1) for k in range(number)]
    return np.array([(0, -1, 0), (0, 1, 0), *edges]), np.array(pages)


def cubes_on_an_edge() -> Surface:
    """Two cubes that share an edge: four triangles meet there, and the whole is closed."""
    (first, faces), (second, _) = cube((0.5,) * 3, (-0.5, 0, -0.5)), cube((0.5,) * 3, (0.5, 0, 0.5))
    merged = trimesh.Trimesh(np.concatenate([first, second]), np.concatenate([faces, faces + 8]), process=True)
    return turned(np.array(merged.vertices), 20, 30), np.array(merged.faces)


def cones_at_a_point() -> Surface:
    """Two closed cones that share their tip, where the weighted normals cancel."""
    around = 2 * np.pi * np.arange(24) / 24
    rim = np.stack([np.cos(around), np.full(24, -1.0), np.sin(around)], axis=1)
    i, j = np.arange(24), (np.arange(24) + 1) % 24
    lower = np.concatenate([np.stack([np.full(24, 48), j, i], 1), np.stack([np.full(24, 49), i, j], 1)])
    upper = np.concatenate(
        [np.stack([np.full(24, 48), i + 24, j + 24], 1), np.stack([np.full(24, 50), j + 24, i + 24], 1)]
    )
    points = np.concatenate([rim, rim * (1, -1, 1), [(0, 0, 0), (0, -1, 0), (0, 1, 0)]])
    return points, np.concatenate([lower, upper])


def with_slivers(surface: Surface) -> Surface:
    """The same surface with every third triangle cut at the middle of an edge, the gap closed by one without area."""
    positions, faces = surface
    cut = faces[::3]
    middle = (positions[cut[:, 0]] + positions[cut[:, 1]]) / 2
    new = len(positions) + np.arange(len(cut))
    a, b, c = cut.T
    halves = np.concatenate([np.stack([a, new, c], 1), np.stack([new, b, c], 1), np.stack([b, new, a], 1)])
    kept = np.delete(faces, np.s_[::3], axis=0)
    return np.concatenate([positions, middle]), np.concatenate([kept, halves])


def turned(points: Floats, elevation: float, azimuth: float, roll: float = 0.0) -> Floats:
    """Turned about z, then x, then y, degrees."""
    r, e, a = np.radians([roll, elevation, azimuth])
    about_z = np.array([(np.cos(r), -np.sin(r), 0), (np.sin(r), np.cos(r), 0), (0, 0, 1)])
    about_x = np.array([(1, 0, 0), (0, np.cos(e), -np.sin(e)), (0, np.sin(e), np.cos(e))])
    about_y = np.array([(np.cos(a), 0, np.sin(a)), (0, 1, 0), (-np.sin(a), 0, np.cos(a))])
    result: Floats = points @ (about_y @ about_x @ about_z).T
    return result


def joined(*surfaces: Surface) -> Surface:
    """Several surfaces in one file, none of their vertices shared."""
    starts = np.cumsum([0] + [len(positions) for positions, _ in surfaces])
    faces = [triangles + start for (_, triangles), start in zip(surfaces, starts, strict=False)]
    return np.concatenate([positions for positions, _ in surfaces]), np.concatenate(faces)


def reversed_winding(surface: Surface, every: int = 1) -> Surface:
    """With every n-th triangle wound the other way."""
    positions, faces = surface[0], surface[1].copy()
    faces[::every] = faces[::every, ::-1]
    return positions, faces


def obj(surface: Surface) -> bytes:
    """All 17 digits of a float64."""
    positions, faces = surface
    points = [f"v {x!r} {y!r} {z!r}" for x, y, z in positions.tolist()]
    triangles = [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    return "\n".join([*points, *triangles, ""]).encode()


def ply(surface: Surface, normals: Floats | None = None) -> bytes:
    """Binary, float64; with `normals` (V, 3) stored at the vertices."""
    positions, faces = surface
    names = [*"xyz", *(("nx", "ny", "nz") if normals is not None else ())]
    columns = positions if normals is None else np.column_stack([positions, normals])
    rows = np.zeros(len(faces), [("corners", "u1"), ("index", "<i4", 3)])
    rows["corners"], rows["index"] = 3, faces
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(positions)}"]
    header += [f"property double {name}" for name in names]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    return "\n".join(header).encode() + np.ascontiguousarray(columns, "<f8").tobytes() + rows.tobytes()


def stl(surface: Surface) -> bytes:
    """Binary: float32 corners, three of their own for each triangle."""
    positions, faces = surface
    rows = np.zeros(len(faces), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("colour", "<u2")])
    rows["corners"] = positions[faces]
    return bytes(80) + struct.pack("<I", len(faces)) + rows.tobytes()


def glb(surface: Surface) -> bytes:
    content: bytes = trimesh.Trimesh(*surface, process=False).export(file_type="glb")
    return content
