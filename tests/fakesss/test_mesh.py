"""Loading, repair and normals of meshes."""

import time
from pathlib import Path

import numpy as np
import pytest
import trimesh

from fakesss.mesh import EXTENSIONS, Mesh, load_mesh, mesh_from_triangles
from fakesss.mesh_repair import weld, winding_number
from fakesss.problem import BadInput

BALL = trimesh.creation.icosphere(3, radius=2.5)
BOX = trimesh.creation.box((1, 2, 3))


def build(mesh: trimesh.Trimesh, faces: np.ndarray | None = None) -> Mesh:
    return mesh_from_triangles(np.array(mesh.vertices, float), mesh.faces if faces is None else faces, "test")


def volume(mesh: Mesh) -> float:
    a, b, c = np.moveaxis(mesh.positions[mesh.faces].astype(float), 1, 0)
    return float((a * np.cross(b, c)).sum() / 6)


@pytest.mark.parametrize("extension", EXTENSIONS)
def test_formats(tmp_path: Path, extension: str) -> None:
    moved = BALL.copy()
    moved.apply_translation((4, -5, 6))
    moved.export(tmp_path / f"ball.{extension}")
    mesh = load_mesh(tmp_path / f"ball.{extension}")
    assert mesh.watertight and len(mesh.faces) == len(BALL.faces) and len(mesh.positions) == len(BALL.vertices)
    assert mesh.positions.dtype == mesh.normals.dtype == np.float32 and mesh.faces.dtype == np.int32
    assert mesh.centre == pytest.approx((4, -5, 6), abs=1e-6) and mesh.radius == pytest.approx(2.5, rel=1e-6)
    assert np.linalg.norm(mesh.positions, axis=1).max() == pytest.approx(1, abs=1e-6)
    np.testing.assert_allclose(mesh.normals, mesh.positions, atol=0.01)


def test_scene_parts_keep_their_transforms(tmp_path: Path) -> None:
    scene = trimesh.Scene()
    scene.add_geometry(BOX, transform=trimesh.transformations.translation_matrix((5, 0, 0)))
    scene.add_geometry(BOX, transform=trimesh.transformations.translation_matrix((-5, 0, 0)))
    scene.export(tmp_path / "two.glb")
    mesh = load_mesh(tmp_path / "two.glb")
    assert mesh.watertight and len(mesh.faces) == 24
    assert mesh.radius == pytest.approx(np.sqrt(5.5**2 + 1 + 1.5**2), rel=1e-6)


def test_obj_materials_and_other_files_are_not_read(tmp_path: Path) -> None:
    text = "mtllib ../elsewhere.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n"
    (tmp_path / "tri.obj").write_text(text)
    mesh = load_mesh(tmp_path / "tri.obj")
    assert len(mesh.faces) == 1 and not mesh.watertight


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("offset", [0.0, 1e7])
def test_scale_and_offset_do_not_change_the_mesh(scale: float, offset: float) -> None:
    """An offset of 1e7 times the size leaves 9 digits in float64, more than float32 has."""
    plain = build(BALL)
    moved = mesh_from_triangles((np.array(BALL.vertices) + offset * np.array([1, -1, 1])) * scale, BALL.faces, "test")
    np.testing.assert_allclose(moved.positions, plain.positions, atol=2e-7 if offset == 0 else 2e-9 * 2.5)
    assert moved.watertight
    np.testing.assert_array_equal(moved.faces, plain.faces)


def test_bounding_sphere_of_a_tetrahedron() -> None:
    """Centre of the bounding box, not of the vertices: the contract's definition."""
    corners = np.array([(0, 0, 0), (4, 0, 0), (0, 2, 0), (0, 0, 2)], float)
    mesh = mesh_from_triangles(corners, np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]), "test")
    assert mesh.centre == (2, 1, 1) and mesh.radius == pytest.approx(np.sqrt(6))


def test_vertices_that_no_face_uses_do_not_count() -> None:
    positions = np.concatenate([np.array(BALL.vertices), [(1e3, 0, 0), (np.nan, 0, 0)]])
    mesh = mesh_from_triangles(positions, BALL.faces, "test")
    assert mesh.radius == pytest.approx(2.5)
    assert len(mesh.positions) == len(BALL.vertices)


def test_creases_are_hard_and_curves_smooth() -> None:
    box = build(BOX)
    assert len(box.positions) == 24, "each corner once for each of its three sides"
    assert box.watertight
    np.testing.assert_allclose(np.sort(np.abs(box.normals), axis=1), np.tile([0, 0, 1], (24, 1)), atol=1e-6)
    cone = build(trimesh.creation.cone(radius=1, height=1, sections=48))
    assert len(cone.positions) == 48 + 48 + 2, "the rim is split, the mantle is not"
    assert len(build(BALL).positions) == len(BALL.vertices)


def test_normals_do_not_depend_on_how_a_side_is_cut() -> None:
    """Weighted by angle, a side of a low pyramid counts once at the tip whether it is one triangle there or two."""
    corners = np.array([(0, 0, 0.5), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0.2, 0.8, 0)])
    cut = np.array([(0, 1, 5), (0, 5, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1)])
    mesh = mesh_from_triangles(corners, cut, "test")
    tip = mesh.normals[mesh.positions[:, 2].argmax()]
    np.testing.assert_allclose(tip, (0, 0, 1), atol=1e-6)


@pytest.mark.parametrize(
    ("damage", "sentence"),
    [
        ("collapsed", "Dropped 1 triangle with two corners at one place."),
        ("copy", "Dropped 2 copies of other triangles."),
        ("mixed", "triangles wound against the neighbours."),
        ("inside out", "Turned 1 closed surface that faced inwards."),
        ("soup", "Merged 3,840 vertices into 642."),
    ],
)
def test_repairs_are_said(damage: str, sentence: str) -> None:
    positions, faces = np.array(BALL.vertices, float), np.array(BALL.faces)
    if damage == "collapsed":
        faces = np.concatenate([faces, [(3, 3, 9)]])
    elif damage == "copy":
        faces = np.concatenate([faces, faces[:2, [1, 2, 0]]])
    elif damage == "mixed":
        faces[::3] = faces[::3, ::-1]
    elif damage == "inside out":
        faces = faces[:, ::-1]
    elif damage == "soup":
        positions, faces = positions[faces.ravel()], np.arange(faces.size).reshape(-1, 3)
    mesh = mesh_from_triangles(positions, faces, "test")
    assert any(said.endswith(sentence) for said in mesh.repairs), mesh.repairs
    assert mesh.watertight
    assert np.isfinite(mesh.positions).all() and np.isfinite(mesh.normals).all()
    assert len(mesh.repairs) == 1, mesh.repairs
    assert volume(mesh) == pytest.approx(volume(build(BALL)), rel=1e-6)


def test_a_sound_mesh_needs_no_repairs() -> None:
    assert build(BALL).repairs == ()


def test_cavities_stay_and_a_whole_inverted_shell_is_turned() -> None:
    outer, inner = np.array(BALL.vertices), 0.5 * np.array(BALL.vertices)
    hollow = np.concatenate([BALL.faces, BALL.faces[:, ::-1] + len(outer)])
    positions = np.concatenate([outer, inner])
    right = mesh_from_triangles(positions, hollow, "test")
    turned = mesh_from_triangles(positions, hollow[:, ::-1], "test")
    assert right.repairs == () and turned.repairs == ("Turned 2 closed surfaces that faced inwards.",)
    assert volume(turned) == pytest.approx(volume(right)) == pytest.approx(volume(build(BALL)) * 7 / 8, rel=1e-5)


def test_many_inverted_surfaces_are_turned_in_little_time() -> None:
    """A heap of grains exported inside out; comparing each with each took minutes."""
    grains = np.stack(np.meshgrid(*[np.arange(20.0)] * 3), axis=-1).reshape(-1, 1, 3)
    corners = np.array([(0, 0, 0), (0.5, 0, 0), (0, 0.5, 0), (0, 0, 0.5)])
    faces = 4 * np.arange(len(grains))[:, None, None] + np.array([(0, 1, 2), (0, 3, 1), (1, 3, 2), (0, 2, 3)])
    started = time.perf_counter()
    mesh = mesh_from_triangles((grains + corners).reshape(-1, 3), faces.reshape(-1, 3), "test")
    assert time.perf_counter() - started < 5
    assert mesh.repairs == ("Turned 8,000 closed surfaces that faced inwards.",)
    assert volume(mesh) > 0


def test_open_and_one_sided_surfaces_are_not_watertight() -> None:
    half = build(BALL, BALL.faces[BALL.triangles_center[:, 1] > 0])
    assert not half.watertight and "open" in half.repairs[-1]
    turn = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    sides = [
        np.stack([(1 + w * np.cos(turn / 2)) * f(turn) for f in (np.cos, np.sin)] + [w * np.sin(turn / 2)], axis=1)
        for w in (-0.3, 0.3)
    ]
    i = np.arange(39)
    strip = np.concatenate([np.stack([i, i + 1, i + 40], 1), np.stack([i + 1, i + 41, i + 40], 1)])
    closing = np.array([(39, 40, 79), (40, 0, 79)])  # a Möbius strip: the last pair joins the first crosswise
    moebius = mesh_from_triangles(np.concatenate(sides), np.concatenate([strip, closing]), "test")
    assert not moebius.watertight
    assert np.isfinite(moebius.normals).all()


def test_both_sides_of_a_sheet_are_kept_with_their_own_normals() -> None:
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
    sheet = mesh_from_triangles(corners, np.array([(0, 1, 2), (0, 2, 3), (2, 1, 0), (3, 2, 0)]), "test")
    assert sheet.watertight and len(sheet.faces) == 4 and len(sheet.positions) == 8
    assert set(np.round(sheet.normals[:, 2])) == {-1, 1}


@pytest.mark.parametrize("away", [0.0, 1e6])
def test_surfaces_that_touch_at_a_point_have_their_own_normals_there(away: float) -> None:
    """Two cones, tip to tip; far from the origin their normals cancel up to rounding alone."""
    lower = trimesh.creation.cone(1, 1, sections=24)
    lower.apply_translation((0, 0, -1))
    points = np.concatenate([lower.vertices, lower.vertices * (1, 1, -1)]) + away / 3
    mesh = mesh_from_triangles(
        points, np.concatenate([lower.faces, lower.faces[:, ::-1] + len(lower.vertices)]), "test"
    )
    tips = mesh.normals[np.abs(mesh.positions).max(axis=1) < 1e-6]
    assert mesh.watertight
    np.testing.assert_allclose(np.sort(tips[:, 2]), [-1, 1], atol=1e-4)


def test_extreme_coordinates_stay_finite() -> None:
    for scale in (1e-300, 1e300):
        mesh = mesh_from_triangles(np.array(BOX.vertices) * scale, BOX.faces, "test")
        assert np.linalg.norm(mesh.positions, axis=1).max() == pytest.approx(1, abs=1e-6)


def test_triangles_on_a_line_keep_the_surface_closed() -> None:
    """A sliver without area between two sides of a box draws nothing, but without it the box would be open."""
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0.5, 0.5, 0)]
    faces = [(0, 4, 1), (0, 2, 4), (0, 1, 3), (1, 2, 3), (0, 3, 2), (1, 4, 2)]
    mesh = mesh_from_triangles(np.array(corners, float), np.array(faces), "test")
    assert mesh.watertight and len(mesh.faces) == 6
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-6)


def test_equal_content_has_an_equal_hash() -> None:
    assert build(BALL).sha256 == build(BALL).sha256 != build(BOX).sha256
    with pytest.raises(ValueError, match="read-only"):
        build(BALL).positions[0] = 0


def test_weld_merges_what_float32_cannot_tell_apart() -> None:
    scaled = np.array([(0.5, 0, 0), (0.5 + 1e-9, -0.0, 0), (0.5 + 1e-6, 0, 0), (0, 1, 0), (0, 0, 1)])
    positions, faces = weld(scaled, np.array([(0, 3, 4), (1, 4, 3), (2, 3, 4)]), [])
    assert len(positions) == 4 and len(faces) == 3


def test_winding_number_of_a_cube() -> None:
    corners = BOX.triangles
    assert winding_number(corners, np.array([0.1, 0.2, 0.3])) == pytest.approx(1)
    assert winding_number(corners, np.array([3.0, 0, 0])) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("missing.ply", None, "no such mesh file"),
        ("thing.fbx", "x", "OBJ, PLY, STL, GLB"),
        ("noise.glb", "not a mesh", "not a valid GLB file"),
        ("empty.obj", "", "export"),
        ("points.obj", "v 0 0 0\nv 1 0 0\n", "export"),
        ("nothing.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n", "export"),
        ("all_nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "1 vertex is not finite"),
        ("some_nan.obj", "v 0 0 0\nv 1 0 0\nv nan 1 0\nv inf 0 1\nf 1 2 3\nf 1 2 4\n", "2 vertices are not finite"),
        ("huge.obj", "v -1.5e308 0 0\nv 1.5e308 0 0\nv 0 1.5e308 0\nf 1 2 3\n", "coordinates beyond 1e[+]307"),
        ("one_point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", "no triangle with an extent"),
    ],
)
def test_bad_files_get_one_sentence(tmp_path: Path, name: str, content: str | None, sentence: str) -> None:
    if content is not None:
        (tmp_path / name).write_text(content)
    with pytest.raises(BadInput, match=sentence) as caught:
        load_mesh(tmp_path / name)
    assert str(caught.value).startswith(str(tmp_path / name)) and "\n" not in str(caught.value)
