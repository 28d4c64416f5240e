"""Pictures of scenes. `render(scene)` is the short way; a `Renderer` keeps what the next picture can use again."""

import threading
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss import gpu as opengl
from fakesss.frame import Made, Outcome, Run
from fakesss.frame_graph import FrameGraph, FrameGraphError, Plan, TextureSpec
from fakesss.image_io import check_picture, write_image
from fakesss.memory import peak_bytes, shadow_maps
from fakesss.mesh import Mesh
from fakesss.passes.mesh import mesh as mesh_of
from fakesss.pipeline import NONE, build, samples_of
from fakesss.problem import BadInput
from fakesss.quality import wanted
from fakesss.recent import Recent
from fakesss.scene import Scene
from fakesss.solidity import is_solid

Float32 = NDArray[np.float32]
BAKES_KEPT = 8  # the last few meshes and their occlusion
PICTURE = "image"
CLIPPING_TOLD = 0.0005  # share of the object's pixels: the least that rounds to 0.1 %


@dataclass(frozen=True)
class Rendering:
    """One picture and what is to be said of it. What needs a look at every pixel is found when it is asked for."""

    image: Float32  # (H, W, 4), top row first: linear RGB over the background (`alpha`: over nothing), and coverage
    passes: list[dict[str, Any]]  # {"name", "gpu_ms"} in the order they ran; gpu_ms is None unless timed
    plan: Plan
    mesh: Mesh
    notes: tuple[str, ...]  # the mesh's repairs and settings that do nothing, one sentence each
    baked: dict[str, Made]
    alpha: bool

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each."""
        wrong = (not_finite(self.non_finite),) if self.non_finite else ()
        return (*wrong, *self.notes, *picture_warnings(self.image, self.alpha))

    @cached_property
    def non_finite(self) -> int:
        """Pixels with a value that is not finite; always 0, counted rather than believed."""
        finite = np.isfinite(self.image)
        return 0 if finite.all() else int((~finite.all(axis=2)).sum())


class Renderer:
    """Meshes, occlusion, programs, buffers and textures kept from picture to picture. Use it on one thread only."""

    def __init__(self, gpu: opengl.Gpu | None = None) -> None:
        self.gpu = gpu or opengl.shared()
        self.bakes: Recent[Any] = Recent(BAKES_KEPT)
        self.largest_texture = int(self.gpu.context.info["GL_MAX_TEXTURE_SIZE"])  # pixels a side

    def render(self, scene: Scene, timed: bool = False, forced: frozenset[str] = NONE) -> Rendering:
        """The picture of `scene`. Raises `BadInput` for what a user can mend.

        `timed` adds GPU times of each pass; `forced` names effects to simulate although their weight is zero.
        """
        return rendering(scene, *self._run(scene, (PICTURE, "mesh"), samples_of(scene), timed, forced))

    def render_with(self, scene: Scene, target: str) -> tuple[Rendering, Any]:
        """The picture of `scene`, its bytes those of `render`, and a resource at the picture's samples, top row first.

        They are drawn together, unless the picture's shading computes the resource in place: then one after the other.
        """
        samples = samples_of(scene)
        plan, outcome = self._run(scene, (PICTURE, "mesh"), samples, beside=target)
        if target not in outcome.values:
            return rendering(scene, plan, outcome), self.data(scene, (target,), samples)[target]
        return rendering(scene, plan, outcome), upright(outcome.values[target])

    def data(self, scene: Scene, targets: tuple[str, ...], samples: int = 1) -> dict[str, Any]:
        """Resources by name, top row first: one sample at each pixel's centre, so data is never averaged.

        Pictures are (H, W) or (H, W, components) float32, 0 outside coverage; baked resources are as they were made:
        a `Mesh`, an `occlusion.Baked`.
        """
        outcome = self._run(scene, targets, samples)[1]
        return {name: upright(value) for name, value in outcome.values.items()}

    def _run(
        self,
        scene: Scene,
        targets: tuple[str, ...],
        samples: int,
        timed: bool = False,
        forced: frozenset[str] = NONE,
        beside: str = "",
    ) -> tuple[Plan, Outcome]:
        """The plan of `targets` and what running it gave; `beside` is made too where that changes nothing of them."""
        self._fit(scene, samples)
        graph, loaded = self._declare(scene, samples, forced)
        plan = graph.compile(targets)
        everything = plan if not beside or is_merged(plan, beside) else graph.compile((*targets, beside))
        maps = shadow_maps(plan)
        self.gpu.keep_drawn(maps)
        if maps and max(maps.size) > self.largest_texture:
            raise too_large_maps(maps, self.largest_texture)
        with opengl.reporting_memory(*what_takes_most(plan, scene, samples)):
            outcome = Run(everything, self.gpu, self.bakes, timed)()
        return plan, replace(outcome, baked={**outcome.baked, **loaded.baked})

    def plan(self, scene: Scene, forced: frozenset[str] = NONE) -> tuple[Plan, Mesh]:
        """What drawing the picture of `scene` would run, and its mesh; nothing is drawn."""
        graph, loaded = self._declare(scene, samples_of(scene), forced)
        return graph.compile((PICTURE, "mesh")), loaded.values["mesh"]

    def _declare(self, scene: Scene, samples: int, forced: frozenset[str]) -> tuple[FrameGraph, Outcome]:
        """The graph, and what loading the mesh gave: the cheapest exact way depends on what it is."""
        loaded = Run(FrameGraph([mesh_of(scene)]).compile(("mesh",)), self.gpu, self.bakes)()
        mesh = loaded.values["mesh"]
        solid = self.bakes.get(("solid", mesh.sha256), lambda: is_solid(mesh))
        return build(scene, samples, solid, forced), loaded

    def _fit(self, scene: Scene, samples: int) -> None:
        size = (scene.size[0] * samples, scene.size[1] * samples)
        if max(size) > self.largest_texture:
            raise BadInput(
                f"scene: size {scene.size[0]}x{scene.size[1]} with supersampling {samples} needs {max(size)} samples "
                f"in a row, this OpenGL has {self.largest_texture}; lower size or supersampling"
            )


def rendering(scene: Scene, plan: Plan, outcome: Outcome) -> Rendering:
    """What a run of `plan` gave, as a picture."""
    image = np.ascontiguousarray(outcome.values[PICTURE][::-1])
    passes = [{"name": name, "gpu_ms": outcome.gpu_ms.get(name)} for name in plan.passes]
    mesh: Mesh = outcome.values["mesh"]
    notes = (*mesh.repairs, *idle_settings(scene, plan))
    return Rendering(image, passes, plan, mesh, notes, dict(outcome.baked), scene.alpha)


def is_merged(plan: Plan, resource: str) -> bool:
    """Whether a pass computes the resource in place for itself."""
    return any(verdict.merged and resource in verdict.node.writes for verdict in plan.verdicts)


def too_large_maps(maps: TextureSpec, largest: int) -> BadInput:
    """What is to be said of shadow maps that are no texture here."""
    return BadInput(
        f"scene: shadow.map_size: the shadow maps need a texture of {maps.size[0]}x{maps.size[1]} texels, this OpenGL "
        f"has {largest} a side; lower shadow.map_size or give fewer lights shadows"
    )


def what_takes_most(plan: Plan, scene: Scene, samples: int) -> tuple[str, str]:
    """The larger of the picture's textures and the shadow maps with their depth buffer, and what makes it smaller."""
    maps = shadow_maps(plan)
    if maps and 4 * maps.bytes > peak_bytes(plan):
        what = f"shadow maps of {maps.size[0]}x{maps.size[1]} texels"
        return what, "lower shadow.map_size or give fewer lights shadows"
    what = f"{scene.size[0]}x{scene.size[1]} pixels with supersampling {samples}"
    return what, "lower size or supersampling"


def upright(value: Any) -> Any:
    """A picture with its top row first; anything else as it is."""
    return np.ascontiguousarray(value[::-1]) if isinstance(value, np.ndarray) and value.ndim > 1 else value


def idle_settings(scene: Scene, plan: Plan) -> tuple[str, ...]:
    """A sentence for each setting that a study may vary in vain."""
    kept = {node.name for node in plan.kept}
    asked = {
        "layers.faces": scene.layers.faces is not None and "coarse_mesh" not in kept,
        "layers.resolution": scene.layers.resolution > 1 and "sparse_back_faces" not in kept,
    }
    why = "the picture needs no second layer of a solid"
    given = {path: value for knob in wanted(scene).values() for path, value in knob.items()}  # not by the scene itself
    idle = [path for path, is_idle in asked.items() if is_idle and scene.at(path) != given.get(path)]
    return tuple(f"{path} does nothing here: {why}." for path in idle)


def not_finite(pixels: int) -> str:
    """What is wrong with a picture, and what can be done about it."""
    return f"{pixels} pixels hold a value that is not finite, a fault of the renderer; change the scene a little."


def picture_warnings(image: Float32, alpha: bool) -> tuple[str, ...]:
    """What a researcher should know of a picture before showing it."""
    covered = image[..., 3] > 0
    pixels = np.count_nonzero(covered)
    if not pixels:
        return ("No pixel shows the object; check camera.distance, camera.near and camera.far.",)
    # channel by channel: numpy is slow along an axis of three
    white = image[..., 3] if alpha else 1
    beyond_white = (image[..., 0] > white) | (image[..., 1] > white) | (image[..., 2] > white)
    clipped = np.count_nonzero(beyond_white & covered) / pixels
    if clipped < CLIPPING_TOLD:
        return ()
    return (f"{clipped:.1%} of the object's pixels are brighter than the display's white and clip.",)


_threads = threading.local()


def shared_renderer() -> Renderer:
    """This thread's renderer, created at the first call."""
    gpu = opengl.shared()
    if getattr(_threads, "renderer", None) is None or _threads.renderer.gpu is not gpu:
        _threads.renderer = Renderer(gpu)
    renderer: Renderer = _threads.renderer
    return renderer


def render(scene: Scene, target: str = PICTURE) -> Any:
    """A picture of `scene`, or any resource of `explain` by name.

    `image`: (H, W, 4) float32, linear RGB composited over `scene.background`, so that showing RGB is the picture;
    the fourth channel is coverage. With `scene.alpha` RGB is composited over nothing: colour times coverage. Other
    targets: see `Renderer.data`. `thickness`: (H, W) float32 in sphere diameters, 0 outside coverage, never NaN.
    Raises `BadInput` for an unknown name or anything a user can mend.
    """
    if target == PICTURE:
        return shared_renderer().render(scene).image
    try:
        return shared_renderer().data(scene, (target,))[target]
    except FrameGraphError as error:
        raise BadInput(f"render: {error}") from None


def timed_rendering(scene: Scene) -> Rendering:
    """The picture of `scene` with the GPU times of a second drawing.

    The first also compiles programs, uploads the mesh and wakes the GPU, which takes many times as long as to draw;
    what it had to bake is what is told of baking.
    """
    baked = shared_renderer().render(scene).baked
    return replace(shared_renderer().render(scene, timed=True), baked=baked)


def render_file(scene: Scene, out: str | Path, views: bool = False, timed: bool = True) -> dict[str, Any]:
    """Write the picture of `scene` (or with `views` the contact sheet of its intermediates) to a .png or .exr file.

    Returns the contract's `render` document, its times None unless `timed`, which draws twice.
    Pixels that are not finite are among its warnings, and black in a PNG.
    """
    path = check_picture(out)
    drawn = timed_rendering(scene) if timed else shared_renderer().render(scene)
    picture: NDArray[Any] = drawn.image
    if views:
        from fakesss.inspect import contact_sheet  # loads matplotlib

        picture = contact_sheet(scene.replace({"alpha": False}))
    if path.suffix.lower() == ".png" and drawn.non_finite:
        picture = np.nan_to_num(picture)  # a PNG has no word for it
    write_image(path, picture, alpha=scene.alpha and not views)
    height, width = picture.shape[:2]
    return {
        "image": str(path),
        "width": width,
        "height": height,
        "gl_renderer": shared_renderer().gpu.renderer,
        "passes": drawn.passes,
        "non_finite": drawn.non_finite,
        "warnings": list(drawn.warnings),
        "scene_sha256": scene.sha256(),
    }
