"""Exact thickness against closed forms of solids, and what is easily got wrong: clip planes, sheets, far cameras."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray
from picture_scenes import sheet_file

from fakesss import reference
from fakesss.accuracy.exact import Truth, exact_thickness
from fakesss.accuracy.exact_sight import corner_shares, interpolated
from fakesss.camera import View
from fakesss.problem import BadInput
from fakesss.scene import Scene
from fakesss.shapes import load_object

Floats = NDArray[np.float64]
SIZE = (48, 40)
INNER = 0.8  # radius of the shell's cavity
CAMERA = {"camera.azimuth": 25.0, "camera.elevation": 20.0}


def scene_of(name: str, **changes: object) -> Scene:
    return Scene(object=name, size=SIZE).replace({**CAMERA, **{k.replace("__", "."): v for k, v in changes.items()}})


def shell_file(folder: Path) -> str:
    mesh = reference.spherical_shell(80_000, 1.0, INNER)
    path = folder / "shell.ply"
    trimesh.Trimesh(mesh.positions, mesh.faces, process=False).export(path)
    return str(path)


def rays(scene: Scene, samples: int) -> tuple[Floats, Floats, Floats]:
    """Origins, directions, and their cosines to the view axis."""
    view = View.of(scene.camera, scene.size)
    origins, directions = reference.camera_rays(view, (scene.size[0] * samples, scene.size[1] * samples))
    return origins, directions, -directions @ view.rotation[2]


SOLIDS: list[tuple[str, Callable[[Floats, Floats], reference.Interval], float]] = [
    ("sphere:80000", reference.sphere_interval, 1e-3),
    ("box:1200", reference.box_interval, 2e-7),
    ("torus:80000", reference.torus_interval, 1e-3),
]


@pytest.mark.parametrize(("name", "interval", "bound"), SOLIDS, ids=[solid[0] for solid in SOLIDS])
@pytest.mark.parametrize("samples", [1, 2])
def test_first_interval_is_the_closed_form(
    name: str, interval: Callable[[Floats, Floats], reference.Interval], bound: float, samples: int
) -> None:
    """To what flat triangles lie from the solid; the box has flat sides, so there only float32 corners are left."""
    scene = scene_of(name)
    origins, directions, cosine = rays(scene, samples)
    entry, leave = interval(origins, directions)
    truth = (np.nan_to_num(leave - entry) * cosine / 2).reshape(SIZE[1] * samples, -1)
    found = exact_thickness(scene, samples)
    assert found.shape == truth.shape and found.dtype == np.float64
    assert (found > 0.01).sum() > 300 * samples**2
    inside = truth > 0.05  # at the outline of a solid in triangles, the two are one triangle apart
    assert np.abs(found - truth)[inside].max() < bound
    # nearly all pixels agree on what is object
    assert ((found > 0) == (truth > 0)).mean() > 0.999


@pytest.mark.parametrize("kind", ["first-interval", "total-path", "bridged"])
def test_a_shell_adds_up_as_each_thickness_says(tmp_path: Path, kind: str) -> None:
    """Two walls of thickness w and a gap of width g between them: w, 2 w and w (1 + exp(-g / gap))."""
    scene = scene_of(shell_file(tmp_path), material__thickness=kind, layers__gap=0.3)
    origins, directions, cosine = rays(scene, 1)
    entry, leave = (np.nan_to_num(end) * cosine / 2 for end in reference.sphere_interval(origins, directions))
    inner = [np.nan_to_num(end) * cosine / 2 for end in reference.sphere_interval(origins, directions, INNER)]
    gap = inner[1] - inner[0]
    walls = leave - entry - gap
    first = np.where(gap > 0, walls / 2, walls)
    after = {"first-interval": 0.0, "total-path": 1.0, "bridged": np.exp(-gap / 0.3)}[kind]
    truth = np.where(gap > 0, first * (1 + after), first).reshape(SIZE[::-1])
    sure = (truth > 0.05) & ((gap > 0.1) | (gap == 0)).reshape(truth.shape)
    error = np.abs(exact_thickness(scene) - truth)[sure]
    assert sure.sum() > 300 and error.max() < 4e-3 and np.median(error) < 3e-4


@pytest.mark.parametrize("distance", [None, 1.5, 9000.0])
def test_thickness_does_not_lose_digits_with_distance(distance: float | None) -> None:
    """Rays start at the near plane, so that float32 in Embree is exact where the object is."""
    view = {} if distance is None else {"camera__distance": distance}
    narrow = {"camera__field_of_view": 1.0, "camera__distance": 9000.0, "size": (2000, 2000)}
    scene = scene_of("box:1200", **(narrow if distance == 9000.0 else view))
    truth = Truth(scene, 1)
    middle = slice(scene.size[1] // 2 - 10, scene.size[1] // 2 + 10), slice(scene.size[0] // 2 - 9, scene.size[0] // 2)
    found = truth.thickness(truth.seen(middle, softened=False))
    columns, rows = (range(one.start, one.stop) for one in middle[::-1])
    view_of = truth.setting.view
    origins, directions = reference.camera_rays(view_of, scene.size, columns, rows)
    entry, leave = reference.box_interval(origins, directions)
    wanted = np.nan_to_num(leave - entry) * -(directions @ view_of.rotation[2]) / 2
    assert (wanted > 0).sum() > 100
    np.testing.assert_allclose(found, wanted, atol=1e-6)


def test_what_clip_planes_cut_away_is_not_there() -> None:
    """A near plane through the sphere's middle opens it: the second surface is seen from behind, and there is no more.

    A far plane there leaves no second surface; `open_surface` says what that means.
    """
    plain = scene_of("sphere:20000")
    distance = View.of(plain.camera, plain.size).distance
    opened = plain.replace({"camera.near": distance, "open_surface": "thick"})
    truth = Truth(opened, 1)
    seen = truth.seen((slice(0, SIZE[1]), slice(0, SIZE[0])), softened=False)
    assert seen.hit.sum() > 300 and seen.from_behind.mean() > 0.95 and np.nanmin(seen.front) > -1e-6
    assert (truth.thickness(seen)[seen.hit & (seen.front > 0.1)] == 1).all()
    closed = plain.replace({"camera.far": distance, "open_surface": "thick"})
    middle = SIZE[1] // 2, SIZE[0] // 2
    assert exact_thickness(closed)[middle] == 1
    assert exact_thickness(closed.replace({"open_surface": "thin"}))[middle] == 0


def test_a_sheet_has_the_thickness_the_scene_states(tmp_path: Path) -> None:
    sheet = sheet_file(tmp_path)
    assert exact_thickness(scene_of(sheet, open_surface="thin")).max() == 0
    thick = exact_thickness(scene_of(sheet, open_surface="thick"))
    assert set(np.unique(thick)) == {0, 1} and (thick == 1).sum() > 300
    for kind in ("total-path", "bridged"):
        np.testing.assert_array_equal(
            exact_thickness(scene_of(sheet, open_surface="thick", material__thickness=kind)), thick
        )


def test_local_thickness_is_the_baked_one() -> None:
    """Of a sphere everywhere alike: the mean way over the hemisphere, no way counted for more than the reach."""
    truth = Truth(scene_of("sphere:1000", material__thickness="local", layers__reach=0.25), 1, rays=1024)
    seen = truth.seen((slice(0, SIZE[1]), slice(0, SIZE[0])), softened=False)
    found = truth.thickness(seen)[seen.hit]
    assert found.std() < 2e-3 and 0.23 < found.max() < 0.25


def test_every_part_of_a_triangle_has_its_shares() -> None:
    mesh = load_object("knot:1000")
    faces = np.arange(len(mesh.faces), dtype=np.int32)
    wanted = np.random.default_rng(1).dirichlet((1, 1, 1), len(faces))
    points = interpolated(mesh, mesh.positions, faces, wanted)
    np.testing.assert_allclose(corner_shares(mesh, faces, points), wanted, atol=1e-6)
    first = interpolated(mesh, np.arange(len(mesh.positions)), faces, np.eye(3)[np.zeros(len(faces), int)])
    np.testing.assert_array_equal(first, mesh.faces[:, 0])


def test_flaws_on_purpose_have_no_truth() -> None:
    with pytest.raises(BadInput, match='style "as published" shows flaws'):
        exact_thickness(Scene(style="as published"))
