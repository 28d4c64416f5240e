"""Thickness of every watertight case against rays through the same triangles, and both exact methods of finding it."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from catalogue import DRAWN
from edges import off_edges
from hard_case import Case
from numpy.typing import NDArray
from terms import largest

from fakesss.camera import View
from fakesss.mesh import Mesh
from fakesss.reference import ExactInterval, camera_rays
from fakesss.renderer import Renderer
from fakesss.scene import Scene

pytestmark = pytest.mark.gl

# Errors in sphere diameters off the edges, over all cases together.
LARGEST, P999, MEDIAN = 1e-4, 1e-5, 1e-6
METHODS = 2e-5  # between the two exact methods: what the peel's epsilon and the interpolation of a depth amount to
LIGHT = 1e-3  # the same in the picture, of the sum of its terms; found: no difference
MOST_PIXELS = 160 * 160


def is_exact_first_interval(case: Case) -> bool:
    """Whether the case draws the first interval of a closed surface that no clip plane cuts, without approximation."""
    other = {"material.thickness", "layers.faces", "style"}
    return case.closed and not case.empty and not other & case.changes.keys()


CLOSED = [case for case in DRAWN.values() if is_exact_first_interval(case)]


def moderate(scene: Scene) -> Scene:
    """One sample a pixel; very large pictures smaller, very small ones larger, so that each has some pixels."""
    pixels = scene.size[0] * scene.size[1]
    return scene.replace({"supersampling": 1, "size": scene.size if 2000 < pixels <= MOST_PIXELS else (128, 128)})


def exact_layers(mesh: Mesh, scene: Scene) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Thickness (H, W) in sphere diameters, 0 where a ray misses or leaves as soon as it enters, and `off_edges`.

    What is an edge is asked of the rays: a wrong pixel of the renderer must not count as one.
    """
    view = View.of(scene.camera, scene.size)
    origins, directions = camera_rays(view, scene.size)
    entry, leave = ExactInterval(mesh)(origins, directions)
    hit = ~np.isnan(entry)
    leave = np.where(np.isnan(leave), entry, leave)
    along = -(directions @ view.rotation[2])
    # as the renderer's layers: from two radii in front of the centre, 0 where there is nothing
    depths = [np.where(hit, distance * along - view.distance + 2, 0) for distance in (entry, leave)]
    front, second = (depth.reshape(scene.size[::-1]) for depth in depths)
    return (second - front) / 2, off_edges({"front": front, "second": second})


@pytest.mark.parametrize("case", CLOSED, ids=str)
def test_peeled_and_automatic_layers_agree(renderer: Renderer, folder: Path, case: Case) -> None:
    scene = moderate(case.scene(folder))
    methods = [scene.replace({"layers.method": method}) for method in ("auto", "peel")]
    auto, peel = (renderer.data(method, ("front", "thickness", "image", "mesh")) for method in methods)
    np.testing.assert_array_equal(auto["front"], peel["front"])
    _, smooth = exact_layers(auto["mesh"], scene)
    assert np.abs(auto["thickness"] - peel["thickness"])[smooth].max(initial=0) <= METHODS
    light = np.abs(auto["image"].astype(np.float64) - peel["image"])[smooth] / largest(scene)
    assert light.max(initial=0) <= LIGHT


def test_thickness_of_all_watertight_cases(renderer: Renderer, folder: Path, record_property: Any) -> None:
    """Each picture of thickness once: what differs in light or material alone would be counted again."""
    errors: dict[str, NDArray[np.float64]] = {}
    seen: set[bytes] = set()
    for case in CLOSED:
        scene = moderate(case.scene(folder))
        if View.of(scene.camera, scene.size).clips_sphere:
            continue
        drawn = renderer.data(scene, ("thickness", "mesh"))
        if drawn["thickness"].tobytes() in seen:
            continue
        seen.add(drawn["thickness"].tobytes())
        exact, smooth = exact_layers(drawn["mesh"], scene)
        errors[case.name] = np.abs(drawn["thickness"] - exact)[smooth]
    pooled = np.concatenate(list(errors.values()))
    found = {"max": pooled.max(), "99.9%": np.percentile(pooled, 99.9), "median": np.median(pooled)}
    worst = max(errors, key=lambda name: errors[name].max(initial=0))
    told = ", ".join(f"{name} {value:.1e}" for name, value in found.items())
    record_property("error of thickness", told)
    print(f"\n{len(errors)} watertight pictures, {pooled.size:,} pixels: {told} sphere diameters; largest in {worst}")
    assert len(errors) >= 25 and pooled.size > 50_000
    assert found["max"] <= LARGEST, worst
    assert found["99.9%"] <= P999 and found["median"] <= MEDIAN
