"""Order in memory after order in space."""

import numpy as np

from fakesss.mesh import mesh_from_triangles
from fakesss.shapes import load_object
from fakesss.space_order import along_curve, in_space_order


def jumps(positions: np.ndarray, faces: np.ndarray) -> float:
    """Mean distance between faces that follow each other."""
    middle = positions[faces].mean(axis=1)
    return float(np.linalg.norm(np.diff(middle, axis=0), axis=1).mean())


def test_what_follows_is_near() -> None:
    mesh = load_object("sphere:4000")
    shuffled = np.random.default_rng(1).permutation(mesh.faces)
    positions, faces = in_space_order(mesh.positions, shuffled)
    assert jumps(positions, faces) < 0.15 * jumps(mesh.positions, shuffled)
    assert np.abs(np.diff(faces[:, 0])).mean() < 0.1 * len(positions)


def test_the_surface_stays_the_same() -> None:
    mesh = load_object("torus:2000")
    positions, faces = in_space_order(mesh.positions, mesh.faces)
    before, after = (
        np.sort(p[f].reshape(len(f), -1), axis=0) for p, f in ((mesh.positions, mesh.faces), (positions, faces))
    )
    np.testing.assert_array_equal(before, after)
    assert len(positions) == len(np.unique(mesh.faces)) and faces.dtype == np.int32


def test_a_shuffled_file_is_drawn_in_the_same_order() -> None:
    mesh = load_object("torus:2000")
    shuffled = np.random.default_rng(2).permutation(mesh.faces)
    one, other = (mesh_from_triangles(mesh.positions.astype(float), faces, "torus") for faces in (mesh.faces, shuffled))
    assert jumps(other.positions, other.faces) < 1.1 * jumps(one.positions, one.faces)


def test_the_curve_keeps_neighbours_together() -> None:
    corners = np.stack(np.meshgrid(*[np.linspace(-1, 1, 8)] * 3), axis=-1).reshape(-1, 3).astype(np.float32)
    order = along_curve(corners)
    assert sorted(order) == list(range(len(corners)))
    steps = np.linalg.norm(np.diff(corners[order], axis=0), axis=1)
    assert np.median(steps) <= 2 / 7 + 1e-6
