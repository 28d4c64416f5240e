"""How far one picture is from another: in linear radiance, and as an eye may see it on a display.

The second is FLIP by NVIDIA's own package (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, *FLIP:
A Difference Evaluator for Alternating Images*, HPG 2020): 0 for what looks alike to 1 for the greatest difference,
for somebody who sees the two pictures at one place by turns. A rater never does, so FLIP is on the strict side.
What it is *not*: a model of threshold vision. It knows no masking, and its authors state no level that is visible.
"""

from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fakesss.colour import to_8bit
from fakesss.problem import BadInput

# Of a picture shown pixel for pixel on a 24-inch display of 1920 x 1080 (531 mm wide) at 60 cm: an ordinary office
# display. FLIP's own default, 67, is a 4K display at 70 cm, on which errors of a pixel or two are harder to see.
PIXELS_PER_DEGREE = 0.60 * (1920 / 0.531) * np.pi / 180  # 37.9

# Of CIELAB units: what observers just told apart (Mahy, Van Eycken and Oosterlinck, *Evaluation of uniform color
# spaces developed after the adoption of CIELAB and CIELUV*, 1994). One unit, CIELAB's own aim, is stricter.
MAHY = 2.3
# FLIP of two even fields d units apart in lightness: p_t / (p_c c_max) d^q_c (Andersson et al., sec. 4.1.3) with p_t =
# 0.95, p_c = 0.4, q_c = 0.7 and c_max = 41.276. Where edges or points differ too, it is larger.
JUST_NOTICEABLE = 0.95 / (0.4 * 41.276) * MAHY**0.7  # 0.103

EVERYWHERE = 99.9  # percentile, see `Errors.flip_everywhere`

MISSING = "FLIP: its package is not installed; install it with `pip install 'fakesss[offline]'`"


@dataclass(frozen=True)
class Errors:
    """Of a picture against a reference, over the pixels that either of them covers."""

    rmse: float  # root mean square over pixels and channels, linear radiance
    max_abs: float  # largest absolute difference of any channel, linear radiance
    flip: float  # mean FLIP, 0..1
    flip_map: NDArray[np.float32]  # (H, W), 0..1, also beside the object, where an eye blurs differences to
    # FLIP that 99.9% of the pixels do not exceed: "everywhere". Not the maximum, which is that of one pixel: it grows
    # with the number of pixels, and one silhouette sample in 100,000 that falls on the other side decides it
    flip_everywhere: float


def errors(picture: NDArray[Any], reference: NDArray[Any]) -> Errors:
    """How far `picture` is from `reference`: linear RGB and coverage (H, W, 4) of the same size, as `render` gives."""
    if picture.shape != reference.shape or picture.ndim != 3 or picture.shape[2] != 4:
        raise BadInput(
            f"picture: its shape {picture.shape} is not the reference's {reference.shape}; "
            "compare pictures (height, width, 4) of one size"
        )
    covered = (picture[..., 3] > 0) | (reference[..., 3] > 0)
    if not covered.any():
        raise BadInput("picture: nothing of the object is seen, so there is nothing to compare; move the camera")
    difference = (picture[..., :3].astype(np.float64) - reference[..., :3])[covered]
    seen = flip_map(picture, reference)
    return Errors(
        rmse=float(np.sqrt((difference**2).mean())),
        max_abs=float(np.abs(difference).max()),
        flip=float(seen[covered].mean(dtype=np.float64)),
        flip_map=seen,
        flip_everywhere=float(np.percentile(seen[covered], EVERYWHERE)),
    )


def check_flip() -> None:
    """`BadInput` where FLIP's package is missing; called before slow work, not after it."""
    if find_spec("flip_evaluator") is None:
        raise BadInput(MISSING)


def flip_map(picture: NDArray[Any], reference: NDArray[Any]) -> NDArray[np.float32]:
    """FLIP (H, W), 0..1, of linear RGB (H, W, 3 or more) as a display shows it: in 8-bit sRGB."""
    try:
        from flip_evaluator import evaluate  # optional: only accuracy is measured with it
    except ImportError:
        raise BadInput(MISSING) from None
    shown, wanted = (np.ascontiguousarray(to_8bit(one[..., :3]) / np.float32(255)) for one in (picture, reference))
    settings = {"ppd": float(PIXELS_PER_DEGREE)}
    found: NDArray[np.float32] = evaluate(wanted, shown, "LDR", True, False, False, settings)[0]
    return found[..., 0]
