"""How long path tracing takes to be as near to the target as the fitted shader is.

Pictures of other random numbers and 8, 16, 32, ... samples a pixel are compared with the target just as the shader's
picture is, so the noise of the target counts in both. Where the two FLIP agree, samples are interpolated on logarithmic
axes and seconds in proportion.
"""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.accuracy.errors import errors
from fakesss.offline.path_tracing import path_traced
from fakesss.offline.settings import ROUND, PathTracing
from fakesss.scene import Scene

SEEDS = 1 << 32


@dataclass(frozen=True)
class Rung:
    """A path-traced picture of few samples."""

    samples: int
    seconds: float
    flip: float


def matched(
    scene: Scene, settings: PathTracing, target: NDArray[Any], flip: float, quiet: bool | None
) -> dict[str, Any]:
    """The number of samples at which path tracing is `flip` from `target`, and the seconds they take; JSON.

    `bound`: "" where it was found, "at most" where the fewest samples do already, "at least" where as many as
    the target has do not.
    """
    rungs = []
    for rung in ladder(scene, settings, target, quiet):
        rungs.append(rung)
        if rung.flip <= flip:
            break
    last = rungs[-1]
    if last.flip > flip or len(rungs) == 1:
        found = {"samples": float(last.samples), "seconds": last.seconds}
        return {**found, "bound": "at least" if last.flip > flip else "at most", "curve": [asdict(r) for r in rungs]}
    before = rungs[-2]
    share = np.log(before.flip / flip) / np.log(before.flip / last.flip)
    samples = float(before.samples * (last.samples / before.samples) ** share)
    seconds = last.seconds * samples / last.samples
    return {"samples": samples, "seconds": seconds, "bound": "", "curve": [asdict(r) for r in rungs]}


def ladder(scene: Scene, settings: PathTracing, target: NDArray[Any], quiet: bool | None) -> Iterator[Rung]:
    """Ever more samples, up to the target's; each rung goes on from the one before."""
    samples = 2 * ROUND
    while samples <= settings.samples:
        changes = {"seed": (settings.seed + 1) % SEEDS, "samples": samples, "noise": None, "highlights": False}
        traced = path_traced(scene, settings.model_copy(update=changes), quiet=quiet)
        yield Rung(samples, traced.seconds, errors(traced.image, target).flip)
        samples *= 2
