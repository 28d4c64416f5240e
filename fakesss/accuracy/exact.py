"""The picture that all approximations stand for: equation 3.6 from exact quantities, sample by sample.

What is seen and how deep by rays (`exact_sight`), softened by the integral that the blur's taps stand for
(`exact_blur`), occlusion from 16,384 rays a pixel and shadows by rays (`exact_light`), lit in numpy
(`illumination`), and 8 x 8 samples a pixel, other ones than the renderer's. None of it draws a triangle or reads a
texture. Shared with the renderer are the mesh and its smooth normals, the camera, the formulas, what clip planes,
open surfaces and each thickness mean, and local thickness, which is baked at vertices.

It is the truth *of the technique*, on the mesh as it is: facets stay facets, and no light is scattered.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from fakesss import cache, illumination
from fakesss.accuracy import exact_blur, exact_light
from fakesss.accuracy.exact_light import RAYS
from fakesss.accuracy.exact_sight import Seen, Sight, corner_shares, interpolated
from fakesss.calls import Setting
from fakesss.camera import View
from fakesss.mesh import Mesh
from fakesss.problem import BadInput
from fakesss.ray_casting import Caster
from fakesss.scene import Scene
from fakesss.shapes import load_object
from fakesss.vertex_normals import normalised

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Integers = NDArray[np.int64]

VERSION = 2  # raised whenever the values change, so that cached tiles are made again
TILE = 48  # pixels a side: with 8 x 8 samples some 300 MB while it is made
TOGETHER = 300_000  # rays at once
# Settings that say how well something is approximated, not what: no reference depends on them
APPROXIMATIONS: Any = {
    "object": True,  # counts by its content
    "quality": True,
    "supersampling": True,
    "layers": {"method", "rays", "faces", "resolution", "depth"},
    "blur": {"kernel"},
    "occlusion": {"method", "rays", "samples", "radius", "bias"},
    "shadow": True,  # but for a penumbra, see `content`
}

Part = tuple[slice, slice]  # rows and columns of the picture, pixels


@dataclass(frozen=True)
class Truth:
    """A scene and what its exact quantities are computed from."""

    scene: Scene
    samples: int  # a side, in a pixel
    rays: int = RAYS  # a pixel, of occlusion; a vertex, of local thickness

    @cached_property
    def mesh(self) -> Mesh:
        """The object, in the world frame."""
        return load_object(self.scene.object)

    @cached_property
    def setting(self) -> Setting:
        """What the scene calls for, with as many samples."""
        width, height = self.scene.size
        size = (width * self.samples, height * self.samples)
        view = View.of(self.scene.camera, self.scene.size)
        return Setting(self.scene, view, size, self.samples, solid=False)  # which only chooses what is drawn

    @cached_property
    def sight(self) -> Sight:
        """The camera's rays."""
        return Sight(self.scene, self.mesh, self.setting.view, self.rays)

    @cached_property
    def caster(self) -> Caster:
        """Rays to the lights."""
        return Caster(self.mesh)

    @property
    def occluded(self) -> bool:
        """Whether [a] counts, and not everything sees the whole hemisphere."""
        return not self.setting.lacking("occlusion")

    @property
    def open_thickness(self) -> float:
        """Thickness of a sample with no second layer: 0 on a closed surface seen whole, else the scene's policy."""
        if self.mesh.watertight and not self.setting.view.clips_sphere:
            return 0.0
        return {"thin": 0.0, "thick": 1.0}[self.scene.open_surface]

    def seen(self, part: Part, softened: bool, spread: bool = False) -> Seen:
        """What the samples of a part of the picture see; with the second layer `softened` by the dense blur.

        Samples are in the middles of their squares, as the renderer's; where they are `spread`, none but a few are.
        """
        (width, height), view = self.setting.size, self.setting.view
        softened &= exact_blur.step_of(self.scene, view, self.scene.size[0]) >= exact_blur.LEAST
        finer = exact_blur.finer(self.scene, view, width) if softened else 1
        if spread and self.samples > 1:
            finer = max(finer, 3) if softened else self.samples
        size = (width * finer, height * finer)
        rows, columns = places(part, self.samples, finer, spread)
        seen = self.sight(size, rows, columns)
        if not softened or not seen.hit.any():
            return seen
        second = seen.second.copy()
        kernel = exact_blur.kernel(self.scene, view, size)
        second[seen.hit] = self.softened(kernel, size, rows[seen.hit], columns[seen.hit])
        return replace(seen, second=second)

    def softened(self, kernel: exact_blur.Kernel, size: tuple[int, int], rows: Integers, columns: Integers) -> Floats32:
        """The second layer (N,) softened in these cells of a grid of `size`; where no object is, no ray is cast."""
        top, left = rows.min() - kernel.margin, columns.min() - kernel.margin
        shape = (int(rows.max() - top) + kernel.margin + 1, int(columns.max() - left) + kernel.margin + 1)
        exact_blur.check_cells(self.scene, shape)
        layer = np.empty(shape, np.float32)
        across = np.arange(left, left + shape[1])
        at_once = max(TOGETHER // shape[1], 1)
        for start in range(0, shape[0], at_once):
            strip = layer[start : start + at_once]
            down = np.arange(top + start, top + start + len(strip))
            cells = np.repeat(down, shape[1]), np.tile(across, len(down))
            strip[:] = self.sight(size, *cells).second.reshape(strip.shape)
        return kernel(layer, rows - top, columns - left)

    def shape(self, part: Part) -> tuple[int, int]:
        """Rows and columns of samples in a part of the picture."""
        rows, columns = ((one.stop - one.start) * self.samples for one in part)
        return rows, columns

    def thickness(self, seen: Seen) -> Floats:
        """t of samples (N,) in sphere diameters, 0..1; 0 where nothing is seen."""
        behind = np.clip((seen.second - seen.front) / 2, 0, 1)
        return np.where(seen.hit, np.where(np.isnan(seen.second), self.open_thickness, behind), 0.0)


def places(part: Part, samples: int, finer: int, spread: bool) -> tuple[Integers, Integers]:
    """Rows and columns (N,) of a part's samples on a grid of `finer` x `finer` cells a sample.

    In the middle of its square, or `spread`: the further right a sample in its pixel, the further down in its square,
    and the further down, the further right, so that with n cells no two of a pixel's samples share a row or a column
    (multi-jittered sampling before it is shuffled: Chiu, Shirley and Wang 1994). The renderer's samples all do, and
    what an edge does to them is not to go unseen.
    """
    down, right = (np.arange(one.start * samples, one.stop * samples) for one in part)
    down, right = (side.ravel() for side in np.meshgrid(down, right, indexing="ij"))
    if not spread:
        return down * finer + finer // 2, right * finer + finer // 2
    aside = [(2 * (other % samples) + 1) * finer // (2 * samples) for other in (right, down)]
    return down * finer + aside[0], right * finer + aside[1]


def exact_picture(scene: Scene, samples: int = 8, rays: int = RAYS, spread: bool = True) -> Floats32:
    """The exact picture of `scene`, (H, W, 4) float32 as `render` gives: linear RGB over the background, and coverage.

    The mean of `samples` x `samples` samples a pixel, with `rays` a pixel for occlusion and a vertex for local
    thickness. Made tile by tile and kept by content: interrupted, it goes on where it stopped. What `quality` fills
    counts as not set: a preset does not choose its own truth. Without `spread`, at the renderer's own samples: to
    compare without what edges do to either. `BadInput` for style "as published", whose flaws have
    no truth, and for a softening too wide to look at.
    """
    check(scene)
    scene = scene.replace({"quality": None})
    truth = Truth(scene, samples, rays)
    key = {"version": VERSION, "spread": spread, **content(truth)}

    def one(part: Part) -> Floats32:
        """A tile of the picture, from the cache where it is there."""
        shape = (part[0].stop - part[0].start, part[1].stop - part[1].start, 4)
        place = [part[0].start, part[1].start]
        made = cache.cached(
            "exact", {**key, "place": place}, {"tile": shape}, lambda: {"tile": picture(truth, part, spread)}
        )
        tile: Floats32 = made[0]["tile"]
        return tile

    image: Floats32 = together(scene, one, "exact picture")
    return image


def content(truth: Truth) -> dict[str, Any]:
    """What an exact picture depends on, JSON; a setting that only approximates is not among it."""
    settings = truth.scene.model_dump(mode="json", exclude=APPROXIMATIONS)
    shadow = truth.scene.shadow
    if truth.setting.casting and shadow.filter == "disc":
        settings["penumbra"] = shadow.radius
    if truth.occluded and truth.scene.occlusion.method == "screen-space":
        settings["occlusion_radius"] = truth.scene.occlusion.radius  # which asks for another picture
    return {"scene": settings, "mesh": truth.mesh.sha256, "samples": truth.samples, "rays": truth.rays, "tile": TILE}


def check(scene: Scene) -> None:
    """`BadInput` for a scene that stands for nothing but itself."""
    if scene.style == "as published":
        raise BadInput('scene: style "as published" shows flaws that have no exact picture; take "default"')


def together(scene: Scene, one: Callable[[Part], NDArray[Any]], label: str) -> NDArray[Any]:
    """What `one` gives of each part of the picture, put together, with a progress bar."""
    width, height = scene.size
    parts = list(tiles(width, height))
    made = [one(part) for part in tqdm(parts, desc=label, unit="tile", disable=None)]
    in_row = -(-width // TILE)
    return np.concatenate([np.concatenate(made[i : i + in_row], axis=1) for i in range(0, len(made), in_row)])


def tiles(width: int, height: int) -> Iterator[Part]:
    """The parts of a picture, row by row from the top."""
    for top in range(0, height, TILE):
        for left in range(0, width, TILE):
            yield slice(top, min(top + TILE, height)), slice(left, min(left + TILE, width))


def picture(truth: Truth, part: Part, spread: bool = True) -> Floats32:
    """A part of the exact picture, (rows, columns, 4)."""
    scene, setting = truth.scene, truth.setting
    n, (rows, columns) = truth.samples, truth.shape(part)
    seen = truth.seen(part, not (setting.lacking("backlight") or setting.lacking("blur")), spread)
    shaded = np.zeros((len(seen.hit), 4))
    shaded[:, :3] = 0 if scene.alpha else scene.background
    if seen.hit.any():
        numbers = np.tile(np.arange(n * n).reshape(n, n), (rows // n, columns // n)).ravel()
        shaded[seen.hit, :3] = scene.exposure * radiance(truth, seen, numbers[seen.hit])
        shaded[seen.hit, 3] = 1
    averaged: Floats32 = shaded.reshape(rows // n, n, columns // n, n, 4).mean(axis=(1, 3)).astype(np.float32)
    return averaged


def radiance(truth: Truth, seen: Seen, numbers: Integers) -> Floats:
    """Equation 3.6 at the samples that see the object: linear RGB (M, 3), before exposure.

    `numbers` (M,) tells the samples of a pixel apart.
    """
    mesh, setting, view = truth.mesh, truth.setting, truth.setting.view
    shares = corner_shares(mesh, seen.faces, seen.points)
    normals = normalised(interpolated(mesh, mesh.normals, seen.faces, shares))
    normals = np.where(seen.from_behind[:, None], -normals, normals)
    starts = exact_light.onto_smooth_surface(mesh, seen.faces, shares, seen.points, seen.from_behind)
    open_share = np.ones(len(shares))
    if truth.occluded:
        rays = max(truth.rays // truth.samples**2, 1)
        settings = truth.scene.occlusion
        open_share = exact_light.sample_occlusion(truth.caster, starts, normals, numbers, settings, rays)
    lit = exact_light.lit_shares(setting, truth.caster, starts, normals) if setting.casting else {}
    t = truth.thickness(seen)[seen.hit]
    return illumination.lighting(truth.scene, view, view.turn(seen.points), view.turn(normals), open_share, t, lit)


def exact_thickness(scene: Scene, samples: int = 1, softened: bool = False) -> Floats:
    """t at the samples' centres, (H samples, W samples), in sphere diameters, 0 outside coverage as in `render`.

    Of whichever thickness `material.thickness` asks for; `softened` by the dense blur.
    """
    check(scene)
    truth = Truth(scene, samples)

    def one(part: Part) -> Floats:
        """A tile of the thickness."""
        return truth.thickness(truth.seen(part, softened)).reshape(truth.shape(part))

    return together(scene, one, "exact thickness")
