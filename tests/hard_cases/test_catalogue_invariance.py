"""Every case with a mesh file: the same picture in any unit, any place and any order of vertices and triangles."""

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from catalogue import CASES, DRAWN
from hard_case import Case
from hard_meshes import Surface, ply
from same_picture import LARGEST, LAYERS, assert_same, differences

from fakesss.renderer import Renderer

pytestmark = pytest.mark.gl

ONE_SIDED = CASES["one-sided-band"]
FILES = [case for case in DRAWN.values() if case.content and case != ONE_SIDED]
# Linear light of a surface without an inside and an outside, with occlusion and without; found: 0.0147 and 0.0037.
SEAM = {True: 0.02, False: 5e-3}


def surface_of(case: Case) -> Surface:
    """What the case's file holds, as it is there."""
    assert case.content
    mesh = trimesh.load(io.BytesIO(case.content()), case.suffix[1:], process=False, force="mesh")
    return np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int64)


def shuffled(surface: Surface, rng: np.random.Generator) -> Surface:
    """Vertices, triangles and each triangle's corners in another order."""
    positions, faces = surface
    order = rng.permutation(len(positions))
    renamed = np.argsort(order)[faces[rng.permutation(len(faces))]]
    turned = np.take_along_axis(renamed, (rng.integers(0, 3, (len(faces), 1)) + np.arange(3)) % 3, axis=1)
    return positions[order], turned


def moved(surface: Surface, rng: np.random.Generator) -> Surface:
    """In another unit, up to 1e7 of its sizes away."""
    positions, faces = surface
    used = positions[np.unique(faces)]
    size = np.ptp(used, axis=0).max()
    return (positions + size * rng.uniform(-1e7, 1e7, 3)) * 10 ** rng.uniform(-6, 6), faces


def look(renderer: Renderer, folder: Path, case: Case, surface: Surface | None, **changes: Any) -> dict[str, Any]:
    """Layers and picture of the case, or of the same scene with another surface."""
    scene = case.scene(folder).replace({"supersampling": 1, **changes})
    if surface is not None:
        path = folder / "other.ply"
        path.write_bytes(ply(surface))
        renderer.bakes.clear()  # the same path may hold another mesh of the same size and time
        scene = scene.replace({"object": str(path)})
    return renderer.data(scene, LAYERS)


@pytest.mark.parametrize("how", [shuffled, moved])
@pytest.mark.parametrize("case", FILES, ids=str)
def test_order_unit_and_place(renderer: Renderer, folder: Path, case: Case, how: Any) -> None:
    surface = surface_of(case)
    plain = look(renderer, folder, case, None)
    for seed in range(1 if len(surface[1]) > 10_000 else 3):
        assert_same(plain, look(renderer, folder, case, how(surface, np.random.default_rng(seed))))


@pytest.mark.parametrize("occluded", [True, False])
def test_the_order_of_a_one_sided_surface_shows_at_its_seam(renderer: Renderer, folder: Path, occluded: bool) -> None:
    """Somewhere neighbours must be wound against each other, and the order of triangles decides where.

    Occlusion is baked on the side from which a triangle is wound counter-clockwise, so it changes with the order.
    """
    surface = surface_of(ONE_SIDED)
    changes = {"occlusion.enabled": occluded}
    plain = look(renderer, folder, ONE_SIDED, None, **changes)
    for seed in range(6):
        other = look(renderer, folder, ONE_SIDED, shuffled(surface, np.random.default_rng(seed)), **changes)
        found = differences(plain, other)
        assert found["thickness"].max() <= LARGEST["thickness"]
        assert found["image"].max() <= SEAM[occluded]
    assert_same(plain, look(renderer, folder, ONE_SIDED, moved(surface, np.random.default_rng(0)), **changes))
