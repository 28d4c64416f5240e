"""The noise of a path-traced target: how its channels go together, and what it alone makes of the errors.

A path carries all three channels, so they err together: correlations of .33 (red and blue of ketchup) to .96 were
measured. Taken for independent, marble's colours come out three times as uncertain as they are.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.accuracy.errors import Errors, errors
from fakesss.offline.path_tracing import PathTraced, path_traced
from fakesss.offline.settings import ROUND, PathTracing
from fakesss.scene import Scene

Floats = NDArray[np.float64]

SEEDS = 1 << 32
FEWEST = 2 * ROUND  # samples a pixel


def again(scene: Scene, settings: PathTracing, samples: int, quiet: bool | None) -> NDArray[np.float32]:
    """The picture (H, W, 4) with other random numbers and that many samples, without highlights."""
    changes = {"seed": (settings.seed + 1) % SEEDS, "samples": samples, "noise": None, "highlights": False}
    return path_traced(scene, settings.model_copy(update=changes), quiet=quiet).image


def correlation(picture: NDArray[Any], target: NDArray[Any]) -> Floats:
    """Of the channels' noise (3, 3), from two pictures of independent numbers, each (H, W, 4); all pixels as one.

    A channel without noise goes with no other.
    """
    difference = (picture[..., :3].astype(np.float64) - target[..., :3])[target[..., 3] > 0]
    together = difference.T @ difference
    spread = np.sqrt(np.diag(together))
    spread[spread == 0] = 1.0
    found = together / np.outer(spread, spread)
    np.fill_diagonal(found, 1.0)
    return np.asarray(found)


def floor(traced: PathTraced, correlation: Floats, near: Errors, seed: int) -> dict[str, Any]:
    """What the target's own noise sets: errors of it with as much noise again; and RMSE with noise taken out.

    The noise added is Gaussian, which a path tracer's is not in single pixels. RMSE is that of the standard errors.
    """
    values, vectors = np.linalg.eigh(correlation)
    root = vectors * np.sqrt(np.maximum(values, 0))
    noisy, generator = traced.image.copy(), np.random.default_rng(seed)
    noisy[..., :3] += generator.standard_normal(traced.standard_error.shape) @ root.T * traced.standard_error
    alike, covered = errors(noisy, traced.image), traced.image[..., 3] > 0
    rmse = float(np.sqrt((traced.standard_error[covered].astype(np.float64) ** 2).mean()))
    misfit = float(np.sqrt(max(near.rmse**2 - rmse**2, 0.0)))
    facts = {"relative": traced.provenance["noise"], "samples": traced.samples, "misfit_rmse": misfit}
    return {"rmse": rmse, "max_abs": alike.max_abs, "flip": alike.flip, **facts, "correlation": correlation.tolist()}
