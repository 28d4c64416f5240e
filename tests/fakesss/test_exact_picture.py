"""The exact picture: agrees with what is drawn at its best settings, term by term, and is made tile by tile."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from fakesss.accuracy import exact
from fakesss.accuracy.errors import JUST_NOTICEABLE, errors
from fakesss.accuracy.exact import Truth, content, exact_picture, places
from fakesss.problem import BadInput
from fakesss.renderer import Renderer
from fakesss.scene import Scene, scene_paths

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
RAYS = 256  # a vertex of local thickness, in both pictures: the error of rays is another test's
OBJECTS = ["figure:4000", "knot:2000", "shell:2000"]


def scene_of(name: str) -> Scene:
    """Without occlusion, which is drawn from vertices and exact at samples."""
    plain = {"occlusion.enabled": False, "layers.rays": RAYS}
    return Scene(object=name, size=SIZE).replace({**LIT, **BEST, **plain})


def at_the_same_samples(scene: Scene) -> NDArray[Any]:
    """The exact picture, at the renderer's own samples."""
    return exact_picture(scene, rays=RAYS, spread=False)


def differences(picture: NDArray[Any], truth: NDArray[Any]) -> tuple[float, float]:
    """Mean absolute difference over covered pixels and channels, and the share of them that differ by over 0.02."""
    apart = np.abs(picture - truth)[truth[..., 3] > 0]
    return float(apart[:, :3].mean()), float((apart.max(axis=1) > 0.02).mean())


@pytest.mark.gl
@pytest.mark.parametrize("name", OBJECTS)
def test_what_is_drawn_at_its_best_is_the_exact_picture(renderer: Renderer, name: str) -> None:
    scene = scene_of(name)
    mean, share = differences(renderer.render(scene).image, at_the_same_samples(scene))
    print(name, mean, share)
    assert mean < 1.5e-3 and share < 0.04  # the pixels at shadows' edges, where a surface may hide itself by the bias


@pytest.mark.gl
@pytest.mark.parametrize("method", ["baked", "screen-space"])
def test_occlusion_comes_near_that_of_samples(renderer: Renderer, method: str) -> None:
    """Interpolated from vertices, or within the radius as far as the camera sees: nearer than the other's truth."""
    ambient = {"material.backlight": 0.0, "material.specular": 0.0, "material.diffuse_contribution": 0.0}
    few = {"occlusion.method": method, "occlusion.samples": 256, "occlusion.radius": 0.1}
    scene = Scene(object="figure:4000", size=SIZE).replace({**BEST, **ambient, **few})
    truth = exact_picture(scene, rays=1024)
    drawn, _ = differences(renderer.render(scene).image, truth)
    without, _ = differences(renderer.render(scene.replace({"occlusion.enabled": False})).image, truth)
    other = {"baked": "screen-space", "screen-space": "baked"}[method]
    of_other, _ = differences(exact_picture(scene.replace({"occlusion.method": other}), rays=1024), truth)
    print(drawn, without, of_other)
    assert drawn < 0.9 * without and drawn < 0.5 * of_other


@pytest.mark.gl
def test_a_penumbra_is_the_discs(renderer: Renderer) -> None:
    """A wide one, which 64 taps of a fine map draw alike; hard shadows are far from it."""
    wide = {"shadow.filter": "disc", "shadow.samples": 64, "shadow.radius": 0.04}
    scene = scene_of("knot:2000").replace({**wide, "blur.enabled": False})
    truth = at_the_same_samples(scene)
    soft, _ = differences(renderer.render(scene).image, truth)
    hard, _ = differences(renderer.render(scene.replace({"shadow.filter": "hard"})).image, truth)
    print(soft, hard)
    assert soft < 1.2e-3 and hard > 2 * soft


@pytest.mark.gl
def test_without_any_of_its_terms_it_is_another_picture(renderer: Renderer) -> None:
    scene = scene_of("figure:4000")
    truth = at_the_same_samples(scene)
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
    mean, share = differences(renderer.render(scene).image, at_the_same_samples(scene))
    assert mean < 1.5e-3 and share < 0.04


@pytest.mark.gl
def test_coverage_and_background_are_those_of_the_drawn_picture(renderer: Renderer) -> None:
    scene = scene_of("knot:2000").replace({"alpha": True})
    drawn, truth = renderer.render(scene).image, at_the_same_samples(scene)
    assert truth.shape == drawn.shape and truth.dtype == np.float32
    assert np.abs(drawn - truth)[..., 3].max() < 0.05
    assert (truth[truth[..., 3] == 0] == 0).all()
    laid_over = at_the_same_samples(scene.replace({"alpha": False, "background": (0.5, 0.2, 0.1)}))
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

    def watched(truth: Truth, part: exact.Part, spread: bool) -> Any:
        if len(made) == stop_after:
            raise KeyboardInterrupt
        made.append(part)
        return original(truth, part, spread)

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
    "occlusion.radius": 0.1,  # of the other method
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
    "occlusion.method": "screen-space",  # which sees no farther than its radius
    "blur.enabled": False,  # the softening is part of what is asked; how it is done is not
}


def test_one_truth_for_all_approximations() -> None:
    scene = scene_of("torus:1000").replace({"occlusion.enabled": True})
    key = content(Truth(scene, 2))
    for path, value in SAME.items():
        assert content(Truth(scene.replace({path: value}), 2)) == key, path
    for path, value in OTHER.items():
        assert content(Truth(scene.replace({path: value}), 2)) != key, path
    assert content(Truth(scene, 3)) != key
    assert set(SAME) <= set(scene_paths())


@pytest.mark.parametrize(("samples", "finer"), [(8, 8), (8, 3), (4, 5), (1, 1)])
def test_samples_fill_their_squares_and_few_are_the_renderers(samples: int, finer: int) -> None:
    rows, columns = places((slice(2, 4), slice(0, 3)), samples, finer, spread=True)
    squares = np.column_stack([rows // finer, columns // finer])
    assert len(np.unique(squares, axis=0)) == len(rows) == 6 * samples**2
    assert squares.min(axis=0).tolist() == [2 * samples, 0]
    if samples > 1:
        # of a pixel's samples so many lie in one column of cells, and the renderer's all lie in n columns of n
        first = columns[(columns < samples * finer) & (rows < 3 * samples * finer)]
        assert len(np.unique(first)) == min(finer, samples) * samples
        centres = (rows % finer == finer // 2) & (columns % finer == finer // 2)
        assert centres.mean() < 0.2
    centred = places((slice(2, 4), slice(0, 3)), samples, 3, spread=False)
    assert all((place % 3 == 1).all() for place in centred)


def test_its_own_error_is_below_what_is_noticeable() -> None:
    """Against 16 x 16 samples, which are elsewhere; at the renderer's own places it would be above."""
    scene = Scene(object="knot:4000", size=(64, 64)).replace({"occlusion.enabled": False})
    finer = exact_picture(scene, 16)
    own, at_the_renderers = (errors(exact_picture(scene, spread=one), finer).flip_everywhere for one in (True, False))
    print(own, at_the_renderers)
    assert own < JUST_NOTICEABLE < at_the_renderers


def test_a_preset_does_not_choose_its_own_truth() -> None:
    """Whatever a quality fills, also no blur, counts as not set."""
    asked = Scene(object="torus:1000", size=(24, 24)).replace({"occlusion.enabled": False})
    truth = exact_picture(asked, 2)
    without = asked.replace({"blur.enabled": False})
    assert np.abs(exact_picture(without, 2) - truth).max() > 1e-3
    low = asked.replace({"quality": "interactive"})
    object.__setattr__(low, "blur", without.blur)  # as a preset would that leaves the blur out
    np.testing.assert_array_equal(exact_picture(low, 2), truth)


def test_what_shows_flaws_has_no_exact_picture() -> None:
    with pytest.raises(BadInput, match="as published"):
        exact_picture(Scene(style="as published"))
