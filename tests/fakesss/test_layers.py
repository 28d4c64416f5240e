"""Depth and thickness layers as drawn: policies for open surfaces, softening, and what a target's array holds."""

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from picture_scenes import dark, sheet_file
from scipy.ndimage import binary_erosion

from fakesss.colour import to_8bit
from fakesss.hard_edges import hard_edges
from fakesss.problem import BadInput
from fakesss.renderer import Renderer, render
from fakesss.scene import Scene

pytestmark = pytest.mark.gl


def test_thickness_does_not_depend_on_the_cameras_distance(renderer: Renderer) -> None:
    """Far cameras see the same lengths: the layers are measured from the sphere's centre."""
    scene = dark(object="sphere:60000", size=(1, 1), camera__field_of_view=1.0)
    straight_through = [
        float(renderer.data(scene.replace({"camera.distance": distance}), ("thickness",))["thickness"][0, 0])
        for distance in (2.0, 100.0, 1e4)
    ]
    assert straight_through[0] == pytest.approx(1, abs=1e-3)
    assert straight_through == pytest.approx([straight_through[0]] * 3, abs=1e-4)


@pytest.mark.parametrize(("policy", "expected"), [("thin", 0.0), ("thick", 1.0)])
@pytest.mark.parametrize("layer", ["thickness", "blurred_thickness"])
@pytest.mark.parametrize("azimuth", [0.0, 180.0])
def test_an_open_sheet_follows_the_stated_policy(
    renderer: Renderer, tmp_path: Path, policy: str, expected: float, layer: str, azimuth: float
) -> None:
    scene = Scene(object=sheet_file(tmp_path), size=(40, 40), open_surface=policy)  # type: ignore[arg-type]
    data = renderer.data(scene.replace({"camera.azimuth": azimuth}), (layer, "front", "surface"))
    covered = data["front"] > 0
    assert covered.any()
    np.testing.assert_array_equal(data[layer], np.where(covered, expected, 0))
    assert (data["surface"][covered][:, 2] > 0.9).all()  # its back shows with the normal towards the viewer


def test_a_closed_surface_has_no_open_pixels(renderer: Renderer) -> None:
    """Where it is thinner than the peel can part, "thick" must not put dark specks on the outline."""
    scene = dark(object="sphere:60000", size=(200, 200))
    thin, thick = (renderer.data(scene.replace({"open_surface": p}), ("thickness",)) for p in ("thin", "thick"))
    np.testing.assert_array_equal(thin["thickness"], thick["thickness"])


def test_blur_softens_the_second_layer_and_nothing_else(renderer: Renderer) -> None:
    """The edges of a box's far side are hard in the exact layer; the outline is left out, where taps are dropped."""
    scene = dark(object="box:4000", size=(256, 256), camera__azimuth=30.0, camera__elevation=25.0)
    data = renderer.data(scene, ("thickness", "blurred_thickness", "front"))
    exact, soft = data["thickness"], data["blurred_thickness"]
    covered = data["front"] > 0
    assert ((soft > 0) <= covered).all()
    inside = binary_erosion(covered, iterations=8)
    far_side = [data["front"] + 2 * layer for layer in (exact, soft)]
    bend = [np.abs(np.diff(layer, 2, axis=1))[inside[:, 1:-1]].max() for layer in far_side]
    assert bend[1] < 0.5 * bend[0]
    assert np.abs(exact - soft)[inside].max() < 0.01


KINDS = ["first-interval", "bridged", "total-path"]
SEEN = {"camera.azimuth": 25.0, "camera.elevation": 20.0}


def kinds(renderer: Renderer, name: str, size: int, **gap: float) -> list[NDArray[np.float32]]:
    """Front layer, and the thickness of each of KINDS."""
    scene = Scene(object=name, size=(size, size)).replace({**SEEN, **{f"layers.{key}": v for key, v in gap.items()}})
    layers = [renderer.data(scene.replace({"material.thickness": k}), ("thickness",))["thickness"] for k in KINDS]
    return [renderer.data(scene, ("front",))["front"], *layers]


@pytest.mark.parametrize("name", ["knot:8000", "hand:8000", "figure:8000"])
def test_bridged_thickness_lies_between_the_first_interval_and_the_total_path(renderer: Renderer, name: str) -> None:
    _, first, bridged, total = kinds(renderer, name, 128)
    outside = (bridged < first - 1e-5) | (bridged > total + 1e-5)
    assert outside.sum() <= 2  # samples at a triangle seen edge-on, where entry and exit change places by rounding
    assert (bridged > first + 0.01).any() and (bridged < total - 0.01).any()
    _, first, narrow, _ = kinds(renderer, name, 128, gap=1e-6)
    assert np.percentile(np.abs(narrow - first), 99) < 1e-5


def test_bridging_removes_hard_edges_and_lets_thin_parts_glow(renderer: Renderer) -> None:
    """The shell's walls: jumps become slopes, whose length falls as the resolution rises; a jump's does not."""
    lengths = {}
    for size in (256, 512):
        front, *layers = kinds(renderer, "shell:60000", size)
        lengths[size] = [hard_edges(front, layer).length(1 / size) for layer in layers]
    assert lengths[512][0] > 0.9 * lengths[256][0] > 0.5
    assert lengths[512][1] < 0.35 * lengths[512][0] and lengths[512][2] < 0.05 * lengths[512][0]
    _, first, bridged, total = kinds(renderer, "knot:8000", 128)
    thin = (first > 0) & (first < 0.1) & (total > 0.25)  # a thin part before a thick one
    assert thin.sum() > 100
    assert np.median(bridged[thin]) < 0.4 * np.median(total[thin])


def test_a_coarser_second_layer_is_near_the_exact_one(renderer: Renderer) -> None:
    scene = Scene(object="torus:30000", size=(128, 128)).replace(SEEN)
    exact, coarse = (
        renderer.data(scene.replace({"layers.faces": faces}), ("thickness",))["thickness"] for faces in (None, 4000)
    )
    difference = np.abs(exact - coarse)
    assert difference.max() > 0 and np.percentile(difference[exact > 0.02], 99) < 5e-3


def test_the_error_of_a_coarser_second_layer_is_as_documented(renderer: Renderer) -> None:
    """docs/technique.md: head, 60K faces from 8K, 512 x 512."""
    scene = Scene(object="head:60000")
    exact, coarse = (to_8bit(renderer.render(s).image) for s in (scene, scene.replace({"layers.faces": 8000})))
    covered = exact[..., 3] > 0
    error = np.abs(exact.astype(int) - coarse)[covered].max(axis=1)
    assert 0.01 < (error > 2).mean() < 0.03 and np.percentile(error, 99) <= 6


def test_a_coarser_second_layer_that_is_not_to_be_had_is_said(renderer: Renderer, tmp_path: Path) -> None:
    scene = Scene(object=sheet_file(tmp_path), size=(16, 16)).replace({"layers.faces": 100})
    assert any(warning.startswith("layers.faces does nothing here") for warning in renderer.render(scene).warnings)
    solid = Scene(object="torus:8000", size=(16, 16)).replace({"layers.faces": 1000})
    assert renderer.render(solid).warnings == ()


@pytest.mark.parametrize("target", ["thickness", "front", "second", "blurred_thickness"])
def test_layers_are_values_for_every_pixel(renderer: Renderer, target: str) -> None:
    layer = render(Scene(object="torus:8000", size=(317, 211)), target=target)
    assert layer.shape == (211, 317) and layer.dtype == np.float32
    assert np.isfinite(layer).all() and layer[0, 0] == 0 and layer.max() > 0


def test_an_unknown_target_is_one_sentence(renderer: Renderer) -> None:
    with pytest.raises(BadInput, match=r'render: target "thicknes" is written by no pass; there are mesh, occlusion'):
        render(Scene(object="sphere:4000"), target="thicknes")


@pytest.mark.parametrize("plane", ["near", "far"])
@pytest.mark.parametrize("layer", ["thickness", "blurred_thickness"])
def test_a_closed_surface_cut_open_by_a_clip_plane_follows_the_policy(
    renderer: Renderer, plane: str, layer: str
) -> None:
    """Halfway through the sphere: the far plane takes its back away, the near plane its front.

    Only the middle: towards the outline the far plane leaves slivers closed, since rays leave the sphere before it.
    """
    scene = dark(object="sphere:4000", camera__distance=4.0).replace({f"camera.{plane}": 4.0})
    for policy, expected in (("thin", 0), ("thick", 1)):
        data = renderer.data(scene.replace({"open_surface": policy}), (layer, "front"))
        middle = np.s_[28:68, 28:68]
        assert (data["front"][middle] > 0).all()
        np.testing.assert_array_equal(data[layer][middle], expected)
