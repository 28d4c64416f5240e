"""Screen-space ambient occlusion: its twin in numpy, closed forms, the bake, and what must not change it."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from picture_scenes import dark, sheet_file

from fakesss.camera import View
from fakesss.pipeline import build
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.screen_occlusion import frame_around, sampled, smoothed, unprojected

pytestmark = pytest.mark.gl


def screen_space(**changes: Any) -> Scene:
    return dark(occlusion__method="screen-space", **changes)


def open_share(renderer: Renderer, scene: Scene) -> tuple[NDArray[Any], NDArray[np.bool_]]:
    """[a] for each pixel, and where the object is."""
    data = renderer.data(scene, ("screen_occlusion", "front"))
    return data["screen_occlusion"], data["front"] > 0


@pytest.mark.parametrize("sampling", ["cosine", "uniform"])
@pytest.mark.parametrize("camera", [{}, {"camera__distance": 0.8}, {"camera__field_of_view": 120.0}])
def test_drawn_is_what_numpy_computes(renderer: Renderer, camera: dict[str, float], sampling: str) -> None:
    scene = screen_space(object="knot:8000", size=(70, 51), occlusion__sampling=sampling, **camera)
    names = ("front", "surface", "sampled_occlusion", "screen_occlusion")
    data = {name: image[::-1] for name, image in renderer.data(scene, names).items()}
    expected = sampled(data["front"], data["surface"], View.of(scene.camera, scene.size), scene.occlusion)
    difference = np.abs(data["sampled_occlusion"] - expected)
    assert (difference > 1e-4).mean() < 0.01  # a point at the very edge of a texel or a bias may round either way
    assert difference.max() < 0.3
    averaged = smoothed(data["front"], data["sampled_occlusion"], 2 * scene.occlusion.radius)
    np.testing.assert_allclose(data["screen_occlusion"], averaged, rtol=1e-5, atol=1e-6)


@given(st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda n: np.linalg.norm(n) > 1e-3))
def test_frame_is_orthonormal(n: tuple[float, float, float]) -> None:
    unit = np.array([n]) / np.linalg.norm(n)
    frame = np.concatenate([*frame_around(unit), unit])
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-9)


@pytest.mark.parametrize("size", [(7, 5), (64, 64), (301, 200)])
@pytest.mark.parametrize("azimuth", [0.0, 40.0, 80.0, 88.0])
def test_a_flat_sheet_is_open_however_it_is_turned(
    renderer: Renderer, tmp_path: Path, size: tuple[int, int], azimuth: float
) -> None:
    scene = screen_space(object=sheet_file(tmp_path), size=size, camera__azimuth=azimuth, camera__elevation=0.0)
    share, covered = open_share(renderer, scene)
    np.testing.assert_array_equal(share[covered], 1)


def test_a_convex_body_is_open(renderer: Renderer) -> None:
    for size in ((16, 16), (97, 64), (256, 256)):
        share, covered = open_share(renderer, screen_space(object="sphere:20000", size=size))
        assert covered.any() and share[covered].min() > 0.999


def corner_file(folder: Path) -> str:
    """Two squares that meet at a right angle, seen into from +z: the floor and the wall of a room."""
    path = folder / "corner.ply"
    low = [[-1, 0, 0], [1, 0, 0], [1, 0, 1], [-1, 0, 1]]
    high = [[-1, 0, 0], [1, 0, 0], [1, 1, 0], [-1, 1, 0]]
    faces = [[0, 3, 2], [0, 2, 1], [4, 5, 6], [4, 6, 7]]
    trimesh.Trimesh([*low, *high], faces, process=False).export(path)
    return str(path)


def blocked_by_a_wall(apart: NDArray[Any], reach: float) -> NDArray[Any]:
    """Cosine-weighted share of rays from a floor that meet an endless wall `apart` away within `reach`.

    Projected on the floor the hemisphere is a disc (Nusselt 1928), and what meets the wall the disc's segment.
    """
    c = np.clip(apart / reach, 0, 1)
    return np.asarray((np.arccos(c) - c * np.sqrt(1 - c * c)) / np.pi)


SEEN_FROM = [
    {},
    {"size": (67, 67)},
    {"size": (300, 120)},
    {"camera__field_of_view": 5.0},
    {"camera__field_of_view": 80.0},
    {"camera__distance": 2.0},
    {"camera__distance": 9000.0, "camera__field_of_view": 1.0, "size": (3000, 3000)},
]


@pytest.mark.parametrize("changes", SEEN_FROM, ids=str)
def test_beside_a_wall_is_as_open_as_the_closed_form(
    renderer: Renderer, tmp_path: Path, changes: dict[str, Any]
) -> None:
    """Whatever the resolution, the field of view and the camera's distance: the radius is the object's."""
    fine = {"occlusion__samples": 256, "occlusion__radius": 0.25, "occlusion__bias": 1e-4}
    usual = {"size": (200, 200), "camera__elevation": 45.0, **fine}
    scene = screen_space(object=corner_file(tmp_path), **{**usual, **changes})
    names = ("screen_occlusion", "front", "surface")
    data = {name: image[::-1] for name, image in renderer.data(scene, names).items()}
    y, x = np.nonzero(data["front"] > 0)
    points = unprojected(x, y, data["front"], View.of(scene.camera, scene.size))
    normals = data["surface"][y, x, :3]
    floor = normals[:, 1] > 0.1
    apart = (points - points[~floor][0]) @ normals[~floor][0]
    sure = floor & (np.abs(points[:, 0]) < 0.3) & (apart > 0.01) & (apart < 0.6)
    # a ray's last point stands at 3/4 to 4/4 of its length
    ends = 0.5 * (3 + np.arange(64) / 64) / 4
    expected = 1 - np.mean([blocked_by_a_wall(apart[sure], end) for end in ends], axis=0)
    assert sure.sum() > 50 and expected.min() < 0.75
    error = np.abs(data["screen_occlusion"][y, x][sure] - expected)
    assert error.mean() < 0.02 and error.max() < 0.08  # the mean over a tile softens where r is few samples long


def layered_file(folder: Path, apart: float) -> str:
    """A square before a larger one, both facing +z."""
    path = folder / "layered.ply"
    square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    trimesh.Trimesh([*square, *(square * 0.2 + (0, 0, apart))], [*faces, *(faces + 4)], process=False).export(path)
    return str(path)


@pytest.mark.parametrize(("apart", "darkest"), [(0.1, 0.85), (1.0, 1.0)])
def test_what_is_far_in_front_hides_nothing(renderer: Renderer, tmp_path: Path, apart: float, darkest: float) -> None:
    scene = screen_space(object=layered_file(tmp_path, apart), camera__elevation=0.0, occlusion__radius=0.1)
    share, covered = open_share(renderer, scene)
    assert share[covered].min() == 1 if darkest == 1 else share[covered].min() < darkest


def test_finer_samples_show_the_same_picture(renderer: Renderer) -> None:
    """512 with one sample a pixel against 256 with four: to the noise of 16 rotated directions."""
    scene = screen_space(object="figure:8000", light__ambient=(1, 1, 1))
    once = renderer.render(scene.replace({"size": (512, 512)})).image
    averaged = once.reshape(256, 2, 256, 2, 4).mean(axis=(1, 3))
    fine = renderer.render(scene.replace({"size": (256, 256), "supersampling": 2})).image
    np.testing.assert_allclose(fine, averaged, atol=1e-5)
    coarse = renderer.render(scene.replace({"size": (256, 256)})).image
    inside = (averaged[..., 3] == 1) & (coarse[..., 3] == 1)
    difference = np.abs(coarse - averaged)[inside][:, 0] / 0.78
    assert difference.mean() < 0.02 and np.percentile(difference, 99) < 0.1


@pytest.mark.parametrize(
    ("name", "apart", "alike"), [("figure", 0.055, 0.95), ("knot", 0.045, 0.92), ("hand", 0.03, 0.93)]
)
def test_it_is_close_to_the_bake(renderer: Renderer, name: str, apart: float, alike: float) -> None:
    """docs/technique.md states these: mean difference from the baked share of rays, and the correlation with it."""
    scene = screen_space(object=f"{name}:20000", size=(192, 192), light__ambient=(1, 1, 1))
    share, covered = open_share(renderer, scene)
    baked = renderer.data(scene.replace({"occlusion.method": "baked"}), ("surface",))["surface"][..., 3]
    assert np.abs(share - baked)[covered].mean() < apart
    assert np.corrcoef(share[covered], baked[covered])[0, 1] > alike


HARD: list[dict[str, Any]] = [
    {"size": (1, 1)},
    {"size": (1, 64)},
    {"occlusion__radius": 1.0, "occlusion__bias": 0.0},
    {"occlusion__radius": 1e-6},
    {"occlusion__samples": 4},
    {"occlusion__samples": 256, "size": (33, 21)},
    {"camera__distance": 1e-3},
    {"camera__distance": 0.5, "camera__field_of_view": 170.0},
    {"camera__distance": 1e4, "camera__field_of_view": 1.0},
]


@pytest.mark.parametrize("changes", HARD, ids=str)
@pytest.mark.parametrize("shape", ["figure:4000", "sheet"])
def test_hard_cases_stay_within_bounds(renderer: Renderer, tmp_path: Path, shape: str, changes: dict[str, Any]) -> None:
    scene = screen_space(object=sheet_file(tmp_path) if shape == "sheet" else shape, light__ambient=(1, 1, 1))
    scene = scene.replace({path.replace("__", "."): value for path, value in changes.items()})
    share, covered = open_share(renderer, scene)
    assert np.isfinite(share).all() and share.min() >= 0 and share.max() <= 1
    np.testing.assert_array_equal(share[~covered], 0)
    assert renderer.render(scene).non_finite == 0


def test_the_ambient_term_is_multiplied_by_it(renderer: Renderer) -> None:
    scene = screen_space(object="torus:8000", light__ambient=(1, 2, 3), material__diffuse=(0.5, 0.5, 0.5))
    share, covered = open_share(renderer, scene)
    image = renderer.render(scene).image
    assert share[covered].min() < 0.9
    np.testing.assert_allclose(image[covered][:, :3], share[covered][:, None] * np.array([0.5, 1, 1.5]), rtol=1e-5)


@pytest.mark.parametrize(
    ("changes", "because"),
    [
        ({"occlusion.method": "baked"}, 'not read by shade: occlusion.method is "baked"'),
        ({"occlusion.enabled": False}, "not read by shade: occlusion.enabled is false"),
        ({"light.ambient": (0, 0, 0)}, "not read by shade: light.ambient is 0"),
        ({"material.ambient": 0.0}, "not read by shade: material.ambient is 0"),
    ],
)
def test_it_is_left_out_with_a_reason(changes: dict[str, Any], because: str) -> None:
    scene = Scene().replace({"occlusion.method": "screen-space", **changes})
    verdicts = {verdict.node.name: verdict for verdict in build(scene).compile(("image",)).verdicts}
    assert verdicts["screen_occlusion"].because == because
    assert not verdicts["sample_occlusion"].kept
    assert verdicts["occlusion"].kept == (scene.occlusion.method == "baked")


@pytest.mark.parametrize("without", [{"material.ambient": 0.0}, {"light.ambient": (0, 0, 0)}], ids=str)
def test_leaving_it_out_changes_no_byte(renderer: Renderer, without: dict[str, Any]) -> None:
    scene = Scene(object="torus:8000", size=(64, 48)).replace({"occlusion.method": "screen-space", **without})
    culled, forced = renderer.render(scene), renderer.render(scene, forced=frozenset({"occlusion"}))
    ran = [{entry["name"] for entry in drawn.passes} for drawn in (culled, forced)]
    assert "screen_occlusion" not in ran[0] and "screen_occlusion" in ran[1]
    assert culled.image.tobytes() == forced.image.tobytes()


def test_either_occlusion_or_the_other_is_made() -> None:
    plan = build(Scene().replace({"occlusion.method": "screen-space"})).compile(("image",))
    names = [node.name for node in plan.kept]
    assert "occlusion" not in names
    assert names.index("sample_occlusion") < names.index("screen_occlusion") < names.index("shade")
