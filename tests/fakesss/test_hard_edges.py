"""Hard edges against shapes whose edges are known: none on a sphere or a box, straight and round ones where planted."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from planted_edges import step_file

from fakesss import reference
from fakesss.camera import View
from fakesss.hard_edges import FRONT_BOUND, JUMP, hard_edges
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.views import pixel_width

Floats = NDArray[np.float64]
SIDES = [32, 65, 128, 512]


def seen(size: tuple[int, int], interval, **camera: float) -> tuple[Floats, Floats]:  # type: ignore[no-untyped-def]
    """Front layer and thickness (H, W) of a solid given by its first interval along rays."""
    view = View.of(Scene().camera.model_copy(update=camera), size)
    x = ((np.arange(size[0]) + 0.5) / size[0] * 2 - 1) * view.tangent[0]
    y = (1 - (np.arange(size[1]) + 0.5) / size[1] * 2) * view.tangent[1]
    eye = np.stack([*np.meshgrid(x, y), np.full((size[1], size[0]), -1.0)], axis=-1).reshape(-1, 3)
    along = eye @ view.rotation
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    near, far = interval(np.tile(view.distance * view.rotation[2], (len(along), 1)), along)
    forward = along @ -view.rotation[2]
    front = np.nan_to_num(near * forward - view.distance + 2)
    return front.reshape(size[::-1]), np.nan_to_num((far - near) * forward / 2).reshape(size[::-1])


@pytest.mark.parametrize("side", SIDES)
def test_a_sphere_has_none(side: int) -> None:
    found = hard_edges(*seen((side, side), reference.sphere_interval))
    assert found.pairs == 0 and found.share == 0 and found.judged.sum() > 0.4 * side**2


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("azimuth", [0, 20, 45, 80])
def test_a_box_bends_and_does_not_jump(side: int, azimuth: float) -> None:
    found = hard_edges(*seen((side, side), reference.box_interval, azimuth=azimuth, elevation=30))
    assert found.pairs == 0 and found.judged.any()


@pytest.mark.parametrize("side", SIDES[1:])
@pytest.mark.parametrize("longer", [1, 2])
def test_the_edge_of_a_shells_cavity_is_no_silhouette_and_jumps(side: int, longer: int) -> None:
    """Where rays graze the cavity the first wall joins the far one: a circle, slightly wider by perspective."""
    size = (longer * side, side)
    found = hard_edges(*seen(size, reference.shell_interval))
    view = View.of(Scene().camera, size)
    angle = np.arcsin(0.8 / view.distance)
    around = 2 * np.pi * np.tan(angle) * view.distance / 2  # as seen at the sphere's centre, sphere diameters
    length = found.length(pixel_width(Scene(size=size)))
    assert length == pytest.approx(around, rel=0.06 if side < 100 else 0.02)
    row, column = np.nonzero(found.mask)
    radius = np.hypot(row - (side - 1) / 2, column - (size[0] - 1) / 2) * 2 / side * view.tangent[1]
    assert np.abs(radius - np.tan(angle)).max() < 1.5 * 2 / side * view.tangent[1]


def test_two_plates_of_different_thickness() -> None:
    front, thickness = np.full((20, 30), 1.5), np.full((20, 30), 0.1)
    thickness[:, 12:] = 0.1 + 1.01 * JUMP
    found = hard_edges(front, thickness)
    assert found.judged.all() and found.pairs == 20
    assert np.unique(np.nonzero(found.mask)[1]).tolist() == [11, 12] and found.share == 2 / 30
    assert hard_edges(front, thickness, bound=1.02 * JUMP).pairs == 0


def test_no_edge_is_counted_at_a_silhouette() -> None:
    """A nearer plate before another: the front layer breaks where the thickness does."""
    front, thickness = np.full((20, 30), 1.5), np.full((20, 30), 0.1)
    front[:, 12:] -= 2 * 1.1 * FRONT_BOUND
    thickness[:, 12:] = 0.4
    found = hard_edges(front, thickness)
    assert found.pairs == 0 and np.flatnonzero(~found.judged[0]).tolist() == [10, 11, 12, 13]


def test_a_slope_and_a_bend_are_no_jumps() -> None:
    front = np.full((6, 41), 1.5)
    slope = np.tile(np.abs(np.arange(41) - 20) * 2 * JUMP, (6, 1))
    assert hard_edges(front, slope).pairs == 0
    slope[:, 30:] += 1.1 * JUMP
    assert hard_edges(front, slope).pairs == 6


@pytest.mark.parametrize("angle", [0, 12, 30, 45, 77])
def test_length_of_a_straight_edge(angle: float) -> None:
    """Along the grid pi/4 of the length, at 45 degrees pi/4 sqrt 2; right on average over directions."""
    y, x = np.mgrid[:400, :400] - 199.5
    turn = np.radians(angle)
    side = x * np.cos(turn) + y * np.sin(turn) > 0.1
    found = hard_edges(np.full(side.shape, 1.5), 0.1 + 0.3 * side)
    true = 400 / max(abs(np.cos(turn)), abs(np.sin(turn)))
    expected = np.pi / 4 * (abs(np.cos(turn)) + abs(np.sin(turn)))
    assert found.length(1.0) / true == pytest.approx(expected, rel=0.01)


def test_nothing_seen_has_no_edges() -> None:
    found = hard_edges(np.zeros((5, 7)), np.zeros((5, 7)))
    assert found.share == 0 and found.pairs == 0 and not found.judged.any()


@given(st.integers(0, 2**31), st.tuples(st.integers(1, 12), st.integers(1, 12)))
def test_turning_the_picture_turns_the_edges(seed: int, size: tuple[int, int]) -> None:
    random = np.random.default_rng(seed)
    front = random.choice([0, 1.5, 1.501, 1.7], size, p=[0.1, 0.4, 0.4, 0.1])
    thickness = random.choice([0.1, 0.12, 0.3], size)
    mask = hard_edges(front, thickness).mask
    for turned in (np.transpose, np.flipud, np.fliplr):
        assert (hard_edges(turned(front), turned(thickness)).mask == turned(mask)).all()
    assert not (mask & (front == 0)).any()
    assert hard_edges(front, thickness, bound=0.19).pairs <= hard_edges(front, thickness, bound=0.01).pairs


@pytest.mark.gl
@pytest.mark.parametrize("side", [64, 256, 512])
def test_the_step_of_a_rendered_block(renderer: Renderer, tmp_path: Path, side: int) -> None:
    """The step's wall lies in the plane of sight: a vertical line across the block's face."""
    scene = Scene(object=step_file(tmp_path), size=(side, side)).replace({"camera.elevation": 0.0})
    layers = renderer.data(scene, ("front", "thickness"))
    found = hard_edges(layers["front"], layers["thickness"])
    assert np.unique(np.nonzero(found.mask)[1]).tolist() == [side // 2 - 1, side // 2]
    radius = np.sqrt(1 + 0.5**2 + 0.3**2)
    view = View.of(scene.camera, scene.size)
    to_face = view.distance * radius - 0.3
    # rays diverge: near the rim both sides end at the top or bottom, and the thick one must still be JUMP thicker there
    top = 0.5 / (1 + (0.2 + 2 * JUMP * radius) / to_face)
    assert abs(found.pairs - top / to_face / view.tangent[1] * side) <= 2


def length(renderer: Renderer, thickness: str, side: int) -> float:
    """Of the hard edges of the built-in shell, sphere diameters."""
    scene = Scene(object="shell", size=(side, side)).replace({"material.thickness": thickness})
    layers = renderer.data(scene, ("front", "thickness"))
    return hard_edges(layers["front"], layers["thickness"]).length(pixel_width(scene))


@pytest.mark.gl
def test_the_length_of_jumps_settles_and_that_of_slopes_vanishes(renderer: Renderer) -> None:
    jumps = [length(renderer, "first-interval", side) for side in (512, 1024)]
    slopes = [length(renderer, "bridged", side) for side in (512, 1024)]
    assert jumps[0] > 1.5 and jumps[1] == pytest.approx(jumps[0], rel=0.1)
    assert slopes[1] < 0.5 * slopes[0] < 0.25 * jumps[0]


@pytest.mark.gl
def test_sculptures_have_them_and_their_length_settles(renderer: Renderer) -> None:
    lengths, shares = [], []
    for side in (512, 1024):
        scene = Scene(object="knot", size=(side, side)).replace({"camera.azimuth": 25.0, "camera.elevation": 20.0})
        layers = renderer.data(scene, ("front", "thickness"))
        found = hard_edges(layers["front"], layers["thickness"])
        lengths.append(found.length(pixel_width(scene)))
        shares.append(found.share)
    assert lengths[0] == pytest.approx(lengths[1], rel=0.2) and lengths[0] > 0.03
    assert 0 < shares[1] < shares[0]
