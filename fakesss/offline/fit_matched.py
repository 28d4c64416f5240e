"""How long path tracing takes to be as near to the target as the fitted shader is.

Pictures of other random numbers and 8, 16, 32, ... samples a pixel are compared with the target just as the shader's
picture is, so the noise of the target counts in both. Where the two FLIP agree, samples are interpolated on logarithmic
axes; seconds are those of so many samples as measured in turn with the shader's picture (`fit_times`).
"""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from itertools import count, takewhile
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.accuracy.errors import errors
from fakesss.offline.fit_noise import FEWEST, again
from fakesss.offline.fit_times import Times
from fakesss.offline.settings import PathTracing
from fakesss.scene import Scene


@dataclass(frozen=True)
class Rung:
    """A path-traced picture of few samples."""

    samples: int
    flip: float


def matched(
    scene: Scene, settings: PathTracing, target: NDArray[Any], flip: float, times: Times, quiet: bool | None
) -> dict[str, Any]:
    """The number of samples at which path tracing is `flip` from `target`, and what they take; JSON.

    `bound`: "" where it was found, "at most" where the fewest samples do already, "at least" where as many as
    the target has do not.
    """
    rungs = []
    for rung in ladder(scene, settings, target, quiet):
        rungs.append(rung)
        if rung.flip <= flip:
            break
    samples, bound = where(rungs, flip)
    curve = [{**asdict(rung), "seconds": rung.samples * times.sample} for rung in rungs]
    taken = {"seconds": samples * times.sample, "speed_up": samples * times.ratio}
    return {"samples": samples, "bound": bound, **taken, "curve": curve}


def where(rungs: list[Rung], flip: float) -> tuple[float, str]:
    """Samples at which the last two rungs pass `flip`, and the bound that it is if they do not."""
    last = rungs[-1]
    if last.flip > flip:
        return float(last.samples), "at least"
    if len(rungs) == 1:
        return float(last.samples), "at most"
    before = rungs[-2]
    share = np.log(before.flip / flip) / np.log(before.flip / last.flip)
    return float(before.samples * (last.samples / before.samples) ** share), ""


def ladder(scene: Scene, settings: PathTracing, target: NDArray[Any], quiet: bool | None) -> Iterator[Rung]:
    """Ever more samples, up to the target's; each rung goes on from the one before."""
    doubled = (FEWEST << number for number in count())
    for samples in (*takewhile(lambda samples: samples < settings.samples, doubled), settings.samples):
        yield Rung(samples, errors(again(scene, settings, samples, quiet), target).flip)
