"""One stimulus made: drawn by the renderer, or read from a file made elsewhere and checked."""

import hashlib
import json
import zlib
from collections.abc import Callable
from functools import cache, partial
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import fakesss
from fakesss.problem import BadInput
from fakesss.recent import Recent
from fakesss.scene import Material, Scene
from stimuli.cues import cues_of_picture, cues_of_rendering, mean_thickness
from stimuli.design import Stimulus
from stimuli.drawn import Drawn
from stimuli.manifest import sha256
from stimuli.offline import depends_on, made

if TYPE_CHECKING:
    from fakesss.renderer import Rendering

# What a picture's bytes come from besides our own source: shapes, repairs, occlusion, drawing, encoding.
LIBRARIES = ("moderngl", "numpy", "scipy", "trimesh", "embreex", "scikit-image", "fast-simplification", "pillow")
# Our own source that no stimulus comes from, by stem; everything else makes pictures stale when it changes.
COMMANDS = ("__main__", "cli", "cli_analysis", "cli_measure", "cli_picture", "cli_power", "cli_study", "cli_survey")
TUNER = ("cli_tune", "listening", "scene_toml")  # with the folder tuner
TIMES = ("bench", "bench_bake", "bench_tables", "direct", "direct_light", "savings")
LOOKS = ("inspect", "views", "contact_sheet", "explanation", "graph_drawing", "graph_layout")
PLOTS = ("profile_plot", "relief", "lighting_terms")
CHECKS = ("browser", "depth_checks", "doctor", "hard_edges", "reference")
FITTING = ("cli_fit", "fit", "fit_model", "fit_solver", "fit_start", "fit_uncertainty")
FITTED = ("fit_matched", "fit_leftover", "fit_noise", "fit_times", "fit_report", "fit_files")
TRACING = ("media",)  # with the folder offline: see `tracing_files`
# What pictures that are traced have in common with those that are drawn: mesh, rays, lights and encoding.
RAYS = ("calls", "camera", "crossings", "lights", "mesh", "ray_casting", "reference", "shapes", "solidity")
ENCODING = ("colour", "image_io", "png")
ROOMS = ("accuracy", "offline", "tuner")  # folders of nothing but such
NOT_DRAWING = frozenset((*TRACING, *COMMANDS, *TUNER, *TIMES, *LOOKS, *PLOTS, *CHECKS, *FITTING, *FITTED))
# What thickness does not depend on; a sweep of any of it measures thickness once.
ELSEWHERE = ("object", "light", "lights", "shadow", "exposure", "background", "alpha", "occlusion", "blur")
SURFACE = set(Material.model_fields) - {"thickness"}
NOT_THICKNESS: Any = {**dict.fromkeys(ELSEWHERE, True), "material": SURFACE}  # the object's file counts by its content
thicknesses: Recent[float | None] = Recent(4096)


def software() -> dict[str, str]:
    """Who draws: the manifest's `software` table. Opens the OpenGL context."""
    from fakesss.gpu import renderer_facts

    libraries = {name: version(name) for name in LIBRARIES} | {"zlib": zlib.ZLIB_RUNTIME_VERSION}
    return {"fakesss": fakesss.__version__, **libraries, **renderer_facts()}


def build_key(stimulus: Stimulus, size: tuple[int, int], folder: Path, made_by: dict[str, str]) -> str:
    """Hash of everything the picture's bytes depend on."""
    from fakesss.shapes import is_mesh_file

    if stimulus.path_tracing is not None:
        depends = depends_on(stimulus, made_by, source_sha256(), source_sha256(tracing=True))
    else:
        depends = {"software": made_by, "source": source_sha256(), "size": size}
    if stimulus.scene is None:
        depends["image"] = sha256((folder / str(stimulus.image)).read_bytes())
    elif stimulus.path_tracing is None:
        depends["scene"] = stimulus.scene.model_dump(mode="json")
    if stimulus.scene is not None and is_mesh_file(stimulus.scene.object):
        depends["mesh"] = sha256((folder / stimulus.scene.object).read_bytes())
    return sha256(json.dumps(depends, sort_keys=True).encode())


def draw(stimulus: Stimulus, *, size: tuple[int, int], folder: Path) -> Callable[[], Drawn]:
    """Draws the stimulus now, at `size` (width, height); what is returned makes the PNG of it later, on any thread.

    One that is path-traced and not shipped takes minutes.
    """
    if stimulus.scene is None:
        return partial(read_made_elsewhere, stimulus, size, folder)
    if stimulus.path_tracing is not None:
        return made(stimulus, folder)
    return partial(encoded, stimulus.id, *rendered(stimulus.scene.relative_to(folder)))


def rendered(scene: Scene) -> tuple["Rendering", Scene, float | None]:
    """The picture, its scene, and the object's mean thickness in sphere diameters (None: nothing of it is seen)."""
    from fakesss.passes.mesh import identity
    from fakesss.renderer import shared_renderer

    renderer, key = shared_renderer(), (identity(scene.object), scene.model_dump_json(exclude=NOT_THICKNESS))
    if key in thicknesses:
        return renderer.render(scene), scene, thicknesses.get(key, lambda: None)
    rendering, thickness = renderer.render_with(scene, "thickness")
    return rendering, scene, thicknesses.get(key, lambda: mean_thickness(thickness, rendering.image[..., 3]))


def encoded(identity: str, rendering: "Rendering", scene: Scene, thickness: float | None) -> Drawn:
    """The picture as PNG bytes, and its cues; `BadInput` if a pixel of it is no picture."""
    from fakesss.image_io import encode_png

    if rendering.non_finite:
        raise BadInput(
            f"study.toml: {identity}: {rendering.non_finite} pixels hold a value that is not finite, a fault of the "
            "renderer; change this picture's levels a little"
        )
    height, width = rendering.image.shape[:2]
    passes = tuple(timing["name"] for timing in rendering.passes)
    cues = cues_of_rendering(rendering.image, scene.background, thickness)
    return Drawn(encode_png(rendering.image), width, height, passes, rendering.warnings, cues)


def read_made_elsewhere(stimulus: Stimulus, size: tuple[int, int], folder: Path) -> Drawn:
    """A comparison picture, its pixels unchanged, as a PNG that states its colour space."""
    from fakesss.image_io import encode_png8
    from fakesss.picture_reading import read_picture

    path = folder / str(stimulus.image)
    pixels, warnings = read_picture(path)
    height, width = pixels.shape[:2]
    if (width, height) != size:
        raise BadInput(
            f"study.toml: compare {stimulus.image!r}: is {width}x{height} but the study's pictures are "
            f"{size[0]}x{size[1]}; resize it or set scene.size"
        )
    origin = {"image": stimulus.image}
    return Drawn(encode_png8(pixels), width, height, (), tuple(warnings), cues_of_picture(pixels), origin)


@cache
def source_sha256(tracing: bool = False) -> str:
    """Hash of the source that draws, so that a changed shader makes its pictures stale; of what traces, likewise."""
    digest = hashlib.sha256()
    for path in tracing_files() if tracing else drawing_files():
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def drawing_files() -> list[Path]:
    """The source that pictures and their cues come from: modules, shaders, this file and the cues' own."""
    root = Path(fakesss.__file__).parent
    ours = sorted([*root.rglob("*.py"), *root.rglob("glsl/*"), Path(__file__), Path(__file__).with_name("cues.py")])
    return [path for path in ours if path.is_file() and path.stem not in NOT_DRAWING and path.parent.name not in ROOMS]


def tracing_files() -> list[Path]:
    """The source that path-traced pictures come from; what fits the shader to them is none."""
    root = Path(fakesss.__file__).parent
    room = [path for path in sorted((root / "offline").glob("*.py")) if path.stem not in {*FITTING, *FITTED}]
    return [*(root / f"{stem}.py" for stem in (*TRACING, *RAYS, *ENCODING)), *room]
