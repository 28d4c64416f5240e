"""The exact references' own errors and what they take: `python benchmarks/references.py`.

Prints the table of docs/accuracy.md: each reference against a closed form, or against itself made finer, and its
seconds for `figure` at 256 x 256 on this machine, everything made anew.
"""

import time
from collections.abc import Callable, Iterator
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory

import click
import numpy as np
import trimesh
from numpy.typing import NDArray

from fakesss import reference
from fakesss.accuracy import exact_blur, exact_light
from fakesss.accuracy.errors import errors
from fakesss.accuracy.exact import Truth, exact_picture, exact_thickness, picture
from fakesss.accuracy.exact_sight import corner_shares, interpolated
from fakesss.camera import View, direction
from fakesss.occlusion import cast_rays
from fakesss.ray_casting import Caster
from fakesss.scene import Occlusion, Scene
from fakesss.shapes import load_object
from fakesss.vertex_normals import normalised

SIZE = (256, 256)
TURNED = {"camera.azimuth": 25.0, "camera.elevation": 20.0}
SOLIDS = {
    "sphere:60000": reference.sphere_interval,
    "box:60000": reference.box_interval,
    "torus:60000": reference.torus_interval,
    "shell of 60,000 faces": reference.shell_interval,
}
Row = tuple[str, str, float]


def rms(apart: NDArray[np.floating]) -> float:
    return float(np.sqrt(np.mean(np.square(apart, dtype=np.float64))))


def timed(work: Callable[[], object]) -> float:
    """Seconds of `work()`."""
    started = time.perf_counter()
    work()
    return time.perf_counter() - started


def thickness(scene: Scene, folder: Path) -> Iterator[Row]:
    """First intervals against closed forms; the longer ways take as long as their crossings."""
    mesh = reference.spherical_shell(60_000)
    trimesh.Trimesh(mesh.positions, mesh.faces, process=False).export(folder / "shell.ply")
    residuals = []
    for name, interval in SOLIDS.items():
        solid = Scene(object=name if ":" in name else str(folder / "shell.ply"), size=SIZE).replace(TURNED)
        view = View.of(solid.camera, SIZE)
        origins, directions = reference.camera_rays(view, SIZE)
        entry, leave = interval(origins, directions)
        truth = np.nan_to_num((leave - entry) * -(directions @ view.rotation[2]) / 2).reshape(SIZE[::-1])
        residuals.append(f"{name} {np.median(np.abs(exact_thickness(solid) - truth)[truth > 0.05]):.1e}")
    for kind in ("first-interval", "total-path", "bridged"):
        asked = scene.replace({"material.thickness": kind})
        own = f"median in diameters: {', '.join(residuals)}" if kind == "first-interval" else "the same crossings"
        yield f"thickness, {kind}", own, timed(lambda asked=asked: exact_thickness(asked))


def softening(scene: Scene) -> Iterator[Row]:
    """The blur against cells half as wide, one sample a pixel."""
    view = View.of(scene.camera, SIZE)
    cells = (SIZE[0] * 33, SIZE[1] * 33)
    step, reach = view.in_picture(2 * scene.blur.step)[0] * cells[0], 2 * scene.blur.depth_range
    kernels = [exact_blur.dense(step, stride, reach) for stride in (8, 4)]
    margin = max(kernel.margin for kernel in kernels)
    first = 100 * 33 - margin
    rows, columns = (side.ravel() for side in first + np.mgrid[: 16 * 33 + 2 * margin, : 16 * 33 + 2 * margin])
    depths = Truth(scene, 1).sight(cells, rows, columns).second.reshape(16 * 33 + 2 * margin, -1)
    asked = [side.ravel() for side in margin + 16 + 33 * np.mgrid[:16, :16]]
    found = [kernel(depths, *asked) for kernel in kernels]
    seconds = timed(lambda: exact_thickness(scene, softened=True))
    yield (
        "softened second layer",
        f"RMS in diameters: {np.sqrt(np.nanmean((found[0] - found[1]) ** 2)) / 2:.1e}",
        seconds,
    )


def occlusion(scene: Scene) -> Iterator[Row]:
    """The bake against four times the rays and between vertices; rays of points against a wall's closed form."""
    few, many = load_object("figure:2000"), exact_light.RAYS
    own = rms(cast_rays(few, many, "cosine")[0] - cast_rays(few, 4 * many, "cosine")[0])
    mesh = load_object(scene.object)
    seconds = 16 * timed(lambda: cast_rays(mesh, many // 16, "cosine"))  # which grow with the rays
    yield "occlusion at vertices", f"RMS of a: {own:.1e}", seconds
    yield "occlusion between vertices, 4,000 faces", between_vertices(scene.replace({"object": "figure:4000"})), 0.0
    truth = Truth(scene, 1)
    seen = truth.seen((slice(0, SIZE[1]), slice(0, SIZE[0])), softened=False)
    normals = truth.sight.crossings.normals[seen.faces]
    seconds = timed(lambda: exact_light.point_occlusion(truth.caster, seen.points, normals, scene.occlusion))
    yield "occlusion of pixels", f"RMS of a beside a wall: {beside_a_wall():.1e}", seconds


def between_vertices(scene: Scene) -> str:
    """How far interpolated occlusion is from that of the points between, by as many rays."""
    truth = Truth(scene.replace({"size": (64, 64)}), 1)
    mesh, rays = truth.mesh, exact_light.RAYS
    seen = truth.seen((slice(0, 64), slice(0, 64)), softened=False)
    shares = corner_shares(mesh, seen.faces, seen.points)
    normals = normalised(interpolated(mesh, mesh.normals, seen.faces, shares))
    starts = exact_light.onto_smooth_surface(mesh, seen.faces, shares, seen.points, seen.from_behind)
    one = np.zeros(len(starts), np.int64)
    found = exact_light.sample_occlusion(truth.caster, starts, normals, one, scene.occlusion, rays)
    apart = interpolated(mesh, cast_rays(mesh, rays, "cosine")[0], seen.faces, shares) - found
    return f"RMS of a: {rms(apart):.1e}, largest {np.abs(apart).max():.2f}"


def beside_a_wall() -> float:
    """Error of [a] on a floor before a wall, whose closed form is a circle's segment (Nusselt 1928)."""
    room = trimesh.Trimesh(
        [[-1, 0, 0], [1, 0, 0], [1, 0, 1], [-1, 0, 1], [1, 1, 0], [-1, 1, 0]],
        [[0, 3, 2], [0, 2, 1], [0, 1, 4], [0, 4, 5]],
        process=False,
    )
    with TemporaryDirectory() as folder:
        room.export(Path(folder) / "room.ply")
        mesh = load_object(str(Path(folder) / "room.ply"))
    apart = np.linspace(0.02, 0.4, 200)
    file = np.column_stack([np.zeros(200), np.zeros(200), apart * mesh.radius])
    up = np.tile([0.0, 1.0, 0.0], (200, 1))
    found = exact_light.point_occlusion(Caster(mesh), (file - mesh.centre) / mesh.radius, up, Occlusion(radius=0.15))
    c = np.clip(apart / 0.3, 0, 1)
    return rms(found - 1 + (np.arccos(c) - c * np.sqrt(1 - c * c)) / np.pi)


def shadows(scene: Scene) -> Iterator[Row]:
    """A sphere's own shadow begins where N.L is 0: light wrongly kept or let through, as a share of what arrives."""
    lit = scene.replace({"light.shadows": True})
    ball = Truth(lit.replace({"object": "sphere:60000"}), 1)
    seen = ball.seen((slice(0, SIZE[1]), slice(0, SIZE[0])), softened=False)
    normals = seen.points / np.linalg.norm(seen.points, axis=1, keepdims=True)
    n_dot_l = normals @ direction(lit.light.azimuth, lit.light.elevation)
    shares = corner_shares(ball.mesh, seen.faces, seen.points)
    starts = exact_light.onto_smooth_surface(ball.mesh, seen.faces, shares, seen.points, seen.from_behind)
    share = exact_light.lit_shares(ball.setting, ball.caster, starts, normals)[0]
    wrong = np.sum(np.abs(n_dot_l) * (share != (n_dot_l > 0))) / np.sum(np.maximum(n_dot_l, 0))
    of_scene = Truth(lit, 1)
    seen = of_scene.seen((slice(0, SIZE[1]), slice(0, SIZE[0])), softened=False)
    normals = of_scene.sight.crossings.normals[seen.faces]
    seconds = timed(lambda: exact_light.lit_shares(of_scene.setting, of_scene.caster, seen.points, normals))
    yield "shadows", f"share of the light on a sphere: {wrong:.1e}", seconds


def whole() -> Iterator[Row]:
    """The picture of 8 x 8 samples against one of 16 x 16, of a small mesh and size; seconds with occlusion."""
    plain = Scene(object="knot:4000", size=(64, 64)).replace({"occlusion.enabled": False})
    own = errors(exact_picture(plain, 8), exact_picture(plain, 16))
    truth = Truth(Scene(object="figure:4000", size=(64, 64)), 8)
    yield (
        "whole picture, 8 x 8, knot:4000 at 64 pixels",
        f"RMS of radiance: {own.rmse:.1e}, FLIP in 99.9 %: {own.flip_everywhere:.3f}",
        timed(lambda: picture(truth, (slice(0, 64), slice(0, 64)))),
    )


@click.command()
@click.option("--object", "name", default="figure", show_default=True)
def main(name: str) -> None:
    """Print the table of references: how far each is from the truth, and the seconds it takes."""
    scene = Scene(object=name, size=SIZE)
    print("| reference | its own error | seconds |\n|---|---|---|", flush=True)
    with TemporaryDirectory() as folder:
        rows = chain(thickness(scene, Path(folder)), softening(scene), occlusion(scene), shadows(scene), whole())
        for label, own, seconds in rows:
            print(f"| {label} | {own} | {seconds:.1f} |", flush=True)


if __name__ == "__main__":
    main()
