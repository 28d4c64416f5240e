"""The built-in objects: closed, of the asked size, thin and thick where the technique needs it."""

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from fakesss.camera import View
from fakesss.mesh import Mesh
from fakesss.mesh_repair import half_edge_pairs
from fakesss.problem import BadInput
from fakesss.reference import ExactInterval, camera_rays, thickness
from fakesss.scene import Camera
from fakesss.shapes import SCULPTURES, load_object, names
from fakesss.solids import BOX_HALF, TORUS_RADII, knot
from fakesss.vertex_normals import face_normals

ORGANIC = (*SCULPTURES, "knot")


@pytest.fixture(scope="module", autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Made from the code under test, never from what an earlier version left in the user's cache."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FAKESSS_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


def volume(mesh: Mesh) -> float:
    a, b, c = np.moveaxis(mesh.positions[mesh.faces].astype(float), 1, 0)
    return float((a * np.cross(b, c)).sum() / 6)


@pytest.mark.parametrize("faces", [4_000, 30_000])
@pytest.mark.parametrize("name", names())
def test_closed_outward_and_of_the_asked_size(name: str, faces: int) -> None:
    mesh = load_object(f"{name}:{faces}")
    assert mesh.watertight and mesh.repairs == ()
    assert len(mesh.faces) == pytest.approx(faces, rel=0.05)
    assert volume(mesh) > 0.1
    assert np.linalg.norm(mesh.positions, axis=1).max() == pytest.approx(1, abs=1e-6)
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-5)
    if name != "box":
        assert len(half_edge_pairs(mesh.faces)[0]) * 2 == mesh.faces.size, "every edge has two triangles"
    flat = face_normals(mesh.positions, mesh.faces)
    with_vertex = (flat * mesh.normals[mesh.faces].mean(axis=1)).sum(axis=1)
    assert (with_vertex < 0).mean() < 1e-3, "normals agree with the winding but for a few slivers"


@pytest.mark.parametrize("name", ORGANIC)
def test_one_piece_without_bubbles(name: str) -> None:
    """A closed hollow inside would end the first interval where no eye expects it."""
    faces = load_object(f"{name}:30000").faces
    vertices = int(faces.max()) + 1
    edges = coo_array((np.ones(faces.size), (faces.ravel(), np.roll(faces, 1, axis=1).ravel())), shape=(vertices,) * 2)
    assert connected_components(edges, directed=False)[0] == 1


def test_the_figure_has_holes() -> None:
    faces = load_object("figure:30000").faces
    holes = (2 - (int(faces.max()) + 1 - len(faces) / 2)) / 2  # Euler: V - E + F = 2 - 2 holes
    assert holes >= 3


@pytest.mark.parametrize("name", ["shell", "knot", "torus"])
def test_a_quarter_of_a_million_faces(name: str) -> None:
    mesh = load_object(f"{name}:240000")
    assert mesh.watertight and len(mesh.faces) == pytest.approx(240_000, rel=0.05)


@pytest.mark.parametrize("name", ORGANIC)
def test_thin_parts_beside_thick_ones(name: str) -> None:
    """From the default camera: enough that lights up, (1 - t)^25 > 0.28, and enough that stays dark."""
    mesh = load_object(f"{name}:30000")
    view = View.of(Camera(), (96, 96))
    origins, directions = camera_rays(view, (96, 96))
    t = thickness(ExactInterval(mesh)(origins, directions), directions, -view.rotation[2])
    t = t[np.isfinite(t)]
    assert len(t) > 0.2 * 96 * 96, "fills the picture"
    assert (t < 0.05).mean() > 0.07
    assert (t > 0.2).mean() > 0.05
    assert ((t > 0.05) & (t < 0.2)).mean() > 0.1, "with something in between"


def test_coarse_sculptures_keep_the_thin_parts() -> None:
    """A 4K head still has its ears: the two meshes enclose the same space to 1%, and so do their silhouettes."""
    coarse, fine = load_object("head:4000"), load_object("head:30000")
    assert volume(coarse) == pytest.approx(volume(fine), rel=0.01)
    view = View.of(Camera(), (96, 96))
    origins, directions = camera_rays(view, (96, 96))
    covered = [np.isfinite(ExactInterval(mesh)(origins, directions)[0]).sum() for mesh in (coarse, fine)]
    assert covered[0] == pytest.approx(covered[1], rel=0.02)


def test_solids_lie_on_their_surfaces() -> None:
    ball = load_object("sphere").positions.astype(float)
    np.testing.assert_allclose(np.linalg.norm(ball, axis=1), 1, atol=1e-7)
    box = load_object("box")
    reach = np.abs(box.positions / np.array(BOX_HALF)).max(axis=1)
    np.testing.assert_allclose(reach, 1, atol=1e-6)
    assert set(np.unique(np.abs(box.normals))) == {0, 1}
    ring = load_object("torus").positions.astype(float)
    from_middle = np.hypot(np.hypot(ring[:, 0], ring[:, 1]) - TORUS_RADII[0], ring[:, 2])
    np.testing.assert_allclose(from_middle, TORUS_RADII[1], atol=1e-6)


def test_the_knot_does_not_touch_itself() -> None:
    """Points of the surface that are far apart along the tube keep a distance."""
    positions, normals, _ = knot(20_000)
    beyond = positions[::7, None] + 0.05 * normals[::7, None] - positions[None, ::5]
    nearest = np.sqrt((beyond**2).sum(axis=2)).min(axis=1)
    assert nearest.min() > 0.03


def test_made_twice_gives_equal_bytes(
    monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory
) -> None:
    first = load_object("shell:5000").sha256
    assert load_object("shell:5000").sha256 == first, "from the cache"
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path_factory.mktemp("again")))
    assert load_object("shell:5000").sha256 == first, "made again"


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("figur", 'did you mean "figure"'),
        ("sphere:", "must be a whole number of faces"),
        ("sphere:-5", "must be a whole number of faces"),
        ("sphere:999", "1000 to 1000000"),
        ("sphere:2000000", "1000 to 1000000"),
        ("tors:5000", 'did you mean "torus"'),
        ("bunny.ply", "no such mesh file"),
        ("folder/bunny.fbx", "no mesh format"),
        ("", "neither a built-in object nor a file"),
    ],
)
def test_unknown_objects_get_one_sentence(name: str, sentence: str) -> None:
    with pytest.raises(BadInput, match=sentence):
        load_object(name)
