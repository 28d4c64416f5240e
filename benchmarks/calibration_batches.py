"""The quick tests of the report on thousands of studies at once, for the calibration study.

Answers are (people, studies, samples); what is returned is (studies,), NaN where the public object gives no value.
Where analysis/statistics/batches.py has the test it is called; tests/analysis/test_calibration_batches.py holds every
number here equal to that of the public object to 1e-9.
"""

import numpy as np
from scipy import special, stats
from scipy.linalg import helmert

from analysis.statistics.anova import ROUNDING
from analysis.statistics.batches import Moments, independent_p, paired_equivalence_p, repeated_p, welch_equivalence_p
from analysis.statistics.studentized_range import studentized_quantile
from analysis.statistics.undefined import Floats

ALPHA = 0.05
LEVEL = 0.95


def held(where: Floats, p: Floats) -> Floats:
    """1.0 where a claim held and 0.0 where not; NaN where `p` is."""
    return np.where(np.isnan(p), np.nan, where)


def rejects(p: Floats) -> Floats:
    """Whether each study's test says that something differs."""
    return held(p < ALPHA, p)


def no_effect_between(answers: Floats, truth: Floats) -> dict[str, Floats]:
    """Independent samples of one population whose mean is `truth[0]`."""
    pictures = Moments.of(answers)
    n, _, k = answers.shape
    q = range_of_independent(pictures)
    low, high = mean_interval(pictures)
    return {
        "one-way F": rejects(independent_p(pictures, tuple((place,) for place in range(k)))),
        "Tukey, independent samples, any pair": held(q > studentized_quantile(LEVEL, k, k * (n - 1)), q),
        "95% CI of a mean, between people": held((low <= truth[0]) & (truth[0] <= high), q),
    }


def no_effect_within(answers: Floats) -> dict[str, Floats]:
    """The same people, all pictures alike in the mean."""
    levels = Moments.of(answers)
    n, _, k = answers.shape
    plain, huynh = uncorrected_p(levels), huynh_feldt_p(levels)
    q = range_of_repeated(levels)
    return {
        "repeated-measures F, uncorrected": rejects(plain),
        "repeated-measures F, Greenhouse-Geisser": rejects(repeated_p(levels)),
        "repeated-measures F, Huynh-Feldt": rejects(huynh),
        "Friedman": rejects(friedman_p(answers)),
        "paired t tests with Holm, any pair": rejects(smallest_holm_p(levels)),
        "Tukey, repeated measures, any pair": held(q > studentized_quantile(LEVEL, k, (k - 1) * (n - 1)), q),
    }


def effect_between(answers: Floats, truth: Floats) -> dict[str, Floats]:
    """Independent samples of unlike means: do the intervals hold `truth`, the samples' population means?"""
    n, _, k = answers.shape
    q = range_of_independent(Moments.of(answers), truth)
    return {
        "95% CIs of Tukey, independent samples, all pairs": held(q <= studentized_quantile(LEVEL, k, k * (n - 1)), q)
    }


def effect_within(answers: Floats, truth: Floats) -> dict[str, Floats]:
    """The same people, pictures of unlike means."""
    levels = Moments.of(answers)
    n, _, k = answers.shape
    q = range_of_repeated(levels, truth)
    off = levels.mean - truth
    apart, pair = np.abs(off[:, 0] - off[:, 1]), half_of_pair(levels)
    halves = halves_within(levels)
    return {
        "95% CI of a paired difference": held(apart <= pair, q),
        "95% CIs of Tukey, repeated measures, all pairs": held(
            q <= studentized_quantile(LEVEL, k, (k - 1) * (n - 1)), q
        ),
        "95% CI of Cousineau and Morey, of the picture's own mean": held(np.abs(off[:, 0]) <= halves[:, 0], q),
        "95% CI of Cousineau and Morey times √2, of a difference": held(
            apart <= np.sqrt(2) * halves[:, :2].mean(axis=1), q
        ),
    }


def crossed(answers: Floats) -> dict[str, Floats]:
    """Six pictures as a 2 x 3 factorial: the interaction."""
    p = repeated_p(Moments.of(answers), np.kron(helmert(2).T, helmert(3).T))
    return {"2 x 3 interaction within people, Greenhouse-Geisser": rejects(p)}


def at_the_margin(answers: Floats, truth: Floats, independent: bool) -> dict[str, Floats]:
    """Two pictures exactly one margin apart: calling them equivalent is an error."""
    pair, margin = Moments.of(answers), float(abs(truth[1] - truth[0]))
    if independent:
        return {"TOST at the margin, Welch": rejects(welch_equivalence_p(pair, (0,), (1,), margin))}
    return {"TOST at the margin, paired": rejects(paired_equivalence_p(pair, margin))}


def picked(answers: Floats) -> dict[str, Floats]:
    """The last picture against that of the others which was rated highest in the same study."""
    p = picked_p(Moments.of(answers))
    return {"the best of ours, picked by its mean, against a control": rejects(p)}


def picked_p(levels: Moments) -> Floats:
    """p of the repeated-measures test of the picked best and the last picture."""
    best = levels.mean[:, :-1].argmax(axis=1)
    last = np.full_like(best, levels.mean.shape[1] - 1)
    return repeated_p(levels.chosen(np.column_stack([best, last])))


def error_of(levels: Moments) -> tuple[Floats, Floats]:
    """Mean square of the effect and of error of a repeated-measures analysis; error is NaN where there is none."""
    k = levels.mean.shape[1]
    scores = levels.combined(helmert(k).T)
    effect = levels.people * (scores.mean**2).sum(axis=1) / (k - 1)
    error = np.trace(scores.covariance, axis1=1, axis2=2) / (k - 1)
    total = np.trace(levels.covariance, axis1=1, axis2=2) + effect
    return effect, np.where(error <= ROUNDING * total, np.nan, error)


def uncorrected_p(levels: Moments, epsilon: Floats | float = 1.0) -> Floats:
    """p of a repeated-measures effect, its degrees of freedom times `epsilon`."""
    effect, error = error_of(levels)
    df1 = levels.mean.shape[1] - 1
    return np.asarray(special.fdtrc(df1 * epsilon, df1 * (levels.people - 1) * epsilon, effect / error))


def huynh_feldt_p(levels: Moments) -> Floats:
    """p with Huynh and Feldt's epsilon (1976), at most 1."""
    n, df1 = levels.people, levels.mean.shape[1] - 1
    covariance = levels.combined(helmert(df1 + 1).T).covariance
    squares = (covariance**2).sum(axis=(1, 2))
    with np.errstate(invalid="ignore", divide="ignore"):
        gg = np.trace(covariance, axis1=1, axis2=2) ** 2 / (df1 * squares)
        epsilon = (n * df1 * gg - 2) / (df1 * (n - 1 - df1 * gg))
    return uncorrected_p(levels, np.minimum(epsilon, 1.0))


def friedman_p(answers: Floats) -> Floats:
    """p of Friedman's test, corrected for ties: (k - 1) times the ranks' sum of squares between pictures over all."""
    k = answers.shape[2]
    ranks = stats.rankdata(answers, axis=2) - (k + 1) / 2
    with np.errstate(invalid="ignore"):
        chi2 = (k - 1) * (ranks.sum(axis=0) ** 2).sum(axis=1) / (ranks**2).sum(axis=(0, 2))
    return np.asarray(special.chdtrc(k - 1, chi2))


def smallest_holm_p(levels: Moments) -> Floats:
    """The smallest adjusted p of all pairs' t tests; pairs without spread are not counted."""
    a, b = np.triu_indices(levels.mean.shape[1], 1)
    c = levels.covariance
    variance = c[:, a, a] + c[:, b, b] - 2 * c[:, a, b]
    none = variance <= ROUNDING * (c[:, a, a] + c[:, b, b])
    with np.errstate(invalid="ignore", divide="ignore"):
        t = np.abs(levels.mean[:, a] - levels.mean[:, b]) / np.sqrt(variance / levels.people)
    smallest = np.where(none, 2.0, 2 * special.stdtr(levels.people - 1, -t)).min(axis=1)
    return np.where(none.all(axis=1), np.nan, np.minimum((~none).sum(axis=1) * smallest, 1.0))


def range_of_repeated(levels: Moments, truth: Floats | float = 0.0) -> Floats:
    """The largest q of Tukey's test within people, of means less `truth`: no larger than q(k, df) where all pairs'
    intervals hold it."""
    return np.asarray(np.ptp(levels.mean - truth, axis=1) / np.sqrt(error_of(levels)[1] / levels.people))


def range_of_independent(pictures: Moments, truth: Floats | float = 0.0) -> Floats:
    """The same of independent samples."""
    error = np.diagonal(pictures.covariance, axis1=1, axis2=2).mean(axis=1)
    total = error + pictures.mean.var(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        q = np.ptp(pictures.mean - truth, axis=1) / np.sqrt(error / pictures.people)
    return np.where(error <= ROUNDING * total, np.nan, q)


def half_width(variance: Floats, n: int) -> Floats:
    """Half of the t interval of a mean of `n` values with that variance."""
    return np.asarray(stats.t.ppf((1 + LEVEL) / 2, n - 1) * np.sqrt(variance / n))


def mean_interval(pictures: Moments) -> tuple[Floats, Floats]:
    """The t interval of the first sample's mean."""
    half = half_width(pictures.covariance[:, 0, 0], pictures.people)
    return pictures.mean[:, 0] - half, pictures.mean[:, 0] + half


def half_of_pair(levels: Moments) -> Floats:
    """Half of the t interval of the first two pictures' difference."""
    c = levels.covariance
    return half_width(c[:, 0, 0] + c[:, 1, 1] - 2 * c[:, 0, 1], levels.people)


def halves_within(levels: Moments) -> Floats:
    """Half of each picture's interval, (studies, pictures), by Cousineau with Morey's correction (2008)."""
    k = levels.mean.shape[1]
    centred = levels.combined(np.eye(k) - 1 / k).covariance
    return half_width(np.diagonal(centred, axis1=1, axis2=2) * k / (k - 1), levels.people)
