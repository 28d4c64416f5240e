"""Triangles without height are flipped away and leave no crease."""

import numpy as np
import pytest
import trimesh

from fakesss.mesh import mesh_from_triangles
from fakesss.mesh_repair import is_closed
from fakesss.mesh_slivers import without_slivers
from fakesss.vertex_normals import slivers, with_creases

BALL = trimesh.creation.icosphere(3)
POINTS, FACES = np.array(BALL.vertices), np.array(BALL.faces)


def cut_along(number: int) -> tuple[np.ndarray, np.ndarray]:
    """The ball with one triangle's side cut by `number` vertices, and slivers between them and the neighbour."""
    a, b, c = FACES[0]
    inner = POINTS[a] + np.linspace(0, 1, number + 2)[1:-1, None] * (POINTS[b] - POINTS[a])
    chain = [a, *range(len(POINTS), len(POINTS) + number), b]
    fan = [(chain[i], chain[i + 1], c) for i in range(number + 1)]
    caps = [(chain[i + 1], chain[i], b) for i in range(number)]
    return np.concatenate([POINTS, inner]), np.concatenate([FACES[1:], fan, caps])


@pytest.mark.parametrize("number", [1, 2, 7])
def test_vertices_on_a_side_are_taken_in_by_the_neighbour(number: int) -> None:
    positions, faces = cut_along(number)
    single = positions.astype(np.float32)
    assert slivers(single, faces).sum() == number
    repairs: list[str] = []
    mended = without_slivers(single, faces.astype(np.int32), repairs)
    assert not slivers(single, mended).any() and len(mended) == len(faces) and is_closed(mended)
    assert set(mended.ravel()) == set(faces.ravel()), "no vertex is lost"
    volumes = [trimesh.Trimesh(positions, part, process=False).volume for part in (faces, mended)]
    assert volumes[0] == pytest.approx(volumes[1], rel=1e-7)
    assert len(repairs) == 1 and "without height" in repairs[0]


def test_two_slivers_back_to_back_go() -> None:
    line = np.concatenate([POINTS, [POINTS[0] * 0.5, POINTS[0] * 0.7, POINTS[0] * 0.9]]).astype(np.float32)
    a, b, c = range(len(POINTS), len(POINTS) + 3)
    faces = np.concatenate([FACES, [(a, b, c), (a, c, b)]]).astype(np.int32)
    assert len(without_slivers(line, faces, [])) == len(FACES)
    once = faces[:-1]
    assert len(without_slivers(line, once, [])) == len(once), "alone it may be a side of something"


def test_a_sound_mesh_and_both_sides_of_a_sheet_stay() -> None:
    single = POINTS.astype(np.float32)
    both = np.concatenate([FACES, FACES[:, ::-1]]).astype(np.int32)
    for faces in (FACES.astype(np.int32), both):
        assert without_slivers(single, faces, []) is faces


def test_a_sliver_that_stays_makes_no_crease_and_turns_no_normal() -> None:
    """Its own normal is what rounding made of it; here it points along the surface."""
    positions, faces = cut_along(1)
    positions[-1] += 1e-8 * FACES[0, 0]
    points, normals, _ = with_creases(positions.astype(np.float32), faces.astype(np.int32))
    assert len(points) == len(positions)
    assert (normals * points).sum(axis=1).min() > 0.98


def test_only_slivers_is_no_surface() -> None:
    line = np.array([(0, 0, 0), (1, 0, 0), (3, 0, 0)], float)
    with pytest.raises(ValueError, match="no surface"):
        mesh_from_triangles(line, np.array([(0, 1, 2), (0, 2, 1)]), "line")
