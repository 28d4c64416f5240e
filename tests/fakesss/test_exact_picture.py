"""The exact picture: agrees with what is drawn at its best settings, term by term, and is made tile by tile."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from fakesss.accuracy import exact
from fakesss.accuracy.exact import Truth, content, exact_picture
from fakesss.accuracy.exact_light import vertex_occlusion
from fakesss.occlusion import bake_occlusion
from fakesss.problem import BadInput
from fakesss.renderer import Renderer
from fakesss.scene import Scene, scene_paths
from fakesss.shapes import load_object

SIZE = (48, 40)
BEST = {"supersampling": 8, "blur.kernel": "9x9", "shadow.filter": "hard", "shadow.map_size": 4096}
# a light from the side and a near one, so that every term of the equation and shadows of both kinds count
LIT: dict[str, Any] = {
    "light.azimuth": -60.0,
    "light.elevation": 25.0,
    "light.shadows": True,
    "lights": ({"kind": "point", "distance": 1.6, "azimuth": 50.0, "elevation": 10.0, "diffuse": (0.0, 0.3, 0.6)},),
    "lights.0.shadows": True,
    "material.diffuse_contribution": 0.5,
    "material.thickness_exponent": 8.0,
    "blur.step": 1 / 64,
}
# what is left out of the drawn picture, which then must be another one
TERMS: dict[str, dict[str, Any]] = {
    "ambient": {"material.ambient": 0.0},
    "ambient occlusion": {"occlusion.enabled": False},
    "diffuse": {"material.diffuse_contribution": 0.0},
    "specular": {"material.specular": 0.0},
    "backlight": {"material.backlight": 0.0},
    "blur": {"blur.enabled": False},
    "shadows of the light": {"light.shadows": False},
    "shadows of the other": {"lights.0.shadows": False},
    "the other light": {"lights.0.diffuse": (0, 0, 0), "lights.0.specular": (0, 0, 0)},
    "exposure": {"exposure": 1.0},
    "background": {"background": (0.2, 0.2, 0.2)},
}
RAYS = 256  # a vertex, in both pictures: the error of rays is another test's
OBJECTS = ["figure:4000", "knot:2000", "shell:2000"]


def scene_of(name: str) -> Scene:
    return Scene(object=name, size=SIZE).replace({**LIT, **BEST, "occlusion.rays": RAYS, "layers.rays": RAYS})


def differences(picture: NDArray[Any], truth: NDArray[Any]) -> tuple[float, float]:
    """Mean absolute difference over covered pixels and channels, and the share of them that differ by over 0.02."""
    apart = np.abs(picture - truth)[truth[..., 3] > 0]
    return float(apart[:, :3].mean()), float((apart.max(axis=1) > 0.02).mean())


@pytest.mark.gl
@pytest.mark.parametrize("name", OBJECTS)
def test_what_is_drawn_at_its_best_is_the_exact_picture(renderer: Renderer, name: str) -> None:
    scene = scene_of(name)
    mean, share = differences(renderer.render(scene).image, exact_picture(scene, rays=RAYS))
    print(name, mean, share)
    assert mean < 1.5e-3 and share < 0.04  # the pixels at shadows' edges, where a surface may hide itself by the bias


@pytest.mark.gl
def test_a_penumbra_is_the_discs(renderer: Renderer) -> None:
    """A wide one, which 64 taps of a fine map draw alike; hard shadows are far from it."""
    wide = {"shadow.filter": "disc", "shadow.samples": 64, "shadow.radius": 0.04}
    scene = scene_of("knot:2000").replace({**wide, "blur.enabled": False})
    truth = exact_picture(scene, rays=RAYS)
    soft, _ = differences(renderer.render(scene).image, truth)
    hard, _ = differences(renderer.render(scene.replace({"shadow.filter": "hard"})).image, truth)
    print(soft, hard)
    assert soft < 1.2e-3 and hard > 2 * soft


@pytest.mark.gl
def test_without_any_of_its_terms_it_is_another_picture(renderer: Renderer) -> None:
    scene = scene_of("figure:4000")
    truth = exact_picture(scene, rays=RAYS)
    whole, _ = differences(renderer.render(scene).image, truth)
    times = {
        term: differences(renderer.render(scene.replace(change)).image, truth)[0] / whole
        for term, change in TERMS.items()
    }
    print(times)
    assert min(times.values()) > 4


@pytest.mark.gl
@pytest.mark.parametrize("kind", ["total-path", "bridged", "local"])
def test_every_kind_of_thickness(renderer: Renderer, kind: str) -> None:
    scene = scene_of("shell:2000").replace({"material.thickness": kind})
    mean, share = differences(renderer.render(scene).image, exact_picture(scene, rays=RAYS))
    assert mean < 1.5e-3 and share < 0.04


@pytest.mark.gl
def test_coverage_and_background_are_those_of_the_drawn_picture(renderer: Renderer) -> None:
    scene = scene_of("knot:2000").replace({"alpha": True})
    drawn, truth = renderer.render(scene).image, exact_picture(scene, rays=RAYS)
    assert truth.shape == drawn.shape and truth.dtype == np.float32
    assert np.abs(drawn - truth)[..., 3].max() < 0.05
    assert (truth[truth[..., 3] == 0] == 0).all()
    laid_over = exact_picture(scene.replace({"alpha": False, "background": (0.5, 0.2, 0.1)}), rays=RAYS)
    behind = (1 - truth[..., 3:]) * np.array([0.5, 0.2, 0.1])
    np.testing.assert_allclose(laid_over[..., :3], truth[..., :3] + behind, atol=1e-6)


def test_tiles_join_without_a_seam(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_of("knot:2000")
    whole = exact_picture(scene, 2, RAYS)
    monkeypatch.setattr(exact, "TILE", 17)
    np.testing.assert_allclose(exact_picture(scene, 2, RAYS), whole, atol=1e-5)


def test_it_goes_on_where_it_was_interrupted(monkeypatch: pytest.MonkeyPatch, tmp_path: Any) -> None:
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path))
    monkeypatch.setattr(exact, "TILE", 16)
    scene = Scene(object="torus:1000", size=(48, 32)).replace({"occlusion.enabled": False})
    made: list[exact.Part] = []
    stop_after = 4

    def watched(truth: Truth, part: exact.Part) -> Any:
        if len(made) == stop_after:
            raise KeyboardInterrupt
        made.append(part)
        return original(truth, part)

    original = exact.picture
    monkeypatch.setattr(exact, "picture", watched)
    with pytest.raises(KeyboardInterrupt):
        exact_picture(scene, 1)
    stop_after = 100
    first = exact_picture(scene, 1)
    assert len(made) == 6
    np.testing.assert_array_equal(exact_picture(scene, 1), first)
    assert len(made) == 6


# settings by which two scenes have one truth, and a few by which they have not
SAME = {
    "supersampling": 1,
    "layers.method": "peel",
    "layers.faces": 1000,
    "layers.resolution": 2,
    "layers.depth": "float16",
    "blur.kernel": "3x3",
    "occlusion.method": "screen-space",
    "occlusion.rays": 8,
    "occlusion.samples": 16,
    "shadow.map_size": 64,
    "shadow.filter": "pcf",
    "shadow.samples": 2,
    "shadow.bias": 0.01,
}
OTHER = {
    "shadow.filter": "disc",
    "camera.azimuth": 5.0,
    "blur.step": 0.01,
    "material.backlight": 0.1,
    "occlusion.sampling": "uniform",
}


def test_one_truth_for_all_approximations() -> None:
    scene = scene_of("torus:1000")
    key = content(Truth(scene, 2))
    for path, value in SAME.items():
        assert content(Truth(scene.replace({path: value}), 2)) == key, path
    for path, value in OTHER.items():
        assert content(Truth(scene.replace({path: value}), 2)) != key, path
    assert content(Truth(scene, 3)) != key
    assert set(SAME) <= set(scene_paths())


def test_supersampling_is_a_mean_over_samples() -> None:
    """The exact picture at n x n samples is the mean of the samples' own pictures, taken at n times the size."""
    scene = Scene(object="knot:1000", size=(24, 24)).replace({"occlusion.enabled": False, "blur.enabled": False})
    fine = exact_picture(scene.replace({"size": (72, 72)}), 1)
    np.testing.assert_allclose(exact_picture(scene, 3), fine.reshape(24, 3, 24, 3, 4).mean(axis=(1, 3)), atol=1e-6)


def test_what_shows_flaws_has_no_exact_picture() -> None:
    with pytest.raises(BadInput, match="as published"):
        exact_picture(Scene(style="as published"))


def test_occlusion_is_the_bake_with_very_many_rays() -> None:
    mesh = load_object("torus:1000")
    found = vertex_occlusion(mesh, Scene().occlusion, 4096)
    few = bake_occlusion(mesh, 320).values
    assert 1e-4 < np.abs(found - few).max() < 0.05
    assert found.shape == (len(mesh.positions),) and 0 < found.min() < 0.9 < found.max() <= 1
