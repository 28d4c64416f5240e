"""Confidence intervals of effect sizes from the noncentral F and t distributions."""

import math

import numpy as np
from scipy.optimize import brentq
from scipy.special import nctdtrinc
from scipy.stats import chi2, ncf

from analysis.statistics.undefined import Floats

FAR = 1000.0  # from this |t| on scipy's search takes as long as t is large, and noise beside t no longer matters


def eta_squared_interval(eta_squared: float, df1: float, df2: float, level: float = 0.90) -> tuple[float, float]:
    """Interval of (partial) eta squared: the noncentralities at which the observed F is at the tail quantiles.

    Agrees with R effectsize::F_to_eta2(F, df1, df2, ci = level, alternative = "two.sided"). Not for generalized
    eta squared, which F does not determine (see `analysis.statistics.anova.effect_sizes`). Steiger (2004), Psych.
    Methods 9.
    """
    if eta_squared >= 1:
        return (1.0, 1.0)
    observed = (eta_squared / df1) / ((1 - eta_squared) / df2)
    tail = (1 - level) / 2
    low, high = (noncentrality(observed, df1, df2, quantile) for quantile in (1 - tail, tail))
    return low / (low + df2), high / (high + df2)


def noncentrality(observed: float, df1: float, df2: float, quantile: float) -> float:
    """The noncentrality at which `observed` is the `quantile` of F; 0 where even the central F lies above it."""

    def excess(nc: float) -> float:
        below = float(ncf.cdf(observed, df1, df2, nc))
        # scipy answers NaN far above the observed value, where the probability underflows
        return (0.0 if math.isnan(below) and nc > observed * df1 else below) - quantile

    if observed <= 0 or excess(0.0) <= 0:
        return 0.0
    upper = max(10.0, observed * df1)
    while excess(upper) > 0:
        upper *= 1.5
    return float(brentq(excess, 0.0, upper, xtol=1e-12, rtol=1e-12))


def d_z_interval(d_z: Floats, n: int, level: float = 0.95) -> tuple[Floats, Floats]:
    """Interval of a mean difference over the standard deviation of differences, for each of `d_z` of `n` people.

    The noncentralities at which the observed t = d_z sqrt(n) is at the tail quantiles, over sqrt(n). Limits are right
    to 1 in 100,000 where |t| is at most 100 and to 1 in 10,000 beyond: the library's search ends there. From |t| = 1000
    on the limit for large t, noncentrality = t sqrt(chi-squared / df). Agrees with R effectsize::cohens_d(paired =
    TRUE). Cumming & Finch (2001), Educ. Psych. Measurement 61.
    """
    t, df = np.asarray(d_z, dtype=np.float64) * np.sqrt(n), n - 1
    tail = (1 - level) / 2
    near = np.clip(np.abs(t), 0.0, FAR)
    size = np.sqrt(n) * np.where(t < 0, -1.0, 1.0)
    inner, outer = (
        np.where(np.abs(t) > FAR, np.abs(t) * np.sqrt(chi2.ppf(1 - at, df) / df), nctdtrinc(df, at, near)) / size
        for at in (1 - tail, tail)
    )
    return np.minimum(inner, outer), np.maximum(inner, outer)
