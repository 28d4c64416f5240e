"""How fast an error falls as more is spent: the order p of error = c count^-p, by least squares in logarithms."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import linregress
from scipy.stats import t as student

from fakesss.problem import BadInput


@dataclass(frozen=True)
class Order:
    """Of convergence, with its confidence interval; 0.5 is Monte Carlo's in the number of samples."""

    order: float
    ci_low: float
    ci_high: float


def fitted_order(counts: Sequence[float], errors: Sequence[float], confidence: float = 0.95) -> Order:
    """The order at which `errors` fall with `counts` (rays, samples, texels a side, faces, ...), both > 0.

    The interval is Student's, of a straight line's slope (`summary(lm(log(errors) ~ log(counts)))` in R): it tells how
    straight the line is, so three points at least. Counts should reach well below where something else (a bias, the
    reference's own error) holds the error up.
    """
    if len(counts) != len(errors) or len(counts) < 3 or min(*counts, *errors) <= 0:
        raise BadInput(f"order of convergence: counts {list(counts)}, errors {list(errors)}; give 3 pairs > 0 or more")
    line = linregress(np.log(counts), np.log(errors))
    width = student.ppf((1 + confidence) / 2, len(counts) - 2) * line.stderr
    return Order(float(-line.slope), float(-line.slope - width), float(-line.slope + width))
