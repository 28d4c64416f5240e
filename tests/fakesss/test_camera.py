import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fakesss.camera import NEAREST, View, direction, linear_depth, nonlinear_depth
from fakesss.scene import Camera

ANGLES = st.floats(-720, 720)
ELEVATIONS = st.floats(-90, 90)


@given(ANGLES, ELEVATIONS)
def test_the_eye_frame_is_a_rotation_that_looks_at_the_centre(azimuth: float, elevation: float) -> None:
    view = View.of(Camera(azimuth=azimuth, elevation=elevation, distance=3), (640, 480))
    np.testing.assert_allclose(view.rotation @ view.rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(view.rotation) == pytest.approx(1)
    standing = 3 * direction(azimuth, elevation)
    np.testing.assert_allclose(view.to_eye(np.array([standing, [0, 0, 0]])), [[0, 0, -3], [0, 0, 0]], atol=1e-6)
    assert view.rotation[0, 1] == pytest.approx(0)  # right stays level: the horizon is level at the poles too


def test_azimuth_turns_from_the_front_to_the_right() -> None:
    np.testing.assert_allclose(direction(0, 0), [0, 0, 1], atol=1e-15)
    np.testing.assert_allclose(direction(90, 0), [1, 0, 0], atol=1e-15)
    np.testing.assert_allclose(direction(0, 90), [0, 1, 0], atol=1e-15)


@pytest.mark.parametrize("size", [(512, 512), (640, 480), (480, 640), (317, 211)])
@pytest.mark.parametrize("field_of_view", [1.0, 30.0, 90.0, 170.0])
def test_the_sphere_just_fills_the_shorter_side(size: tuple[int, int], field_of_view: float) -> None:
    view = View.of(Camera(field_of_view=field_of_view), size)
    tangent_of_sphere = math.tan(math.asin(1 / view.distance))
    assert min(view.tangent) == pytest.approx(tangent_of_sphere)
    assert view.tangent[0] / view.tangent[1] == pytest.approx(size[0] / size[1])


@pytest.mark.parametrize("distance", [1e-6, 0.5, 1.0, 1.00001, 2.0, 1e4])
def test_clip_planes_hold_the_sphere_and_stay_in_front_of_the_camera(distance: float) -> None:
    view = View.of(Camera(distance=distance), (64, 64))
    assert NEAREST <= view.near < view.far
    assert view.near < max(distance - 1, 2 * NEAREST) and view.far > distance + 1
    assert view.clips_sphere == (distance - 1 < NEAREST)


@pytest.mark.parametrize(
    ("planes", "clips"),
    [
        ({"near": 2.1}, True),
        ({"far": 3.9}, True),
        ({"near": 2.0, "far": 4.0}, False),
    ],
)
def test_either_plane_may_clip_the_sphere(planes: dict[str, float], clips: bool) -> None:
    assert View.of(Camera(distance=3, **planes), (64, 64)).clips_sphere == clips


@pytest.mark.parametrize("distance", [0.5, 1.00001, 3.0, 5e3])
def test_planes_that_cut_nothing_cost_no_depth(distance: float) -> None:
    wide = View.of(Camera(distance=distance, near=1e-9, far=1e4), (64, 64))
    fitted = View.of(Camera(distance=distance), (64, 64))
    assert wide.drawn_between == fitted.drawn_between
    assert fitted.drawn_between[0] >= NEAREST and fitted.drawn_between[1] > distance + 1


def test_planes_that_cut_stay_where_they_are() -> None:
    assert View.of(Camera(distance=3, near=2.5, far=3.5), (64, 64)).drawn_between == (2.5, 3.5)
    assert View.of(Camera(distance=3, near=0.5, far=1.0), (64, 64)).drawn_between == (0.5, 1.0)


@given(st.floats(0.01, 100), st.floats(1.001, 1e4), st.floats(0, 1))
def test_depth_there_and_back(near: float, ratio: float, share: float) -> None:
    far = near * ratio
    depth = near + share * (far - near)
    window = nonlinear_depth(depth, near, far)
    assert -1e-9 <= window <= 1 + 1e-9
    assert linear_depth(window, near, far) == pytest.approx(depth, rel=1e-6)


def test_a_length_covers_the_same_share_of_the_object_at_any_size() -> None:
    shares = [View.of(Camera(), size).in_picture(0.1) for size in ((100, 100), (1000, 1000), (2000, 1000))]
    assert shares[0] == shares[1]
    assert shares[2] == pytest.approx((shares[0][0] / 2, shares[0][1]))
    assert View.of(Camera(distance=1e-9), (64, 64)).in_picture(0.1) == View.of(Camera(distance=1), (64, 64)).in_picture(
        0.1
    )
