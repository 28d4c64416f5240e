"""Do all coefficients of a term vanish? Wald's joint test from estimates and their covariance."""

import sys

import numpy as np
import pandas as pd
from scipy import stats

from analysis.statistics.design_matrix import Coding
from analysis.statistics.undefined import Floats, Undefined


def wald_tests(
    coding: Coding, beta: Floats, covariance: Floats, title: str, unit: str | None, units: int
) -> pd.DataFrame:
    """A row per term: `term, chi2, df, p` of the joint Wald test; `Undefined` where the covariance is singular.

    p is never below the smallest float: smaller values are bounds.
    """
    entries = []
    for term in coding.terms:
        part, block = beta[term.columns], covariance[term.columns, term.columns]
        df = len(part)
        spread = np.sqrt(np.diag(block))
        if not np.isfinite(spread).all() or spread.min() <= 0:
            raise Undefined(f"{title}: the covariance of the estimates is singular, so {term.name} has no test")
        correlation = block / np.outer(spread, spread)
        if np.linalg.matrix_rank(correlation, tol=1e-9, hermitian=True) < df:
            few = f" ({units} {unit}s for {df} degrees of freedom)" if unit and units <= df else ""
            raise Undefined(f"{title}: the covariance of the estimates is singular{few}, so {term.name} has no test")
        scaled = part / spread
        chi2 = float(scaled @ np.linalg.solve(correlation, scaled))
        p = max(float(stats.chi2.sf(chi2, df)), sys.float_info.min)
        entries.append({"term": term.name, "chi2": chi2, "df": df, "p": p})
    return pd.DataFrame(entries)
