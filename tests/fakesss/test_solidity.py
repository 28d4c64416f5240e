"""What is a solid, and what only looks closed."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from fakesss.mesh import Mesh, load_mesh
from fakesss.shapes import load_object, names
from fakesss.solidity import bounds_solid, is_solid


def ball(centre: tuple[float, float, float] = (0, 0, 0), radius: float = 1.0, inwards: bool = False) -> trimesh.Trimesh:
    part = trimesh.creation.icosphere(subdivisions=3, radius=radius)
    part.apply_translation(centre)
    if inwards:
        part.invert()
    return part


def loaded(tmp_path: Path, *parts: trimesh.Trimesh) -> Mesh:
    path = tmp_path / "parts.ply"
    trimesh.util.concatenate(parts).export(path)
    return load_mesh(path)


@pytest.mark.parametrize("name", names())
def test_the_built_in_objects(name: str) -> None:
    """Closed ones are solids. (In few faces the thin shell folds onto itself.)"""
    mesh = load_object(f"{name}:30000")
    assert is_solid(mesh) == mesh.watertight


@pytest.mark.parametrize(
    ("parts", "solid"),
    [
        ([ball()], True),
        ([ball(), ball((3, 0, 0))], True),
        ([ball(), ball(radius=0.5, inwards=True)], True),
        ([ball(), ball(radius=0.5, inwards=True), ball(radius=0.25)], True),
        ([ball(), ball((1, 0, 0))], False),
        ([ball(), ball(radius=0.5)], False),
        ([ball(), ball((1.95, 0, 0))], False),
    ],
    ids=["ball", "two apart", "hollow", "ball in a hollow", "overlapping", "one in the other", "barely overlapping"],
)
def test_parts(tmp_path: Path, parts: list[trimesh.Trimesh], solid: bool) -> None:
    mesh = loaded(tmp_path, *parts)
    assert mesh.watertight
    assert bounds_solid(mesh) == solid


def bar(x: float, y: float, z: float, place: tuple[float, float, float] = (0, 0, 0)) -> trimesh.Trimesh:
    part = trimesh.creation.box((x, y, z))
    part.apply_translation(place)
    return part


@pytest.mark.parametrize(
    ("parts", "solid"),
    [
        ([bar(4, 1, 1), bar(1, 4, 0.8)], False),
        ([bar(4, 1, 1), bar(1, 4, 0.8, (0, 0, 2))], True),
        ([bar(2, 2, 2), bar(2, 2, 2, (1.7, 1.7, 1.7))], False),
        ([bar(2, 2, 2), bar(2, 2, 2, (2.01, 0, 0))], True),
        ([bar(0.3, 0.3, 3, (x, 0, 0)) for x in (-1, 0, 1)] + [bar(3, 0.2, 0.2)], False),
    ],
    ids=["crossing bars", "bars apart", "corner in corner", "side by side", "grid"],
)
def test_parts_of_few_large_faces(tmp_path: Path, parts: list[trimesh.Trimesh], solid: bool) -> None:
    """The middles of such faces lie outside the other part: only edges tell."""
    assert bounds_solid(loaded(tmp_path, *parts)) == solid


def test_an_open_surface_is_none() -> None:
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0]], np.float32)
    sheet = Mesh(corners, np.tile(np.float32([0, 0, 1]), (3, 1)), np.array([[0, 1, 2]], np.int32), False)
    assert not is_solid(sheet)
