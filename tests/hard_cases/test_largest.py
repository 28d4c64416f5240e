"""The largest mesh and the largest picture: loaded and drawn in bounded time and memory."""

import resource
import time
from pathlib import Path

import numpy as np
import pytest
from hard_meshes import Surface, ply, stl

from fakesss.camera import View
from fakesss.gpu import shared
from fakesss.mesh import load_mesh
from fakesss.reference import camera_rays, torus_interval
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.solids import TORUS_RADII, angles, grid

pytestmark = pytest.mark.gl

GIGABYTES = 8.0  # of resident memory: half of what a study's computer usually has
FEW, MANY = 200_000, 5_000_000


def fine_torus(faces: int) -> Surface:
    """A torus around z of exactly so many triangles (twice a square), its vertices on the true surface."""
    side = round(np.sqrt(faces / 2))
    u, v = angles(side, side)
    reach = TORUS_RADII[0] + TORUS_RADII[1] * np.cos(v)
    positions = np.stack([reach * np.cos(u), reach * np.sin(u), TORUS_RADII[1] * np.sin(v)], axis=1)
    return positions, grid(side, side, closed=True)


@pytest.mark.parametrize("faces", [FEW, pytest.param(MANY, marks=[pytest.mark.long, pytest.mark.timeout(900)])])
@pytest.mark.parametrize(("written", "suffix"), [(ply, ".ply"), (stl, ".stl")])
def test_a_mesh_of_so_many_triangles(tmp_path: Path, faces: int, written, suffix: str) -> None:  # type: ignore[no-untyped-def]
    path = tmp_path / f"fine{suffix}"
    path.write_bytes(written(fine_torus(faces)))
    started = time.process_time()
    mesh = load_mesh(path)
    took = time.process_time() - started
    assert len(mesh.faces) == pytest.approx(faces, rel=1e-2) and mesh.watertight
    assert took < 60 * max(faces / MANY, 0.1), f"{took:.1f} s of processor time"
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < GIGABYTES * 1e6
    scene = Scene(object=str(path), size=(256, 256), supersampling=1)
    scene = scene.replace({"camera.elevation": 35.0, "occlusion.rays": 8})
    layers = Renderer(shared()).data(scene, ("thickness", "image"))
    view = View.of(scene.camera, scene.size)
    origins, directions = camera_rays(view, scene.size)
    entry, leave = torus_interval(origins, directions)
    exact = ((leave - entry) * -(directions @ view.rotation[2]) / 2).reshape(256, 256)
    error = np.abs(layers["thickness"] - exact)[~np.isnan(exact)]
    assert np.isfinite(layers["image"]).all()
    assert np.median(error) < 8 / faces + 1e-6 and np.percentile(error, 99) < 1e-3  # chords of a circle


@pytest.mark.parametrize("size", [(4096, 1024), (4096, 4096)], ids=str)
def test_a_picture_of_so_many_pixels(size: tuple[int, int]) -> None:
    """The same object at the same places, whatever the number of pixels."""
    renderer = Renderer(shared())
    scene = Scene(object="knot:4000", supersampling=1).replace({"occlusion.rays": 16})
    times = min(size) // 256
    columns, rows = size[0] // times, size[1] // times
    small, large = (renderer.render(scene.replace({"size": shape})).image for shape in ((columns, rows), size))
    assert np.isfinite(large).all()
    mean = large.reshape(rows, times, columns, times, 4).mean(axis=(1, 3))
    assert np.abs(mean[..., 3] - small[..., 3]).mean() < 0.01
    assert np.abs(mean - small)[(mean[..., 3] == 1) & (small[..., 3] == 1)].mean() < 0.01
