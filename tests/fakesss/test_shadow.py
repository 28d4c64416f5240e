"""Shadow maps against exact rays and closed forms, and what they must leave alone."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray
from picture_scenes import dark, sheet_file
from scipy.ndimage import maximum_filter, minimum_filter

from fakesss import illumination
from fakesss.camera import View
from fakesss.ray_casting import Caster
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.shadow_maps import REACH, MapView, atlas, depth_slope, map_views
from fakesss.shapes import load_object

LIT = {"light__diffuse": (1, 1, 1), "material__diffuse": (1, 1, 1), "material__diffuse_contribution": 1.0}
KINDS: dict[str, dict[str, Any]] = {
    "directional": {},
    "spot": {"light.kind": "spot", "light.distance": 3.0},
    "point": {"light.kind": "point", "light.distance": 1.5},
    "point, six maps": {"light.kind": "point", "light.distance": 1.05},
    "far point": {"light.kind": "point", "light.distance": 1e4},
}


def light_visible(renderer: Renderer, scene: Scene) -> tuple[NDArray[Any], NDArray[Any], NDArray[np.bool_]]:
    """The share of `light` that shadows let through, N.L and coverage, (H, W)."""
    shadowed, plain = (renderer.render(scene.replace({"light.shadows": on})).image[..., 0] for on in (True, False))
    data = renderer.data(scene, ("front", "surface"))
    view = View.of(scene.camera, scene.size)
    to_light = illumination.arriving(scene.light, view, illumination.positions(view, data["front"]))[0]
    n_dot_l = (data["surface"][..., :3] * to_light).sum(axis=-1)
    return shadowed / np.where(plain > 0, plain, 1), n_dot_l, (data["front"] > 0) & (plain > 0)


def rays_clear(renderer: Renderer, scene: Scene, asked: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether nothing lies between each asked point and the light, by rays through the same triangles."""
    data, view = renderer.data(scene, ("front", "surface")), View.of(scene.camera, scene.size)
    points = illumination.positions(view, data["front"])
    to_light = illumination.arriving(scene.light, view, points)[0]
    place = illumination.place(scene.light, view)
    reach = np.linalg.norm(place[:3] - points, axis=-1) if place[3] else np.full(asked.shape, np.inf)
    starts = (points + 2e-3 * data["surface"][..., :3]) @ view.rotation
    directions = (to_light @ view.rotation)[asked].astype(np.float32)
    clear = np.zeros(asked.shape, bool)
    rays = starts[asked].astype(np.float32), directions, reach[asked].astype(np.float32)
    clear[asked] = Caster(load_object(scene.object)).clear(*rays)
    return clear


@pytest.mark.gl
@pytest.mark.parametrize("name", ["figure:30000", "knot:8000", "relief:30000"])
@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
@pytest.mark.parametrize("filtering", ["hard", "pcf"])
def test_shadows_are_where_rays_are_blocked(
    renderer: Renderer, name: str, kind: dict[str, Any], filtering: str
) -> None:
    """Off a shadow's edge by two pixels and not at grazing light, less than one pixel in a thousand is wrong."""
    scene = dark(object=name, size=(200, 200), light__azimuth=-60.0, light__elevation=25.0, **LIT)
    scene = scene.replace({**kind, "shadow.filter": filtering})
    share, n_dot_l, covered = light_visible(renderer, scene)
    asked = covered & (n_dot_l > 0.15)
    clear = rays_clear(renderer, scene, asked)
    even = maximum_filter(np.where(asked, clear, False), 5) == minimum_filter(np.where(asked, clear, True), 5)
    sure = asked & even
    wrong = sure & (np.abs(share - clear) > 0.5)
    assert wrong.sum() <= 1e-3 * sure.sum()
    assert np.abs(share - clear)[sure].mean() < 3e-3
    assert min(clear[sure].sum(), (~clear)[sure].sum()) > 100


def ball_on_table(folder: Path) -> str:
    """A table of 4 x 4 in the plane y = 0 and a ball of radius 0.5 floating at y = 1, before it is scaled."""
    table = trimesh.creation.box([4, 0.2, 4])
    table.apply_translation([0, -0.1, 0])
    ball = trimesh.creation.icosphere(5, 0.5)
    ball.apply_translation([0, 1, 0])
    path = folder / "ball.ply"
    trimesh.util.concatenate([table, ball]).export(path)
    return str(path)


def passing_the_ball(renderer: Renderer, scene: Scene) -> tuple[NDArray[Any], NDArray[np.bool_], float]:
    """How far from the ball's centre each pixel's line to the light passes, in radii of the ball; where the table is;
    and the ball's radius in sphere radii."""
    data, view, mesh = (
        renderer.data(scene, ("front", "surface")),
        View.of(scene.camera, scene.size),
        load_object(scene.object),
    )
    points = illumination.positions(view, data["front"])
    to_light = illumination.arriving(scene.light, view, points)[0]
    radius = 0.5 / mesh.radius
    offset = view.rotation @ ((np.array([0, 1, 0]) - mesh.centre) / mesh.radius) - points
    squared = (offset**2).sum(axis=-1)
    passing = np.sqrt(np.maximum(squared - (offset * to_light).sum(axis=-1) ** 2, 0)) / radius
    up = (data["surface"][..., :3] @ view.rotation)[..., 1] > 0.999
    return passing, up & (data["front"] > 0) & (np.sqrt(squared) > 1.2 * radius), radius


@pytest.mark.gl
@pytest.mark.parametrize("filtering", ["hard", "pcf", "disc"])
@pytest.mark.parametrize("kind", ["directional", "point"])
def test_a_balls_shadow_on_a_table_is_an_ellipse(renderer: Renderer, tmp_path: Path, filtering: str, kind: str) -> None:
    """A point is in shadow if its line to the light passes the ball's centre by less than the radius."""
    scene = dark(object=ball_on_table(tmp_path), size=(200, 200), camera__elevation=50.0, light__azimuth=40.0, **LIT)
    filters = {"shadow.filter": filtering, "shadow.radius": 0.004, "shadow.samples": 16}
    scene = scene.replace({**filters, "light.kind": kind, "light.distance": 2.0})
    share, _, _ = light_visible(renderer, scene)
    passing, table, _ = passing_the_ball(renderer, scene)
    inner, outer = table & (passing < 0.93), table & (passing > 1.07)
    assert inner.sum() > 300 and outer.sum() > 3000
    assert share[inner].max() == 0 and share[outer].min() > 0.999


@pytest.mark.gl
@pytest.mark.parametrize("radius", [0.005, 0.02])
def test_a_disc_blurs_as_wide_as_it_is(renderer: Renderer, tmp_path: Path, radius: float) -> None:
    """And evenly: on the edge of the shadow every turn of the disc has about half of its samples on either side."""
    scene = dark(object=ball_on_table(tmp_path), size=(200, 200), camera__elevation=50.0, light__azimuth=40.0, **LIT)
    scene = scene.replace({"shadow.filter": "disc", "shadow.radius": radius, "shadow.samples": 32})
    share, _, _ = light_visible(renderer, scene)
    passing, table, ball = passing_the_ball(renderer, scene)
    soft = (passing[table & (share > 0.02) & (share < 0.98)] - 1) * ball / (2 * radius)  # 1 is the disc's radius
    texel = 2 / 800 / (2 * radius)
    assert 0.75 < -soft.min() < 1 + texel and 0.75 < soft.max() < 1 + texel
    edge = table & (np.abs(passing - 1) * ball < 0.1 * 2 * radius)
    assert edge.sum() > 10 and abs(share[edge].mean() - 0.5) < 0.1 and share[edge].std() < 0.15


@pytest.mark.gl
@pytest.mark.parametrize(
    ("filtering", "elevation"),
    [(name, e) for name in ("hard", "pcf") for e in (2.0, 5.0, 20.0, 85.0)] + [("disc", 7.0), ("disc", 20.0)],
)
@pytest.mark.parametrize("name", ["sheet", "box:4000"])
def test_a_flat_surface_does_not_shadow_itself(
    renderer: Renderer, tmp_path: Path, name: str, filtering: str, elevation: float
) -> None:
    """Not even at grazing light, from N.L = 0.03 on, the wide disc from 0.12; the box shows its front and its top."""
    scene = dark(object=sheet_file(tmp_path) if name == "sheet" else name, size=(64, 64), **LIT)
    scene = scene.replace({"shadow.map_size": 1024})
    changes = {"light.azimuth": 90 - elevation, "light.elevation": elevation, "shadow.filter": filtering}
    share, _, covered = light_visible(renderer, scene.replace({**changes, "camera.elevation": 10.0}))
    assert covered.sum() > 500
    assert (share[covered] > 0.999).mean() > 0.97 and share[covered].mean() > 0.985


@pytest.mark.gl
@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
@pytest.mark.parametrize("filtering", ["hard", "pcf"])
def test_a_round_surface_does_not_shadow_itself(renderer: Renderer, kind: dict[str, Any], filtering: str) -> None:
    scene = dark(object="sphere:20000", size=(128, 128), **LIT).replace({**kind, "shadow.filter": filtering})
    share, n_dot_l, covered = light_visible(renderer, scene)
    lit = covered & (n_dot_l > 0.1)
    assert lit.sum() > 300 and share[lit].min() > 0.99


@pytest.mark.gl
def test_shadows_leave_ambient_light_and_backlight_alone(renderer: Renderer) -> None:
    scene = Scene(object="figure:8000", size=(96, 96)).replace({"light.azimuth": -80.0, "light.kind": "spot"})
    unlit = {"light.diffuse": (0, 0, 0), "light.specular": (0, 0, 0)}
    plain, shadowed, none = (
        renderer.render(scene.replace(change)).image for change in ({}, {"light.shadows": True}, unlit)
    )
    assert (shadowed > none - 1e-6).all() and (shadowed < plain + 1e-6).all()
    dimmed = shadowed < plain - 1e-3
    assert dimmed[..., 0].sum() > 300
    assert np.isclose(shadowed, none)[dimmed].mean() > 0.5  # most of what is dimmed has nothing but these left


@pytest.mark.gl
def test_each_light_has_a_shadow_of_its_own(renderer: Renderer) -> None:
    """Red and blue from two sides, each in channels of its own: the same as one at a time."""
    scene = dark(object="knot:8000", size=(96, 96), material__diffuse=(1, 1, 1), material__diffuse_contribution=1.0)
    red = {"azimuth": -60.0, "diffuse": (1, 0, 0), "shadows": True, "kind": "point", "distance": 0.9}
    blue = {"azimuth": 60.0, "diffuse": (0, 0, 1), "shadows": True, "specular": (0, 0, 0)}
    scene = scene.replace({"material.specular": 0.0, "shadow.map_size": 512})
    both, only_red, only_blue = (
        renderer.render(scene.replace({"lights": lights})).image[..., :3] for lights in ([red, blue], [red], [blue])
    )
    np.testing.assert_allclose(both, only_red + only_blue, atol=1e-6)
    assert both[..., 0].max() > 0.3 and both[..., 2].max() > 0.3


@pytest.mark.gl
@pytest.mark.parametrize("name", ["directional", "spot", "point, six maps"])
def test_a_hard_shadow_is_what_the_map_says(renderer: Renderer, name: str) -> None:
    """The numpy way through the same map, texel by texel."""
    scene = dark(object="figure:8000", size=(96, 96), light__azimuth=-60.0, light__shadows=True, **LIT)
    scene = scene.replace({**KINDS[name], "shadow.filter": "hard", "shadow.map_size": 256})
    share, n_dot_l, covered = light_visible(renderer, scene)
    data, view = renderer.data(scene, ("front", "surface", "shadow_maps")), View.of(scene.camera, scene.size)
    maps, layout = data["shadow_maps"][::-1], atlas([scene.light], 256, scene.size)
    seen = map_views(scene.light, view)
    flip = np.array([1, 1, -1])
    points, normals = illumination.positions(view, data["front"]) * flip, data["surface"][..., :3] * flip
    expected = np.zeros(covered.shape)
    for number, one in enumerate(seen):
        p, n = points @ one.turn.T + one.centre, normals @ one.turn.T
        mine = covered if len(seen) == 1 else covered & (p[..., 2] >= np.abs(p).max(axis=-1) - 1e-12)
        expected[mine] = read_hard(maps, layout.corner(number), 256, one, p[mine], n[mine], n_dot_l[mine], scene)
    lit = covered & (n_dot_l > 1e-3)
    # a point on the seam of two texels may fall into either
    assert (np.abs(share - expected)[lit] > 1e-3).mean() < 2e-3


def read_hard(
    maps: NDArray[Any],
    corner: tuple[int, int],
    side: int,
    one: MapView,
    p: NDArray[Any],
    n: NDArray[Any],
    n_dot_l: NDArray[Any],
    scene: Scene,
) -> NDArray[np.float64]:
    """1 where points (N, 3) in a map's frame are lit."""
    width = one.width[0] + one.width[1] * p[:, 2]
    texel = (p[:, :2] / (width * one.half_width)[:, None] * 0.5 + 0.5) * side
    along = np.column_stack([one.width[1] * p[:, :2] / width[:, None], np.ones(len(p))])
    slope = depth_slope(n, along) * (2 * width * one.half_width / side)[:, None]
    tap = np.clip(np.floor(texel), 0, side - 1)
    plane = np.clip((slope * (tap + 0.5 - texel)).sum(axis=1), -REACH, 0)
    bias = 2 * scene.shadow.bias
    tangent = np.sqrt(1 - np.minimum(n_dot_l, 1) ** 2) / np.maximum(n_dot_l, 1e-9)
    x, y = (tap.astype(int) + corner).T
    return np.where(p[:, 2] - np.clip(bias * tangent, bias, 2 * bias) + plane > maps[y, x], 0.0, 1.0)


@pytest.mark.gl
def test_a_picture_with_shadows_is_the_same_bytes_every_time(renderer: Renderer) -> None:
    scene = Scene(object="knot:4000", size=(64, 48)).replace({"light.shadows": True, "shadow.filter": "disc"})
    first = renderer.render(scene).image.tobytes()
    renderer.render(scene.replace({"light.kind": "point", "light.distance": 0.5, "shadow.map_size": 64}))
    assert renderer.render(scene).image.tobytes() == first


def dish(folder: Path) -> str:
    """A floor 1/8 radius behind the middle, with rising walls, and small triangles that hold the bounding sphere so."""
    turns = 2 * np.pi * np.arange(16) / 16
    around = np.stack([np.cos(turns), np.sin(turns), np.zeros(16)], axis=1)
    middle = np.array([[0, 0, -0.125]])
    outside = [
        [1, 0, 0],
        [0.9, 0.01, 0.125],
        [0.9, -0.01, 0.125],
        [-1, 0, 0],
        [-0.9, 0.01, 0.125],
        [-0.9, -0.01, 0.125],
    ]
    points = np.concatenate([middle, 0.5 * around + middle, 0.8 * around, outside])
    faces = [(33, 34, 35), (36, 37, 38)]
    for i in range(16):
        j = (i + 1) % 16
        faces += [(0, 1 + i, 1 + j), (1 + i, 17 + i, 17 + j), (1 + i, 17 + j, 1 + j)]
    path = folder / "dish.ply"
    trimesh.Trimesh(points, faces, process=False).export(path)
    return str(path)


@pytest.mark.gl
@pytest.mark.parametrize("filtering", ["hard", "pcf", "disc"])
def test_a_spot_in_the_plane_of_a_surface_leaves_it_finite(renderer: Renderer, tmp_path: Path, filtering: str) -> None:
    """There a point lies beside the light, exactly as deep in its map: seen in a width of 0, and outside the cone."""
    scene = Scene(object=dish(tmp_path), size=(65, 65), supersampling=1).replace({"camera.elevation": 0.0})
    light = {"kind": "spot", "distance": 0.125, "azimuth": 180.0, "elevation": 0.0, "cutoff": 59.0, "shadows": True}
    scene = scene.replace({f"light.{name}": value for name, value in light.items()})
    scene = scene.replace({"shadow.filter": filtering})
    floor = renderer.data(scene, ("front",))["front"] == 2.125
    assert floor.sum() > 300
    drawn = renderer.render(scene)
    assert drawn.non_finite == 0
    dark = renderer.render(scene.replace({"light.diffuse": (0, 0, 0), "light.specular": (0, 0, 0)}))
    np.testing.assert_array_equal(drawn.image[floor], dark.image[floor])
