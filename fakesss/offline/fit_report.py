"""The shader fitted to a measured medium, and what the fit is worth: errors, times, and what is left over."""

import math
import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.accuracy.errors import Errors, check_flip, errors
from fakesss.accuracy.tradeoff_document import measured_by
from fakesss.lights import LARGEST
from fakesss.media import medium_named
from fakesss.offline.fit import Fit, Target, Try, fit
from fakesss.offline.fit_leftover import leftover
from fakesss.offline.fit_matched import matched
from fakesss.offline.fit_model import basis, matte
from fakesss.offline.fit_noise import FEWEST, again, correlation, floor
from fakesss.offline.fit_solver import EXPONENTS
from fakesss.offline.fit_start import starting_scene
from fakesss.offline.fit_times import measured
from fakesss.offline.path_tracing import PathTraced, path_traced
from fakesss.offline.physical_scene import lights
from fakesss.offline.settings import PathTracing
from fakesss.problem import BadInput
from fakesss.renderer import shared_renderer
from fakesss.scene import Material, Scene

NUMBERS = ("thickness_exponent", "backlight", "diffuse_weight", "diffuse_contribution", "ambient")
METHOD = (
    "Bounded least squares in linear radiance over the pixels that the shader covers, all weighted alike, without "
    "highlights on either side, over black, so that neither the background nor what of it shines through a medium "
    "unscattered is taken for the object; separable (variable projection), from several starts and thicknesses.",
    "Kd, ka, wd, wb and Kb are known up to one factor: the largest channel of Kd is held at the medium's reflectance.",
    "FLIP and RMSE are of the pixels that either picture covers, and of a real rendering of the fitted scene.",
    "Times are measured in turn, path tracing by a few samples that are multiplied up; what the target took when "
    "made stands in its provenance.",
)


@dataclass(frozen=True)
class Named:
    """What the page calls the scene, and the command that makes it again."""

    scene: str
    command: str


@dataclass(frozen=True)
class Report:
    """What `fakesss fit` tells and writes."""

    scene: Scene  # fitted, with the highlights that it had
    document: dict[str, Any]  # JSON
    pictures: dict[str, NDArray[np.float32]]  # target, fitted, start: (H, W, 4), without highlights


def fit_medium(
    scene: Scene, settings: PathTracing, starts: int, seed: int, named: Named, quiet: bool | None = None
) -> Report:
    """Fit `scene` to its own path-traced picture. `BadInput` for what cannot be drawn, traced or fitted."""
    medium, plain = medium_named(settings.medium, "--to"), settings.model_copy(update={"highlights": False})
    scene = scene.replace({"alpha": False})
    alone = matte(scene)
    traced, target = target_of(alone, plain, quiet)
    as_many = plain.model_copy(update={"samples": traced.samples})  # --noise may have stopped it before
    began = time.perf_counter()
    found = fit(starting_scene(scene, medium, settings.size_mm), target, starts, seed, quiet)
    taken = time.perf_counter() - began
    fitted, start = (shared_renderer().render(matte(each)).image for each in (found.scene, found.start))
    near, times = errors(fitted, traced.image), measured(found.scene, medium, settings.size_mm)
    document = {
        "scene": named.scene,
        "medium": medium.name,
        "size_mm": settings.size_mm,
        "width": scene.size[0],
        "height": scene.size[1],
        "parameters": parameters(found),
        "thickness": thicknesses(found),
        "starts": [tried(one) for one in found.tries],
        **numbers(near),
        "start_errors": numbers(errors(start, traced.image)),
        "noise": floor(traced, target.correlation, near, seed),
        "model_max_abs": float(np.abs(fitted - found.picture).max()),
        "seconds": {"shader": times.shader, "path_traced": traced.samples * times.sample, "fit": taken},
        "speed_up": traced.samples * times.ratio,
        "leftover": leftover(found.scene, fitted, traced.image, traced.standard_error),
        "matched": matched(alone, as_many, traced.image, near.flip, times, quiet),
        "notes": [*traced.warnings, *found.notes],
        "method": list(METHOD),
        "target": traced.provenance,
        "gl_renderer": shared_renderer().gpu.renderer,
        **measured_by(named.command),
        "scene_sha256": found.scene.sha256(),
    }
    pictures = {"target": traced.image, "fitted": fitted, "start": start}
    return Report(found.scene, concluded(document), pictures)


def target_of(alone: Scene, plain: PathTracing, quiet: bool | None) -> tuple[PathTraced, Target]:
    """The picture of the object alone, and what a fit sees of it; what is missing is said before hours of tracing."""
    check_flip()
    if not lights(alone):
        raise BadInput("scene: no light shines, so there is nothing to fit; raise light.diffuse or light.ambient")
    basis(alone)
    traced = path_traced(alone, plain, quiet=quiet)
    if not math.isfinite(traced.noise):
        raise BadInput("target: it is nothing but noise, so there is nothing to fit; raise samples, or give it light")
    together = correlation(again(alone, plain, FEWEST, quiet), traced.image)
    return traced, Target(traced.image, traced.standard_error, together)


def concluded(document: dict[str, Any]) -> dict[str, Any]:
    """With all of it in one sentence."""
    seconds, equal = document["seconds"], document["matched"]
    sentence = (
        f"{duration(seconds['shader'])} against {duration(seconds['path_traced'])} at FLIP {document['flip']:.2f}; for "
        f"that FLIP the path tracer needs {' '.join((equal['bound'], duration(equal['seconds']))).strip()} "
        f"({equal['samples']:.0f} samples a pixel), {equal['speed_up']:,.0f} times as long."
    )
    return {**document, "sentence": sentence}


def numbers(found: Errors) -> dict[str, float]:
    """The errors that are numbers."""
    return {"rmse": found.rmse, "max_abs": found.max_abs, "flip": found.flip}


def parameters(found: Fit) -> dict[str, Any]:
    """Each fitted field: where it started and ended, its bounds, and its standard error from the target's noise.

    Without a standard error: what is held, at a bound, or not in the picture.
    """
    start, end, errors_ = found.start.material, found.scene.material, found.standard_error
    top = max(end.diffuse)
    bounds = {"thickness_exponent": EXPONENTS, "diffuse_weight": (-min(end.diffuse), top)}
    table = {
        f"material.{name}": entry(getattr(start, name), getattr(end, name), *bounds.get(name, (0.0, LARGEST)))
        | {"standard_error": finite(errors_.get(name))}
        for name in NUMBERS
    }
    colour = entry(list(start.diffuse), list(end.diffuse), [0.0] * 3, [top] * 3)
    spread = [finite(errors_.get(f"diffuse.{channel}")) for channel in range(3)]
    return {**table, "material.diffuse": colour | {"standard_error": spread}}


def entry(start: Any, fitted: Any, low: Any, high: Any) -> dict[str, Any]:
    return {"start": start, "fitted": fitted, "low": low, "high": high}


def finite(value: float | None) -> float | None:
    """None for what JSON has no number for."""
    return value if value is not None and np.isfinite(value) else None


def thicknesses(found: Fit) -> dict[str, Any]:
    """What the backlight passes through: the kinds that were tried, and the least RMSE of each."""
    kinds = dict.fromkeys(one.end.thickness for one in found.tries)
    least = {kind: min(one.rmse for one in found.tries if one.end.thickness == kind) for kind in kinds}
    tried = [{"thickness": kind, "rmse": rmse} for kind, rmse in least.items()]
    return {"start": found.start.material.thickness, "fitted": found.scene.material.thickness, "tried": tried}


def tried(one: Try) -> dict[str, Any]:
    """Where a start was, and where it ended."""
    facts = {"thickness": one.end.thickness, "start": of(one.start), "ended": of(one.end), "rmse": one.rmse}
    return {**facts, "evaluations": one.evaluations, "converged": one.converged}


def of(material: Material) -> dict[str, Any]:
    """The fitted fields of a material."""
    return {**{name: getattr(material, name) for name in NUMBERS}, "diffuse": list(material.diffuse)}


def duration(seconds: float) -> str:
    """`0.021 s`, `12 s`, `3.4 min`, `2.1 h`."""
    if seconds < 120:
        return f"{seconds:.2g} s" if seconds < 10 else f"{seconds:.0f} s"
    return f"{seconds / 60:.3g} min" if seconds < 7200 else f"{seconds / 3600:.3g} h"
