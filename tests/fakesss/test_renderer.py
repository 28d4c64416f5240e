"""Pictures: every lighting term against its closed form, and what must not change them."""

import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from picture_scenes import dark

from fakesss import illumination
from fakesss.camera import View
from fakesss.colour import decode_srgb, to_8bit
from fakesss.renderer import Renderer
from fakesss.scene import Scene

pytestmark = pytest.mark.gl


def test_white_furnace_of_the_ambient_term(renderer: Renderer) -> None:
    """White under unit ambient light, nothing hidden: radiance 1 at every covered pixel."""
    scene = dark(light__ambient=(1, 1, 1), material__diffuse=(1, 1, 1), occlusion__enabled=False)
    image = renderer.render(scene).image
    covered = image[..., 3] == 1
    np.testing.assert_allclose(image[covered][:, :3], 1, rtol=1e-6)
    np.testing.assert_array_equal(image[~covered], 0)


def test_occlusion_scales_the_ambient_term(renderer: Renderer) -> None:
    scene = dark(light__ambient=(1, 2, 3), material__diffuse=(0.5, 0.5, 0.5), object="torus:8000")
    surface = renderer.data(scene, ("surface",))["surface"]
    expected = surface[..., 3:] * np.array([0.5, 1.0, 1.5])
    image = renderer.render(scene).image
    np.testing.assert_allclose(image[..., :3], np.where(image[..., 3:] > 0, expected, 0), rtol=1e-5)
    assert surface[..., 3][image[..., 3] > 0].min() < 0.9


@pytest.mark.parametrize(
    "changes",
    [
        {"light__diffuse": (1.0, 0.5, 0.25)},
        {"light__specular": (1.0, 0.5, 0.25), "material__shininess": 40.0},
        {"light__specular": (1.0, 1.0, 1.0), "material__shininess": 0.0},
        {"material__backlight": 1.2, "material__thickness_exponent": 5.0},
        {"material__backlight": 1.2, "blur__enabled": False},
        {"light__diffuse": (2.0, 2.0, 2.0), "light__ambient": (1, 1, 1), "material__backlight": -0.3},
    ],
    ids=["diffuse", "specular", "specular exponent 0", "backlight", "backlight, exact layer", "several"],
)
@pytest.mark.parametrize("light", [(-35.0, 50.0), (180.0, 0.0), (0.0, -90.0)])
def test_picture_is_equation_3_6(renderer: Renderer, changes: dict[str, Any], light: tuple[float, float]) -> None:
    scene = dark(**changes, light__azimuth=light[0], light__elevation=light[1], object="torus:8000")
    layer = "blurred_thickness" if scene.blur.enabled else "thickness"
    data = renderer.data(scene, ("surface", layer, "front"))
    view = View.of(scene.camera, scene.size)
    points = illumination.positions(view, data["front"])
    normals, occlusion = data["surface"][..., :3].astype(np.float64), data["surface"][..., 3]
    expected = illumination.lighting(scene, view, points, normals, occlusion, data[layer])
    n_dot_l = (normals * illumination.arriving(scene.light, view, points)[0]).sum(axis=-1)
    image = renderer.render(scene).image
    sure = (data["front"] > 0) & (np.abs(n_dot_l) > 1e-6)  # at N.L = 0 the highlight's edge may round either way
    np.testing.assert_allclose(image[sure][:, :3], expected[sure], rtol=3e-5, atol=1e-6)


def test_normals_of_a_sphere_are_its_directions(renderer: Renderer) -> None:
    scene = dark(object="sphere:60000")
    data = renderer.data(scene, ("surface", "front"))
    covered = data["front"] > 0
    normals = data["surface"][covered][:, :3]
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)
    depth = 2 - data["front"][covered]
    np.testing.assert_allclose(normals[:, 2], depth, atol=2e-3)


def test_a_picture_is_the_same_bytes_every_time_and_in_a_new_process(renderer: Renderer) -> None:
    code = """
import hashlib, fakesss
scene = fakesss.Scene(object="figure:8000", size=(317, 211))
print(hashlib.sha256(fakesss.render(scene).tobytes()).hexdigest())
"""
    import hashlib

    scene = Scene(object="figure:8000", size=(317, 211))
    first = renderer.render(scene).image.tobytes()
    renderer.render(Scene(object="torus:8000", size=(64, 32)))
    assert renderer.render(scene).image.tobytes() == first
    elsewhere = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert elsewhere.stdout.strip() == hashlib.sha256(first).hexdigest()


def averaged(image: NDArray[Any]) -> NDArray[Any]:
    """Every 2 x 2 pixels as one."""
    height, width = image.shape[:2]
    return image.reshape(height // 2, 2, width // 2, 2, 4).mean(axis=(1, 3))


@pytest.mark.parametrize(("samples", "mean", "most"), [((2, 1), 1e-6, 1e-5), ((1, 1), 2e-3, 5e-2)])
def test_resolution_does_not_change_the_picture(
    renderer: Renderer, samples: tuple[int, int], mean: float, most: float
) -> None:
    """512 against 1024 averaged: to rounding where both take the same samples, to sampling error where not."""
    scene = Scene(object="figure:8000").replace({"material.specular_contribution": 0.0})
    small = renderer.render(scene.replace({"size": (512, 512), "supersampling": samples[0]})).image
    large = averaged(renderer.render(scene.replace({"size": (1024, 1024), "supersampling": samples[1]})).image)
    inside = (small[..., 3] == 1) & (large[..., 3] == 1)
    difference = np.abs(small - large)[inside][:, :3]
    assert difference.mean() < mean
    assert np.percentile(difference, 99) < most


@pytest.mark.parametrize("size", [(1, 1), (1, 64), (64, 1), (317, 211), (33, 97)])
@pytest.mark.parametrize("style", ["default", "as published"])
def test_odd_sizes(renderer: Renderer, size: tuple[int, int], style: str) -> None:
    drawn = renderer.render(Scene(object="torus:4000", size=size, style=style))  # type: ignore[arg-type]
    assert drawn.image.shape == (size[1], size[0], 4) and drawn.image.dtype == np.float32
    assert drawn.non_finite == 0


EXTREMES: list[dict[str, Any]] = [
    {"camera.distance": 1e-3},
    {"camera.distance": 1.0},
    {"camera.distance": 1e4, "camera.field_of_view": 1.0},
    {"camera.field_of_view": 170.0},
    {"camera.elevation": 90.0},
    {"camera.near": 3.9},
    {"camera.far": 0.5},
    {"material.thickness_exponent": 0.0},
    {"material.thickness_exponent": 1e-3},
    {"material.thickness_exponent": 1e4},
    {"material.shininess": 0.0},
    {"material.shininess": 1e5},
    {"material.backlight": -1e6},
    {"material.backlight": 1e6, "material.diffuse_weight": 1e6, "exposure": 1e6},
    {"light.elevation": -90.0, "camera.elevation": 90.0},
    {"blur.step": 0.25, "blur.depth_range": 1e-9},
    {"blur.step": 1e-9, "blur.depth_range": 1.0},
]


@pytest.mark.parametrize("changes", EXTREMES, ids=str)
@pytest.mark.parametrize("style", ["default", "as published"])
def test_every_pixel_is_finite(renderer: Renderer, changes: dict[str, Any], style: str) -> None:
    scene = Scene(object="torus:4000", size=(48, 40)).replace({**changes, "style": style})
    assert renderer.render(scene).non_finite == 0


def test_background_shows_where_nothing_covers(renderer: Renderer) -> None:
    scene = Scene(object="torus:8000", size=(64, 64), background=(0.2, 0.4, 0.6))
    image = renderer.render(scene).image
    alone = renderer.render(scene.replace({"background": (0, 0, 0)})).image
    expected = alone[..., :3] + (1 - alone[..., 3:]) * np.array([0.2, 0.4, 0.6])
    np.testing.assert_allclose(image[..., :3], expected, atol=1e-6)
    partly = (image[..., 3] > 0) & (image[..., 3] < 1)
    assert partly.any()


def test_top_row_comes_first(renderer: Renderer) -> None:
    """Light from above: the upper half of the sphere is lit, the lower is not."""
    scene = dark(light__diffuse=(1, 1, 1), light__azimuth=0.0, light__elevation=90.0, camera__elevation=0.0)
    light = renderer.render(scene).image[..., :3]
    assert light[:48].sum() > 10 * light[48:].sum()
    assert light[24, 48, 0] > 0.01 and light[72, 48, 0] == 0


def test_as_published_is_shown_without_encoding(renderer: Renderer) -> None:
    scene = Scene(object="torus:8000", size=(64, 64), style="as published").replace({"material.backlight": 1.6})
    raw = np.clip(renderer.data(scene, ("shaded",))["shaded"][..., :3], 0, 1)
    image = renderer.render(scene).image
    covered = image[..., 3] == 1
    np.testing.assert_allclose(image[covered][:, :3], decode_srgb(raw)[covered], rtol=1e-4, atol=1e-6)
    assert np.abs(to_8bit(image[..., :3]).astype(int) - np.floor(raw * 255 + 0.5))[covered].max() <= 1
    assert set(np.unique(image[..., 3])) == {0.0, 1.0}


def test_a_sweep_uploads_and_bakes_once(renderer: Renderer) -> None:
    scene = Scene(object="torus:4000", size=(32, 32))
    renderer.render(scene)
    held = len(renderer.gpu.uploads.values), list(renderer.gpu.programs.compiled.values)
    for level in np.linspace(0.1, 2, 9):
        drawn = renderer.render(scene.replace({"material.backlight": float(level)}))
        assert all(made.cached for made in drawn.baked.values())
    assert (len(renderer.gpu.uploads.values), list(renderer.gpu.programs.compiled.values)) == held


def test_a_turning_camera_rewrites_its_buffers(renderer: Renderer) -> None:
    """New ones for each pose would leave holes in the driver's memory, half a megabyte a picture."""
    scene = Scene(object="torus:4000", size=(32, 32))
    first = renderer.render(scene).image
    held = dict(renderer.gpu.uploads.values)
    for degrees in (10.0, 20.0, 30.0):
        assert not np.array_equal(renderer.render(scene.replace({"camera.azimuth": degrees})).image, first)
    assert dict(renderer.gpu.uploads.values) == held
    np.testing.assert_array_equal(renderer.render(scene).image, first)
