"""Do all coefficients of a term vanish? Wald's joint test from estimates and their covariance."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from scipy import stats

from analysis.statistics.design_matrix import Coding, Term
from analysis.statistics.undefined import Floats, Undefined, not_zero


def wald_tests(coding: Coding, beta: Floats, covariance: Floats, title: str) -> pd.DataFrame:
    """A row per term: `term, chi2, df, F, df2, p`. p is that of chi2, which takes the covariance as known; F and df2
    are NaN until `clustered` or `against` give them. `Undefined` where the covariance is singular."""
    entries = []
    for term in coding.terms:
        chi2, df = joint_chi2(term, beta, covariance, title), len(beta[term.columns])
        entries.append({"term": term.name, "chi2": chi2, "df": df, "F": np.nan, "df2": np.nan})
    table = pd.DataFrame(entries)
    return table.assign(p=not_zero(stats.chi2.sf(table["chi2"], table["df"])))


def joint_chi2(term: Term, beta: Floats, covariance: Floats, title: str) -> float:
    """Wald's statistic of one term's coefficients."""
    part, block = beta[term.columns], covariance[term.columns, term.columns]
    spread = np.sqrt(np.diag(block))
    singular = f"{title}: the covariance of the estimates is singular, so {term.name} has no test"
    if not np.isfinite(spread).all() or spread.min() <= 0:
        raise Undefined(singular)
    correlation = block / np.outer(spread, spread)
    if np.linalg.matrix_rank(correlation, tol=1e-9, hermitian=True) < len(part):
        raise Undefined(singular)
    scaled = part / spread
    return float(scaled @ np.linalg.solve(correlation, scaled))


def refuse_few(coding: Coding, title: str, unit: str, units: int) -> None:
    """`Undefined` for one cluster, and for a term of as many degrees of freedom as there are clusters, or more."""
    if units < 2:
        raise Undefined(f"{title}: one {unit}; clustered standard errors need at least two")
    for term in coding.terms:
        df = term.columns.stop - term.columns.start
        if units <= df:
            raise Undefined(
                f"{title}: {units} {unit}s for the {df} degrees of freedom of {term.name}; clustered standard errors "
                f"need more {unit}s than that"
            )


def clustered(tests: pd.DataFrame, units: int) -> pd.DataFrame:
    """The tests of coefficients whose errors are clustered: F = (G - q) / ((G - 1) q) chi2 with q and `df2` = G - q.

    G (`units`) clusters make the covariance, so chi2 of q coefficients is Hotelling's T squared, not chi-squared: of 44
    people and 8 coefficients chi2 would find an effect that is not there in 14%. Hotelling (1931), Ann. Math. Stat. 2;
    Pustejovsky & Tipton (2018), J. Bus. Econ. Stat. 36, whose approximate test has these degrees of freedom where
    clusters are alike.
    """
    q = tests["df"]
    return referred(tests, (units - q) / ((units - 1) * q) * tests["chi2"], units - q)


def against(tests: pd.DataFrame, df2: Sequence[int]) -> pd.DataFrame:
    """The tests of estimates whose variance has `df2` degrees of freedom (one for each term): F = chi2 / q."""
    return referred(tests, tests["chi2"] / tests["df"], pd.Series(df2, tests.index))


def referred(tests: pd.DataFrame, f: "pd.Series[float]", df2: "pd.Series[int]") -> pd.DataFrame:
    """The tests with p from F."""
    return tests.assign(F=f, df2=df2.astype(float), p=not_zero(stats.f.sf(f, tests["df"], df2)))
