"""Kernels of the softening: one Gaussian, GLSL beside numpy, which passes they take, what they change."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from layer_programs import filled, random_layer

from fakesss.depth_checks import blur_width
from fakesss.frame_graph import Plan
from fakesss.gpu import Gpu, shared
from fakesss.pipeline import build
from fakesss.problem import BadInput
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.softening import KERNELS, TABLE, VARIANCE, Kernel, softened

EXAMPLES = settings(max_examples=15)
SIZE = (23, 17)


def along(kernel: Kernel) -> tuple[Any, Any]:
    """Places of the taps along an axis, in steps, and their weights, which add up to 1."""
    weights = kernel.side if kernel.separable else kernel.table.sum(axis=0)
    return (np.arange(kernel.taps) - kernel.taps // 2) * kernel.spacing, weights / weights.sum()


@pytest.mark.parametrize("name", KERNELS)
def test_all_kernels_stand_for_one_gaussian(name: str) -> None:
    """The same variance, and waves longer than 6 steps are dimmed alike."""
    places, weights = along(KERNELS[name])
    assert (weights * places**2).sum() == pytest.approx(VARIANCE, rel=1e-6)
    for frequency in np.linspace(0, 1, 11):  # radians a step
        response = (weights * np.cos(frequency * places)).sum()
        assert response == pytest.approx(np.exp(-VARIANCE * frequency**2 / 2), abs=0.018)


def test_three_taps_are_gauss_hermites() -> None:
    """Moments of a Gaussian up to the fifth: the fourth is 3 v^2, odd ones vanish."""
    places, weights = along(KERNELS["3x3"])
    assert (weights * places**4).sum() == pytest.approx(3 * VARIANCE**2)


def test_the_separated_table_is_the_table() -> None:
    row = KERNELS["separable"].side
    product = np.outer(row, row) / TABLE.sum()
    assert np.abs(product - TABLE).max() < 0.03 * TABLE.max() and np.abs(product - TABLE).max() > 0


def away_from_ties(rng: np.random.Generator, spacing: float) -> float:
    """Texels between taps, such that no tap falls on the border between two texels."""
    while True:
        tap = rng.uniform(0.3, 2.5) * spacing
        rest = np.arange(1, 5) * tap % 1
        if (np.abs(rest - 0.5) > 1e-2).all():
            return float(tap)


def drawn_softened(gpu: Gpu, layer: Any, kernel: Kernel, tap: tuple[float, float], depth_range: float) -> Any:
    """As the passes `soften_across` and `soften` draw it."""
    uniforms = {"tap": (tap[0] / SIZE[0], tap[1] / SIZE[1]), "depth_range": depth_range, "size": SIZE}
    if not kernel.separable:
        return filled(gpu, "soften.frag", {"second": layer}, uniforms, SIZE, TAPS=kernel.taps)
    row = filled(gpu, "soften.frag", {"second": layer}, uniforms, SIZE, ROWS=0, COLUMNS=1)
    return filled(gpu, "soften.frag", {"softened_across": row}, uniforms, SIZE, ROWS=1, COLUMNS=0, SECOND_STEP=1)


@pytest.mark.gl
@pytest.mark.parametrize("name", KERNELS)
@EXAMPLES
@given(seed=st.integers(0, 2**32 - 1))
def test_glsl_beside_numpy(name: str, seed: int) -> None:
    gpu, rng, kernel = shared(), np.random.default_rng(seed), KERNELS[name]
    layer, depth_range = random_layer(rng, SIZE), float(rng.uniform(0.05, 2))
    tap = (away_from_ties(rng, kernel.spacing), away_from_ties(rng, kernel.spacing))
    drawn = drawn_softened(gpu, layer, kernel, tap, depth_range)
    np.testing.assert_allclose(drawn, softened(layer, kernel, tap, depth_range), rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize("name", KERNELS)
def test_a_plane_stays_a_plane(name: str) -> None:
    y, x = np.mgrid[:30, :40]
    plane = 1.5 + 0.01 * x + 0.005 * y
    soft = softened(plane, KERNELS[name], (1.0, 2.0) if name != "3x3" else (2.0, 2.0), 0.2)
    np.testing.assert_allclose(soft[8:-8, 8:-8], plane[8:-8, 8:-8], rtol=1e-12)


PASSES = [
    ({"blur.kernel": "3x3"}, "mesh occlusion front back_faces blur+shade"),
    ({"blur.kernel": "9x9"}, "mesh occlusion front back_faces blur+shade"),
    ({"blur.kernel": "separable"}, "mesh occlusion front back_faces soften_across blur+shade"),
    (
        {"blur.kernel": "separable", "material.thickness": "total-path"},
        "mesh occlusion front total_path path_exit soften_across blur+shade",
    ),
    ({"blur.kernel": "separable", "blur.enabled": False}, "mesh occlusion front back_faces thickness+shade"),
    ({"blur.kernel": "separable", "material.backlight": 0.0}, "mesh occlusion front shade"),
]


def plan_of(changes: dict[str, Any], solid: bool = True) -> Plan:
    return build(Scene().replace(changes), 1, solid).compile(("image",))


@pytest.mark.parametrize(("changes", "passes"), PASSES, ids=str)
def test_surviving_passes(changes: dict[str, Any], passes: str) -> None:
    kept = plan_of(changes).kept
    names = ["+".join([*(inner.name for inner in getattr(node, "merged", ())), node.name]) for node in kept]
    assert " ".join(names) == passes


def test_reasons_name_the_setting() -> None:
    reasons = {verdict.node.name: verdict.because for verdict in plan_of({"blur.kernel": "3x3"}).verdicts}
    assert 'not read by blur: blur.kernel is "3x3"' in reasons["soften_across"]
    assert "layers.resolution is 1" in reasons["soften"]


# Difference from "5x5" in linear light over the covered pixels: mean, 99th percentile. Without any: 0.0055, 0.047.
# Most of it is where a tap falls between samples, of which it takes the nearest: here taps are 1.5 of them apart.
CHANGES = {"3x3": (2e-3, 0.02), "9x9": (2.5e-3, 0.025), "separable": (6e-4, 8e-3)}


@pytest.mark.gl
@pytest.mark.parametrize("name", CHANGES)
def test_the_picture_changes_little(renderer: Renderer, name: str) -> None:
    scene = Scene(object="figure:8000", size=(128, 128))
    default = renderer.render(scene).image
    other = renderer.render(scene.replace({"blur.kernel": name})).image
    difference = np.abs(other - default)[default[..., 3] > 0].max(axis=1)
    mean, most = CHANGES[name]
    assert 0 < difference.mean() < mean and np.percentile(difference, 99) < most


@pytest.mark.gl
@pytest.mark.parametrize("name", KERNELS)
def test_asked_for_or_in_place_it_is_one_thickness(renderer: Renderer, name: str) -> None:
    """The backlight from the pass's texture, and computed by the shading."""
    scene = Scene(object="knot:4000", size=(64, 64), supersampling=1).replace({"blur.kernel": name})
    both = renderer.data(scene, ("image", "blurred_thickness"))
    np.testing.assert_array_equal(renderer.render(scene).image, both["image"])


@pytest.mark.parametrize(("name", "steps"), [("5x5", 4), ("3x3", 3.4322), ("9x9", 4), ("separable", 4)])
def test_how_far_a_kernel_reaches_is_told(name: str, steps: float) -> None:
    """From the first tap to the last; `render --views` shows it."""
    second = np.full((4, 4), 2.0)  # in the plane of the sphere's centre
    scene = Scene(size=(4, 4)).replace({"blur.kernel": name})
    assert blur_width(second, scene)[0, 0] == pytest.approx(steps * scene.blur.step, rel=1e-4)


@pytest.mark.parametrize(
    ("path", "value"), [("blur.kernel", "3x3"), ("layers.resolution", 2), ("layers.depth", "float16")]
)
def test_the_published_style_has_none_of_it(path: str, value: Any) -> None:
    with pytest.raises(BadInput, match=f'style "as published" has {path} = .*; leave it out'):
        Scene().replace({"style": "as published", path: value}, "study.toml")


def test_a_kernel_that_is_not_known_is_one_sentence() -> None:
    with pytest.raises(BadInput, match=r"study.toml: .*blur.kernel"):
        Scene().replace({"blur.kernel": "7x7"}, "study.toml")
