"""Exact thickness: ray casting and closed forms check each other."""

from collections.abc import Callable

import numpy as np
import pytest

from fakesss.camera import View
from fakesss.mesh import Mesh, mesh_from_surface, mesh_from_triangles
from fakesss.reference import (
    ExactInterval,
    Interval,
    box_interval,
    camera_rays,
    shell_interval,
    sphere_interval,
    spherical_shell,
    thickness,
    torus_interval,
)
from fakesss.scene import Camera
from fakesss.solids import box, sphere, torus

CASES: dict[str, tuple[Callable[[], Mesh], Callable[..., Interval], float]] = {
    "sphere": (lambda: mesh_from_surface(*sphere(100_000)), sphere_interval, 1e-3),
    "box": (lambda: mesh_from_surface(*box(2_000)), box_interval, 1e-6),
    "torus": (lambda: mesh_from_surface(*torus(100_000)), torus_interval, 2e-3),
    "shell": (lambda: spherical_shell(200_000), shell_interval, 2e-3),
}


def rays(camera: Camera, pixels: int = 96) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    view = View.of(camera, (pixels, pixels))
    return *camera_rays(view, (pixels, pixels)), -view.rotation[2]


@pytest.mark.parametrize(
    "camera", [Camera(), Camera(azimuth=33, elevation=25, field_of_view=60)], ids=["front", "turned"]
)
@pytest.mark.parametrize("name", CASES)
def test_meshes_agree_with_closed_forms(name: str, camera: Camera) -> None:
    make, closed_form, p999 = CASES[name]
    origins, directions, forward = rays(camera)
    exact = thickness(closed_form(origins, directions), directions, forward)
    cast = thickness(ExactInterval(make())(origins, directions), directions, forward)
    assert (np.isnan(exact) != np.isnan(cast)).mean() < 1e-3, "only silhouettes may differ"
    error = np.abs(exact - cast)[np.isfinite(exact) & np.isfinite(cast)]
    assert len(error) > 1000
    assert np.median(error) < 1e-4 and np.percentile(error, 99) < p999


def test_a_ray_through_the_middle() -> None:
    origin, direction = np.array([[0.0, 0, 4]]), np.array([[0.0, 0, -1]])
    assert np.ravel(sphere_interval(origin, direction)) == pytest.approx((3, 5))
    assert np.ravel(shell_interval(origin, direction, 1.0, 0.8)) == pytest.approx((3, 3.2))
    assert np.ravel(box_interval(origin, direction)) == pytest.approx((4 - 1 / 3, 4 + 1 / 3))
    assert np.isnan(torus_interval(origin, direction)).all(), "through the hole"
    along_x = np.array([[4.0, 0, 0]]), np.array([[-1.0, 0, 0]])
    assert np.ravel(torus_interval(*along_x)) == pytest.approx((3, 3.6))
    assert thickness(sphere_interval(origin, direction), direction, np.array([0.0, 0, -1])) == pytest.approx(1)


@pytest.mark.parametrize("closed_form", [sphere_interval, box_interval, torus_interval, shell_interval])
def test_rays_that_miss_have_no_interval(closed_form: Callable[..., Interval]) -> None:
    origin, direction = np.array([[0.0, 2, 4], [0.0, 2, 4]]), np.array([[0.0, 0, -1], [0.0, 1, 0]])
    assert np.isnan(closed_form(origin, direction)).all()


def test_torus_roots_lie_on_the_torus() -> None:
    rng = np.random.default_rng(2011)
    origins = rng.normal(size=(2000, 3))
    origins *= 3 / np.linalg.norm(origins, axis=1, keepdims=True)
    directions = 0.5 * rng.uniform(-1, 1, (2000, 3)) - origins
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    for distance in torus_interval(origins, directions):
        hit = np.isfinite(distance)
        at = origins[hit] + distance[hit, None] * directions[hit]
        away = np.hypot(np.hypot(at[:, 0], at[:, 1]) - 0.7, at[:, 2]) - 0.3
        assert hit.sum() > 500
        np.testing.assert_allclose(away, 0, atol=1e-6)


def test_rays_through_edges_and_vertices_do_not_slip() -> None:
    """Every ray goes through a vertex or the middle of an edge of a coarse sphere."""
    mesh = mesh_from_surface(*sphere(980))
    middles = mesh.positions[mesh.faces[:, :2]].mean(axis=1)
    targets = np.concatenate([mesh.positions, middles]).astype(float)
    facing = targets[targets[:, 2] > 0.05]
    origins = np.tile([0.0, 0, 4], (len(facing), 1))
    directions = facing - origins
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    inside = (directions @ np.array([0, 0, -1])) > np.cos(np.arcsin(0.24))
    entry, leave = ExactInterval(mesh)(origins[inside], directions[inside])
    true_entry, true_leave = sphere_interval(origins[inside], directions[inside])
    np.testing.assert_allclose(entry, true_entry, atol=0.05)
    np.testing.assert_allclose(leave, true_leave, atol=0.05)


def test_open_sheet_has_an_entry_but_no_exit() -> None:
    corners = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float)
    mesh = mesh_from_triangles(corners, np.array([(0, 1, 2), (0, 2, 3)]), "test")
    entry, leave = ExactInterval(mesh)(np.array([[0.1, 0.2, 4]]), np.array([[0.0, 0, -1]]))
    assert entry == pytest.approx(4) and np.isnan(leave).all()


def test_camera_rays_meet_the_pictures_corners() -> None:
    """The middle of the outermost pixels lies half a pixel inside the field of view; the first row is the top."""
    size = (8, 4)
    view = View.of(Camera(elevation=0, field_of_view=90), size)
    origins, directions = camera_rays(view, size)
    assert origins.shape == directions.shape == (32, 3)
    np.testing.assert_allclose(origins, np.tile([0, 0, view.distance], (32, 1)), atol=1e-12)
    np.testing.assert_allclose(directions[0] / -directions[0, 2], (-1.75, 0.75, -1), atol=1e-12)
    np.testing.assert_allclose(directions[-1] / -directions[-1, 2], (1.75, -0.75, -1), atol=1e-12)
