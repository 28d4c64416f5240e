"""Which parameters of the empirical shader come nearest to a given picture, and what is left over.

Least squares in linear radiance over the pixels in which the shader draws the object, without highlights. Every start
is searched to its end with equal weights; the best is then searched again with each pixel weighted by 1 / (noise^2 +
misfit^2), its own standard error and the mean square of what no parameters explain. Where the shader cannot match, that
is nearly equal weights; where it can, it is the weighting of least variance. Pixels that fireflies left noisy count
less, so the loss is a plain square.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

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
LEAST = (
    0.01  # of the mean noise variance: what a pixel's variance counts as at least, or one without noise would be all
)
SAME = 1e-6  # relative difference of errors that is none; of equally good thicknesses the scene's own is kept
STARTS = 8


@dataclass(frozen=True)
class Target:
    """The picture to come near to: linear RGB over the scene's background, and coverage, without highlights."""

    image: NDArray[np.float32]  # (H, W, 4)
    standard_error: NDArray[np.float32]  # (H, W, 3) of the RGB; 0 of a picture without noise


@dataclass(frozen=True)
class Try:
    """One start, with equal weights, and where it ended."""

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
    return polished(bases[best.end.thickness], target, best, start, tuple(tries))


def problem_of(made: Basis, target: Target) -> Problem:
    """Equal weights; what the background adds is taken off the target."""
    if target.image.shape != (*made.covered.shape, 4):
        raise BadInput(f"target: its shape {target.image.shape} is not the scene's; make it at the scene's size")
    wanted = target.image[made.covered][:, :3].astype(np.float64) - made.behind()
    if not (np.isfinite(wanted).all() and (wanted > 0).any()):
        raise BadInput("target: is black where the object is, or not finite, so there is nothing to fit; give it light")
    return Problem(made, wanted, np.ones_like(wanted))


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
    return Try(from_, to, float(np.sqrt(ended.cost)), ended.evaluations, ended.converged, ended.point)


def polished(made: Basis, target: Target, best: Try, start: Scene, tries: tuple[Try, ...]) -> Fit:
    """The best try searched on with the weights of its own residuals; with Kb held where nothing tells it from wb."""
    plain, notes = problem_of(made, target), []
    noise = target.standard_error[made.covered].astype(np.float64)
    problem = replace(plain, weight=weights(plain.linear(best.point).residual, noise))
    first = start.material.model_copy(update={"thickness": best.end.thickness})
    point, material = refined(problem, best.point, first)
    if spread_of_weight(problem, material, problem.linear(point).residual) > max(material.diffuse):
        problem = replace(problem, tint=first.diffuse_weight / (max(first.diffuse) or 1.0))
        point, material = refined(problem, point, first)
        notes.append(
            "The colour is so grey that diffuse_weight cannot be told from backlight; it was left as it began."
        )
    notes += told(at_bounds(material))
    scene = start.replace({f"material.{name}": getattr(material, name) for name in Material.model_fields})
    errors = standard_errors(problem, material, noise)
    return Fit(scene, start, tries, errors, made.picture(material), tuple(notes))


def told(bound: set[str]) -> list[str]:
    """A sentence for each parameter that the target does not hold."""
    if "backlight" in bound:
        bound = bound - {"backlight", "thickness_exponent", "diffuse_weight"}
        nothing = ["The target shows no backlight; thickness_exponent and diffuse_weight were left as they began."]
    else:
        nothing = []
    return nothing + [f"material.{name} ended at its bound." for name in sorted(bound)]


def refined(problem: Problem, point: Floats, start: Material) -> tuple[Floats, Material]:
    """Where one more search ends, and its material."""
    ended = search(problem, point)
    return ended.point, fitted(problem, ended.point, start)


def weights(residual: Floats, noise: Floats) -> Floats:
    """Square roots of the weights (P, 3), 1 on average square; see the top of the file."""
    by_noise = noise**2
    misfit = max(float((residual**2).mean() - by_noise.mean()), LEAST * float(by_noise.mean()))
    if not by_noise.any():
        return np.ones_like(noise)
    weight = 1 / (by_noise + misfit)
    return np.asarray(np.sqrt(weight / weight.mean()))
