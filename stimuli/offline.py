"""Path-traced pictures of a study: taken from those shipped where they are the same, otherwise traced here.

What is traced lies in the cache of `fakesss.offline.path_tracing`: an interrupted build goes on where it stopped.
"""

import logging
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.offline.path_tracing import PathTraced, path_traced, planned
from fakesss.offline.settings import PathTracing
from fakesss.problem import BadInput
from fakesss.scene import Scene
from stimuli.cues import cues_of_picture
from stimuli.design import Stimulus
from stimuli.drawn import Drawn
from stimuli.levels import written
from stimuli.shipped import Shipped, expected_minutes, shipped, shown

MESH = ("trimesh", "scikit-image", "fast-simplification")
LIBRARIES = ("numpy", "scipy", *MESH, "embreex", "zlib")  # sums, the mesh, its silhouette by rays, encoding
NOT_KEPT = {"seconds", "scene_sha256"}  # no two renderings share a time; the manifest has the scene itself

log = logging.getLogger(__name__)


def asked_for(stimulus: Stimulus) -> tuple[Scene, PathTracing]:
    """Scene and settings of a path-traced picture."""
    assert stimulus.scene is not None and stimulus.path_tracing is not None
    return stimulus.scene, stimulus.path_tracing


def depends_on(stimulus: Stimulus, made_by: dict[str, str], source: str, tracing: str) -> dict[str, Any]:
    """What the build key is made of; our renderer's `source` and OpenGL only where they draw the highlights.

    `tracing` is the source that traces; where only its words changed, the light comes from the cache all the same.
    """
    scene, settings = asked_for(stimulus)
    ready = shipped(scene, settings)
    if ready is not None:
        return {"shipped": ready.record}
    drawn_by = {"renderer": made_by, "source": source} if settings.highlights else {}
    denoised_by = {"denoiser": installed("pyoidn")} if settings.denoise else {}
    libraries = {"mitsuba": installed("mitsuba"), **{name: made_by[name] for name in LIBRARIES}}
    return {"software": libraries, "tracing": tracing, **drawn_by, **denoised_by, **shown(scene, settings)}


def installed(package: str) -> str | None:
    """Its version; None where it is missing, which is said when it is needed."""
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def look_ahead(stimuli: Iterable[Stimulus], folder: Path) -> None:
    """`BadInput` for a picture that cannot be traced, before the first is begun; and says what will take long."""
    for stimulus in stimuli:
        if not at_hand(stimulus, folder):
            log.warning(
                "%s (%s) is path-traced now, which takes about %s; what is done is kept when you interrupt it",
                stimulus.id,
                stimulus.label,
                duration(expected_minutes(*asked_for(stimulus))),
            )


def at_hand(stimulus: Stimulus, folder: Path) -> bool:
    """Whether nothing has to be traced for the picture. `BadInput` if it cannot be."""
    scene, settings = asked_for(stimulus)
    with placed(stimulus):
        return shipped(scene, settings) is not None or planned(scene.relative_to(folder), settings).done


def duration(minutes: float) -> str:
    """In words, as roughly as it is known."""
    if minutes < 1:
        return "a minute"
    return f"{minutes:.0f} minutes" if minutes < 90 else f"{minutes / 60:.0f} hours"


def made(stimulus: Stimulus, folder: Path) -> Callable[[], Drawn]:
    """Takes the shipped picture or traces it now; what is returned makes the PNG of it later, on any thread."""
    scene, settings = asked_for(stimulus)
    ready = shipped(scene, settings)
    if ready is not None:
        return partial(unpacked, ready)
    with placed(stimulus):
        result = path_traced(scene.relative_to(folder), settings)
    return partial(encoded, result)


def unpacked(ready: Shipped) -> Drawn:
    """A shipped picture as it is."""
    from fakesss.picture_reading import read_picture

    pixels, _ = read_picture(ready.path)
    origin = {**ready.record["provenance"], "shipped": ready.name}
    return with_cues(ready.png(), pixels, tuple(ready.record["warnings"]), origin)


def encoded(result: PathTraced) -> Drawn:
    """A traced picture as PNG bytes."""
    from fakesss.colour import to_8bit
    from fakesss.image_io import encode_png
    from fakesss.renderer import picture_warnings

    origin = {name: value for name, value in result.provenance.items() if name not in NOT_KEPT}
    warnings = (*picture_warnings(result.image, alpha=False), *result.warnings)
    return with_cues(encode_png(result.image), to_8bit(result.image[..., :3]), warnings, origin)


def with_cues(png: bytes, pixels: NDArray[np.uint8], warnings: tuple[str, ...], origin: dict[str, Any]) -> Drawn:
    """The picture with cues of its whole area, as any picture of other origin."""
    height, width = pixels.shape[:2]
    return Drawn(png, width, height, (), warnings, cues_of_picture(pixels), origin)


@contextmanager
def placed(stimulus: Stimulus) -> Iterator[None]:
    """`BadInput` of the path tracer names the picture's place in study.toml."""
    try:
        yield
    except BadInput as error:
        raise BadInput(f"study.toml: compare {written(stimulus.label)}: {str(error).removeprefix('scene: ')}") from None
