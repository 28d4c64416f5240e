"""Baked local thickness against closed forms."""

from pathlib import Path

import numpy as np
import pytest

from fakesss.local_thickness import bake_local_thickness, cast_inwards
from fakesss.mesh import Mesh, mesh_from_surface, mesh_from_triangles
from fakesss.reference import spherical_shell
from fakesss.shapes import built_in
from fakesss.solids import box, grid, knot, sphere, torus


def slab(thickness: float, cells: int = 24, lift: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """A closed square plate of side 2 in the xz plane, and its triangles facing outwards."""
    x, z = np.meshgrid(*(np.linspace(-1, 1, cells + 1),) * 2, indexing="ij")
    top = np.stack([x.ravel(), np.full(x.size, lift + thickness / 2), z.ravel()], axis=1)
    face = grid(cells + 1, cells + 1, closed=False)[:, ::-1]
    index = np.arange(x.size).reshape(x.shape)
    rim = np.concatenate([index[0, :-1], index[:-1, -1], index[-1, :0:-1], index[:0:-1, 0]])
    following, below = np.roll(rim, -1), rim + x.size
    sides = np.stack([rim, following, below, following, np.roll(below, -1), below], axis=1).reshape(-1, 3)
    return np.concatenate([top, top - [0, thickness, 0]]), np.concatenate([face, face[:, ::-1] + x.size, sides])


def middle(mesh: Mesh) -> np.ndarray:
    """Vertices of a slab far from its rim."""
    inner: np.ndarray = (np.abs(mesh.positions[:, [0, 2]]) < 0.1).all(axis=1)
    return inner


def mean_over_surface(mesh: Mesh, values: np.ndarray) -> tuple[float, float]:
    """Area-weighted mean of `values`, and 4 V / S in sphere diameters (Cauchy), by the divergence theorem."""
    corners = mesh.positions[mesh.faces].astype(float)
    doubled = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(doubled, axis=1) / 2
    volume = (corners[:, 0] * doubled).sum() / 6
    return float((values[mesh.faces].mean(axis=1) * area).sum() / area.sum()), float(4 * volume / area.sum() / 2)


@pytest.mark.parametrize("reach", [1.0, 0.5, 0.1])
def test_sphere(reach: float) -> None:
    """At cosine u the chord is u diameters; the mean of min(u, R) with density 2 u over 0..1 is R - R^3 / 3."""
    values, _ = cast_inwards(mesh_from_surface(*sphere(20_000)), 320, reach)
    assert values.dtype == np.float32
    np.testing.assert_allclose(values, reach - reach**3 / 3, atol=2e-3)


@pytest.mark.parametrize("thickness", [0.2, 0.02])
def test_slab(thickness: float) -> None:
    """A ray at cosine u is h / u long: the mean of min(h / u, R) with density 2 u is 2 h - h^2 / R."""
    mesh = mesh_from_triangles(*slab(thickness), "test")
    h, reach = thickness / mesh.radius / 2, 0.25
    values, _ = cast_inwards(mesh, 4096, reach)
    assert mesh.watertight and middle(mesh).sum() >= 8
    np.testing.assert_allclose(values[middle(mesh)], 2 * h - h * h / reach, rtol=0.01)


@pytest.mark.parametrize("thickness", [1e-3, 1e-4, 1e-5, 1e-7])
def test_plates_thinner_than_the_usual_clearance(thickness: float) -> None:
    """A second plate behind the gap must not be taken for the far side of the first."""
    first, faces = slab(thickness)
    second, _ = slab(thickness, lift=-0.3)
    mesh = mesh_from_triangles(np.concatenate([first, second]), np.concatenate([faces, faces + len(first)]), "test")
    values, _ = cast_inwards(mesh, 320, 0.25)
    assert values[middle(mesh)].max() <= thickness / mesh.radius * 1.02 + 1e-6


def test_needle() -> None:
    """Away from its ends a long round rod is as thick as its diameter: Cauchy's 4 V / S."""
    along, across, radius = 101, 32, 0.01
    z, angle = np.meshgrid(np.linspace(-1, 1, along), 2 * np.pi * np.arange(across) / across, indexing="ij")
    outward = np.stack([np.cos(angle), np.sin(angle), 0 * z], axis=-1)
    points = np.concatenate([(radius * outward + z[..., None] * [0, 0, 1]).reshape(-1, 3), [(0, 0, -1), (0, 0, 1)]])
    rings = np.arange(along * across).reshape(along, across)
    low, high = rings[:, :, None], np.roll(rings, -1, axis=1)[:, :, None]
    walls = np.concatenate([low[:-1], high[:-1], high[1:], low[:-1], high[1:], low[1:]], axis=2).reshape(-1, 3)
    caps = [
        np.stack([np.full(across, len(points) + end), *ring], axis=1)
        for end, ring in ((-2, (high[0, :, 0], low[0, :, 0])), (-1, (low[-1, :, 0], high[-1, :, 0])))
    ]
    mesh = mesh_from_triangles(points, np.concatenate([walls, *caps]), "test")
    values, _ = cast_inwards(mesh, 1024, 1.0)
    assert mesh.watertight
    inner = np.abs(mesh.positions[:, 2]) < 0.5
    np.testing.assert_allclose(values[inner] * mesh.radius, radius, rtol=0.02)


@pytest.mark.parametrize("make", [knot, torus, sphere])
def test_mean_chord_of_any_closed_object(make: object) -> None:
    mesh = mesh_from_surface(*make(20_000))  # type: ignore[operator]
    mean, exact = mean_over_surface(mesh, cast_inwards(mesh, 320, 1.0)[0])
    assert mean == pytest.approx(exact, rel=2e-3)


def test_a_cavity_ends_the_way() -> None:
    """A hollow sphere, its inner surface asked too: Cauchy's mean counts the cavity's area but not its volume."""
    mesh = spherical_shell(20_000)
    values, _ = cast_inwards(mesh, 320, 1.0)
    mean, exact = mean_over_surface(mesh, values)
    assert mean == pytest.approx(exact, rel=5e-3)
    # from outside: the wall at cosine u up to the grazing ray past the cavity, beyond it the whole chord
    u = (np.arange(200_000) + 0.5) / 200_000
    far = u * u < 1 - 0.8**2
    chord = np.where(far, u, (u - np.sqrt(np.maximum(u * u - 1 + 0.8**2, 0))) / 2)
    outer = np.linalg.norm(mesh.positions, axis=1) > 0.9
    assert values[outer].mean() == pytest.approx((2 * u * chord).mean(), abs=2e-3)


def test_open_sheet_holds_no_matter() -> None:
    x, z = np.meshgrid(*(np.linspace(-1, 1, 9),) * 2, indexing="ij")
    points = np.stack([x.ravel(), np.zeros(x.size), z.ravel()], axis=1)
    mesh = mesh_from_triangles(points, grid(9, 9, closed=False), "test")
    assert not mesh.watertight and cast_inwards(mesh, 64, 0.5)[0].max() == 0


def test_rays_out_of_an_opening_count_nothing() -> None:
    """Half a sphere: opposite the opening the chord is u where a ray still meets the bowl, elsewhere 0."""
    positions, _, faces = sphere(20_000)
    kept = faces[(positions[faces][:, :, 1] <= 1e-9).all(axis=1)]
    mesh = mesh_from_triangles(positions, kept, "test")
    values, _ = cast_inwards(mesh, 1024, 1.0)
    bottom = np.argmin(mesh.positions[:, 1])
    # in the bowl's own diameters a chord from the bottom ends below the opening where its cosine is below sqrt(1/2)
    assert values[bottom] * mesh.radius == pytest.approx(2 / 3 * 0.5**1.5, rel=0.02)


def test_neither_scale_nor_place_nor_order_matters() -> None:
    mesh = built_in("figure", 4000)
    points, faces = mesh.positions.astype(float), mesh.faces
    plain = mesh_from_triangles(points, faces, "test")
    values, _ = cast_inwards(plain, 64, 0.5)
    moved, _ = cast_inwards(mesh_from_triangles(1e6 * points + 1e7, faces, "test"), 64, 0.5)
    np.testing.assert_allclose(moved, values, atol=1e-3)
    order = np.random.default_rng(2011).permutation(len(plain.positions))
    place = np.argsort(order)
    shuffled = Mesh(plain.positions[order], plain.normals[order], place[plain.faces].astype(np.int32), True)
    np.testing.assert_allclose(cast_inwards(shuffled, 64, 0.5)[0], values[order], atol=1e-5)


def test_no_spots_where_triangles_are_crumpled() -> None:
    """A coarse figure runs through itself at three vertices, which have no inside."""
    values, _ = cast_inwards(built_in("figure", 4000), 64, 0.5)
    assert values.min() > 0.05 * values.mean()


def test_edges_are_thin_and_nothing_exceeds_the_reach() -> None:
    mesh = mesh_from_surface(*box(2_000))
    values, _ = cast_inwards(mesh, 320, 0.2)
    assert values.min() >= 0 and values.max() <= 0.2
    corners = (np.abs(mesh.positions) > 0.99 * np.abs(mesh.positions).max(axis=0)).all(axis=1)
    assert corners.sum() == 24 and values[corners].max() < values.mean()


def test_baked_once_per_content(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path))
    mesh = mesh_from_surface(*torus(2000))
    first, again = bake_local_thickness(mesh, 64), bake_local_thickness(mesh, 64)
    assert not first.cached and again.cached and again.rays_cast == 0
    assert first.rays_cast == pytest.approx(64 * len(mesh.positions), rel=0.05)
    np.testing.assert_array_equal(first.values, again.values)
    assert not bake_local_thickness(mesh, 65).cached
    assert not bake_local_thickness(mesh, 64, 0.3).cached
