"""Intel Open Image Denoise over a path-traced picture: a network's guess at what more samples would show.

Optional, and marked wherever it was used: it takes grain for noise, and its error is not the noise that is reported.
"""

from importlib.metadata import version
from importlib.util import find_spec

import numpy as np
from numpy.typing import NDArray

from fakesss.problem import BadInput

Floats = NDArray[np.float64]


def check_denoiser() -> None:
    """`BadInput` with the line that installs it where it is missing; called before the slow work, not after it."""
    if find_spec("pyoidn") is None:
        raise BadInput("path tracing: denoise = true needs Open Image Denoise; pip install 'fakesss[denoise]'")


def denoised(rgb: Floats, coverage: Floats) -> Floats:
    """Linear RGB (H, W, 3) without the grain of few samples; `coverage` (H, W) tells it where the object ends.

    The outline goes in as the "albedo" by which the network knows edges: without it grain is left over.
    """
    import pyoidn  # optional

    outline = np.repeat(coverage[..., None], 3, axis=2).astype(np.float32)
    picture = np.ascontiguousarray(rgb, np.float32)
    return np.asarray(pyoidn.denoise(picture, albedo=outline, hdr=True), np.float64)


def denoiser() -> str:
    """Its name and version, for the provenance."""
    return f"Open Image Denoise, pyoidn {version('pyoidn')}"
