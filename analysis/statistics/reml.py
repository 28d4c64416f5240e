"""The REML estimate of a mixed model with random intercepts: statsmodels' likelihood, a search that can end at 0."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize
from statsmodels.regression.linear_model import OLS
from statsmodels.regression.mixed_linear_model import MixedLM, VCSpec

from analysis.statistics.undefined import ROUNDING, Floats, Undefined

Codes = npt.NDArray[np.int64]
STARTS = (0.1, 0.4, 1.5)  # standard deviations of random terms, in those of the residual
LEAST = 1e-4  # the search's lower bound of them: statsmodels divides by the variance
NOTHING = 1e-3  # below it a term holds less than a millionth of the variance: it is 0
SINGULAR = "factors, people and pictures leave no residual or cannot be told apart, so the model has no estimate"
FLAT = 1e-5  # slope of the log-likelihood for each rating at its maximum: statsmodels' own limit


@dataclass(frozen=True)
class Estimate:
    """Fixed effects, their covariance (X' V^-1 X)^-1, and variances: of each random term fitted, and of the residual.

    `dropped`: terms whose variance was 0, fitted without.
    """

    effects: Floats
    covariance: Floats
    variances: Mapping[str, float]
    residual: float
    dropped: tuple[str, ...]


def estimate(title: str, values: Floats, fixed: Floats, random: Mapping[str, Codes]) -> Estimate:
    """The REML estimate for `values`, `fixed` (ratings x effects) and `random` (name -> whose each rating is, from 0).

    A random term whose variance is 0 is dropped, and the model fitted again without it. Values are centred and scaled
    first: limits are then those of variances near 1. Raises `Undefined` where there is nothing to estimate.
    """
    centred = values - values[0]
    centred = centred - centred.mean()
    spread = float(np.sqrt(np.mean(centred**2)))
    if spread == 0:
        raise Undefined(f"{title}: all ratings are equal, so there is no variance to divide")
    if len(values) <= fixed.shape[1]:
        raise Undefined(f"{title}: {len(values)} ratings for {fixed.shape[1]} fixed effects; nothing is left over")
    refuse_perfect(title, centred / spread, fixed)
    terms, dropped = dict(random), []
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")  # statsmodels warns of boundaries and of the search: both are looked at here
        try:
            ratios = search(title, centred / spread, fixed, terms)
            while len(ratios) and ratios.min() < NOTHING:
                dropped.append(list(terms)[int(ratios.argmin())])
                del terms[dropped[-1]]
                ratios = search(title, centred / spread, fixed, terms)
            effects, covariance, variances = fitted(centred / spread, fixed, terms, ratios)
        except np.linalg.LinAlgError:
            raise Undefined(f"{title}: {SINGULAR}") from None
    if not (np.isfinite(covariance).all() and np.isfinite(variances).all()):
        raise Undefined(f"{title}: {SINGULAR}")
    if not variances[-1] > 1e-8 * variances.sum():
        raise Undefined(f"{title}: {SINGULAR}")
    scaled = [float(part) for part in variances * spread**2]
    named = dict(zip(terms, scaled[:-1], strict=True))
    return Estimate(effects * spread, covariance * spread**2, named, scaled[-1], tuple(dropped))


def refuse_perfect(title: str, values: Floats, fixed: Floats) -> None:
    """`Undefined` where the fixed effects leave of `values` (of spread 1) what float64 leaves of nothing."""
    basis = np.linalg.qr(fixed)[0]
    if np.sqrt(np.mean((values - basis @ (basis.T @ values)) ** 2)) <= ROUNDING:
        raise Undefined(f"{title}: {SINGULAR}")


class SearchedMixedLM(MixedLM):  # type: ignore[misc]  # statsmodels has no types
    """`MixedLM` whose likelihood can be asked before `fit`, which is where statsmodels sets these."""

    cov_pen = None
    _cov_sing = 0
    _freepat = None


def search(title: str, values: Floats, fixed: Floats, random: Mapping[str, Codes]) -> Floats:
    """Standard deviations of the random terms in those of the residual, at the likelihood's maximum; each >= `LEAST`.

    statsmodels' own search is without bounds, and loses itself where a variance is near 0.
    """
    if not random:
        return np.zeros(0)
    model = model_of(values, fixed, random)
    grid = np.array(np.meshgrid(*[STARTS] * len(random))).reshape(len(random), -1).T
    start = max(grid, key=model.loglike)
    n = len(values)

    def downhill(ratios: Floats) -> float:
        return float(-model.loglike(ratios) / n)

    def slope(ratios: Floats) -> Floats:
        steep: Floats = np.asarray(-model.score(ratios) / n, dtype=np.float64)
        return steep

    # differences of the likelihood cost a tenth of statsmodels' slope: they come near, the slope gives the digits
    near = minimize(downhill, start, jac="3-point", **steps(len(random), 1e-6))
    found = minimize(downhill, near.x, jac=slope, **steps(len(random), 1e-9))
    ratios: Floats = np.asarray(found.x, dtype=np.float64)
    if not (np.abs(slope(ratios)) <= FLAT)[ratios > NOTHING].all():
        raise Undefined(f"{title}: the search for the likelihood's maximum did not converge")
    return ratios


def steps(terms: int, flat: float) -> dict[str, Any]:
    """How L-BFGS-B searches: each standard deviation >= `LEAST`, until the slope is at most `flat`."""
    options = {"ftol": 1e-15, "gtol": flat}
    return {"method": "L-BFGS-B", "bounds": [(LEAST, None)] * terms, "options": options}


def fitted(values: Floats, fixed: Floats, random: Mapping[str, Codes], ratios: Floats) -> tuple[Floats, Floats, Floats]:
    """Fixed effects, their covariance, and the variances, the residual's last, at the maximum that was found."""
    if not random:
        plain = OLS(values, fixed).fit()
        return plain.params, plain.cov_params(), np.array([plain.scale])
    found = model_of(values, fixed, random).fit(reml=True, method="bfgs", gtol=FLAT, start_params=ratios)
    parts = np.diag(found.cov_re) if len(random) == 1 else found.vcomp
    # statsmodels' covariance is that of effects and variances together, which of ratings that lack some is up to 1% too
    # large; its inverse's block of the effects alone is X' V^-1 X
    count = fixed.shape[1]
    precision = np.linalg.inv(np.asarray(found.cov_params()))[:count, :count]
    return np.asarray(found.fe_params), np.linalg.inv(precision), np.array([*parts, found.scale])


def model_of(values: Floats, fixed: Floats, random: Mapping[str, Codes]) -> SearchedMixedLM:
    """One random term: its labels are the groups. Several: crossed variance components within a single group."""
    if len(random) == 1:
        return SearchedMixedLM(values, fixed, groups=next(iter(random.values())))
    columns = [np.eye(int(codes.max()) + 1)[codes] for codes in random.values()]
    names = [[[f"{name}{place}" for place in range(part.shape[1])]] for name, part in zip(random, columns, strict=True)]
    spec = VCSpec(list(random), names, [[part] for part in columns])
    return SearchedMixedLM(values, fixed, groups=np.zeros(len(values)), exog_vc=spec)
