"""What the tuner draws and says of it, and how both travel in one message."""

import json
import struct
import time
from dataclasses import dataclass
from io import BytesIO
from typing import Any, TypedDict

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from fakesss.calls import EFFECTS, Setting, lights_of
from fakesss.camera import View
from fakesss.colour import to_8bit
from fakesss.frame_graph import Bake, Plan
from fakesss.image_io import encode_png, encode_png8
from fakesss.mesh import Mesh
from fakesss.renderer import Renderer, Rendering
from fakesss.scene import Scene

PICTURE = "picture"  # the view that is no intermediate
QUALITY = 88  # of a JPEG, in libjpeg's percent, with colour at full resolution: a drag shows no blocks
LEVELS = 4096  # of linear light in the table below: as fine as sRGB's steps near black
TABLE = to_8bit(np.arange(LEVELS) / (LEVELS - 1))
MOST_SAMPLES = 1 << 25
"""Of one picture here: 1.5 GB of buffers, and seconds of drawing on a processor. 1920x1080 at 4 x 4 samples is less."""

Bytes = NDArray[np.uint8]


class PassTold(TypedDict):
    """One pass of a picture, as `explain` tells it."""

    name: str
    kept: bool
    because: str
    gpu_ms: float | None  # None unless timed


class Header(TypedDict):
    """What goes before a frame's image."""

    number: int  # the wish that it answers
    type: str  # of the image: image/jpeg or image/png
    width: int  # pixels of the image; fewer than the scene's while something moves
    height: int
    moving: bool
    view: str
    times: dict[str, float]  # ms: wait (for others' pictures), draw, encode
    passes: list[PassTold]
    reasons: dict[str, str]  # of each effect why it is not simulated, "" if it is
    warnings: list[str]  # of a still frame all, of a moving one those that need no look at the pixels
    faces: int
    vertices: int
    stand_in: str  # a sentence if this is not quite what was asked for
    matrix: list[float] | None  # (4, 4) row by row: world to clip space; None of a drawing, which has no camera
    box: list[list[float]]  # the object's smallest and largest x, y, z, sphere radii
    note: str  # what a view shows
    legend: dict[str, Any] | None  # of a view's colours: `looks.Legend`
    scene_sha256: str  # of the scene that was drawn


@dataclass(frozen=True)
class Asked:
    """One picture to draw. `scale`: 2 and 4 draw half and a quarter of the size, while something moves."""

    scene: Scene
    forced: frozenset[str] = frozenset()
    view: str = PICTURE
    moving: bool = False
    scale: int = 1

    @property
    def drawn(self) -> Scene:
        """The scene as it is drawn: while something moves with one sample a pixel."""
        if not self.moving:
            return self.scene
        width, height = self.scene.size
        size = (max(1, width // self.scale), max(1, height // self.scale))
        return self.scene.model_copy(update={"size": size, "supersampling": 1})


@dataclass(frozen=True)
class Drawn:
    """An encoded picture with what there is to say of it; `header` lacks what only the viewer's loop knows."""

    image: bytes
    header: dict[str, Any]
    samples: int  # that were drawn
    is_usual: bool  # no shader was compiled, so that it took as long as the next will

    @property
    def type(self) -> str:
        return str(self.header["type"])

    def message(self, number: int, wait: float, stand_in: str) -> bytes:
        """The whole frame."""
        times = {"wait": wait, **self.header["times"]}
        header = json.dumps({**self.header, "number": number, "times": times, "stand_in": stand_in}).encode()
        return struct.pack("<I", len(header)) + header + self.image


@dataclass(frozen=True)
class Shown:
    """What was drawn, before it is said."""

    image: bytes
    type: str
    plan: Plan
    mesh: Mesh
    gpu_ms: dict[str, float | None]
    warnings: tuple[str, ...]
    samples: int
    drawn: float  # when, on `perf_counter`; what came after is encoding
    note: str = ""
    legend: Any = None
    has_camera: bool = True


def draw(renderer: Renderer, asked: Asked) -> Drawn:
    """The picture, or the view of it, that is asked for. Raises `BadInput`, `ShaderError` and `studio.Unprepared`."""
    started, scene = time.perf_counter(), asked.drawn
    known = set(renderer.gpu.programs.compiled.values)
    shown = picture(renderer, asked) if asked.view == PICTURE else view(renderer, asked)
    header = {
        "type": shown.type,
        "width": scene.size[0],
        "height": scene.size[1],
        "moving": asked.moving,
        "view": asked.view,
        "times": {"draw": 1e3 * (shown.drawn - started), "encode": 1e3 * (time.perf_counter() - shown.drawn)},
        "passes": passes_of(shown.plan, shown.gpu_ms),
        "reasons": reasons(scene, asked.forced),
        "warnings": list(shown.warnings),
        **facts_of(shown.mesh),
        "matrix": world_to_clip(asked.scene) if shown.has_camera else None,
        "note": shown.note,
        "legend": shown.legend,
        "scene_sha256": scene.sha256(),
    }
    return Drawn(shown.image, header, shown.samples, known.issuperset(renderer.gpu.programs.compiled.values))


def picture(renderer: Renderer, asked: Asked) -> Shown:
    """The picture itself."""
    scene = asked.drawn
    # timing takes no time, but draws shadow maps again that a moving picture could keep
    timed = not asked.moving or not any(light.shadows for light in lights_of(scene))
    rendering = renderer.render(scene, timed, asked.forced)
    drawn = time.perf_counter()
    image, kind = encoded(rendering, asked.moving)
    warnings = rendering.notes if asked.moving else rendering.warnings
    gpu_ms = {entry["name"]: entry["gpu_ms"] for entry in rendering.passes}
    return Shown(image, kind, rendering.plan, rendering.mesh, gpu_ms, warnings, samples(scene), drawn)


def view(renderer: Renderer, asked: Asked) -> Shown:
    """An intermediate of the picture."""
    from fakesss.tuner.looks import DRAWINGS, ONE_SAMPLE, look  # loads matplotlib, which pictures never need

    scene = asked.drawn
    plan, mesh = renderer.plan(scene, asked.forced)
    pixels, note, legend = look(scene, asked.view)
    drawn = time.perf_counter()
    image, kind = (jpeg(pixels), "image/jpeg") if asked.moving else (encode_png8(pixels), "image/png")
    count = scene.size[0] * scene.size[1] if asked.view in ONE_SAMPLE else samples(scene)
    has_camera = asked.view not in DRAWINGS
    return Shown(image, kind, plan, mesh, {}, mesh.repairs, count, drawn, note, legend, has_camera)


def samples(scene: Scene) -> int:
    """How many a picture has."""
    return scene.size[0] * scene.size[1] * scene.supersampling**2


def encoded(rendering: Rendering, moving: bool) -> tuple[bytes, str]:
    """The file that `fakesss render` writes, or quickly something like it; and its type."""
    if moving and not rendering.alpha:
        light = np.fmax(rendering.image, 0)  # 0 where it is no number
        np.fmin(light, 1, out=light)
        light *= LEVELS - 1
        light += 0.5
        return jpeg(TABLE.take(light.astype(np.uint16))), "image/jpeg"
    picture = np.nan_to_num(rendering.image) if rendering.non_finite else rendering.image
    return encode_png(picture, rendering.alpha), "image/png"


def jpeg(pixels: Bytes) -> bytes:
    """8-bit sRGB (H, W, 3) as a JPEG; of four channels without the last."""
    file, (height, width, channels) = BytesIO(), pixels.shape
    kind = "RGBX" if channels == 4 else "RGB"
    image = Image.frombuffer(kind, (width, height), np.ascontiguousarray(pixels), "raw", kind, 0, 1)
    image.save(file, "JPEG", quality=QUALITY, subsampling=0)
    return file.getvalue()


def passes_of(plan: Plan, gpu_ms: dict[str, float | None]) -> list[PassTold]:
    """Every pass, kept or culled, and why."""
    return [
        {
            "name": verdict.node.name,
            "kept": verdict.kept,
            "because": verdict.because,
            "gpu_ms": gpu_ms.get(verdict.node.name),
        }
        for verdict in plan.verdicts
        if not isinstance(verdict.node, Bake)
    ]


def reasons(scene: Scene, forced: frozenset[str]) -> dict[str, str]:
    """Of each effect why it is not simulated, "" if it is."""
    setting = Setting(scene, View.of(scene.camera, scene.size), scene.size, 1, False, forced)
    return {name: setting.lacking(name) for name in EFFECTS}


def facts_of(mesh: Mesh) -> dict[str, Any]:
    """The object's numbers."""
    axes = mesh.positions.T  # numpy is slow along an axis of three
    box = [[float(axis.min()) for axis in axes], [float(axis.max()) for axis in axes]]
    return {"faces": len(mesh.faces), "vertices": len(mesh.positions), "box": box}


def world_to_clip(scene: Scene) -> list[float]:
    """OpenGL's model-view-projection matrix, 16 numbers row by row."""
    view = View.of(scene.camera, scene.size)
    eye = np.eye(4)
    eye[:3, :3] = view.rotation
    eye[2, 3] = -view.distance
    near, far = view.near, view.far
    projection = np.diag([1 / view.tangent[0], 1 / view.tangent[1], -(far + near) / (far - near), 0.0])
    projection[2, 3] = -2 * far * near / (far - near)
    projection[3, 2] = -1
    clip: list[float] = (projection @ eye).ravel().tolist()
    return clip
