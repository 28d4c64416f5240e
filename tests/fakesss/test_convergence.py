"""Orders at which approximations converge to their exact references, fitted and held to what theory says.

Samples of a discontinuous quantity, spread evenly in d dimensions, err as N^-(1/2 + 1/(2d)): of the N cells,
N^(1 - 1/d) lie on the discontinuity, each wrong by 1/N at random (Mitchell, *Consequences of stratified sampling in
graphics*, 1996). With d = 2 that is 3/4, for rays over a hemisphere as for samples over a pixel; with d = 3, directions
and distances, 2/3. Independent random samples would have 1/2.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from test_exact_light import ball_on_table

from fakesss import hemisphere
from fakesss.accuracy import exact_light
from fakesss.accuracy.convergence import fitted_order
from fakesss.accuracy.exact import Truth, exact_picture, exact_thickness, picture
from fakesss.accuracy.exact_light import point_occlusion
from fakesss.camera import View
from fakesss.hemisphere import even_directions
from fakesss.local_thickness import cast_inwards
from fakesss.occlusion import cast_rays
from fakesss.problem import BadInput
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.screen_occlusion import sampled
from fakesss.shapes import load_object


def rms(errors: Any) -> float:
    return float(np.sqrt(np.mean(np.square(errors, dtype=np.float64))))


def mean(errors: Any) -> float:
    return float(np.mean(np.abs(errors), dtype=np.float64))


def powers(first: int, last: int) -> list[int]:
    """2^first to 2^last."""
    return [2**k for k in range(first, last + 1)]


def holds(name: str, counts: Sequence[float], error: Callable[[int], float], low: float, high: float) -> None:
    """Fits the order of `error(count)`, prints it, and holds it between `low` and `high`."""
    errors = [error(int(count)) for count in counts]
    found = fitted_order(counts, errors)
    print(f"{name}: {found}", *(f"{count}: {one:.2e}" for count, one in zip(counts, errors, strict=True)))
    assert low < found.order < high


@dataclass(frozen=True)
class Size:
    """How large a test is."""

    faces: int
    most: int  # 2^most rays a vertex, or points around a sample
    truth: int  # rays a vertex of the reference
    pixels: int


SIZES = [
    pytest.param(Size(1000, 9, 8192, 48), id="small"),
    pytest.param(Size(4000, 12, 65536, 128), id="large", marks=pytest.mark.long),
]


@contextmanager
def turned_directions() -> Iterator[None]:
    """Rays along the lattice turned at random: no direction is one of those that a truth is to judge."""
    turn = Rotation.from_quat([0.3, -0.5, 0.7, 0.2])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(hemisphere, "even_directions", lambda number: turn.apply(even_directions(number)))
        yield


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("name", ["figure", "knot"])
def test_baked_rays_are_better_than_random_ones(name: str, size: Size) -> None:
    """Per-vertex RMSE of [a]: an even lattice of directions over the sphere, N^-3/4."""
    mesh = load_object(f"{name}:{size.faces}")
    with turned_directions():
        truth = cast_rays(mesh, size.truth, "cosine")[0]
    holds(f"{name} rays", powers(3, size.most), lambda n: rms(cast_rays(mesh, n, "cosine")[0] - truth), 0.65, 0.85)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("name", ["figure", "knot"])
def test_rays_inwards_are_better_than_random_ones(name: str, size: Size) -> None:
    """Per-vertex RMSE of local thickness: the way inside jumps where the surface behind does, so again N^-3/4."""
    mesh = load_object(f"{name}:{size.faces}")
    with turned_directions():
        truth = cast_inwards(mesh, size.truth, 0.5)[0]
    found = {n: rms(cast_inwards(mesh, n, 0.5)[0] - truth) for n in powers(3, size.most)}
    holds(f"{name} rays inwards", list(found), lambda n: found[n], 0.65, 1.0)


@pytest.mark.gl
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("name", ["figure:4000", "knot:4000"])
def test_screen_space_samples_converge_to_their_own_integral(renderer: Renderer, name: str, size: Size) -> None:
    """To 4,096 points around each sample, which the numpy twin can take: directions and distances, about N^-2/3.

    That integral is not the truth: it does not see what the camera does not, and more samples do not bring it nearer.
    """
    scene = Scene(object=name, size=(size.pixels, size.pixels)).replace({"occlusion.method": "screen-space"})
    view = View.of(scene.camera, scene.size)
    layers = {name: layer[::-1] for name, layer in renderer.data(scene, ("front", "surface")).items()}
    covered = layers["front"] > 0
    many = scene.occlusion.model_copy(update={"samples": 4096})  # beyond what a scene may ask for
    integral = sampled(layers["front"], layers["surface"], view, many)[covered]

    def drawn(samples: int) -> NDArray[Any]:
        asked = scene.replace({"occlusion.samples": samples})
        values: NDArray[Any] = renderer.data(asked, ("sampled_occlusion",))["sampled_occlusion"][::-1][covered]
        return values

    holds(f"{name} screen space", powers(3, 8), lambda n: rms(drawn(n) - integral), 0.5, 0.8)
    traced = by_rays(scene)[::-1][covered]
    few, most = rms(drawn(256) - traced), rms(integral - traced)
    print(f"{name} screen space against rays within its radius: {few:.3f} at 256 samples, {most:.3f} at 4096")
    assert most > 0.9 * few > 2 * rms(drawn(256) - integral)


def by_rays(scene: Scene) -> NDArray[np.float64]:
    """[a] by 1,024 rays from every pixel within the scene's radius, (H, W), 1 where there is no object."""
    truth = Truth(scene, 1)
    seen = truth.seen((slice(0, scene.size[1]), slice(0, scene.size[0])), softened=False)
    found = np.ones(len(seen.hit))
    normals = truth.sight.crossings.normals[seen.faces]
    found[seen.hit] = point_occlusion(truth.caster, seen.points, normals, scene.occlusion, rays=1024)
    return found.reshape(scene.size[::-1])


@pytest.mark.gl
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("name", ["figure:4000", "knot:4000"])
@pytest.mark.parametrize("shown", ["coverage", "radiance"])
def test_supersampling_resolves_edges(renderer: Renderer, name: str, size: Size, shown: str) -> None:
    """RMSE over all pixels against 16 x 16 rays, in the samples n^2 of a pixel: N^-3/4 for edges at any slope.

    Each of the n rows of samples puts an edge in the wrong place by up to half a sample, 1/n, more or less at random:
    their mean errs as 1/n n^-1/2. (An edge along the rows would err as 1/n, N^-1/2: all rows go wrong together.)
    """
    scene = Scene(object=name, size=(size.pixels, size.pixels))
    scene = scene.replace({"occlusion.enabled": False, "blur.enabled": False})
    channel = slice(3, 4) if shown == "coverage" else slice(0, 3)
    truth = exact_picture(scene, 16)[..., channel]

    def error(samples: int) -> float:
        side = round(samples**0.5)
        return rms(renderer.render(scene.replace({"supersampling": side})).image[..., channel] - truth)

    holds(f"{name} supersampling, {shown}", [n * n for n in range(1, 9)], error, 0.6, 0.85)


@pytest.mark.gl
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("filtering", ["hard", "pcf"])
def test_shadows_edges_follow_the_texels(renderer: Renderer, tmp_path: Path, size: Size, filtering: str) -> None:
    """The area that is wrongly lit or dark, in texels a side of the map: order 1, a strip a texel wide at the edge."""
    bright = {"material.diffuse": (1, 1, 1), "material.diffuse_contribution": 1.0, "material.backlight": 0.0}
    scene = Scene(object=ball_on_table(tmp_path), size=(5 * size.pixels, 5 * size.pixels), supersampling=1)
    scene = scene.replace({**bright, "light.ambient": (0, 0, 0), "light.specular": (0, 0, 0), "camera.elevation": 50.0})
    scene = scene.replace({"light.azimuth": 40.0, "light.shadows": True, "shadow.filter": filtering})
    plain = renderer.render(scene.replace({"light.shadows": False})).image[..., 0]
    asked = plain > 0.15 * plain.max()
    truth = exact_picture(scene, 1)[asked][:, 0] / plain[asked]

    def error(texels: int) -> float:
        drawn = renderer.render(scene.replace({"shadow.map_size": texels})).image[..., 0]
        return mean(drawn[asked] / plain[asked] - truth)

    holds(f"shadow map, {filtering}", powers(5, 9), error, 0.8, 1.25)


@pytest.mark.gl
@pytest.mark.parametrize("size", SIZES)
def test_taps_fill_a_penumbra(renderer: Renderer, tmp_path: Path, size: Size, monkeypatch: pytest.MonkeyPatch) -> None:
    """RMSE within the penumbra of a ball to 1,024 rays through the disc: places on a disc, d = 2, N^-3/4."""
    bright = {"material.diffuse": (1, 1, 1), "material.diffuse_contribution": 1.0, "material.backlight": 0.0}
    scene = Scene(object=ball_on_table(tmp_path), size=(3 * size.pixels, 3 * size.pixels), supersampling=1)
    scene = scene.replace({**bright, "light.ambient": (0, 0, 0), "light.specular": (0, 0, 0), "camera.elevation": 50.0})
    disc = {"shadow.filter": "disc", "shadow.radius": 0.05, "shadow.map_size": 4096}
    scene = scene.replace({"light.azimuth": 40.0, "light.shadows": True, **disc})
    plain = renderer.render(scene.replace({"light.shadows": False})).image[..., 0]
    monkeypatch.setattr(exact_light, "DISC_RAYS", 1024)
    traced = Truth(scene, 1)
    truth = picture(traced, (slice(0, scene.size[1]), slice(0, scene.size[0])))[..., 0] / np.maximum(plain, 1e-6)
    asked = (plain > 0.15 * plain.max()) & (truth > 0.02) & (truth < 0.98)
    assert asked.sum() > 200

    def error(taps: int) -> float:
        drawn = renderer.render(scene.replace({"shadow.samples": taps})).image[..., 0]
        return rms(drawn[asked] / plain[asked] - truth[asked])

    holds("shadow taps", powers(0, 5), error, 0.6, 0.9)


@pytest.mark.gl
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("shape", ["figure", "knot"])
@pytest.mark.parametrize("every", [2, 4])
def test_a_sparse_layer_errs_most_along_outlines(renderer: Renderer, shape: str, size: Size, every: int) -> None:
    """Errors of thickness, in texels a side of the sparse layer, h = 1/N apart.

    Inside, bilinear interpolation of a round surface errs as h^2: the median. Towards an outline thickness sinks to 0
    as a root, so that a strip h wide errs as h^1/2: the mean falls as h^3/2, the root mean square as h.
    """
    # as many triangles to a texel at every size: texels within one, which is flat, would err less still
    name = f"{shape}:{round(20_000 * (size.pixels / 48) ** 2)}"
    scene = Scene(object=name, size=(16, 16), supersampling=1).replace({"layers.resolution": every})

    def differences(texels: int) -> NDArray[Any]:
        asked = scene.replace({"size": (every * texels, every * texels)})
        truth = exact_thickness(asked)
        drawn = renderer.data(asked, ("thickness",), samples=1)["thickness"]
        return np.asarray((drawn - truth)[truth > 0])

    found = {count: differences(count) for count in (size.pixels * k // 2 for k in (1, 2, 3, 4))}
    label = f"{name}, second layer at every {every}th sample"
    holds(f"{label}, median", list(found), lambda n: float(np.median(np.abs(found[n]))), 1.6, 2.6)
    holds(f"{label}, mean", list(found), lambda n: mean(found[n]), 1.25, 2.0)
    holds(f"{label}, rms", list(found), lambda n: rms(found[n]), 0.7, 1.5)


@pytest.mark.gl
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("name", ["figure", "knot"])
def test_fewer_faces_are_farther_from_the_surface(renderer: Renderer, name: str, size: Size) -> None:
    """Thickness with the second layer from `layers.faces` faces: an edge h wide lies h^2 from a round surface, 1/faces.

    That is the median's order. The outline of a near part moves as far, and beside it thickness is wrong by any amount:
    a share of 1/faces of the pixels, so that the root mean square falls as faces^-1/2 and the mean in between.
    """
    scene = Scene(object=f"{name}:60000", size=(2 * size.pixels, 2 * size.pixels))
    truth = exact_thickness(scene)

    def differences(faces: int) -> NDArray[Any]:
        drawn = renderer.data(scene.replace({"layers.faces": faces}), ("thickness",))["thickness"]
        return np.asarray((drawn - truth)[truth > 0])

    counts = [1000, 2000, 4000, 8000]
    found = {faces: differences(faces) for faces in counts}
    holds(f"{name} faces, median", counts, lambda n: float(np.median(np.abs(found[n]))), 0.75, 1.15)
    holds(f"{name} faces, mean", counts, lambda n: mean(found[n]), 0.6, 1.15)
    holds(f"{name} faces, rms", counts, lambda n: rms(found[n]), 0.3, 0.8)


@pytest.mark.gl
@pytest.mark.parametrize("name", ["figure:4000", "knot:4000"])
def test_depths_err_by_their_formats_rounding(renderer: Renderer, name: str) -> None:
    """One more bit halves it: float16 as its spacings at both layers say, float32 8,192 times less.

    A rounding to the nearest errs by spacing / sqrt(12); OpenGL may also cut off, which is twice as far.
    """
    scene = Scene(object=name, size=(96, 96))
    truth = exact_thickness(scene)
    names = ("thickness", "front", "second")
    half, full = (renderer.data(scene.replace({"layers.depth": kind}), names) for kind in ("float16", "float32"))
    covered = (truth > 0) & (full["thickness"] > 0)
    spacings = [np.spacing(full[layer][covered].astype(np.float16)).astype(float) for layer in ("front", "second")]
    expected = np.sqrt((spacings[0] ** 2 + spacings[1] ** 2).mean() / 12) / 2
    error = rms((half["thickness"] - full["thickness"])[covered])
    print(f"{name}: float16 {error:.2e}, its rounding {expected:.2e}")
    assert 0.8 * expected < error < 2 * expected
    assert np.median(np.abs(full["thickness"] - truth)[covered]) < 4 * expected / 8192


def test_a_power_law_is_found_again() -> None:
    counts = [8, 16, 32, 64, 128]
    found = fitted_order(counts, [3 * n**-0.75 for n in counts])
    assert found.order == pytest.approx(0.75) and found.ci_low == pytest.approx(found.ci_high)


def test_the_interval_is_a_straight_lines() -> None:
    """Student's interval of a slope, written out."""
    found = fitted_order([2, 4, 8, 16, 32], [0.50, 0.31, 0.18, 0.11, 0.07])
    x, y = np.log([2, 4, 8, 16, 32]), np.log([0.50, 0.31, 0.18, 0.11, 0.07])
    slope, offset = np.polyfit(x, y, 1)
    spread = np.sqrt(((y - slope * x - offset) ** 2).sum() / 3 / ((x - x.mean()) ** 2).sum())
    assert found.order == pytest.approx(-slope)
    # 3.182446 is Student's quantile for 3 degrees of freedom
    assert found.ci_high - found.ci_low == pytest.approx(2 * 3.182446 * spread, rel=1e-6)


@pytest.mark.parametrize(("counts", "errors"), [([1, 2], [1, 2]), ([1, 2, 3], [1, 0, 1]), ([1, 2, 3], [1, 2])])
def test_what_has_no_order_is_refused(counts: list[float], errors: list[float]) -> None:
    with pytest.raises(BadInput, match="give 3 pairs > 0 or more"):
        fitted_order(counts, errors)
