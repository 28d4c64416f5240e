"""Depth and thickness layers as drawn: policies for open surfaces, softening, and what a target's array holds."""

from pathlib import Path

import numpy as np
import pytest
from picture_scenes import dark, sheet_file
from scipy.ndimage import binary_erosion

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
