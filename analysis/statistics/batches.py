"""The tests of the report for thousands of studies at once, from means and covariances: for power, not for a report.

The public objects take one study at some ten milliseconds; simulation needs microseconds. Each function says which of
them it agrees with; tests/analysis/test_batches.py holds the p values equal to 1e-9.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import special
from scipy.linalg import helmert

from analysis.statistics.anova import ROUNDING
from analysis.statistics.undefined import Floats


@dataclass(frozen=True)
class Moments:
    """What the tests need of a batch of studies: `mean` (studies, samples), `covariance` (studies, samples, samples).

    `people`: how many answers each mean is of, n >= 2. The covariance has n - 1 in its denominator.
    """

    people: int
    mean: Floats
    covariance: Floats

    @classmethod
    def of(cls, answers: npt.NDArray[np.floating[Any]]) -> "Moments":
        """From answers of shape (people, studies, samples)."""
        mean = answers.mean(axis=0, dtype=np.float64)
        centred = np.ascontiguousarray((answers - mean).transpose(1, 2, 0))
        return cls(len(answers), mean, centred @ centred.transpose(0, 2, 1) / (len(answers) - 1))

    def combined(self, weights: Floats) -> "Moments":
        """Of weighted sums of the samples. `weights`: (samples, sums)."""
        return Moments(self.people, self.mean @ weights, weights.T @ self.covariance @ weights)

    def chosen(self, samples: npt.NDArray[np.intp]) -> "Moments":
        """Of other samples in each study. `samples`: (studies, how many), their places."""
        studies = np.arange(len(samples))[:, None]
        covariance = self.covariance[studies[:, :, None], samples[:, :, None], samples[:, None, :]]
        return Moments(self.people, self.mean[studies, samples], covariance)


def repeated_p(levels: Moments, contrasts: Floats | None = None) -> Floats:
    """p of a repeated-measures effect with Greenhouse and Geisser's correction, (studies,); NaN without a residual.

    `contrasts`: (levels, df1), orthonormal columns; without them the levels are compared with each other. Agrees with
    `RepeatedMeasuresAnova` and `FactorialAnova` (`p_gg`).
    """
    count = levels.mean.shape[1]
    scores = levels.combined(helmert(count).T if contrasts is None else contrasts)
    df1, n = scores.mean.shape[1], levels.people
    trace = np.trace(scores.covariance, axis1=1, axis2=2)
    effect = n * (scores.mean**2).sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        f = effect / trace
        # Greenhouse & Geisser 1959, from the covariance of orthonormal contrasts
        epsilon = trace**2 / (df1 * (scores.covariance**2).sum(axis=(1, 2)))
        p = special.fdtrc(df1 * epsilon, df1 * (n - 1) * epsilon, f)
    spread = (n - 1) * np.trace(levels.covariance, axis1=1, axis2=2)
    spread += n * ((levels.mean - levels.mean.mean(axis=1, keepdims=True)) ** 2).sum(axis=1)
    return np.where((n - 1) * trace <= ROUNDING * spread, np.nan, p)


def independent_p(pictures: Moments, samples: tuple[tuple[int, ...], ...]) -> Floats:
    """p of a one-way analysis of independent samples, (studies,); NaN where nothing varies inside them.

    `samples`: for each its places among `pictures`, whose answers are pooled. Agrees with `OneWayAnova`.
    """
    parts = [sample_of(pictures, list(places)) for places in samples]
    size, mean, squares = (np.stack(column, axis=1) for column in zip(*parts, strict=True))
    total = size.sum(axis=1)
    grand = (size * mean).sum(axis=1) / total
    between = (size * (mean - grand[:, None]) ** 2).sum(axis=1)
    within = squares.sum(axis=1)
    df1, df2 = len(samples) - 1, total - len(samples)
    with np.errstate(invalid="ignore", divide="ignore"):
        p = special.fdtrc(df1, df2, (between / df1) / (within / df2))
    return np.where(within <= ROUNDING * (between + within), np.nan, p)


def sample_of(pictures: Moments, places: list[int]) -> tuple[Floats, Floats, Floats]:
    """Size, mean and sum of squares about the mean, each (studies,), of pictures' answers pooled."""
    n, means = pictures.people, pictures.mean[:, places]
    mean = means.mean(axis=1)
    squares = (n - 1) * pictures.covariance[:, places, places].sum(axis=1)
    squares += n * ((means - mean[:, None]) ** 2).sum(axis=1)
    return np.full(len(means), float(n * len(places))), mean, squares


def paired_equivalence_p(pair: Moments, margin: float) -> Floats:
    """The larger p of two one-sided paired t tests of a difference within (-margin, margin), (studies,).

    `pair`: moments of two samples. NaN where everybody's difference is the same. Agrees with `Equivalence`.
    """
    a, b = pair.covariance[:, 0, 0], pair.covariance[:, 1, 1]
    variance = a + b - 2 * pair.covariance[:, 0, 1]
    p = larger_p(pair.mean[:, 0] - pair.mean[:, 1], margin, variance / pair.people, pair.people - 1)
    return np.where(variance <= ROUNDING * (a + b), np.nan, p)


def welch_equivalence_p(pictures: Moments, a: tuple[int, ...], b: tuple[int, ...], margin: float) -> Floats:
    """As `paired_equivalence_p`, by Welch's t tests of two independent samples.

    `a`, `b`: places of the samples among `pictures`, whose answers are pooled. NaN where nothing varies inside them.
    Agrees with `Equivalence` without a subject.
    """
    (n_a, mean_a, squares_a), (n_b, mean_b, squares_b) = (sample_of(pictures, list(places)) for places in (a, b))
    error_a, error_b = squares_a / (n_a - 1) / n_a, squares_b / (n_b - 1) / n_b
    error = error_a + error_b
    with np.errstate(invalid="ignore", divide="ignore"):
        df = error**2 / (error_a**2 / (n_a - 1) + error_b**2 / (n_b - 1))
    return np.where(error <= 0, np.nan, larger_p(mean_a - mean_b, margin, error, df))


def larger_p(difference: Floats, margin: float, error: Floats, df: Floats | int) -> Floats:
    """Of two one-sided t tests: the one against the nearer margin. `error`: the difference's variance."""
    with np.errstate(invalid="ignore", divide="ignore"):
        p: Floats = special.stdtr(df, (np.abs(difference) - margin) / np.sqrt(error))
    return p
