"""Which parameters of the empirical shader come nearest to a given picture, and what is left over.

Least squares in linear radiance over the pixels in which the shader draws the object, without highlights, all weighted
alike. Weights from each pixel's own standard error were tried and do harm: it comes from the same samples as the pixel,
so those that came out dark count more, and the fit is too dark. Nor is the loss robust: it would drop fireflies, which
a path tracer's mean needs. Noise only adds a constant to the error, and standard errors to the parameters.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc
from tqdm import tqdm

from fakesss.offline.fit_model import Basis, Floats, basis
from fakesss.offline.fit_solver import Ended, Problem, bounds, fitted, point_of, search
from fakesss.offline.fit_uncertainty import at_bounds, spread_of_weight, standard_errors
from fakesss.problem import BadInput
from fakesss.scene import Material, Scene

KINDS = ("first-interval", "bridged", "total-path")  # of thickness, tried beside the scene's own
SAME = 1e-6  # relative difference of errors that is none; of equally good thicknesses the scene's own is kept
STARTS = 8


@dataclass(frozen=True)
class Target:
    """The picture to come near to: linear RGB of the object alone, over black, and coverage, without highlights."""

    image: NDArray[np.float32]  # (H, W, 4)
    standard_error: NDArray[np.float32]  # (H, W, 3) of the RGB; 0 of a picture without noise
    correlation: Floats = field(default_factory=lambda: np.eye(3))  # (3, 3), of the channels' noise in a pixel


@dataclass(frozen=True)
class Try:
    """One start, and where it ended."""

    start: Material
    end: Material
    rmse: float  # over the covered pixels and channels, linear radiance
    evaluations: int
    converged: bool
    point: Floats


@dataclass(frozen=True)
class Fit:
    """What was found."""

    scene: Scene  # the start with the fitted material
    start: Scene
    tries: tuple[Try, ...]
    standard_error: dict[str, float]  # from the target's noise, by field of the material ("diffuse.0", ...)
    picture: NDArray[np.float32]  # (H, W, 4): the fitted material by the model, without highlights
    notes: tuple[str, ...]  # one sentence each


def fit(start: Scene, target: Target, starts: int = STARTS, seed: int = 0, quiet: bool | None = None) -> Fit:
    """Fit the material of `start`, which is also the first of `starts` starts for each kind of thickness.

    The others are a Latin hypercube over the bounds (McKay, Beckman and Conover 1979). Equal arguments give equal
    numbers. `quiet`: no progress bar (None: where there is no terminal). `BadInput` where there is nothing to fit.
    """
    kinds = dict.fromkeys((start.material.thickness, *KINDS))
    tries: list[Try] = []
    bases = {kind: basis(start.replace({"material.thickness": kind})) for kind in kinds}
    with tqdm(total=len(kinds) * starts, desc="fit", unit="start", disable=quiet, leave=False) as bar:
        for kind, made in bases.items():
            problem = problem_of(made, target)
            for found in searched(problem, start.material.model_copy(update={"thickness": kind}), starts, seed):
                tries.append(found)
                bar.update()
    least = min(found.rmse for found in tries)
    best = next(found for found in tries if found.rmse <= least * (1 + SAME))
    return concluded(problem_of(bases[best.end.thickness], target), target, best, start, tuple(tries))


def problem_of(made: Basis, target: Target) -> Problem:
    """What is to be matched; `BadInput` where there is nothing."""
    if target.image.shape != (*made.covered.shape, 4):
        raise BadInput(f"target: its shape {target.image.shape} is not the scene's; make it at the scene's size")
    wanted = target.image[made.covered][:, :3].astype(np.float64)
    if not (np.isfinite(wanted).all() and (wanted > 0).any()):
        raise BadInput("target: is black where the object is, or not finite, so there is nothing to fit; give it light")
    return Problem(made, wanted)


def searched(problem: Problem, start: Material, starts: int, seed: int) -> Iterator[Try]:
    """From `start` and from all over the bounds."""
    low, high = bounds()
    anywhere = qmc.LatinHypercube(len(low), rng=seed).random(max(starts - 1, 0))
    for point in (point_of(problem, start), *(low + (high - low) * anywhere)):
        ended = search(problem, point)
        yield tried(problem, point, ended, start)


def tried(problem: Problem, point: Floats, ended: Ended, start: Material) -> Try:
    """A search in the words of the scene."""
    from_, to = (fitted(problem, at, start) for at in (point, ended.point))
    return Try(from_, to, ended.rmse, ended.evaluations, ended.converged, ended.point)


def concluded(problem: Problem, target: Target, best: Try, start: Scene, tries: tuple[Try, ...]) -> Fit:
    """The best try as a scene; searched on with Kb held where nothing tells it from wb."""
    material, notes = best.end, []
    if spread_of_weight(problem, material, problem.linear(best.point).residual) > max(material.diffuse):
        first = start.material.model_copy(update={"thickness": material.thickness})
        problem = replace(problem, tint=first.diffuse_weight / (max(first.diffuse) or 1.0))
        material = fitted(problem, search(problem, best.point).point, first)
        notes.append("The target does not tell diffuse_weight from colour and backlight; it was left as it began.")
    notes += told(at_bounds(material))
    scene = start.replace({f"material.{name}": getattr(material, name) for name in Material.model_fields})
    noise = target.standard_error[problem.basis.covered].astype(np.float64)
    errors = standard_errors(problem, material, noise, target.correlation)
    return Fit(scene, start, tries, errors, problem.basis.picture(material), tuple(notes))


def told(bound: set[str]) -> list[str]:
    """A sentence for each parameter that the target does not hold."""
    if "backlight" in bound:
        bound = bound - {"backlight", "thickness_exponent", "diffuse_weight"}
        nothing = ["The target shows no backlight; thickness_exponent and diffuse_weight were left as they began."]
    else:
        nothing = []
    return nothing + [f"material.{name} ended at its bound." for name in sorted(bound)]
