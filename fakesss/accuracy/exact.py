"""The picture that all approximations stand for: equation 3.6 from exact quantities, sample by sample.

What is seen and how deep by rays (`exact_sight`), softened by the integral that the blur's taps stand for
(`exact_blur`), occlusion from 16,384 rays a vertex and shadows by rays (`exact_light`), lit in numpy
(`illumination`), and 8 x 8 samples a pixel. None of it draws a triangle or reads a texture.

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
from fakesss.accuracy.exact_light import BAKE_RAYS
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

VERSION = 1  # raised whenever the values change, so that cached tiles are made again
TILE = 48  # pixels a side: with 8 x 8 samples some 300 MB while it is made
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
    rays: int = BAKE_RAYS  # a vertex, of what is baked

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

    @cached_property
    def occlusion(self) -> Floats32 | None:
        """[a] at the vertices (V,), or None where everything sees the whole hemisphere."""
        if self.setting.lacking("occlusion"):
            return None
        return exact_light.vertex_occlusion(self.mesh, self.scene.occlusion, self.rays)

    @property
    def open_thickness(self) -> float:
        """Thickness of a sample with no second layer: 0 on a closed surface seen whole, else the scene's policy."""
        if self.mesh.watertight and not self.setting.view.clips_sphere:
            return 0.0
        return {"thin": 0.0, "thick": 1.0}[self.scene.open_surface]

    def cast(self, part: Part, finer: int = 1, margin: int = 0) -> Seen:
        """What the samples of a part of the picture see, `finer` times as many a side and `margin` more around."""
        size = self.setting.size
        rows, columns = (
            range(one.start * self.samples * finer - margin, one.stop * self.samples * finer + margin) for one in part
        )
        return self.sight((size[0] * finer, size[1] * finer), columns, rows)

    def seen(self, part: Part, softened: bool) -> Seen:
        """What the samples of a part of the picture see; with the second layer `softened` by the dense blur."""
        if not softened:
            return self.cast(part)
        size, view = self.setting.size, self.setting.view
        finer = exact_blur.finer(self.scene, view, size[0])
        kernel = exact_blur.kernel(self.scene, view, (size[0] * finer, size[1] * finer))
        wide = self.cast(part, finer, kernel.margin)
        chosen = np.pad(middles(self.shape(part), finer), kernel.margin)
        second = kernel(wide.second.reshape(chosen.shape), finer)
        return replace(wide.only(chosen.ravel()), second=second.ravel().astype(np.float64))

    def shape(self, part: Part) -> tuple[int, int]:
        """Rows and columns of samples in a part of the picture."""
        rows, columns = ((one.stop - one.start) * self.samples for one in part)
        return rows, columns

    def thickness(self, seen: Seen) -> Floats:
        """t of samples (N,) in sphere diameters, 0..1; 0 where nothing is seen."""
        behind = np.clip((seen.second - seen.front) / 2, 0, 1)
        return np.where(seen.hit, np.where(np.isnan(seen.second), self.open_thickness, behind), 0.0)


def middles(shape: tuple[int, int], finer: int) -> NDArray[np.bool_]:
    """Where on a grid of `finer` x `finer` cells a sample the samples' centres are."""
    one = np.zeros((finer, finer), bool)
    one[finer // 2, finer // 2] = True
    return np.tile(one, shape)


def exact_picture(scene: Scene, samples: int = 8, rays: int = BAKE_RAYS) -> Floats32:
    """The exact picture of `scene`, (H, W, 4) float32 as `render` gives: linear RGB over the background, and coverage.

    The mean of `samples` x `samples` samples a pixel, with `rays` a vertex for what is baked. Made tile by tile and
    kept by content: interrupted, it goes on where it stopped. `BadInput` for style "as published", whose flaws have no
    truth.
    """
    check(scene)
    truth = Truth(scene, samples, rays)
    key = {"version": VERSION, **content(truth)}

    def one(part: Part) -> Floats32:
        shape = (part[0].stop - part[0].start, part[1].stop - part[1].start, 4)
        place = [part[0].start, part[1].start]
        made = cache.cached("exact", {**key, "place": place}, {"tile": shape}, lambda: {"tile": picture(truth, part)})
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


def picture(truth: Truth, part: Part) -> Floats32:
    """A part of the exact picture, (rows, columns, 4)."""
    scene, setting = truth.scene, truth.setting
    seen = truth.seen(part, softened=not (setting.lacking("backlight") or setting.lacking("blur")))
    shaded = np.zeros((len(seen.hit), 4))
    shaded[:, :3] = 0 if scene.alpha else scene.background
    if seen.hit.any():
        shaded[seen.hit, :3] = scene.exposure * radiance(truth, seen)
        shaded[seen.hit, 3] = 1
    n, (rows, columns) = truth.samples, truth.shape(part)
    averaged: Floats32 = shaded.reshape(rows // n, n, columns // n, n, 4).mean(axis=(1, 3)).astype(np.float32)
    return averaged


def radiance(truth: Truth, seen: Seen) -> Floats:
    """Equation 3.6 at the samples that see the object: linear RGB (M, 3), before exposure."""
    mesh, setting, view = truth.mesh, truth.setting, truth.setting.view
    shares = corner_shares(mesh, seen.faces, seen.points)
    normals = normalised(interpolated(mesh, mesh.normals, seen.faces, shares))
    normals = np.where(seen.from_behind[:, None], -normals, normals)
    open_share = np.ones(len(shares))
    if truth.occlusion is not None:
        open_share = np.clip(interpolated(mesh, truth.occlusion, seen.faces, shares), 0, 1)
    lit = {}
    if setting.casting:
        starts = exact_light.onto_smooth_surface(mesh, seen.faces, shares, seen.points, seen.from_behind)
        lit = exact_light.lit_shares(setting, truth.caster, starts, normals)
    t = truth.thickness(seen)[seen.hit]
    return illumination.lighting(truth.scene, view, view.turn(seen.points), view.turn(normals), open_share, t, lit)


def exact_thickness(scene: Scene, samples: int = 1, softened: bool = False) -> Floats:
    """t at the samples' centres, (H samples, W samples), in sphere diameters, 0 outside coverage as in `render`.

    Of whichever thickness `material.thickness` asks for; `softened` by the dense blur.
    """
    check(scene)
    truth = Truth(scene, samples)

    def one(part: Part) -> Floats:
        return truth.thickness(truth.seen(part, softened)).reshape(truth.shape(part))

    return together(scene, one, "exact thickness")
