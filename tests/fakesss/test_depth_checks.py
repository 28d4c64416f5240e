"""Depth precision and the reach of the softening against planted values and the projection's own arithmetic."""

import numpy as np
import pytest

from fakesss.camera import View
from fakesss.depth_checks import ORIGIN, blur_width, depth_precision
from fakesss.scene import Scene


def test_bits_count_float32_spacings() -> None:
    spacing = np.spacing(np.float32(1.5))
    row = 1.5 + spacing * np.array([0, 1, 1, 9, 9 + 2**20], dtype=np.float64)
    layer = np.concatenate([row, [0]]).astype(np.float32)[None]
    bits, same = depth_precision(layer)
    assert bits[0].tolist() == pytest.approx([0, 0, 3, 20, 20, 0])
    assert same[0].tolist() == [False, True, True, False, False, False]


def test_a_flat_face_shares_one_depth_and_a_background_does_not() -> None:
    layer = np.zeros((5, 6), np.float32)
    layer[1:4, 1:4] = 1.25
    bits, same = depth_precision(layer)
    assert (same == (layer > 0)).all() and not bits.any()


@pytest.mark.parametrize("step", [1 / 256, 0.02])
def test_width_of_softening_at_the_spheres_centre_is_four_steps(step: float) -> None:
    scene = Scene(size=(317, 211)).replace({"blur.step": step})
    distance = View.of(scene.camera, scene.size).distance
    second = np.array([[ORIGIN, ORIGIN + 0.5, 0.0]])
    width = blur_width(second, scene)[0]
    assert width == pytest.approx([4 * step, 4 * step * (distance + 0.5) / distance, 0.0])


def test_the_published_taps_are_a_share_of_the_viewport() -> None:
    scene = Scene(style="as published").replace({"camera.field_of_view": 40.0})
    view = View.of(scene.camera, scene.size)
    across = view.distance * np.tan(np.radians(20))  # of the viewport at the sphere's centre, sphere diameters
    assert blur_width(np.array([[ORIGIN]]), scene)[0, 0] == pytest.approx(4 / 256 * across)
