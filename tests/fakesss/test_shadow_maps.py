"""Where shadow maps look, where they stand in their texture, and how long they are kept."""

from typing import Any

import numpy as np
import pytest

from fakesss.camera import View
from fakesss.lights import Light
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.shadow_maps import SIDES, atlas, is_outside, map_views, slope_bias

LIGHTS = [
    Light(),
    Light(kind="point", distance=1e4),
    Light(kind="point", distance=1.2),
    Light(kind="spot", cutoff=90.0),
    Light(kind="point", distance=1.01),
    Light(kind="point", distance=0.0),
    Light(kind="spot", cutoff=80.0, distance=0.5),
]


@pytest.mark.parametrize("light", LIGHTS, ids=str)
def test_the_maps_of_a_light_show_the_whole_sphere(light: Light) -> None:
    view = View.of(Scene().camera, (512, 512))
    directions = np.random.default_rng(0).normal(size=(2000, 3))
    points = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    shown = np.zeros(len(points), bool)
    for one in map_views(light, view):
        seen = points @ one.turn.T + one.centre
        width = one.width[0] + one.width[1] * seen[:, 2]
        inside = (np.abs(seen[:, :2]) <= width[:, None] * one.half_width).all(axis=1)
        shown |= inside & (seen[:, 2] >= one.ends[0]) & (seen[:, 2] <= one.ends[1])
    assert shown.all() and is_outside(light) == (light.kind == "directional" or light.distance > 1)


def test_a_narrow_spot_gives_its_map_to_its_cone() -> None:
    view = View.of(Scene().camera, (512, 512))
    (one,) = map_views(Light(kind="spot", cutoff=1.0, distance=3.0), view)
    assert one.half_width == pytest.approx(np.tan(np.radians(1)), rel=1e-3)


def test_sides_of_a_cube_are_rotations() -> None:
    np.testing.assert_array_equal(SIDES @ SIDES.transpose(0, 2, 1), [np.eye(3)] * 6)
    assert np.linalg.det(SIDES) == pytest.approx(1)
    ahead = {tuple(side.T @ [0, 0, 1]) for side in SIDES}
    assert len(ahead) == 6


@pytest.mark.parametrize("number", [0, 1, 2, 5, 31, 192])
def test_maps_stand_side_by_side(number: int) -> None:
    layout = atlas([Light()] * number, None, (512, 300))
    corners = {layout.corner(index) for index in range(number)}
    assert len(corners) == number
    assert all(max(x + layout.side - layout.size[0], y + layout.side - layout.size[1]) <= 0 for x, y in corners)
    assert layout.side == (2048 if number in (0, 1, 2, 5) else layout.side) and max(layout.size) <= 8192


def test_the_default_map_is_four_times_the_picture_at_most_4096() -> None:
    sides = [atlas([Light()], None, size).side for size in ((512, 300), (100, 700), (4000, 10), (1, 1))]
    assert sides == [2048, 2800, 4096, 16]
    assert atlas([Light()], 333, (512, 512)).side == 333


def test_the_bias_follows_the_slope_between_once_and_twice() -> None:
    degrees = np.array([0.0, 30.0, 45.0, 60.0, 63.0, 70.0, 90.0])
    expected = 1e-3 * np.clip(np.tan(np.radians(degrees)), 1, 2)
    np.testing.assert_allclose(slope_bias(1e-3, np.cos(np.radians(degrees))), expected)


@pytest.mark.gl
def test_a_sweep_draws_its_shadow_maps_once(renderer: Renderer) -> None:
    """They are drawn again when light, camera, object or map change, and the pictures are as if drawn afresh."""
    scene = Scene(object="knot:4000", size=(48, 48)).replace({"light.shadows": True, "material.backlight": 0.3})
    moving: list[dict[str, Any]] = [
        {"light.azimuth": 10.0},
        {"camera.azimuth": 10.0},
        {"object": "torus:4000"},
        {"shadow.map_size": 64},
        {"light.kind": "point", "light.distance": 0.5},
    ]
    still: list[dict[str, Any]] = [{}, {"light.diffuse": (0.1, 0.2, 0.3)}, {"shadow.filter": "hard"}, {"exposure": 0.5}]
    fresh = []
    for changes in (*moving, *still):
        renderer.gpu.drawn.clear()
        fresh.append(renderer.render(scene.replace(changes)).image.tobytes())
    for changes, expected in zip(moving, fresh[: len(moving)], strict=True):
        renderer.render(scene)
        before = next(iter(renderer.gpu.drawn.values))
        assert renderer.render(scene.replace(changes)).image.tobytes() == expected
        assert next(iter(renderer.gpu.drawn.values)) != before
    renderer.render(scene)
    maps = next(iter(renderer.gpu.drawn.values))
    for changes, expected in zip(still, fresh[len(moving) :], strict=True):
        assert renderer.render(scene.replace(changes)).image.tobytes() == expected
        assert next(iter(renderer.gpu.drawn.values)) == maps
    assert renderer.data(scene, ("shadow_maps",))["shadow_maps"].shape == (192, 192)
