"""Rendered thickness against closed forms, and against rays cast through the same triangles."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from fakesss import reference
from fakesss.camera import View
from fakesss.crossings import Crossings, bridged_paths, paths
from fakesss.mesh import load_mesh
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.shapes import load_object

Floats = NDArray[np.float64]
SIZE = (512, 512)
JUMP = 0.1  # sphere diameters between neighbours: the edge of something inside the outline
CAMERA = {"camera.azimuth": 25.0, "camera.elevation": 20.0}


def rays(view: View) -> tuple[Floats, Floats]:
    """World-frame origins and unit directions (H * W, 3) through the pixels' centres, top row first."""
    width, height = SIZE
    x = ((np.arange(width) + 0.5) / width * 2 - 1) * view.tangent[0]
    y = (1 - (np.arange(height) + 0.5) / height * 2) * view.tangent[1]
    eye = np.stack([*np.meshgrid(x, y), np.full((height, width), -1.0)], axis=-1).reshape(-1, 3)
    directions = eye @ view.rotation
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return np.tile(view.distance * view.rotation[2], (len(eye), 1)), directions


def exact_thickness(view: View, interval: Callable[[Floats, Floats], reference.Interval]) -> Floats:
    """(H, W) in sphere diameters, NaN where the ray misses."""
    origins, directions = rays(view)
    t = reference.thickness(interval(origins, directions), directions, -view.rotation[2])
    return t.reshape(SIZE[1], SIZE[0])


def off_silhouettes(t: Floats) -> NDArray[np.bool_]:
    """Pixels whose eight neighbours all hit, with no jump of thickness to any of them."""
    padded = np.pad(t, 1, constant_values=np.nan)
    height, width = t.shape
    around = [padded[y : y + height, x : x + width] for y in range(3) for x in range(3)]
    with np.errstate(invalid="ignore"):
        return np.all([np.abs(neighbour - t) < JUMP for neighbour in around], axis=0)


def shell_file(folder: Path) -> str:
    mesh = reference.spherical_shell(240_000)
    path = folder / "shell.ply"
    trimesh.Trimesh(mesh.positions, mesh.faces, process=False).export(path)
    return str(path)


# Bounds on the maximum and the 99.9th percentile of the error, in sphere diameters. Against rays through the same
# triangles only float32 and the rasteriser's 1/256 pixel grid remain; against the closed form also the triangles'
# distance from the solid they approximate, which the box does not have.
ROUNDING = (1e-5, 2e-6)
TRIANGLES = (6e-4, 4e-4)
SOLIDS = [
    ("sphere:240000", reference.sphere_interval, TRIANGLES),
    ("box:60000", reference.box_interval, ROUNDING),
    ("torus:240000", reference.torus_interval, TRIANGLES),
    ("shell", reference.shell_interval, TRIANGLES),
]


@pytest.mark.gl
@pytest.mark.parametrize("method", ["auto", "peel"])
@pytest.mark.parametrize(("name", "interval", "bounds"), SOLIDS, ids=[solid[0] for solid in SOLIDS])
def test_thickness_of_solids(  # type: ignore[no-untyped-def]
    renderer: Renderer, tmp_path, record_property, name, interval, bounds, method
) -> None:
    name = shell_file(tmp_path) if name == "shell" else name
    scene = Scene(object=name, size=SIZE).replace({**CAMERA, "layers.method": method})
    view = View.of(scene.camera, scene.size)
    drawn = renderer.data(scene, ("thickness",))["thickness"]
    mesh = load_mesh(name) if name.endswith(".ply") else load_object(name)
    truths = [("closed form", interval, bounds), ("ray casting", reference.ExactInterval(mesh), ROUNDING)]
    for against, truth, (worst, most) in truths:
        exact = exact_thickness(view, truth)
        error = np.abs(drawn - exact)[off_silhouettes(exact)]
        p999 = float(np.percentile(error, 99.9))
        record_property(against, f"max {error.max():.1e}, 99.9% {p999:.1e}, pixels {error.size}")
        print(f"{Path(name).name} against {against}: max {error.max():.2e} 99.9% {p999:.2e} pixels {error.size}")
        assert error.size > 10_000
        assert error.max() < worst and p999 < most
    assert drawn.dtype == np.float32 and drawn.shape == SIZE[::-1]
    assert np.isfinite(drawn).all() and (drawn[np.isnan(exact) & ~near(exact)] == 0).all()


BETWEEN = ["figure:30000", "knot:30000", "hand:30000", "torus:30000"]


@pytest.mark.gl
@pytest.mark.parametrize("kind", ["total-path", "bridged"])
@pytest.mark.parametrize("name", BETWEEN)
def test_longer_ways_through_solids(renderer: Renderer, name: str, kind: str) -> None:
    """Against every crossing of rays through the same triangles, sphere diameters along the view axis."""
    scene = Scene(object=name, size=SIZE).replace({**CAMERA, "material.thickness": kind})
    view = View.of(scene.camera, scene.size)
    drawn = renderer.data(scene, ("thickness",))["thickness"]
    origins, directions = rays(view)
    hits = Crossings(load_object(name))(origins, directions)
    depths = hits.distances * (directions @ -view.rotation[2])[:, None]
    inside = paths(hits, depths) if kind == "total-path" else bridged_paths(hits, depths, 2 * scene.layers.gap)
    truth = np.where(hits.sides[:, :1].any(axis=1), inside / 2, np.nan).reshape(SIZE[::-1])
    alternating = (np.abs(np.cumsum(hits.sides, axis=1) + 0.5) == 0.5).all(axis=1).reshape(truth.shape)
    sure = off_silhouettes(truth) & alternating
    error = np.abs(drawn - truth)[sure]
    print(f"{name} {kind}: max {error.max():.2e} 99.9% {np.percentile(error, 99.9):.2e} pixels {error.size}")
    assert error.size > 10_000
    assert np.percentile(error, 99.9) < ROUNDING[1] and error.max() < 2e-3


@pytest.mark.gl
def test_bridging_parts_that_pass_through_one_another(renderer: Renderer, tmp_path: Path) -> None:
    """Two balls, one into the other: their union is one stretch, where it can be told by six layers."""
    balls = [trimesh.creation.icosphere(subdivisions=4) for _ in range(2)]
    balls[1].apply_translation((0.4, 0.2, -0.9))
    path = tmp_path / "balls.ply"
    trimesh.util.concatenate(balls).export(path)
    scene = Scene(object=str(path), size=SIZE).replace({"material.thickness": "bridged"})
    view, mesh = View.of(scene.camera, scene.size), load_mesh(path)
    origins, directions = rays(view)
    hits = Crossings(mesh)(origins, directions)
    depths = hits.distances * (directions @ -view.rotation[2])[:, None]
    truth = bridged_paths(hits, depths, 2 * scene.layers.gap) / 2
    truth = np.where(hits.sides[:, :1].any(axis=1), truth, np.nan).reshape(SIZE[::-1])
    error = np.abs(renderer.data(scene, ("thickness",))["thickness"] - truth)[off_silhouettes(truth)]
    assert error.size > 10_000 and np.percentile(error, 99.9) < 1e-5
    assert np.nanmax(truth) > 0.8  # more than either ball


def near(t: Floats) -> NDArray[np.bool_]:
    """Pixels at most one away from the object."""
    hit = np.pad(~np.isnan(t), 1)
    return np.any([hit[y : y + t.shape[0], x : x + t.shape[1]] for y in range(3) for x in range(3)], axis=0)
