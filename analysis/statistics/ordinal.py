"""Ratings as ordered answers, not as numbers: the proportional odds model."""

import warnings
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy import sparse, stats

from analysis.statistics.design_matrix import Coding, coding_of, refuse_empty_cells
from analysis.statistics.proportional_odds import CountedOrderedModel
from analysis.statistics.separation import separation
from analysis.statistics.undefined import Floats, Undefined, require_columns
from analysis.statistics.wald import clustered, refuse_few, wald_tests

MOST_ANSWERS = 50
MOST_WORK = 1.5e9  # distinct rows times parameters squared: half a minute for the Newton steps of one model
LARGEST_EFFECT = 30.0  # log odds; nothing that was not separated comes near


@dataclass(frozen=True)
class OrdinalFit:
    """A fitted model. `tests`: a row per factor and interaction (`term, chi2, df, F, df2, p`; F is
    NaN without a cluster). `odds_ratios`: a row per level
    but the first (`factor, level, against, log_odds, se, odds_ratio, ci_low, ci_high`). `thresholds`: between
    neighbouring answers, at every factor's first level (`threshold, value`). `clusters`: 0 without a cluster."""

    tests: pd.DataFrame
    odds_ratios: pd.DataFrame
    thresholds: pd.DataFrame
    n: int
    clusters: int
    log_likelihood: float
    cautions: tuple[str, ...]


@dataclass(frozen=True)
class OrdinalRegression:
    """Proportional odds (cumulative logit) regression of `value` on categorical `factors`.

    logit P(answer <= j) = threshold_j - effects: an odds ratio above 1 says that higher answers are likelier than at
    the factor's first level, by the same ratio at every step of the scale. `interactions`: with all of them; an odds
    ratio is then at the plain mean over the other factors' levels. `cluster`: whose answers hang together (the
    participant); standard errors are then clustered (G / (G - 1), no other correction), else those of independent
    answers. `confidence`: of the intervals. Tests are Wald's: of G clusters referred to F with q and G - q degrees of
    freedom (`analysis.statistics.wald.clustered`), and intervals to t with G - 1. Agrees with R `ordinal::clm`,
    `MASS::polr` and `sandwich::vcovCL`. McCullagh (1980). Not a mixed model: odds ratios are those of the population's
    answers, smaller than one person's. Answers nobody gave are no step of the scale. Missing values are left out.

    `__call__` returns `fit(frame).tests`. Raises `Undefined` where all ratings are equal, levels are separated, a
    cell is empty, there are no more clusters than a test has degrees of freedom, or the model would take too long.
    """

    value: str
    factors: tuple[str, ...]
    cluster: str | None = None
    interactions: bool = False
    confidence: float = 0.95

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The joint Wald test of every term for a long `frame`, one row per rating."""
        return self.fit(frame).tests

    def fit(self, frame: pd.DataFrame) -> OrdinalFit:
        """Tests, odds ratios and thresholds."""
        used = [self.value, *self.factors, *([self.cluster] if self.cluster else [])]
        require_columns(frame, *used)
        present = frame[used].dropna()
        coding = coding_of(present, self.value, self.factors, self.interactions)
        answers, category = np.unique(present[self.value].to_numpy(float), return_inverse=True)
        self.refuse_scale(answers)
        code = present.groupby(list(self.factors), observed=True, sort=True).ngroup().to_numpy() * len(answers)
        kept, row = np.unique(code + category, return_inverse=True)
        first = np.unique(code + category, return_index=True)[1]
        rows = present.take(first)
        refuse_empty_cells(coding, rows.drop_duplicates(list(self.factors)), self.value)
        matrix = coding.matrix(rows)
        self.refuse_work(len(kept), matrix.shape[1] + len(answers) - 1)
        if self.cluster is not None:
            refuse_few(coding, self.title, self.cluster, present[self.cluster].nunique())
        if why := separation(rows, self.factors, category[first], matrix):
            raise Undefined(f"{self.title}: {why}, so an odds ratio is infinite and the model has no estimate")
        counts = np.bincount(row).astype(float)
        model = CountedOrderedModel(category[first], matrix, counts)
        params = self.estimate(model)
        covariance, clusters = self.covariance(model, params, row, present)
        return self.described(coding, model, params, covariance, answers, clusters)

    @property
    def title(self) -> str:
        """rating by thickness and backlight."""
        return f"{self.value} by {' and '.join(self.factors)}"

    def refuse_scale(self, answers: Floats) -> None:
        """One answer orders nothing; very many are a measurement."""
        if len(answers) < 2:
            raise Undefined(f"{self.title}: all ratings are equal, so there is no order to model")
        if len(answers) > MOST_ANSWERS:
            raise Undefined(
                f"{self.title}: {len(answers)} different answers; ordinal regression is for scales of at most "
                f"{MOST_ANSWERS} steps"
            )

    def refuse_work(self, rows: int, parameters: int) -> None:
        """Too many levels."""
        if rows * parameters**2 > MOST_WORK:
            raise Undefined(
                f"{self.title}: {parameters} parameters of {rows} distinct rows would take minutes; ordinal regression "
                "is not fitted; compare fewer pictures"
            )

    def estimate(self, model: CountedOrderedModel) -> Floats:
        """The maximum of the likelihood: Newton's steps, where they fail BFGS."""
        for method in ("newton", "bfgs"):
            with warnings.catch_warnings(), np.errstate(all="ignore"):
                warnings.simplefilter("ignore")  # a failure shows in what is checked below
                try:
                    found = model.fit(method=method, maxiter=200, disp=0)
                    params: Floats = np.asarray(found.params, dtype=np.float64)
                    flat = np.abs(model.score(params)).max() <= 1e-4 * model.counts.sum() ** 0.5
                except np.linalg.LinAlgError:
                    continue
            if np.isfinite(params).all() and flat and np.abs(params[: model.k_vars]).max() < LARGEST_EFFECT:
                return params
        raise Undefined(f"{self.title}: the search for the likelihood's maximum did not converge")

    def covariance(
        self, model: CountedOrderedModel, params: Floats, row: npt.NDArray[np.int64], present: pd.DataFrame
    ) -> tuple[Floats, int]:
        """Of the coefficients, and the number of clusters. `row`: which distinct row each rating is."""
        try:
            bread: Floats = np.linalg.inv(-model.hessian(params)).astype(np.float64)
        except np.linalg.LinAlgError:
            raise Undefined(
                f"{self.title}: the covariance of the estimates is singular, so nothing is tested"
            ) from None
        if self.cluster is None:
            return bread[: model.k_vars, : model.k_vars], 0
        who = present.groupby(self.cluster, observed=True, sort=False).ngroup().to_numpy()
        clusters = int(who.max()) + 1
        times = sparse.csr_array((np.ones(len(row)), (who, row)), shape=(clusters, len(model.counts)))
        scores: Floats = np.asarray(times @ model.score_obs(params))
        whole: Floats = bread @ (scores.T @ scores) @ bread * (clusters / (clusters - 1))
        return whole[: model.k_vars, : model.k_vars], clusters

    def described(
        self,
        coding: Coding,
        model: CountedOrderedModel,
        params: Floats,
        covariance: Floats,
        answers: Floats,
        clusters: int,
    ) -> OrdinalFit:
        """The fit in tables."""
        beta = params[: model.k_vars]
        tests = wald_tests(coding, beta, covariance, self.title)
        if self.cluster is not None:
            tests = clustered(tests, clusters)
        thresholds = model.transform_threshold_params(params)[1:-1] - float(coding.at_first @ beta)
        steps = [f"{low:g}|{high:g}" for low, high in pairwise(answers)]
        cautions = []
        if 0 < clusters < len(params):
            cautions.append(
                f"{clusters} {self.cluster}s for {len(params)} parameters; clustered standard errors are too small then"
            )
        return OrdinalFit(
            tests,
            self.odds_ratios(coding, beta, covariance, clusters),
            pd.DataFrame({"threshold": steps, "value": thresholds}),
            int(model.counts.sum()),
            clusters,
            model.loglike(params),
            tuple(cautions),
        )

    def odds_ratios(self, coding: Coding, beta: Floats, covariance: Floats, clusters: int) -> pd.DataFrame:
        """Each level against its factor's first."""
        reach = float(stats.t.ppf((1 + self.confidence) / 2, clusters - 1 if clusters else np.inf))
        entries = []
        for factor, levels in zip(coding.factors, coding.levels, strict=True):
            contrast = coding.against_first(factor)
            for level, row in zip(levels[1:], contrast, strict=True):
                log_odds, se = float(row @ beta), float(np.sqrt(row @ covariance @ row))
                entry = {"factor": factor, "level": level, "against": levels[0], "log_odds": log_odds, "se": se}
                low, high = np.exp([log_odds - reach * se, log_odds + reach * se])
                entries.append({**entry, "odds_ratio": float(np.exp(log_odds)), "ci_low": low, "ci_high": high})
        return pd.DataFrame(entries)
