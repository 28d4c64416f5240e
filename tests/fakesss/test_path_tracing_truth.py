"""Path-traced pictures against closed forms: furnace, Beer-Lambert, Lambert, Chandrasekhar's half-space, the dipole."""

import numpy as np
import pytest
from numpy.typing import NDArray

from fakesss.camera import View, direction
from fakesss.media import MEDIA, Medium, total_diffuse_reflectance
from fakesss.offline.path_tracing import PathTraced, PathTracing, path_traced
from fakesss.reference import camera_rays, sphere_interval
from fakesss.renderer import render
from fakesss.scene import Scene

pytestmark = pytest.mark.gl
Floats = NDArray[np.float64]

DARK = {"ambient": (0.0, 0.0, 0.0), "diffuse": (0.0, 0.0, 0.0), "specular": (0.0, 0.0, 0.0)}
FURNACE = {**DARK, "ambient": (1.0, 1.0, 1.0)}
HEAD_ON = {**DARK, "diffuse": (1.0, 1.0, 1.0), "azimuth": 0.0, "elevation": 0.0}
SIZE_MM = 2.0  # so that a radius is a millimetre, and coefficients are per radius


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path))


def sphere(light: dict, size: tuple[int, int] = (24, 24), **more) -> Scene:
    fields = {"object": "sphere:20000", "size": size, "light": light, "exposure": 1.0, "background": (0.0, 0.0, 0.0)}
    return Scene.from_dict({**fields, "camera": {"elevation": 0.0, "field_of_view": 10.0}, **more}, "test")


def picture(scene: Scene, medium: Medium | str, samples: int = 64, seed: int = 0) -> PathTraced:
    """Of a measured medium by name, or of one made up for the test."""
    if isinstance(medium, Medium):
        MEDIA[medium.name] = medium  # type: ignore[index]
    name = medium if isinstance(medium, str) else medium.name
    settings = PathTracing(medium=name, size_mm=SIZE_MM, samples=samples, seed=seed, highlights=False)
    try:
        return path_traced(scene, settings, quiet=True)
    finally:
        if isinstance(medium, Medium):
            del MEDIA[medium.name]  # type: ignore[attr-defined]


def inside(traced: PathTraced) -> NDArray[np.bool_]:
    """Pixels that lie within the outline whole."""
    return np.asarray(traced.image[..., 3] == 1)


def normals(scene: Scene) -> tuple[Floats, Floats]:
    """Of the unit sphere seen through each pixel's centre (H, W, 3), NaN beside it, and cosines to the viewer."""
    view = View.of(scene.camera, scene.size)
    origins, directions = camera_rays(view, scene.size)
    points = origins + sphere_interval(origins, directions)[0][:, None] * directions
    shape = (scene.size[1], scene.size[0])
    return points.reshape(*shape, 3), -(points * directions).sum(axis=1).reshape(shape)


def assert_within_noise(difference: Floats, standard_error: Floats, systematic: float = 0.0) -> None:
    """The mean is nowhere near five of its standard errors off, and single pixels as often as they may."""
    count = np.count_nonzero(standard_error > 0)
    assert count > 50
    assert abs(difference.mean()) < 5 * np.sqrt((standard_error**2).sum()) / difference.size + systematic
    assert np.sqrt((difference**2).mean()) < 1.5 * np.sqrt((standard_error**2).mean()) + systematic


@pytest.mark.parametrize("density", [0.5, 5.0])
def test_white_furnace(density: float) -> None:
    """What absorbs nothing is invisible in uniform light: what it scatters towards us is what it takes away."""
    clear = Medium("clear", (density, 2 * density, 4 * density), (0.0, 0.0, 0.0), 1.0)
    scene = sphere(FURNACE, background=(1.0, 1.0, 1.0))
    traced = picture(scene, clear)
    all_inside = inside(traced)
    assert_within_noise(traced.image[all_inside][:, :3] - 1.0, traced.standard_error[all_inside])


def test_pure_absorption_is_beer_lambert() -> None:
    glass = Medium("glass", (0.0, 0.0, 0.0), (0.2, 1.0, 3.0), 1.0)
    scene = sphere(FURNACE, size=(40, 24), background=(0.8, 0.6, 0.4))
    traced = picture(scene, glass, samples=8)
    view = View.of(scene.camera, scene.size)
    entry, leave = sphere_interval(*camera_rays(view, scene.size))
    way = np.nan_to_num(leave - entry).reshape(24, 40, 1)
    expected = np.array(scene.background) * np.exp(-np.array(glass.sigma_a) * way)
    middle = way[..., 0] > 0.8  # elsewhere the way is no straight line over a pixel
    np.testing.assert_allclose(traced.image[middle][:, :3], expected[middle], atol=0.01)
    outside = traced.image[..., 3] == 0
    assert (traced.image[outside][:, :3] == np.float32(scene.background)).all()
    assert traced.noise == np.inf and traced.provenance["noise"] is None  # no light of its own


def test_an_opaque_sphere_is_lambert_and_where_the_shader_has_it() -> None:
    """Equation 3.8 with wd = 1, and 3.7 without occlusion, as a closed form and as the shader draws it."""
    light = {**DARK, "diffuse": (1.0, 0.8, 0.5), "azimuth": -50.0, "elevation": 30.0}
    only_diffuse = {"diffuse": (0.9, 0.6, 0.3), "diffuse_contribution": 1.0, "backlight": 0.0, "specular": 0.0}
    scene = sphere(light, size=(40, 24), material=only_diffuse)
    traced, drawn = picture(scene, "opaque"), render(scene)
    normal, facing = normals(scene)
    cosine = np.maximum(normal @ direction(light["azimuth"], light["elevation"]), 0)
    expected = cosine[..., None] * np.array(light["diffuse"]) * np.array(only_diffuse["diffuse"])
    whole = inside(traced) & (facing > 0.3)
    assert_within_noise(traced.image[whole][:, :3] - expected[whole], traced.standard_error[whole], 0.003)
    np.testing.assert_allclose(traced.image[whole][:, :3], drawn[whole][:, :3], atol=0.06)


@pytest.mark.parametrize("size", [(40, 24), (24, 40)])
def test_the_outline_is_the_shaders(size: tuple[int, int]) -> None:
    """A white object in a white furnace shows 1 where it is, so that the picture is its own coverage."""
    view = {"azimuth": 25.0, "elevation": -20.0, "field_of_view": 40.0}
    white = {"diffuse": (1.0, 1.0, 1.0)}
    scene = sphere(FURNACE, size=size, object="knot:8000", camera=view, material=white)
    traced, drawn = picture(scene, "opaque"), render(scene)[..., 3]
    coverage = traced.image[..., 3]
    assert (
        np.abs(coverage - drawn).max() < 0.25 and np.abs(coverage - drawn).mean() < 0.01
    )  # 4 x 4 against 3 x 3 points
    assert_within_noise(
        traced.image[..., 0] - coverage.astype(np.float64), np.maximum(traced.standard_error[..., 0], 0.02)
    )


def H(mu: Floats | float, albedo: float) -> Floats:
    """Chandrasekhar's H function for isotropic scattering, *Radiative Transfer* (1950), chapter V, by iteration."""
    nodes, weights = np.polynomial.legendre.leggauss(64)
    nodes, weights = (nodes + 1) / 2, weights / 2
    values = np.ones_like(nodes)
    for _ in range(2000):
        kernel = (weights * nodes * values) / (nodes + nodes[:, None])
        values = 1 / (np.sqrt(1 - albedo) + albedo / 2 * kernel.sum(axis=1))
    mu = np.asarray(mu, np.float64)
    integral = ((weights * nodes * values) / (nodes + mu[..., None])).sum(axis=-1)
    return np.asarray(1 / (np.sqrt(1 - albedo) + albedo / 2 * integral))


ALBEDOS = (0.9, 0.6, 0.3)
DENSE = Medium("dense", tuple(100 * a for a in ALBEDOS), tuple(100 * (1 - a) for a in ALBEDOS), 1.0)
CURVED = 0.003  # a sphere of a hundred free paths is no half-space, and Mitsuba's rays start a little under its surface


def test_a_thick_sphere_lit_from_the_front_is_chandrasekhars_half_space() -> None:
    """Radiance a/4 mu0 / (mu + mu0) H(mu) H(mu0) Id (chapter III, equation 123)."""
    scene = sphere(HEAD_ON)
    traced = picture(scene, DENSE)
    normal, mu = normals(scene)
    whole = inside(traced) & (mu > 0.3)
    m, m0 = mu[whole], normal[whole][:, 2]
    expected = np.stack([a / 4 * m0 / (m + m0) * H(m, a) * H(m0, a) for a in ALBEDOS], axis=-1)
    assert_within_noise(traced.image[whole][:, :3] - expected, traced.standard_error[whole], CURVED)


def test_a_thick_sphere_in_uniform_light_reflects_as_a_half_space_and_nearly_as_the_dipole() -> None:
    """By reciprocity it shows the reflectance of light from the viewer, 1 - H(mu) sqrt(1 - a)."""
    scene = sphere(FURNACE)
    traced = picture(scene, DENSE)
    _, mu = normals(scene)
    whole = inside(traced) & (mu > 0.3)
    expected = np.stack([1 - H(mu[whole], a) * np.sqrt(1 - a) for a in ALBEDOS], axis=-1)
    assert_within_noise(traced.image[whole][:, :3] - expected, traced.standard_error[whole], CURVED)
    straight = inside(traced) & (mu > 0.9)
    dipole = total_diffuse_reflectance(DENSE.sigma_s_prime, DENSE.sigma_a, 1.0)
    np.testing.assert_allclose(traced.image[straight][:, :3].mean(axis=0), dipole, atol=0.055)


@pytest.mark.parametrize("name", ["marble", "ketchup", "spectralon"])
def test_no_medium_gives_back_more_than_it_gets(name: str) -> None:
    traced = picture(sphere(FURNACE), name, samples=32)
    covered = traced.image[..., 3] > 0
    assert traced.image[covered][:, :3].mean(axis=0).max() < 1 + 5 * traced.noise / np.sqrt(covered.sum())


def test_what_is_lit_from_behind_is_darker_when_thicker() -> None:
    behind = sphere({**HEAD_ON, "azimuth": 180.0})
    shown = [
        picture(behind, Medium("grey", (d,) * 3, (0.05 * d,) * 3, 1.0), samples=32).image[8:16, 8:16, :3].mean()
        for d in (1.0, 3.0, 9.0)
    ]
    assert shown[0] > 1.2 * shown[1] > 1.2**2 * shown[2]
