"""Confidence intervals of variance-explained effect sizes from the noncentral F distribution."""

import math

from scipy.optimize import brentq
from scipy.stats import ncf


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
