"""Each panel and plot against values computed without the views: from the camera, the layers, known shapes."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from planted_edges import HOLLOW, hollow_ball_file, step_file

from fakesss import views as module
from fakesss.camera import View
from fakesss.colour import decode_srgb, to_8bit
from fakesss.contact_sheet import EMPTY, Panel, Plot
from fakesss.lighting_terms import TERMS
from fakesss.profile_plot import Profile
from fakesss.reference import camera_rays, sphere_interval
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.views import FLOOR, pixel_width, views

pytestmark = pytest.mark.gl

BALL = Scene(object="sphere:60000", size=(72, 64))
KNOT = Scene(object="knot:8000", size=(64, 56)).replace({"camera.azimuth": 25.0, "occlusion.rays": 64})
CHORD = 5e-3  # what a polyhedron may differ from the sphere it stands for


def panel(scene: Scene, name: str) -> Panel:
    made = views(scene)[name]
    assert isinstance(made, Panel)
    return made


def ball_depths(scene: Scene) -> tuple[NDArray[np.float64], ...]:
    """Of the unit sphere: points in front (H, W, 3) in the eye frame, depth of front and back from its centre, hits."""
    view = View.of(scene.camera, scene.size)
    origins, directions = camera_rays(view, scene.size)
    entry, leave = sphere_interval(origins, directions)
    points = (origins + entry[:, None] * directions) @ view.rotation.T
    depths = [distance * -(directions @ view.rotation[2]) - view.distance for distance in (entry, leave)]
    shape = scene.size[::-1]
    return (points.reshape(*shape, 3), *(depth.reshape(shape) for depth in depths), ~np.isnan(entry).reshape(shape))


def test_layers_are_depths_into_the_sphere() -> None:
    _, front, back, hit = ball_depths(BALL)
    made = views(BALL)
    for name, depth in (("front", front), ("second", back)):
        shown = made[name]
        assert isinstance(shown, Panel)
        both = hit & shown.covered & (back - front > 0.2)
        assert both.sum() > 0.5 * hit.sum()
        np.testing.assert_allclose(shown.values[both], 1 + depth[both], atol=CHORD)


def test_normals_are_those_of_the_sphere() -> None:
    points, front, back, hit = ball_depths(BALL)
    shown = panel(BALL, "normals")
    inside = hit & shown.covered & (back - front > 0.2)
    np.testing.assert_allclose(shown.values[inside], 255 * (points[inside] + 1) / 2, atol=1.5)


def test_softening_reaches_over_its_taps_where_they_meet_the_back() -> None:
    _, front, back, hit = ball_depths(BALL)
    shown = panel(BALL, "blur_width")
    distance = View.of(BALL.camera, BALL.size).distance
    inside = hit & shown.covered & (back - front > 0.2)
    expected = 4 * BALL.blur.step * (distance + back) / distance
    np.testing.assert_allclose(shown.values[inside], expected[inside], rtol=CHORD)


@pytest.mark.parametrize(("method", "resource"), [("baked", "surface"), ("screen-space", "screen_occlusion")])
def test_occlusion_is_the_open_share(renderer: Renderer, method: str, resource: str) -> None:
    scene = KNOT.replace({"occlusion.method": method})
    data = renderer.data(scene, (resource, "front"))
    shown = panel(scene, "occlusion")
    found = data[resource] if data[resource].ndim == 2 else data[resource][..., 3]
    np.testing.assert_array_equal(shown.values, found)
    assert shown.limits == (0, 1) and (shown.covered == (data["front"] > 0)).all()
    ball = panel(BALL.replace({"occlusion.method": method}), "occlusion")
    assert np.median(ball.values[ball.covered]) > 0.95  # nothing hides a convex body from itself


def test_gaps_are_marked_for_each_layer_apart(tmp_path: Path) -> None:
    """The block's front is one plane; its back has a step in the middle."""
    scene = Scene(object=step_file(tmp_path), size=(64, 64)).replace({"camera.elevation": 0.0})
    second, front = panel(scene, "depth_gaps").marks
    assert (second.label, front.label) == ("second", "front") and second.colour != front.colour
    assert not front.pixels.any()
    assert second.pixels.any(axis=0)[31:33].all() and second.pixels[:, 31:33].any(axis=1).sum() > 10
    crossing = panel(KNOT, "depth_gaps")  # one strand before another
    jumps = np.abs(np.diff(crossing.values, axis=1)) > 0.5
    both = crossing.covered[:, 1:] & crossing.covered[:, :-1]
    assert (jumps & both).any() and crossing.marks[1].pixels[:, 1:][jumps & both].any()


def test_a_face_towards_the_viewer_shares_one_depth(tmp_path: Path) -> None:
    scene = Scene(object=step_file(tmp_path), size=(64, 64)).replace({"camera.elevation": 0.0})
    shown = panel(scene, "depth_precision")
    (shared,) = shown.marks
    assert shared.pixels[shown.covered].mean() > 0.95 and not shared.pixels[~shown.covered].any()
    ball = panel(BALL, "depth_precision")
    assert ball.marks[0].pixels[ball.covered].mean() < 0.1 and np.median(ball.values[ball.covered]) > 10


def test_the_circle_of_a_hollow_ball(tmp_path: Path) -> None:
    """Its hard edges, as long as the note says: a circle around the cavity, slightly wider by perspective."""
    scene = Scene(object=hollow_ball_file(tmp_path), size=(320, 240))
    shown = panel(scene, "hard_edges")
    distance = View.of(scene.camera, scene.size).distance
    sine = HOLLOW / distance
    radius = distance * sine / np.sqrt(1 - sine**2) / 2  # as seen at the sphere's centre, sphere diameters
    assert float(shown.note.split(", ")[1].split(" ")[0]) == pytest.approx(2 * np.pi * radius, rel=0.03)
    row, column = np.nonzero(shown.marks[0].pixels)
    across = np.hypot(row - 119.5, column - 159.5) * pixel_width(scene)
    assert len(row) > 400 and np.abs(across - radius).max() < 2 * pixel_width(scene)
    assert float(shown.note.split("%")[0]) / 100 == pytest.approx(len(row) / np.pi / (0.48 * 240) ** 2, rel=0.1)


def test_the_width_of_a_pixel_from_within_the_sphere() -> None:
    """The sphere just fills the shorter side; from inside, its surface is seen a radius away."""
    sine = np.sin(np.radians(15))
    assert pixel_width(Scene(size=(300, 200))) == pytest.approx(1 / np.sqrt(1 - sine**2) / 200)
    near = Scene(size=(300, 200)).replace({"camera.distance": 0.2, "camera.field_of_view": 90.0})
    assert pixel_width(near) == pytest.approx(1 / 200)


def test_softening_and_both_thicknesses_share_their_scale(renderer: Renderer) -> None:
    scene = KNOT.replace({"blur.step": 0.02})
    data = renderer.data(scene, ("front", "thickness", "blurred_thickness"))
    made = views(scene)
    exact, soft, change = (made[name] for name in ("thickness", "blurred_thickness", "softening"))
    assert isinstance(exact, Panel) and isinstance(soft, Panel) and isinstance(change, Panel)
    assert exact.limits == soft.limits == (0, data["thickness"].max()) and exact.line == 28 and soft.line is None
    difference = data["blurred_thickness"] - data["thickness"]
    assert (change.values == difference).all() and np.abs(difference).max() > 0
    most = np.percentile(np.abs(difference[data["front"] > 0]), 99.5)
    assert change.limits == pytest.approx((-most, most))


def test_terms_and_picture_are_those_of_the_scene(renderer: Renderer) -> None:
    made = views(KNOT)
    picture = made["picture"]
    assert isinstance(picture, Panel)
    np.testing.assert_array_equal(picture.values, to_8bit(renderer.render(KNOT).image[..., :3]))
    for term in TERMS:
        weights = {f"material.{other}": 0.0 for other in ("ambient", "diffuse_contribution", "specular_contribution")}
        weights |= {"material.backlight": 0.0}
        own = TERMS[term][0]
        alone = KNOT.replace({**weights, own: KNOT.at(own), "background": (0.0, 0.0, 0.0)})
        image = renderer.render(alone).image.astype(np.float64)
        shown = made[term]
        assert isinstance(shown, Panel) and shown.note.startswith(TERMS[term][1])
        factor = int(shown.note.split(", ")[-1].removesuffix(" times")) if shown.note.endswith("times") else 1
        expected = factor * image[..., :3] + (1 - image[..., 3:]) * decode_srgb(np.array(EMPTY) / 255)
        np.testing.assert_array_equal(shown.values, to_8bit(expected), err_msg=term)


def plotted(scene: Scene, name: str, monkeypatch: pytest.MonkeyPatch) -> tuple[Any, ...]:
    """What the view hands to the function that draws it."""
    handed: list[Any] = []
    drawing = {"profile": "profile_plot", "relief": "relief"}[name]
    monkeypatch.setattr(module, drawing, lambda *given: handed.extend(given))
    plot = views(scene)[name]
    assert isinstance(plot, Plot)
    plot.draw((300, 200))
    return tuple(handed)


def test_the_profile_is_the_middle_row_with_its_edges(
    renderer: Renderer, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The block's step stands at the picture's middle, and its row 0 is empty."""
    scene = Scene(object=step_file(tmp_path), size=(64, 48)).replace({"camera.elevation": 0.0})
    profile, size = plotted(scene, "profile", monkeypatch)
    assert isinstance(profile, Profile) and size == (300, 200)
    data = renderer.data(scene, ("front", "thickness", "blurred_thickness"))
    covered = data["front"][24] > 0
    assert covered.any() and not (data["front"][0] > 0).any()
    for shown, name in ((profile.exact, "thickness"), (profile.softened, "blurred_thickness")):
        np.testing.assert_array_equal(shown, np.where(covered, data[name][24], np.nan))
    assert list(profile.edges) == pytest.approx([0.0], abs=1e-12)
    np.testing.assert_allclose(profile.across, (np.arange(64) - 31.5) * pixel_width(scene))


def test_the_relief_stands_as_high_as_the_surface_is_near(monkeypatch: pytest.MonkeyPatch) -> None:
    _, front, back, hit = ball_depths(BALL)
    heights, covered, spacing, size, colours, _ = plotted(BALL, "relief", monkeypatch)
    inside = hit & covered & (back - front > 0.2)
    relative = heights[inside] - heights[inside].max()
    np.testing.assert_allclose(relative, (front[inside].min() - front[inside]) / 2, atol=CHORD)
    assert not heights[~covered].any() and heights[covered].min() == pytest.approx(FLOOR)
    assert spacing == pixel_width(BALL) and size == (300, 200) and colours == "cividis"
