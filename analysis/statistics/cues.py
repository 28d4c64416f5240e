"""Which image cues go along with ratings: every person's slope on a cue, and what cues explain together."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats
from statsmodels.regression.linear_model import OLS
from statsmodels.stats.outliers_influence import variance_inflation_factor

from analysis.statistics.multiplicity import adjusted
from analysis.statistics.undefined import Floats, Undefined, not_zero, require_columns
from fakesss.problem import BadInput

FLAT = 1e-5  # relative range of a cue that is its rounding
SAME = 1e-12  # what float64 leaves of an exact zero


@dataclass(frozen=True)
class CueSlopes:
    """Slope of `value` on each standardised cue within every person, and a t test of the slopes' mean against 0.

    The frame has a row per person and picture; `cues` name columns that are the same in all rows of a picture. A cue is
    standardised over the pictures (n - 1), so a slope is in steps of the scale for a standard deviation between
    pictures. Returns a row per cue: `cue, pictures, r` (correlation with the pictures' means), `p_pictures,
    p_pictures_holm` (of r, with pictures - 2 df; NaN for two pictures or means on a line), `slope, ci_low, ci_high, t,
    df, p, p_holm` (over the cues), `n` (people with a slope). NaN for t and p where all slopes are equal; what is NaN
    is not counted in the adjustment. Agrees with R `cor.test(means, cue)` and `t.test(sapply(split(d, d$person), \\(x)
    coef(lm(rating ~ z, x))[2]))`.

    Lorch & Myers (1990), method 3: `p` asks whether other people would have such slopes on these very pictures, and is
    small for most cues that have nothing to do with the ratings (the fixed effect of Clark 1973); `p_pictures` asks
    whether other pictures would show it. Neither tells of causes: cues that change together share their slopes.

    Raises `Undefined` where a cue is the same in all pictures, or nobody rated two pictures in which it differs.
    """

    value: str
    subject: str
    picture: str
    cues: tuple[str, ...]
    confidence: float = 0.95

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per person and picture."""
        wide, pictures = by_picture(frame, self.value, self.subject, self.picture, self.cues)
        table = pd.DataFrame([self.row(cue, wide, standardised(pictures[cue])) for cue in self.cues])
        for p in ("p", "p_pictures"):
            table[f"{p}_holm"] = adjusted(table[p], "holm")
        first = ["cue", "pictures", "r", "p_pictures", "p_pictures_holm"]
        return table[[*first, "slope", "ci_low", "ci_high", "t", "df", "p", "p_holm", "n"]]

    def row(self, cue: str, wide: pd.DataFrame, z: Floats) -> dict[str, object]:
        """One cue, not yet adjusted."""
        slopes = person_slopes(wide.to_numpy(), z)
        if len(slopes) < 2:
            raise Undefined(
                f"{self.value} by {cue}: {len(slopes)} {self.subject}s rated pictures in which it differs; a test of "
                "slopes needs at least two"
            )
        row = {"cue": cue, "pictures": len(z), "slope": float(slopes.mean()), "n": len(slopes)}
        row |= dict(zip(("r", "p_pictures"), correlation(np.asarray(wide.mean(), dtype=np.float64), z), strict=True))
        row |= dict.fromkeys(("t", "p", "ci_low", "ci_high"), np.nan) | {"df": len(slopes) - 1}
        if np.ptp(slopes) <= SAME * np.abs(slopes).max():
            return row
        found = stats.ttest_1samp(slopes, 0.0)
        low, high = found.confidence_interval(self.confidence)
        return row | {
            "t": float(found.statistic),
            "p": not_zero(found.pvalue),
            "ci_low": float(low),
            "ci_high": float(high),
        }


@dataclass(frozen=True)
class CueRegression:
    """Ordinary least squares of all ratings on all standardised `cues` at once, with errors clustered by person.

    Returns a row per cue: `cue, slope` (what a standard deviation adds when the others stay), `se, ci_low, ci_high, t,
    df` (people - 1), `p, vif` (variance inflation over the pictures), `n` (people), `pictures`. Agrees with Stata
    `regress ..., vce(cluster person)` and R `sandwich::vcovCL(type = "HC1")`. Raises `Undefined` where there are fewer
    pictures than cues + 2, a cue is the same in all pictures, nothing is left as residual, or one person is all there
    is.
    """

    value: str
    subject: str
    picture: str
    cues: tuple[str, ...]
    confidence: float = 0.95

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per person and picture."""
        wide, pictures = by_picture(frame, self.value, self.subject, self.picture, self.cues)
        refuse_few(self.value, len(pictures), len(self.cues))
        if len(wide) < 2:
            raise Undefined(f"{self.value}: one {self.subject} is no sample; errors are clustered by {self.subject}")
        z = np.column_stack([standardised(pictures[cue]) for cue in self.cues])
        y = wide.to_numpy().ravel()
        answered = ~np.isnan(y)
        design = np.column_stack([np.ones(len(y)), np.tile(z, (len(wide), 1))])[answered]
        people = np.repeat(np.arange(len(wide)), len(pictures))[answered]
        y = y[answered]
        if float(np.ptp(y)) == 0:
            raise Undefined(f"{self.value}: all ratings are equal, so there is nothing to explain")
        fit = OLS(y, design).fit(cov_type="cluster", cov_kwds={"groups": people}, use_t=True)
        if fit.ssr <= SAME * fit.centered_tss:
            raise Undefined(f"{self.value}: the cues leave no residual, so there is no error to test them against")
        intervals = fit.conf_int(1 - self.confidence)[1:]
        columns = {"cue": self.cues, "slope": fit.params[1:], "se": fit.bse[1:]}
        columns |= {"ci_low": intervals[:, 0], "ci_high": intervals[:, 1], "t": fit.tvalues[1:], "df": len(wide) - 1}
        columns |= {"p": not_zero(fit.pvalues[1:]), "vif": inflation(z), "n": len(wide), "pictures": len(pictures)}
        return pd.DataFrame(columns)


@dataclass(frozen=True)
class ExplainedMeans:
    """Share of the variance between the pictures' mean ratings that `predictors` (numbers, linear) explain.

    The frame has a row per person and picture. Returns one row: `predictors` (how many), `pictures, r2, r2_adjusted,
    F, df1, df2, p`. Agrees with R `summary(lm(means ~ ...))`. Raises `Undefined` where there are fewer pictures than
    predictors + 2, all means are equal, or a predictor is the same in all pictures.
    """

    value: str
    subject: str
    picture: str
    predictors: tuple[str, ...]

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The row for a long `frame`, one row per person and picture."""
        wide, pictures = by_picture(frame, self.value, self.subject, self.picture, self.predictors)
        refuse_few(self.value, len(pictures), len(self.predictors))
        means = np.asarray(wide.mean(), dtype=np.float64)
        if is_flat(means, SAME):
            raise Undefined(f"{self.value}: all pictures have the same mean, so there is nothing to explain")
        z = np.column_stack([standardised(pictures[name]) for name in self.predictors])
        fit = OLS(means, np.column_stack([np.ones(len(z)), z])).fit()
        exact = fit.ssr <= SAME * fit.centered_tss
        row = {"predictors": len(self.predictors), "pictures": len(z), "r2": 1.0 if exact else float(fit.rsquared)}
        row |= {"r2_adjusted": 1.0 if exact else float(fit.rsquared_adj), "F": np.nan if exact else float(fit.fvalue)}
        row |= {"df1": int(fit.df_model), "df2": int(fit.df_resid), "p": np.nan if exact else not_zero(fit.f_pvalue)}
        return pd.DataFrame([row])


def by_picture(
    frame: pd.DataFrame, value: str, subject: str, picture: str, cues: Sequence[str]
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """People x pictures of ratings less the first (NaN: none), and pictures x cues in the same order."""
    require_columns(frame, value, subject, picture, *cues)
    present = frame.dropna(subset=[value])
    twice = present.duplicated([subject, picture])
    if twice.any():
        row = present[twice].iloc[0]
        raise BadInput(f'frame: {subject} "{row[subject]}" has two values of "{row[picture]}"; average them first')
    # less the first value, so that differences keep their digits
    centred = present.assign(**{value: present[value].astype(float) - float(present[value].iloc[0])})
    wide = centred.pivot(index=subject, columns=picture, values=value)
    return wide, present.drop_duplicates(picture).set_index(picture).loc[wide.columns, list(cues)].astype(float)


def standardised(cue: "pd.Series[float]") -> Floats:
    """Mean 0 and standard deviation 1 (n - 1) over the pictures; `Undefined` if it is the same in all."""
    values = np.asarray(cue, dtype=np.float64)
    if is_flat(values):
        raise Undefined(f"{cue.name}: is the same in all pictures, so nothing goes along with it")
    return np.asarray((values - values.mean()) / values.std(ddof=1))


def correlation(means: Floats, z: Floats) -> tuple[float, float]:
    """Pearson's r of the pictures' means and a cue, and its p: NaN where there is none, p also where r is exact."""
    if is_flat(means, SAME):
        return np.nan, np.nan
    found = stats.pearsonr(means, z)
    r = float(found.statistic)
    return r, not_zero(found.pvalue) if len(z) > 2 and abs(r) < 1 - SAME else np.nan


def is_flat(values: Floats, rounding: float = FLAT) -> bool:
    """Whether the values are equal but for a relative rounding."""
    return bool(np.ptp(values) <= rounding * np.abs(values).max()) if len(values) else True


def person_slopes(ratings: Floats, z: Floats) -> Floats:
    """Least-squares slope on `z` of every person (a row; NaN: not rated) who rated pictures in which it differs."""
    rated = ~np.isnan(ratings)
    count = np.maximum(rated.sum(axis=1), 1)[:, None]
    cue = np.where(rated, z - (rated * z).sum(axis=1, keepdims=True) / count, 0.0)
    level = np.where(rated, ratings, 0.0).sum(axis=1, keepdims=True) / count
    spread = (cue**2).sum(axis=1)
    differs = spread > FLAT**2
    slopes = (cue * np.where(rated, ratings - level, 0.0)).sum(axis=1)[differs] / spread[differs]
    return np.asarray(slopes, dtype=np.float64)


def refuse_few(value: str, pictures: int, predictors: int) -> None:
    """With fewer pictures than predictors + 2 any ratings are explained."""
    if pictures < predictors + 2:
        raise Undefined(
            f"{value}: {pictures} pictures for {predictors} predictors; at least {predictors + 2} are needed, or they "
            "explain anything"
        )


def inflation(z: Floats) -> list[float]:
    """Variance inflation factor of every column: 1 / (1 - R^2) of it on the others."""
    with warnings.catch_warnings():
        # statsmodels 0.15 warns of what the factors themselves say
        warnings.filterwarnings("ignore", message="The design matrix is poorly conditioned", category=UserWarning)
        design = np.column_stack([np.ones(len(z)), z])
        return [float(variance_inflation_factor(design, column)) for column in range(1, design.shape[1])]


def correlation_with(cue: Floats, others: Floats) -> float:
    """Multiple correlation, 0..1, of one standardised cue (pictures,) with others (pictures, k)."""
    if not others.shape[1]:
        return 0.0
    fit = OLS(cue, np.column_stack([np.ones(len(cue)), others])).fit()
    return float(np.sqrt(np.clip(fit.rsquared, 0.0, 1.0)))
