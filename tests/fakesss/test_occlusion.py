"""Baked occlusion against closed forms."""

from pathlib import Path

import numpy as np
import pytest

from fakesss.hemisphere import Sampling, even_directions
from fakesss.mesh import Mesh, mesh_from_surface, mesh_from_triangles
from fakesss.occlusion import bake_occlusion, cast_rays
from fakesss.solids import box, grid, sphere, torus

BOTH: tuple[Sampling, ...] = ("cosine", "uniform")


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path))
    return tmp_path


def plane(cells: int, half: float) -> tuple[np.ndarray, np.ndarray]:
    """A horizontal square of that half side, facing +y."""
    x, z = np.meshgrid(*(np.linspace(-half, half, cells + 1),) * 2, indexing="ij")
    return np.stack([x.ravel(), np.zeros(x.size), z.ravel()], axis=1), grid(cells + 1, cells + 1, closed=False)[:, ::-1]


def joined(*parts: tuple[np.ndarray, np.ndarray]) -> Mesh:
    starts = np.cumsum([0] + [len(positions) for positions, _ in parts[:-1]])
    faces = np.concatenate([faces + start for (_, faces), start in zip(parts, starts, strict=True)])
    return mesh_from_triangles(np.concatenate([positions for positions, _ in parts]), faces, "test")


@pytest.mark.parametrize("sampling", BOTH)
@pytest.mark.parametrize("make", [sphere, box])
def test_nothing_shades_a_convex_object(make: object, sampling: Sampling) -> None:
    values, _ = cast_rays(mesh_from_surface(*make(2000)), 320, sampling)  # type: ignore[operator]
    assert values.dtype == np.float32 and values.min() > 0.995 and values.max() <= 1


@pytest.mark.parametrize("sampling", BOTH)
def test_inside_a_closed_room_no_ray_gets_out(sampling: Sampling) -> None:
    """Also from its corners, whose vertices lie on three walls at once."""
    positions, normals, faces = box(500)
    values, _ = cast_rays(mesh_from_surface(positions, -normals, faces[:, ::-1]), 320, sampling)
    assert values.max() == 0


def test_floor_beside_a_wall() -> None:
    """At distance d a long wall of height h hides (1 - d / sqrt(h^2 + d^2)) / 2 of the cosine-weighted sky."""
    floor, floor_faces = plane(40, 1.0)
    height, long = 0.4, 8.0
    wall = np.array([(-0.5, 0, -long), (-0.5, height, -long), (-0.5, height, long), (-0.5, 0, long)])
    mesh = joined((floor, floor_faces), (wall, np.array([(0, 1, 2), (0, 2, 3)])))
    scale = 1 / mesh.radius
    values, _ = cast_rays(mesh, 8192, "cosine")
    here = mesh.positions / scale + np.array(mesh.centre)
    middle = (np.abs(here[:, 1]) < 1e-3) & (np.abs(here[:, 2]) < 0.05) & (here[:, 0] > -0.3) & (here[:, 0] < 0.9)
    distance = here[middle, 0] + 0.5
    expected = 1 - (1 - distance / np.hypot(height, distance)) / 2
    assert middle.sum() >= 20
    np.testing.assert_allclose(values[middle], expected, atol=0.01)


def test_sphere_resting_on_a_plane() -> None:
    """Seen from the plane at distance d from where it rests, a unit sphere hides cos(elevation) sin^2(half angle).

    Its centre is at height 1 and distance s = sqrt(1 + d^2), so it hides (1 / s^2) (1 / s) of the cosine-weighted sky
    where all of it lies above the horizon, as it does on the plane it rests on.
    """
    floor, floor_faces = plane(60, 6.0)
    ball, _, ball_faces = sphere(8000)
    mesh = joined((floor, floor_faces), (ball + np.array([0, 1.0, 0]), ball_faces))
    values, _ = cast_rays(mesh, 4096, "cosine")
    here = mesh.positions * mesh.radius + np.array(mesh.centre)
    ground = (np.abs(here[:, 1]) < 1e-4) & (mesh.normals[:, 1] > 0.99)
    distance = np.hypot(here[ground, 0], here[ground, 2])
    away = distance > 0.3
    expected = 1 - (1 + distance[away] ** 2) ** -1.5
    np.testing.assert_allclose(values[ground][away], expected, atol=0.01)


def test_error_falls_with_the_number_of_rays() -> None:
    mesh = mesh_from_surface(*torus(2000))
    exact, _ = cast_rays(mesh, 8192, "cosine")
    errors = [float(np.sqrt(((cast_rays(mesh, rays, "cosine")[0] - exact) ** 2).mean())) for rays in (20, 80, 320)]
    assert errors[0] > 2 * errors[1] > 4 * errors[2]
    assert errors[2] < 0.005


def test_sampling_differs_where_the_horizon_is_blocked() -> None:
    """Inside of the ring the view is blocked low over the surface, which a cosine counts less."""
    mesh = mesh_from_surface(*torus(2000))
    cosine, uniform = (cast_rays(mesh, 320, sampling)[0] for sampling in BOTH)
    inner = np.hypot(mesh.positions[:, 0], mesh.positions[:, 1]) < 0.41
    outer = np.hypot(mesh.positions[:, 0], mesh.positions[:, 1]) > 0.9
    assert cosine[outer].min() > 0.999
    assert cosine[inner].mean() < 0.9 and abs(cosine[inner].mean() - uniform[inner].mean()) > 0.02


def test_no_speckle() -> None:
    """The error hardly differs between neighbours; with directions drawn anew for each vertex it would by 0.02."""
    mesh = mesh_from_surface(*torus(8_000))
    error = cast_rays(mesh, 320, "cosine")[0] - cast_rays(mesh, 4096, "cosine")[0]
    steps = error[mesh.faces] - error[np.roll(mesh.faces, 1, axis=1)]
    assert np.sqrt((steps**2).mean()) < 0.004


def test_baked_once_per_content(own_cache: Path) -> None:
    mesh = mesh_from_surface(*torus(2000))
    first, again = bake_occlusion(mesh, 64), bake_occlusion(mesh, 64)
    assert not first.cached and again.cached and again.rays_cast == 0
    assert first.rays == 64 and first.rays_cast == pytest.approx(64 * len(mesh.positions), rel=0.05)
    np.testing.assert_array_equal(first.values, again.values)
    assert not bake_occlusion(mesh, 65).cached
    assert not bake_occlusion(mesh, 64, "uniform").cached
    assert not bake_occlusion(mesh_from_surface(*torus(2100)), 64).cached
    assert len(list(own_cache.rglob("*.npz"))) == 4


def test_deterministic() -> None:
    mesh = mesh_from_surface(*torus(4000))
    np.testing.assert_array_equal(cast_rays(mesh, 100, "cosine")[0], cast_rays(mesh, 100, "cosine")[0])


def test_directions_are_even() -> None:
    directions = even_directions(640)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1)
    np.testing.assert_allclose(directions.mean(axis=0), 0, atol=2e-3)
    for normal in np.eye(3):
        above = directions[directions @ normal > 0]
        assert len(above) == pytest.approx(320, abs=4)
        assert (above @ normal).mean() == pytest.approx(0.5, abs=0.003)


def test_one_ray_is_enough_to_be_finite() -> None:
    values, _ = cast_rays(mesh_from_surface(*torus(1000)), 1, "cosine")
    assert np.isfinite(values).all() and values.min() >= 0 and values.max() <= 1
