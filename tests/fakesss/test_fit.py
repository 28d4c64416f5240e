"""Known parameters are found again; what cannot be fitted is said."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as examples
from hypothesis import strategies as st

from fakesss.brdf import backlight
from fakesss.offline.fit import Fit, Target, fit, problem_of
from fakesss.offline.fit_model import Basis, basis, matte
from fakesss.offline.fit_solver import EXPONENTS, Problem, bounds, search
from fakesss.problem import BadInput
from fakesss.renderer import Renderer
from fakesss.scene import Material, Scene

pytestmark = pytest.mark.gl

SCENE = Scene(object="knot:4000", size=(40, 32))
FIRST = {"material.diffuse": (0.78, 0.5, 0.5), "material.thickness_exponent": 6.0, "material.backlight": 0.5}
PARAMETERS = ("thickness_exponent", "backlight", "diffuse_weight", "diffuse_contribution", "ambient")
KNOWN: list[dict[str, Any]] = [
    {},
    {"material.thickness": "total-path", "light.shadows": True, "lights": [{"kind": "spot", "elevation": -10.0}]},
    {"material.thickness_exponent": 4.0, "material.diffuse": (0.1, 0.78, 0.6), "material.diffuse_weight": -0.05},
    {"light.azimuth": 180.0, "exposure": 2.0, "background": (0.5, 0.2, 0.1), "supersampling": 2},
]


def clean(renderer: Renderer, scene: Scene) -> Target:
    """The shader's own picture, without noise."""
    image = renderer.render(matte(scene)).image
    return Target(image, np.zeros_like(image[..., :3]))


def numbers(material: Material) -> list[float]:
    return [*material.diffuse, *(getattr(material, name) for name in PARAMETERS)]


@pytest.mark.parametrize("changes", [*KNOWN, {"material.thickness": "bridged", "blur.enabled": False}], ids=str)
def test_the_model_is_the_renderers_picture(renderer: Renderer, changes: dict[str, Any]) -> None:
    scene = SCENE.replace(changes)
    np.testing.assert_allclose(
        basis(scene).picture(scene.material), renderer.render(matte(scene)).image, atol=3e-6 * scene.exposure
    )


def test_the_backlight_is_its_numpy_twin_averaged_over_samples(renderer: Renderer) -> None:
    made = basis(SCENE)
    t = renderer.data(SCENE, ("blurred_thickness",), 3)["blurred_thickness"].astype(np.float64)
    inside = renderer.data(SCENE, ("front",), 3)["front"] > 0
    whole = np.where(inside, backlight(t, 7.3), 0).reshape(32, 3, 40, 3).mean(axis=(1, 3))
    np.testing.assert_allclose(made.backlight(7.3)[0], SCENE.exposure * whole[made.covered], atol=1e-12)
    change = (made.backlight(7.3 * np.exp(1e-5))[0] - made.backlight(7.3 * np.exp(-1e-5))[0]) / 2e-5
    np.testing.assert_allclose(made.backlight(7.3)[1], change, atol=1e-7)


@pytest.mark.parametrize("changes", KNOWN, ids=str)
def test_known_parameters_are_found_again(renderer: Renderer, changes: dict[str, Any]) -> None:
    scene = SCENE.replace(changes)
    found = fit(scene.replace({**FIRST, "material.thickness": "bridged"}), clean(renderer, scene), starts=2)
    assert found.scene.material.thickness == scene.material.thickness
    np.testing.assert_allclose(numbers(found.scene.material), numbers(scene.material), rtol=1e-4, atol=1e-6)
    again = renderer.render(matte(found.scene)).image
    np.testing.assert_allclose(again, found.picture, atol=1e-5)


TOGETHER = np.array([[1.0, 0.8, 0.6], [0.8, 1.0, 0.9], [0.6, 0.9, 1.0]])  # of the channels' noise


def noisy(renderer: Renderer, seed: int) -> Target:
    """With noise of a known standard error, larger where the picture is brighter, and of a known correlation."""
    picture = clean(renderer, SCENE).image.copy()
    error = (0.02 * np.sqrt(picture[..., :3] + 1e-3)).astype(np.float32)
    picture[..., :3] += (
        np.random.default_rng(seed).standard_normal(error.shape) @ np.linalg.cholesky(TOGETHER).T * error
    )
    return Target(picture, error, TOGETHER)


def deviations(renderer: Renderer, seed: int) -> list[float]:
    """Fitted less true in standard errors."""
    found = fit(SCENE, noisy(renderer, seed), starts=1)
    errors, truth, material = found.standard_error, SCENE.material, found.scene.material
    whole = [(getattr(material, name) - getattr(truth, name)) / errors[name] for name in PARAMETERS]
    return [*whole, *((material.diffuse[i] - truth.diffuse[i]) / errors[f"diffuse.{i}"] for i in (1, 2))]


@pytest.mark.parametrize("draws", [8, pytest.param(60, marks=pytest.mark.long)])
def test_with_noise_within_standard_errors(renderer: Renderer, draws: int) -> None:
    found = np.array([deviations(renderer, seed) for seed in range(draws)])
    assert np.abs(found).max() < 3.7  # of 420 normal numbers, 1 in 10 draws has a larger one
    assert 0.75 < np.sqrt((found**2).mean()) < 1.25


def test_equal_seeds_give_equal_numbers_and_others_end_in_the_same_place(renderer: Renderer) -> None:
    target = noisy(renderer, 3)

    def numbers_of(seed: int) -> tuple[Fit, list[float]]:
        found = fit(SCENE.replace(FIRST), target, starts=3, seed=seed)
        return found, numbers(found.scene.material)

    (first, here), (again, same), (_, elsewhere) = (numbers_of(seed) for seed in (5, 5, 6))
    assert here == same and first.tries[1].start == again.tries[1].start
    assert first.tries[0].start.thickness_exponent == pytest.approx(6.0)
    np.testing.assert_allclose(here, elsewhere, rtol=1e-5)


@examples(max_examples=8)
@given(st.integers(0, 2**32), st.sampled_from(("brighter", "negative", "backwards")))
def test_bounds_hold_whatever_the_target(seed: int, how: str) -> None:
    scene, generator = SCENE.replace({"size": (20, 16)}), np.random.default_rng(seed)
    shape = (16, 20, 4)
    image = {"brighter": generator.exponential(9.0, shape), "negative": generator.normal(0.1, 1, shape)}.get(
        how, np.linspace(0, 1, 16)[:, None, None] * generator.random(shape)
    )
    target = Target(image.astype(np.float32), np.full((16, 20, 3), 0.1, np.float32))
    material = fit(scene, target, starts=2).scene.material
    low, high = -min(material.diffuse), max(material.diffuse)
    assert all(0 <= channel <= 1 for channel in material.diffuse) and high == pytest.approx(0.78)
    assert min(material.ambient, material.diffuse_contribution, material.backlight) >= 0
    assert EXPONENTS[0] <= material.thickness_exponent <= EXPONENTS[1] and low <= material.diffuse_weight <= high


def test_the_derivative_leads_downhill_as_fast_as_it_says(renderer: Renderer) -> None:
    """Kaufman's leaves out only what is at right angles to the residual."""
    target = clean(renderer, SCENE)
    problem = problem_of(basis(SCENE), target)
    for tint in (None, 0.3):
        held, point = Problem(problem.basis, problem.wanted, tint), np.array([2.0, -1.0, -2.0])
        slope = held.jacobian(point).T @ held.residual(point)
        for axis, step in enumerate(1e-6 * np.eye(3)):
            ends = [(held.residual(point + sign * step) ** 2).sum() / 2 for sign in (-1, 1)]
            assert slope[axis] == pytest.approx((ends[1] - ends[0]) / 2e-6, rel=1e-5)


def test_a_grey_colour_keeps_its_diffuse_weight(renderer: Renderer) -> None:
    grey = SCENE.replace({"material.diffuse": (0.7, 0.7, 0.7)})
    found = fit(grey.replace({"material.thickness_exponent": 8.0}), clean(renderer, grey), starts=1)
    np.testing.assert_allclose(numbers(found.scene.material), numbers(grey.material), rtol=1e-4)
    assert (
        any("does not tell diffuse_weight" in note for note in found.notes)
        and "diffuse_weight" not in found.standard_error
    )


def test_a_target_without_backlight_leaves_the_exponent_as_it_was(renderer: Renderer) -> None:
    opaque = SCENE.replace({"material.backlight": 0.0})
    found = fit(SCENE.replace({"material.thickness_exponent": 8.0}), clean(renderer, opaque), starts=2)
    glow = basis(SCENE).backlight(found.scene.material.thickness_exponent)[0].max() * found.scene.material.backlight
    assert glow == pytest.approx(0, abs=1e-6)
    assert found.scene.material.thickness == "first-interval" and "backlight" not in found.standard_error
    if not found.scene.material.backlight:
        assert found.scene.material.thickness_exponent == 8.0
        assert found.notes == (
            "The target shows no backlight; thickness_exponent and diffuse_weight were left as they began.",
        )


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"camera.near": 100.0, "camera.far": 200.0}, "no pixel shows the object"),
        ({"object": "sheet.ply", "open_surface": "thick", "light.azimuth": 180.0}, "no backlight passes"),
        ({"exposure": 0.0}, "exposure is 0"),
        ({"style": "as published"}, "clips light"),
    ],
    ids=lambda value: "" if isinstance(value, dict) else value,
)
def test_a_degenerate_scene_is_one_sentence(tmp_path: Any, changes: dict[str, Any], sentence: str) -> None:
    from picture_scenes import sheet_file

    sheet_file(tmp_path)
    with pytest.raises(BadInput, match=sentence) as caught:
        basis(SCENE.replace(changes).relative_to(tmp_path))
    assert "\n" not in str(caught.value)


def test_a_target_that_is_black_or_of_another_size_is_one_sentence(renderer: Renderer) -> None:
    target = clean(renderer, SCENE)
    with pytest.raises(BadInput, match="black where the object is"):
        fit(SCENE, Target(0 * target.image, target.standard_error))
    with pytest.raises(BadInput, match="not the scene's"):
        fit(SCENE, Target(target.image[1:], target.standard_error[1:]))


def test_every_start_ends_where_a_single_search_does(renderer: Renderer) -> None:
    """What is told of a start is what `search` finds from there."""
    target = clean(renderer, SCENE)
    found = fit(SCENE.replace(FIRST), target, starts=3)
    made: Basis = basis(SCENE.replace({"material.thickness": found.tries[1].end.thickness}))
    low, high = bounds()
    assert len(found.tries) == 9 and all((low <= one.point).all() and (one.point <= high).all() for one in found.tries)
    ended = search(problem_of(made, target), found.tries[1].point)
    assert ended.rmse == pytest.approx(found.tries[1].rmse, abs=1e-7)
