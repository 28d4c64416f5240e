"""A small change of any number of a scene, or of the mesh, is a small change of the picture."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from catalogue import DRAWN
from edges import LAYERS, off_edges
from hard_case import Case
from hard_meshes import ball, obj, ring
from small_changes import CHANGE, Place, changed, numbers, with_given_camera
from terms import largest

from fakesss.camera import View
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.shadow_maps import map_views

pytestmark = pytest.mark.gl

# Of the sum of the picture's terms, for a change of 1e-4.
PIXEL = 0.01  # at any pixel off the edges; the worst found is 0.0066
MEAN = 5e-4  # of the whole picture, edges included; the worst found is 0.0003
JUMP, FEW = 0.1, 0.005  # where a light goes over to six maps: at any pixel, and share of those beyond PIXEL
MOST_PIXELS = 128 * 128


def look(renderer: Renderer, scene: Scene) -> Mapping[str, Any]:
    return renderer.data(scene, (*LAYERS, "image"))


def differences(one: Mapping[str, Any], other: Mapping[str, Any], scale: float) -> tuple[float, float]:
    """The largest at a pixel off the edges, and the mean of all."""
    difference = np.abs(one["image"][..., :3].astype(np.float64) - other["image"][..., :3]) / scale
    smooth = off_edges(one) & off_edges(other)  # type: ignore[arg-type]
    return float(difference[smooth].max(initial=0)), float(difference.mean())


def moderate(scene: Scene) -> Scene:
    """One sample a pixel, so that edges are known exactly, and a picture that many can be drawn of."""
    small = scene.size if scene.size[0] * scene.size[1] <= MOST_PIXELS else (96, 96)
    return with_given_camera(scene.replace({"supersampling": 1, "size": small}))


def is_exact(case: Case) -> bool:
    """An approximate second layer need not meet the exact one where the scene goes over from one to the other."""
    return not {"layers.faces"} & case.changes.keys()


@pytest.mark.parametrize("case", [case for case in DRAWN.values() if is_exact(case)], ids=str)
def test_every_number_of_the_scene(renderer: Renderer, folder: Path, case: Case) -> None:
    scene = moderate(case.scene(folder))
    before = look(renderer, scene)
    found = {}
    data = scene.model_dump(mode="json")
    data["lights"] = data["lights"][:2]  # the others are like these
    for place in numbers(data):
        after = changed(scene, place)
        found[place] = differences(before, look(renderer, after), max(largest(scene), largest(after)))
    assert len(found) >= 30
    worst = max(found, key=lambda place: found[place][0])
    assert found[worst][0] <= PIXEL, worst
    widest = max(found, key=lambda place: found[place][1])
    assert found[widest][1] <= MEAN, widest


WIDEST: dict[str, tuple[Place, dict[str, Any]]] = {
    "point": (("light", "distance"), {"light.kind": "point", "light.distance": 1.15465}),
    "spot": (("light", "cutoff"), {"light.kind": "spot", "light.distance": 0.8, "light.cutoff": 60.0}),
}


@pytest.mark.parametrize(("place", "changes"), WIDEST.values(), ids=WIDEST)
@pytest.mark.parametrize("shape", ["knot:4000", "figure:8000"])
def test_a_light_that_goes_over_to_six_maps(
    renderer: Renderer, folder: Path, shape: str, place: Place, changes: dict[str, Any]
) -> None:
    """The one jump there is: the shadows' texels are others, so single pixels on their edges change by more."""
    scene = moderate(Case("widest", "", "", changes={"light.shadows": True, **changes, "object": shape}).scene(folder))
    other = changed(scene, place)
    maps = [len(map_views(one.light, View.of(one.camera, one.size))) for one in (scene, other)]
    assert sorted(maps) == [1, 6]
    before, after = look(renderer, scene), look(renderer, other)
    assert differences(before, after, largest(scene))[1] <= MEAN / 5
    jumps = np.abs(before["image"][..., :3] - after["image"][..., :3]).max(axis=-1) / largest(scene)
    assert 0 < jumps.max() <= JUMP and (jumps > PIXEL).sum() <= FEW * (before["front"] > 0).sum()


@pytest.mark.parametrize("surface", [ball(), ring()], ids=["ball", "ring"])
@pytest.mark.parametrize("how", ["stretched", "bent", "one vertex moved"])
def test_the_mesh(renderer: Renderer, tmp_path: Path, surface: Any, how: str) -> None:
    positions, faces = surface
    moved = positions.copy()
    if how == "stretched":
        moved[:, 0] *= 1 + CHANGE
    elif how == "bent":
        moved[:, 0] += CHANGE * np.sin(2 * positions[:, 1])
    else:
        moved[positions[:, 2].argmax()] += (0, 0, CHANGE)
    pictures = []
    for name, points in (("before", positions), ("after", moved)):
        (tmp_path / f"{name}.obj").write_bytes(obj((points, faces)))
        scene = Scene(object=str(tmp_path / f"{name}.obj"), size=(96, 96), supersampling=1)
        pictures.append(look(renderer, scene.replace({"occlusion.rays": 64})))
    pixel, mean = differences(*pictures, largest(scene))
    assert 0 < mean <= MEAN and pixel <= PIXEL
