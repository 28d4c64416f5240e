"""Lights of every kind: what a scene calls for, equation 3.6 summed over them, limits, and what must stay finite."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from picture_scenes import dark, sheet_file

from fakesss import illumination
from fakesss.camera import View
from fakesss.frame_graph import Pass
from fakesss.lights import MOST_LIGHTS
from fakesss.pipeline import build
from fakesss.renderer import Renderer
from fakesss.scene import Scene

UNLIT = {"diffuse": (0, 0, 0), "specular": (0, 0, 0)}
CASTING = {"light.shadows": True}
KEPT: list[tuple[dict[str, Any], bool]] = [
    ({}, False),
    (CASTING, True),
    ({"lights": [{}]}, False),
    ({"lights": [{"shadows": True}]}, True),
    ({**CASTING, "light.kind": "spot"}, True),
    ({**CASTING, "light.diffuse": (0, 0, 0)}, True),
    ({**CASTING, "light.diffuse": (0, 0, 0), "material.specular": 0.0}, False),
    ({**CASTING, "light.diffuse": (0, 0, 0), "light.specular": (0, 0, 0), "lights": [{}]}, False),
    ({**CASTING, "material.diffuse_contribution": 0.0, "material.specular_contribution": 0.0}, False),
    ({"lights": [{**UNLIT, "shadows": True}]}, False),
]
REASONS: list[tuple[dict[str, Any], str]] = [
    ({}, "no light has shadows = true"),
    (
        {**CASTING, "material.diffuse_contribution": 0.0, "material.specular": 0.0},
        "material.diffuse_contribution is 0 and material.specular is 0",
    ),
    (
        {**CASTING, "light.diffuse": (0, 0, 0), "light.specular": (0, 0, 0), "lights": [{}]},
        "no light with shadows = true shines",
    ),
    (
        {**CASTING, "light.diffuse": (0, 0, 0), "light.specular": (0, 0, 0)},
        "light.diffuse is 0 and light.specular is 0",
    ),
]


def shade(scene: Scene) -> Pass:
    """The kept shading pass."""
    verdicts = build(scene).compile(["image"]).verdicts
    found = next(verdict.node for verdict in verdicts if verdict.node.name == "shade")
    assert isinstance(found, Pass)
    return found


@pytest.mark.parametrize(("changes", "kept"), KEPT, ids=[str(changes) for changes, _ in KEPT])
def test_shadow_maps_are_made_only_for_lights_that_shine(changes: dict[str, Any], kept: bool) -> None:
    plan = build(Scene().replace(changes)).compile(["image"])
    assert ("shadow" in plan.passes) == kept


@pytest.mark.parametrize(("changes", "because"), REASONS, ids=[reason for _, reason in REASONS])
def test_a_culled_shadow_map_says_why(changes: dict[str, Any], because: str) -> None:
    verdicts = build(Scene().replace(changes)).compile(["image"]).verdicts
    assert [v.because for v in verdicts if v.node.name == "shadow"] == [f"not read by shade: {because}"]


@pytest.mark.parametrize(
    ("changes", "reads"),
    [
        ({"blur.enabled": False, "material.backlight": 0.0}, False),
        ({"material.backlight": 0.0, "lights": [{}, {}]}, False),
        ({"material.backlight": 0.0, "light.kind": "point"}, True),
        ({"material.backlight": 0.0, "light.shadows": True}, True),
        ({"material.backlight": 0.0, "lights": [{"kind": "spot"}]}, True),
        ({"material.backlight": 0.0, "lights": [{"kind": "spot", **UNLIT}]}, False),
    ],
    ids=str,
)
def test_depth_is_read_only_where_place_matters(changes: dict[str, Any], reads: bool) -> None:
    assert ("front" in shade(Scene().replace(changes)).reads) == reads


def expected(renderer: Renderer, scene: Scene) -> tuple[NDArray[Any], NDArray[np.bool_]]:
    """The picture by `illumination` from the drawn layers, and where no term sits on the edge of its `if`."""
    data = renderer.data(scene, ("surface", "blurred_thickness", "front"))
    view = View.of(scene.camera, scene.size)
    points = illumination.positions(view, data["front"])
    normals, occlusion = data["surface"][..., :3].astype(np.float64), data["surface"][..., 3]
    sure = data["front"] > 0
    for light in (scene.light, *scene.lights):
        n_dot_l = (normals * illumination.arriving(light, view, points)[0]).sum(axis=-1)
        sure &= np.abs(n_dot_l) > 1e-4
    return illumination.lighting(scene, view, points, normals, occlusion, data["blurred_thickness"]), sure


SPOT = {"kind": "spot", "distance": 3.0, "azimuth": 30.0, "elevation": 20.0}
POINT = {"kind": "point", "distance": 1.2, "azimuth": -70.0, "elevation": 30.0, "attenuation": (0.5, 0.25, 2.0)}
SETS: dict[str, list[dict[str, Any]]] = {
    "point": [POINT],
    "spot": [{**SPOT, "spot_exponent": 8.0}],
    "linear spot": [{**SPOT, "falloff": "linear", "cutoff": 12.0}],
    "narrow spot": [{**SPOT, "cutoff": 2.0, "spot_exponent": 0.0}],
    "point inside": [{**POINT, "distance": 0.2}],
    "one of each": [{"azimuth": 90.0}, POINT, {**SPOT, "diffuse": (0.1, 0.5, 2.0)}],
    "two that do not shine": [UNLIT, {**SPOT, **UNLIT}, POINT],
}


@pytest.mark.gl
@pytest.mark.parametrize("lights", SETS.values(), ids=SETS)
def test_picture_is_equation_3_6_summed(renderer: Renderer, lights: list[dict[str, Any]]) -> None:
    changes = {"material.backlight": 0.7, "light.diffuse": (0.2, 0.3, 0.4), "light.ambient": (0.1, 0.2, 0.3)}
    scene = dark(object="torus:8000").replace({**changes, "lights": lights})
    picture, sure = expected(renderer, scene)
    image = renderer.render(scene).image
    # positions are float32, and a specular exponent of 100 multiplies what rounding does to a cosine
    np.testing.assert_allclose(image[sure][:, :3], picture[sure], rtol=2e-4, atol=2e-5)


@pytest.mark.gl
def test_the_published_style_takes_every_light(renderer: Renderer) -> None:
    """Its blur needs the camera's distance too, under a name of its own."""
    scene = Scene(object="torus:4000", size=(48, 40), style="as published")
    lit = [{**POINT, "shadows": True}, {**SPOT, "shadows": True}]
    assert renderer.render(scene.replace({"lights": lit})).non_finite == 0


@pytest.mark.gl
def test_a_far_point_light_is_a_directional_one(renderer: Renderer) -> None:
    scene = dark(object="torus:8000", light__diffuse=(1, 1, 1), light__specular=(0.5, 0.5, 0.5))
    directional = renderer.render(scene).image
    gaps = [
        np.abs(renderer.render(scene.replace({"light.kind": "point", "light.distance": d})).image - directional).max()
        for d in (10.0, 100.0, 1e4)
    ]
    assert gaps[0] > gaps[1] > gaps[2] and gaps[2] < 3e-3


@pytest.mark.gl
def test_a_spot_that_leaves_nothing_out_is_a_point_light(renderer: Renderer) -> None:
    scene = dark(object="torus:8000", light__diffuse=(1, 1, 1), light__specular=(1, 1, 1), light__kind="point")
    spot = {"light.kind": "spot", "light.cutoff": 90.0, "light.spot_exponent": 0.0}
    np.testing.assert_array_equal(renderer.render(scene.replace(spot)).image, renderer.render(scene).image)


@pytest.mark.gl
def test_inverse_square(renderer: Renderer) -> None:
    """Light straight above the top of a sphere: twice as far from it, a quarter as bright."""
    scene = dark(
        size=(65, 65),
        object="sphere:60000",
        camera__elevation=90.0,
        light__elevation=90.0,
        light__diffuse=(1, 1, 1),
        light__kind="point",
        light__attenuation=(0, 0, 1),
    )
    top = [renderer.render(scene.replace({"light.distance": 1 + d})).image[32, 32, 1] for d in (0.5, 1.0, 2.0)]
    np.testing.assert_allclose(top, 0.24 * 0.13 * np.array([4, 1, 0.25]), rtol=2e-3)


ON_SURFACE: dict[str, Any] = {"light__distance": 0.0, "light__diffuse": (1, 1, 1)}
HARD: list[dict[str, Any]] = [
    {"kind": "point", "distance": 0.0, "attenuation": (0, 0, 1)},
    {"kind": "spot", "distance": 0.0, "falloff": "linear"},
    {"kind": "point", "distance": 1.0, "attenuation": (0, 0, 1), "azimuth": 0.0, "elevation": 8.0},
    {"kind": "point", "distance": 1e4, "attenuation": (0, 1e6, 1e6)},
    {"kind": "spot", "cutoff": 0.1, "spot_exponent": 1e4},
    {"kind": "spot", "cutoff": 0.1, "falloff": "linear", "distance": 1.0},
    {"kind": "spot", "cutoff": 90.0, "distance": 0.3, "azimuth": 180.0},
    {"kind": "point", "azimuth": 180.0, "elevation": -8.0},
    {"kind": "point", "azimuth": 0.0, "elevation": 8.0, "distance": 3.8637033},  # at the camera
    {"kind": "point", "attenuation": (1e-30, 0, 0), "diffuse": (1e6, 1e6, 1e6), "specular": (1e6, 1e6, 1e6)},
]


@pytest.mark.gl
@pytest.mark.parametrize("shadows", [False, True])
@pytest.mark.parametrize("light", HARD, ids=str)
def test_every_pixel_is_finite(renderer: Renderer, light: dict[str, Any], shadows: bool) -> None:
    scene = Scene(object="torus:4000", size=(48, 40)).replace({"lights": [{**light, "shadows": shadows}]})
    assert renderer.render(scene).non_finite == 0


@pytest.mark.gl
@pytest.mark.parametrize("kind", ["point", "spot"])
def test_a_light_exactly_on_the_surface_is_finite(renderer: Renderer, tmp_path: Path, kind: str) -> None:
    """At distance 0 there is no direction to it, and so no light; a little farther it is bright but bounded.

    Between, the vector to the light grows from 0 to unit length, and a spot's cone counts its shortness as an angle.
    """
    scene = dark(object=sheet_file(tmp_path), size=(1, 1), camera__elevation=0.0, light__azimuth=0.0, **ON_SURFACE)
    scene = scene.replace({"light.kind": kind, "light.attenuation": (0, 0, 1), "light.elevation": 0.0})
    levels = [renderer.render(scene.replace({"light.distance": d})).image[0, 0, 1] for d in (0.0, 1e-4, 1e-3, 1e-2)]
    reflected = 0.24 * 0.13
    np.testing.assert_allclose(levels, reflected * np.array([0, 1e5 if kind == "point" else 0, 1e6, 1e4]), rtol=1e-4)


@pytest.mark.gl
def test_thirty_two_lights_add_up(renderer: Renderer) -> None:
    """Of all kinds and with shadows: as bright as the same lights drawn one by one."""
    scene = dark(object="torus:4000", size=(40, 40), shadow__map_size=64)
    kinds = ("directional", "point", "spot")
    lights = [
        {
            "kind": kinds[i % 3],
            "azimuth": 11.0 * i,
            "elevation": 5.0 * i - 80,
            "shadows": i % 2 == 0,
            "ambient": (0, 0, 0),
        }
        for i in range(MOST_LIGHTS - 1)
    ]
    together = renderer.render(scene.replace({"lights": lights})).image[..., :3]
    alone = sum(renderer.render(scene.replace({"lights": [light]})).image[..., :3] for light in lights)
    np.testing.assert_allclose(together, alone, rtol=1e-4, atol=1e-5)
    assert together.max() > 1


@pytest.mark.gl
@pytest.mark.parametrize("lights", [[], [UNLIT], [{**UNLIT, "kind": "spot", "shadows": True}]], ids=str)
def test_no_light_leaves_ambient_and_backlight(renderer: Renderer, lights: list[dict[str, Any]]) -> None:
    none = {"light.diffuse": (0, 0, 0), "light.specular": (0, 0, 0), "light.ambient": (0, 0, 0)}
    further = [{**light, "ambient": (0, 0, 0)} for light in lights]
    scene = Scene(object="torus:4000", size=(64, 64)).replace({**none, "lights": further})
    image = renderer.render(scene).image
    assert image[..., :3].max() > 0.2
    dark_one = renderer.render(scene.replace({"material.backlight": 0.0, "background": (0, 0, 0)})).image
    assert not dark_one[..., :3].any() and dark_one[..., 3].any()


FORCED: list[tuple[str, dict[str, Any]]] = [
    ("shadows", {**CASTING, "material.diffuse_contribution": 0.0, "material.specular_contribution": 0.0}),
    ("shadows", {**CASTING, "light.diffuse": (0, 0, 0), "light.specular": (0, 0, 0), "light.kind": "point"}),
    ("shadows", {**CASTING, "light.diffuse": (0, 0, 0), "light.specular": (0, 0, 0), "lights": [{"azimuth": 70.0}]}),
    ("diffuse", {"light.diffuse": (0, 0, 0), "lights": [{**SPOT, "diffuse": (0, 0, 0)}]}),
    ("specular", {"light.specular": (0, 0, 0), "light.kind": "spot"}),
]


@pytest.mark.gl
@pytest.mark.parametrize(("effect", "changes"), FORCED, ids=str)
def test_what_weighs_nothing_changes_no_byte(renderer: Renderer, effect: str, changes: dict[str, Any]) -> None:
    scene = Scene(object="torus:8000", size=(96, 96)).replace(changes)
    culled, forced = renderer.render(scene), renderer.render(scene, forced=frozenset({effect}))
    assert culled.image.tobytes() == forced.image.tobytes()
    ran = ["shadow" in [entry["name"] for entry in drawn.passes] for drawn in (culled, forced)]
    assert ran == [False, effect == "shadows"]


@given(st.floats(0, 2), st.floats(1e-6, 1), st.floats(0, 1e4))
def test_a_cones_edge_is_continuous(v: float, edge: float, exponent: float) -> None:
    """A step of a millionth of the cone changes no fall-off by more than its steepest slope allows."""
    near = v + 1e-6 * edge
    change = abs(illumination.spot_exponent(v, edge, exponent) - illumination.spot_exponent(near, edge, exponent))
    assert change <= 1e-6 * (1.5 / illumination.EDGE + exponent * edge) + 1e-12
    assert abs(illumination.spot_linear(v, edge) - illumination.spot_linear(near, edge)) <= 1.001e-6
    for value in (illumination.spot_exponent(v, edge, exponent), illumination.spot_linear(v, edge)):
        assert 0 <= value <= 1 and (v < edge or value == 0)


@given(st.floats(0, 1e4), st.tuples(st.floats(0, 1e6), st.floats(0, 1e6), st.floats(0, 1e6)))
def test_attenuation_is_finite_and_falls(d: float, k: tuple[float, float, float]) -> None:
    here, farther = illumination.attenuation(d, k), illumination.attenuation(d + 1, k)
    assert 0 < farther <= here <= 1e6


def test_versine_is_exact_where_the_cosine_is_not() -> None:
    angle = 1e-4
    a, b = np.array([0.0, 0.0, 1.0]), np.array([np.sin(angle), 0.0, np.cos(angle)])
    assert illumination.versine(a, b) == pytest.approx(angle**2 / 2, rel=1e-6)
