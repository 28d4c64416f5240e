"""Tail probabilities and quantiles of the studentized range: scipy's, and what to do where they are slow or lost."""

import warnings
from functools import lru_cache

import numpy as np
from numpy.polynomial import Chebyshev
from scipy import integrate, stats

from analysis.statistics.undefined import Floats

P_FLOOR = 1e-10  # scipy's studentized range is accurate to about 1e-11 absolutely: smaller p values are bounds
FEW = 300  # distinct q that scipy is asked for one by one
NODES = 200
HEAVY_DF, HEAVY_Q = 10, 100.0  # with less than 10 df scipy loses the tail from a q of some hundreds on
NEGLIGIBLE = 1e-9
WIDEST = 40.0  # no range of standard normal values is wider: its probability underflows


def tail_probabilities(q: Floats, k: int, df: float) -> Floats:
    """P(Q > q) of k means and df degrees of freedom for each of `q` >= 0: R's `ptukey(q, k, df, lower.tail = FALSE)`.

    Never below 1e-10, which is a bound: smaller values stand for "less than that". Within 1e-10 of scipy's own double
    integral, which is asked once for each distinct q; of more than 300 distinct ones, 200 values are interpolated. Two
    means: Student's t, exactly. df below 10 and q above 100: `heavy_tail`.
    """
    distinct, place = np.unique(q, return_inverse=True)
    if k == 2:
        p = 2 * stats.t.sf(distinct / np.sqrt(2), df)
    elif len(distinct) > FEW and df >= HEAVY_DF:
        p = interpolated(distinct, k, df)
    else:
        p = ascending(distinct, k, df)
    return np.asarray(np.maximum(p, P_FLOOR)[place], dtype=np.float64)


def ascending(q: Floats, k: int, df: float) -> Floats:
    """One by one; once a tail is below the floor, those of larger q are too."""
    p = np.zeros(len(q))
    for index, each in enumerate(q):
        p[index] = tail(float(each), k, df)
        if p[index] <= P_FLOOR:
            break
    return p


def tail(q: float, k: int, df: float) -> float:
    """P(Q > q) of one q."""
    if df < HEAVY_DF and q > HEAVY_Q:
        return heavy_tail(q, k, df)
    return survival(q, k, df)


def survival(q: float, k: int, df: float) -> float:
    """scipy's P(Q > q), without its warning where P(Q <= q) is below 1e-9.

    It asks for that small probability to eleven digits, and of hundreds of means does not always get them. The tail,
    which is 1 less that, is right to better than 1e-9 all the same.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", integrate.IntegrationWarning)
        p = float(stats.studentized_range.sf(q, k, df))
    for said in caught:
        if p < 1 - NEGLIGIBLE:
            warnings.warn_explicit(said.message, said.category, said.filename, said.lineno)
    return p


def heavy_tail(q: float, k: int, df: float) -> float:
    """P(Q > q) as the mean of P(range > x) over x = q s, where s squared is the estimated over the true variance.

    That is the definition (Lund & Lund 1983, AS 190) with x in place of s: however large q is, the range of normal
    values that matters stays the same, whereas scipy 1.17 integrates over s and finds nothing (scipy issue 17832).
    """

    def integrand(x: float) -> float:
        s = x / q
        density = np.sqrt(df) * stats.chi.pdf(s * np.sqrt(df), df)
        return float(stats.studentized_range.sf(x, k, np.inf) * density / q)

    return float(integrate.quad(integrand, 0.0, WIDEST, epsabs=1e-14, epsrel=1e-9, limit=200)[0])


def interpolated(q: Floats, k: int, df: float) -> Floats:
    """By the Chebyshev polynomial through 200 values of scipy's, up to the first q whose tail is below the floor."""
    end = 4.0
    while tail(end, k, df) > P_FLOOR:
        end *= 1.25
    through = Chebyshev.interpolate(
        lambda nodes: np.array([survival(float(each), k, df) for each in nodes]), NODES, domain=[0.0, end]
    )
    return np.asarray(np.where(q < end, through(np.minimum(q, end)), 0.0), dtype=np.float64).clip(0.0, 1.0)


@lru_cache(maxsize=1024)
def studentized_quantile(level: float, k: int, df: float) -> float:
    """q(k, df) at `level`: R's `qtukey(level, k, df)`. Kept, as each takes scipy 70 ms and more."""
    return float(stats.studentized_range.ppf(level, k, df))
