"""Polygons with more than three corners, in the text and binary forms in which files hold them."""

import struct
from pathlib import Path

import numpy as np
import pytest

from fakesss.mesh import Mesh, load_mesh
from fakesss.polygons import triangles
from fakesss.problem import BadInput

L_SHAPE: list[tuple[float, ...]] = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (0.9, 1, 0), (0.9, -0.9, 0), (-1, -0.9, 0)]
L_AREA = 2 * 0.1 + 1.9 * 0.1
COMB = [(0, 0), (9, 0), (9, 4), (8, 1), (7, 1), (6, 4), (5, 1), (4, 1), (3, 4), (2, 1), (1, 1), (0, 4)]


def area(mesh: Mesh) -> float:
    a, b, c = np.moveaxis(mesh.positions[mesh.faces].astype(float), 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2 * mesh.radius**2)


def obj(corners: list[tuple[float, ...]], *faces: str) -> bytes:
    vertices = [f"v {x} {y} {z}" for x, y, z in corners]
    return "\n".join([*vertices, *(f"f {face}" for face in faces), ""]).encode()


def ply(form: str, corners: list[tuple[float, ...]], *faces: list[int]) -> bytes:
    head = f"ply\nformat {form} 1.0\nelement vertex {len(corners)}\nproperty float x\nproperty float y\n"
    head += f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    if form == "ascii":
        rows = [*corners, *([len(face), *face] for face in faces)]
        return (head + "".join(" ".join(map(str, row)) + "\n" for row in rows)).encode()
    blob = b"".join(struct.pack("<3f", *corner) for corner in corners)
    return head.encode() + blob + b"".join(struct.pack(f"<B{len(face)}i", len(face), *face) for face in faces)


def turned(start: int) -> list[int]:
    return [(start + corner) % 6 for corner in range(6)]


FILES = {
    "l.obj": obj(L_SHAPE, "1 2 3 4 5 6"),
    "textured.obj": obj(L_SHAPE, "1/1/1 2/1/1 3/1/1 4/1/1 5/1/1 6/1/1"),
    "backwards.obj": obj(L_SHAPE, "-6 -5 -4 -3 -2 -1") + b"v 7 7 7\n",
    "continued.obj": obj(L_SHAPE, "1 2 3 \\\n 4 5 6"),
    "quads.obj": obj(L_SHAPE, "1 2 5 6", "2 3 4 5"),
    "ascii.ply": ply("ascii", L_SHAPE, turned(2)),
    "mixed.ply": ply("ascii", L_SHAPE, [1, 2, 3, 4], [0, 1, 4], [0, 4, 5]),
    "binary.ply": ply("binary_little_endian", L_SHAPE, turned(1)),
}


@pytest.mark.parametrize("name", FILES)
def test_a_polygon_that_bends_inwards_covers_its_own_area(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(FILES[name])
    mesh = load_mesh(tmp_path / name)
    assert len(mesh.faces) == 4
    assert area(mesh) == pytest.approx(L_AREA, rel=1e-5)


@pytest.mark.parametrize("start", range(4))
def test_an_arrow_is_cut_at_its_bend(start: int) -> None:
    arrow = np.array([(0, 0, 0), (2, 2, 0), (0, 1, 0), (-2, 2, 0)], float)
    cut = triangles(arrow, [[(start + corner) % 4 for corner in range(4)]])
    a, b, c = np.moveaxis(arrow[cut], 1, 0)
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()


def test_convex_polygons_are_fans_from_their_first_corner() -> None:
    angle = np.arange(7) / 7 * 2 * np.pi
    heptagon = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    np.testing.assert_array_equal(triangles(heptagon, [range(7)]), [(0, i, i + 1) for i in range(1, 6)])


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (obj([(x, y, 0) for x, y in COMB], " ".join(map(str, range(1, 13)))), "1 polygon that bends inwards too much"),
        (obj(L_SHAPE, "1 2 3 9"), "1 face that names vertices that are not there"),
        (obj(L_SHAPE, "0 1 2"), "names vertex 0"),
        (obj(L_SHAPE, "1/1/1 2/1/1 0/1/1"), "names vertex 0"),
        (obj(L_SHAPE, "1 2 x 4"), "is not a valid OBJ file"),
    ],
)
def test_what_cannot_be_cut_is_one_sentence(tmp_path: Path, content: bytes, sentence: str) -> None:
    (tmp_path / "bad.obj").write_bytes(content)
    with pytest.raises(BadInput, match=sentence) as caught:
        load_mesh(tmp_path / "bad.obj")
    assert "\n" not in str(caught.value) and ";" in str(caught.value)


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian"])
def test_a_ply_that_names_a_missing_vertex_is_refused(tmp_path: Path, form: str) -> None:
    (tmp_path / "bad.ply").write_bytes(ply(form, L_SHAPE, [0, 1, 2], [0, 1, 9]))
    with pytest.raises(BadInput, match="1 face that names vertices that are not there"):
        load_mesh(tmp_path / "bad.ply")
