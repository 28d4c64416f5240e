"""statsmodels' proportional odds model on counted rows, with exact derivatives: a million ratings are few of them."""

import numpy as np
from statsmodels.miscmodels.ordinal_model import OrderedModel

from analysis.statistics.undefined import Floats


class CountedOrderedModel(OrderedModel):  # type: ignore[misc]  # statsmodels has no types
    """`OrderedModel(distr="logit")` of distinct rows, each with how often it occurs.

    Parameters as there: coefficients, the first threshold, logarithms of the steps to the next. statsmodels takes its
    derivatives by differences, which leaves standard errors four digits and costs a likelihood for each pair of
    parameters; here they are written out: McCullagh (1980), Regression models for ordinal data, appendix.
    """

    def __init__(self, endog: "np.ndarray[tuple[int], np.dtype[np.int64]]", exog: Floats, counts: Floats) -> None:
        """`endog`: 0..K-1, every value used; `exog`: rows x coefficients; `counts`: of each row."""
        super().__init__(endog, exog, distr="logit")
        self.counts = counts

    def loglike(self, params: Floats) -> float:
        """Log-likelihood of all ratings."""
        return float(self.counts @ self.loglikeobs(params))

    def score(self, params: Floats) -> Floats:
        """Its gradient."""
        total: Floats = self.counts @ self.score_obs(params)
        return total

    def score_obs(self, params: Floats) -> Floats:
        """Gradient of one rating of each row."""
        upper, lower, *_ = self.slopes(params)
        above, below = self.threshold_columns()
        by_threshold = above * upper[:, None] + below * lower[:, None]
        return np.hstack([-self.exog * (upper + lower)[:, None], by_threshold @ self.steps(params)])

    def hessian(self, params: Floats) -> Floats:
        """Second derivatives of the log-likelihood."""
        plain = self.plain_hessian(params)
        turn = self.turn(params)
        hessian: Floats = turn.T @ plain @ turn
        upper, lower, *_ = self.slopes(params)
        above, below = self.threshold_columns()
        gradient = self.counts @ (above * upper[:, None] + below * lower[:, None])
        later = np.cumsum(gradient[::-1])[::-1]  # a step moves every threshold behind it
        places = np.arange(self.k_vars + 1, len(params))
        hessian[places, places] += np.exp(params[places]) * later[1:]
        return hessian

    def plain_hessian(self, params: Floats) -> Floats:
        """Second derivatives by coefficients and thresholds themselves."""
        *_, upper2, lower2, mixed = self.slopes(params)
        above, below = self.threshold_columns()
        up, down = np.hstack([-self.exog, above]), np.hstack([-self.exog, below])
        cross = up.T @ (down * (self.counts * mixed)[:, None])
        own = up.T @ (up * (self.counts * upper2)[:, None]) + down.T @ (down * (self.counts * lower2)[:, None])
        hessian: Floats = own + cross + cross.T
        return hessian

    def slopes(self, params: Floats) -> tuple[Floats, ...]:
        """Derivatives of log(F(upp) - F(low)) by upp, low, twice upp, twice low, and both."""
        low, upp = self._bounds(params)
        p = self.prob(low, upp)
        at_low, at_upp = self.pdf(low), self.pdf(upp)
        # the logistic density's own slope: f' = f (1 - 2 F)
        upper, lower = at_upp / p, -at_low / p
        upper2 = upper * (1 - 2 * self.cdf(upp)) - upper**2
        lower2 = lower * (1 - 2 * self.cdf(low)) - lower**2
        return upper, lower, upper2, lower2, -upper * lower

    def threshold_columns(self) -> tuple[Floats, Floats]:
        """Which threshold closes a row's category above, and which below; none at the ends."""
        padded = np.vstack([np.zeros(self.k_levels - 1), np.eye(self.k_levels - 1), np.zeros(self.k_levels - 1)])
        return padded[self.endog + 1], padded[self.endog]

    def steps(self, params: Floats) -> Floats:
        """Derivatives of the thresholds (rows) by the first one and the logarithms of the steps."""
        widths = np.concatenate([[1.0], np.exp(params[self.k_vars + 1 :])])
        steps: Floats = np.tril(np.ones((len(widths), len(widths)))) * widths
        return steps

    def turn(self, params: Floats) -> Floats:
        """Derivatives of coefficients and thresholds by the parameters."""
        turn = np.eye(len(params))
        turn[self.k_vars :, self.k_vars :] = self.steps(params)
        return turn

    @property
    def start_params(self) -> Floats:
        """No effects, and the thresholds of all ratings together."""
        share = np.bincount(self.endog, weights=self.counts).cumsum() / self.counts.sum()
        thresholds = self.transform_reverse_threshold_params(self.distr.ppf(share))
        return np.concatenate([np.zeros(self.k_vars), thresholds])
