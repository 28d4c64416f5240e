"""A second layer at every n-th sample: where its samples stand, how it is brought to all, when it is not to be had."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from layer_programs import filled, random_layer
from numpy.typing import NDArray
from picture_scenes import sheet_file

from fakesss.camera import View
from fakesss.frame_graph import Plan
from fakesss.gpu import shared
from fakesss.pipeline import build
from fakesss.problem import BadInput
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.softening import KERNELS, softened
from fakesss.sparse_layer import sparse_size, texel_width, upsampled

EXAMPLES = settings(max_examples=15)
SIZE = (23, 17)
LIT = "mesh occlusion front"
SEEN = {"camera.azimuth": 25.0, "camera.elevation": 20.0}
Image = NDArray[Any]


@pytest.mark.gl
@EXAMPLES
@given(seed=st.integers(0, 2**32 - 1), every=st.sampled_from([2, 4]))
def test_glsl_beside_numpy(seed: int, every: int) -> None:
    rng = np.random.default_rng(seed)
    front, sparse = random_layer(rng, SIZE), random_layer(rng, sparse_size(SIZE, every))
    width = float(rng.uniform(0.005, 0.2))
    layers = {"front": front, "sparse_back": sparse}
    drawn = filled(shared(), "upsample.frag", layers, {"texel_width": width}, SIZE, EVERY=every)
    covered = front > 0  # the mask of the pass
    np.testing.assert_allclose(drawn[covered], upsampled(sparse, front, every, width)[covered], rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize("every", [2, 4])
@pytest.mark.parametrize("slope", [0.0, 0.9])
def test_a_thin_plate_comes_back(every: int, slope: float) -> None:
    """1e-3 radii thin: exactly where it is level, else to 2 % of a texel's width; beyond the last texel it is level."""
    width = 0.01 * every
    front = np.tile(1.8 + 0.01 * slope * np.arange(33), (25, 1))
    back = upsampled((front + 1e-3)[::every, ::every], front, every, width)
    np.testing.assert_allclose(back[:, :-every], front[:, :-every] + 1e-3, rtol=0, atol=1e-12 + 0.02 * slope * width)


@pytest.mark.parametrize("every", [2, 4])
def test_what_no_texel_shows_is_thin_and_parts_do_not_mix(every: int) -> None:
    """A wire one sample wide between texels, before a wall: nothing is known behind it but the wall's back."""
    front = np.full((16, 16), 2.0)
    front[:, 1] = 1.2
    sparse = np.full((16 // every, 16 // every), 2.5)
    back = upsampled(sparse, front, every, 0.01)
    np.testing.assert_array_equal(back[:, 2:], 2.5)
    assert np.isfinite(back).all()
    alone = np.where(front == 1.2, front, 0)
    np.testing.assert_array_equal(upsampled(np.zeros_like(sparse), alone, every, 0.01), 0)
    near = front.copy()
    near[:, ::every] = 1.2  # texels see the near part only: its back lies before the wall and is not the wall's
    np.testing.assert_array_equal(upsampled(np.full_like(sparse, 1.3), near, every, 0.01)[:, 2:][near[:, 2:] == 2.0], 0)


@pytest.mark.gl
@pytest.mark.parametrize("every", [2, 4])
@pytest.mark.parametrize("size", [(317, 211), (64, 64), (97, 61), (5, 3), (1, 1)])
def test_texels_are_samples_of_the_picture(renderer: Renderer, size: tuple[int, int], every: int) -> None:
    """Every n-th, for any size; what differs are single samples at triangles seen edge-on."""
    scene = Scene(object="figure:8000", size=size).replace(SEEN)
    exact = renderer.data(scene, ("nearest_back",))["nearest_back"][::-1][::every, ::every]
    sparse = renderer.data(scene.replace({"layers.resolution": every}), ("sparse_back",))["sparse_back"][::-1]
    assert sparse.shape == exact.shape == sparse_size(size, every)[::-1]
    assert (np.abs(sparse - exact) > 1e-5).sum() <= 3 + 5e-4 * exact.size


@pytest.mark.gl
@pytest.mark.parametrize("every", [2, 4])
def test_drawn_is_what_numpy_computes(renderer: Renderer, every: int) -> None:
    scene = Scene(object="head:8000", size=(97, 131)).replace({**SEEN, "layers.resolution": every})
    names = ("front", "sparse_back", "second", "thickness")
    data = {name: image[::-1] for name, image in renderer.data(scene, names).items()}
    width = texel_width(View.of(scene.camera, scene.size), scene.size, every)
    expected = upsampled(data["sparse_back"], data["front"], every, width)
    np.testing.assert_allclose(data["second"], expected, rtol=1e-5, atol=1e-6)
    thickness = np.clip((data["second"] - data["front"]) / 2, 0, 1) * (data["second"] > 0)
    np.testing.assert_allclose(data["thickness"], thickness, atol=1e-6)


@pytest.mark.gl
@pytest.mark.parametrize("every", [2, 4])
@pytest.mark.parametrize("side", [48, 49, 50, 51])
@pytest.mark.parametrize("kernel", ["5x5", "separable"])
def test_taps_are_as_far_apart_where_n_does_not_divide_the_picture(
    renderer: Renderer, side: int, every: int, kernel: str
) -> None:
    """Softened as the numpy twin does it; the outermost tap falls just short of the next texel."""
    scene = Scene(object="figure:4000", size=(side, side + 1), supersampling=1)
    step = 1.2475 * every / side / View.of(scene.camera, scene.size).in_picture(2.0)[0]
    scene = scene.replace({"layers.resolution": every, "blur.step": step, "blur.kernel": kernel})
    found = renderer.data(scene, ("sparse_back", "softened"))
    data = {name: image[::-1].astype(float) for name, image in found.items()}
    steps = View.of(scene.camera, scene.size).in_picture(2 * scene.blur.step)
    tap = steps[0] * side / every, steps[1] * (side + 1) / every
    expected = softened(data["sparse_back"], KERNELS[kernel], tap, 2 * scene.blur.depth_range)
    assert np.abs(expected - data["sparse_back"]).max() > 0.01
    np.testing.assert_allclose(data["softened"], expected, atol=1e-6)


def plain(layer: Image, every: int) -> Image:
    """The nearest texel's depth at every sample: what shows dotted seams."""
    height, width = layer.shape
    rows, columns = ((np.arange(n) + every // 2) // every * every for n in (height, width))
    return layer[
        np.ix_(np.minimum(rows, (height - 1) // every * every), np.minimum(columns, (width - 1) // every * every))
    ]


@pytest.mark.gl
@pytest.mark.parametrize(("name", "fewer"), [("figure", 0.25), ("knot", 0.4), ("head", 0.4), ("shell", 0.45)])
def test_seams_where_parts_overlap_are_few(renderer: Renderer, name: str, fewer: float) -> None:
    """Samples whose backlight (1 - t)^25 is wrong by more than 0.2, against those of the nearest texel."""
    scene = Scene(object=f"{name}:20000", size=(512, 512)).replace(SEEN)
    names = ("front", "second", "thickness")
    exact = {key: image[::-1] for key, image in renderer.data(scene, names).items()}
    drawn = renderer.data(scene.replace({"layers.resolution": 2}), ("thickness",))["thickness"][::-1]
    nearest = np.clip((plain(exact["second"], 2) - exact["front"]) / 2, 0, 1)
    light = [(1 - layer[exact["front"] > 0]) ** 25 for layer in (exact["thickness"], drawn, nearest)]
    wrong = [(np.abs(other - light[0]) > 0.2).mean() for other in light[1:]]
    assert 0 < wrong[0] < fewer * wrong[1]


PASSES = [
    ({}, f"{LIT} sparse_back_faces soften blur+shade resolve"),
    ({"layers.resolution": 4}, f"{LIT} sparse_back_faces soften blur+shade resolve"),
    ({"blur.kernel": "3x3"}, f"{LIT} sparse_back_faces soften blur+shade resolve"),
    ({"blur.kernel": "separable"}, f"{LIT} sparse_back_faces soften_across soften blur+shade resolve"),
    ({"blur.enabled": False}, f"{LIT} sparse_back_faces upsample thickness+shade resolve"),
    ({"layers.faces": 8000}, "mesh occlusion coarse_mesh front sparse_back_faces soften blur+shade resolve"),
    ({"material.backlight": 0.0}, f"{LIT} shade resolve"),
    ({"layers.method": "peel"}, f"{LIT} peel blur+shade resolve"),
    ({"camera.distance": 0.5}, f"{LIT} peel blur+shade resolve"),
    ({"material.thickness": "total-path"}, f"{LIT} total_path path_exit blur+shade resolve"),
    ({"material.thickness": "local"}, "mesh occlusion local_thickness front local_exit blur+shade resolve"),
]


def plan_of(changes: dict[str, Any], target: str = "image") -> Plan:
    return build(Scene().replace({"layers.resolution": 2, **changes}), 3, True).compile((target,))


def names_of(plan: Plan) -> str:
    return " ".join("+".join([*(m.name for m in getattr(n, "merged", ())), n.name]) for n in plan.kept)


@pytest.mark.parametrize(("changes", "passes"), PASSES, ids=str)
def test_surviving_passes(changes: dict[str, Any], passes: str) -> None:
    assert names_of(plan_of(changes)) == passes


def test_data_targets_have_all_samples() -> None:
    assert names_of(plan_of({}, "second")) == "mesh front sparse_back_faces upsample"
    assert names_of(plan_of({}, "blurred_thickness")) == "mesh front sparse_back_faces soften blur"


REASONS = [
    ({"layers.resolution": 1}, "layers.resolution is 1"),
    ({"layers.method": "peel"}, 'layers.resolution is for back faces, and layers.method is "peel"'),
    ({"camera.distance": 0.5}, "layers.resolution is for solids seen from outside"),
    (
        {"material.thickness": "bridged"},
        'layers.resolution is for the first interval, and material.thickness is "bridged"',
    ),
]


@pytest.mark.parametrize(("changes", "why"), REASONS, ids=str)
def test_why_it_does_nothing_is_said(changes: dict[str, Any], why: str) -> None:
    verdicts = {verdict.node.name: verdict for verdict in plan_of(changes).verdicts}
    assert not verdicts["sparse_back_faces"].kept
    assert why in verdicts["soften"].because


def test_why_it_is_taken_is_said() -> None:
    reasons = {verdict.node.name: verdict.because for verdict in plan_of({"blur.enabled": False}).verdicts}
    assert reasons["first_exit"].endswith("nearest back face ends the first interval; layers.resolution is 2")
    assert "not read by first_exit: layers.resolution is 2" in reasons["back_faces"]


@pytest.mark.gl
def test_a_picture_that_has_no_use_for_it_says_so(renderer: Renderer, tmp_path: Path) -> None:
    sheet = Scene(object=sheet_file(tmp_path), size=(16, 16)).replace({"layers.resolution": 2})
    assert any(warning.startswith("layers.resolution does nothing here") for warning in renderer.render(sheet).warnings)
    solid = Scene(object="torus:8000", size=(16, 16)).replace({"layers.resolution": 4})
    assert renderer.render(solid).warnings == ()


@pytest.mark.parametrize("value", [0, 3, 8, 1.5, "2"])
def test_only_some_resolutions_can_be_had(value: Any) -> None:
    with pytest.raises(BadInput, match=r"study.toml: .*layers.resolution"):
        Scene().replace({"layers.resolution": value}, "study.toml")


# Share of the covered pixels wrong by more than 2/255 of linear light, and the 99th percentile: at only 128 pixels.
CHANGES = {2: (0.15, 0.07), 4: (0.2, 0.12)}


@pytest.mark.gl
@pytest.mark.parametrize("every", CHANGES)
def test_the_picture_changes_little(renderer: Renderer, every: int) -> None:
    scene = Scene(object="knot:8000", size=(128, 128))
    exact = renderer.render(scene).image
    sparse = renderer.render(scene.replace({"layers.resolution": every})).image
    difference = np.abs(sparse - exact)[exact[..., 3] > 0].max(axis=1)
    share, most = CHANGES[every]
    assert 0 < (difference > 2 / 255).mean() < share and np.percentile(difference, 99) < most
