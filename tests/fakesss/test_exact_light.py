"""What rays say of shadows and occlusion: closed forms of balls, tables and walls."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from fakesss.accuracy.exact import Truth
from fakesss.accuracy.exact_light import lit_shares, onto_smooth_surface, point_occlusion, sample_occlusion
from fakesss.accuracy.exact_sight import corner_shares, interpolated
from fakesss.camera import direction
from fakesss.ray_casting import Caster
from fakesss.scene import Occlusion, Scene
from fakesss.shapes import load_object
from fakesss.vertex_normals import normalised

Floats = NDArray[np.float64]
UP = np.array([0.0, 1.0, 0.0])


def ball_on_table(folder: Path) -> str:
    """A ball of radius 0.5 floating at y = 1 over a table of 4 x 4 in the plane y = 0, before it is scaled."""
    table, ball = trimesh.creation.box([4, 0.2, 4]), trimesh.creation.icosphere(5, 0.5)
    table.apply_translation([0, -0.1, 0])
    ball.apply_translation([0, 1, 0])
    path = folder / "ball.ply"
    trimesh.util.concatenate([table, ball]).export(path)
    return str(path)


def on_the_table(truth: Truth, count: int = 4000) -> Floats:
    """Random points of the table top, world frame."""
    spread = np.random.default_rng(3).uniform(-1.9, 1.9, (count, 2))
    file = np.column_stack([spread[:, 0], np.zeros(count), spread[:, 1]])
    return np.asarray((file - truth.mesh.centre) / truth.mesh.radius)


LIGHTS: dict[str, dict[str, Any]] = {
    "directional": {"light.azimuth": 40.0, "light.elevation": 60.0},
    "point": {"light.kind": "point", "light.distance": 0.8, "light.azimuth": 40.0, "light.elevation": 60.0},
    "spot": {"light.kind": "spot", "light.distance": 1.5, "light.cutoff": 80.0, "light.elevation": 70.0},
    "point between": {"light.kind": "point", "light.distance": 0.15, "light.elevation": -90.0},
}


@pytest.mark.parametrize("name", LIGHTS)
def test_a_ball_hides_a_light_from_a_table_where_geometry_says(tmp_path: Path, name: str) -> None:
    """Where the way to the light passes the ball's centre by less than its radius, if the light lies behind it."""
    scene = Scene(object=ball_on_table(tmp_path)).replace({**LIGHTS[name], "light.shadows": True})
    truth = Truth(scene, 1)
    points = on_the_table(truth)
    lit = lit_shares(truth.setting, truth.caster, points, np.tile(UP, (len(points), 1)))[0]
    radius, middle = 0.5 / truth.mesh.radius, (UP - truth.mesh.centre) / truth.mesh.radius
    towards = direction(scene.light.azimuth, scene.light.elevation)
    way = np.tile(towards, (len(points), 1))
    if scene.light.kind != "directional":
        way = scene.light.distance * towards - points
    length = np.linalg.norm(way, axis=1)
    along = ((middle - points) * way).sum(axis=1) / length
    passing = np.sqrt(((middle - points) ** 2).sum(axis=1) - along**2) / radius
    far = np.full(len(points), np.inf) if scene.light.kind == "directional" else length
    hidden = (passing < 1) & (along - radius * np.sqrt(np.maximum(1 - passing**2, 0)) < far)
    sure = np.abs(passing - 1) > 0.02  # the ball is of flat triangles
    assert np.array_equal(lit[sure], np.where(hidden, 0.0, 1.0)[sure])
    assert (lit[sure] == 1).sum() > 100
    assert hidden.any() == (name != "point between")  # a light under the ball is hidden from nothing on the table


def test_only_lights_that_cast_shadows_and_shine_are_asked(tmp_path: Path) -> None:
    scene = Scene(object=ball_on_table(tmp_path)).replace(
        {"lights": ({"shadows": True}, {"shadows": True, "diffuse": (0, 0, 0), "specular": (0, 0, 0)}, {})}
    )
    truth = Truth(scene, 1)
    points = on_the_table(truth, 10)
    assert list(lit_shares(truth.setting, truth.caster, points, np.tile(UP, (10, 1)))) == [1]


def test_flat_triangles_of_a_ball_are_lifted_to_it() -> None:
    """All over a coarse sphere: above its triangles, and a third of their depth from the round surface at most."""
    mesh = load_object("sphere:1000")
    rng = np.random.default_rng(4)
    faces = rng.integers(len(mesh.faces), size=3000).astype(np.int32)
    points = interpolated(mesh, mesh.positions, faces, rng.dirichlet((1, 1, 1), len(faces)))
    shares = corner_shares(mesh, faces, points)
    lifted = onto_smooth_surface(mesh, faces, shares, points, np.zeros(len(faces), bool))
    depth, left = 1 - np.linalg.norm(points, axis=1), 1 - np.linalg.norm(lifted, axis=1)
    assert depth.max() > 3e-3 and (left <= depth + 1e-9).all()
    assert left.max() < 0.1 * depth.max() and -left.min() < 1.1 * depth.max()
    # and seen from inside, where its normals are turned, nothing is below them
    inside = onto_smooth_surface(mesh, faces, shares, points, np.ones(len(faces), bool))
    np.testing.assert_allclose(inside, points, atol=1e-9)


def test_a_ball_in_triangles_casts_no_shadow_on_its_lit_side() -> None:
    """Wherever smooth shading lets light arrive, to two degrees of the horizon; from flat triangles it does."""
    scene = Scene(object="sphere:1000").replace({"light.shadows": True, "light.elevation": 17.0})
    truth = Truth(scene, 1)
    mesh, rng = truth.mesh, np.random.default_rng(5)
    faces = rng.integers(len(mesh.faces), size=20000).astype(np.int32)
    shares = rng.dirichlet((1, 1, 1), len(faces))
    normals = normalised(interpolated(mesh, mesh.normals, faces, shares))
    points = interpolated(mesh, mesh.positions, faces, shares)
    starts = onto_smooth_surface(mesh, faces, shares, points, np.zeros(len(faces), bool))
    lit = lit_shares(truth.setting, truth.caster, starts, normals)[0]
    above = normals @ direction(scene.light.azimuth, scene.light.elevation) > np.sin(np.radians(2))
    assert above.sum() > 1000 and (lit[above] == 1).all()
    assert (lit_shares(truth.setting, truth.caster, points, normals)[0][above] == 0).sum() > 10


def test_beside_a_wall_points_are_as_open_as_the_closed_form(tmp_path: Path) -> None:
    """Projected on the floor the hemisphere is a disc (Nusselt 1928), and what meets the wall its segment."""
    path = tmp_path / "corner.ply"
    low, high = [[-1, 0, 0], [1, 0, 0], [1, 0, 1], [-1, 0, 1]], [[-1, 0, 0], [1, 0, 0], [1, 1, 0], [-1, 1, 0]]
    trimesh.Trimesh([*low, *high], [[0, 3, 2], [0, 2, 1], [4, 5, 6], [4, 6, 7]], process=False).export(path)
    mesh = load_object(str(path))
    apart = np.linspace(0.02, 0.4, 30)
    file = np.column_stack([np.zeros(30), np.zeros(30), apart * mesh.radius])
    points = (file - mesh.centre) / mesh.radius
    settings = Occlusion(radius=0.15)
    found = point_occlusion(Caster(mesh), points, np.tile(UP, (30, 1)), settings, rays=4096)
    c = np.clip(apart / 0.3, 0, 1)
    np.testing.assert_allclose(found, 1 - (np.arccos(c) - c * np.sqrt(1 - c * c)) / np.pi, atol=5e-3)
    assert found.min() < 0.6 and found.max() == 1
    # the same of 64 samples in each place, with 64 rays each, their own directions
    places, numbers, up = np.repeat(points, 64, axis=0), np.tile(np.arange(64), 30), np.tile(UP, (30 * 64, 1))
    near = settings.model_copy(update={"method": "screen-space"})
    spread = sample_occlusion(Caster(mesh), places, up, numbers, near, 64).reshape(30, 64)
    np.testing.assert_allclose(spread.mean(axis=1), found, atol=8e-3)
    assert spread.std(axis=1).max() > 0.005
    far = sample_occlusion(Caster(mesh), places, up, numbers, settings, 64).reshape(30, 64)
    assert (far.mean(axis=1) < found - 0.05).any()
