"""One-way analysis of variance: independent samples, and repeated measures of the same people."""

import warnings
from dataclasses import dataclass

import numpy as np
import pandas as pd
import pingouin
from pandas.errors import Pandas4Warning
from scipy import stats
from statsmodels.stats.anova import AnovaRM

from analysis.statistics.effect_size import eta_squared_interval
from analysis.statistics.undefined import Floats, Undefined, complete_table, groups_of, not_zero, residuals

EFFECT_LEVEL = 0.90  # the interval that excludes 0 exactly when a one-sided F test at .05 is significant
ROUNDING = 1e-12  # a residual this small against the total is what float64 leaves of an exact zero


@dataclass(frozen=True)
class OneWayAnova:
    """Fixed-effects one-way analysis of variance of independent samples.

    Returns one row: `F, df1, df2, p, ss_between, ss_within, ms_within, eta_squared, ci_low, ci_high` (90% interval of
    eta squared), `n` (ratings), `k` (levels). Agrees with R `summary(aov(value ~ group))`. Raises `Undefined` with a
    sentence where F has no value (see `analysis.statistics.undefined.groups_of`).
    """

    value: str
    group: str

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per rating."""
        parts = list(groups_of(frame, self.value, self.group).values())
        everything = np.concatenate(parts)
        between = sum(len(part) * (part.mean() - everything.mean()) ** 2 for part in parts)
        within = sum(((part - part.mean()) ** 2).sum() for part in parts)
        df1, df2 = len(parts) - 1, len(everything) - len(parts)
        eta = between / (between + within)
        low, high = eta_squared_interval(eta, df1, df2, EFFECT_LEVEL)
        # scipy.stats.f_oneway loses a digit of F by squaring sums; its p is the same survival function
        f = (between / df1) / (within / df2)
        row = {"F": f, "df1": df1, "df2": df2, "p": not_zero(stats.f.sf(f, df1, df2))}
        row |= {"ss_between": between, "ss_within": within, "ms_within": within / df2}
        row |= {"eta_squared": eta, "ci_low": low, "ci_high": high, "n": len(everything), "k": len(parts)}
        return pd.DataFrame([row])


@dataclass(frozen=True)
class RepeatedMeasuresAnova:
    """One-way repeated-measures analysis of variance with Greenhouse-Geisser and Huynh-Feldt corrections.

    Returns one row: `F, df1, df2, p` (uncorrected), `ss_effect, ss_subject, ss_error, ms_error, epsilon_gg, p_gg,
    epsilon_hf, p_hf, mauchly_w, mauchly_p` (NaN for two levels, where there are no more people than levels, and where
    some comparison of levels is the same in everyone: the test has no meaning), `partial_eta_squared, partial_ci_low,
    partial_ci_high, generalized_eta_squared, ci_low, ci_high` (90% intervals), `n`, `k`, `dropped` (participants
    without a value at every level, "; " between). Agrees with R `afex::aov_ez(subject, value, within = within)`. Raises
    `Undefined` where F has no value.
    """

    value: str
    within: str
    subject: str

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per participant and level."""
        wide, dropped = complete_table(frame, self.value, self.within, self.subject)
        return pd.DataFrame([{**self.of_table(wide), "dropped": "; ".join(dropped)}])

    def of_table(self, wide: pd.DataFrame) -> dict[str, float]:
        """The row, less `dropped`, for a complete people x levels table, centred as `complete_table` does."""
        self.refuse_no_residual(wide)
        table = library_anova(wide)
        effect, error = table.iloc[0], table.iloc[1]
        ss_error = float((residuals(wide.to_numpy()) ** 2).sum())
        ss_subject = float(wide.shape[1] * ((wide.mean(axis=1) - wide.to_numpy().mean()) ** 2).sum())
        df1, df2 = int(effect["DF"]), int(error["DF"])
        row = {"F": float(effect["F"]), "df1": df1, "df2": df2, "p": not_zero(effect["p_unc"])}
        row |= {"ss_effect": float(effect["SS"]), "ss_subject": ss_subject, "ss_error": ss_error}
        row |= {"ms_error": ss_error / df2, **sphericity(wide, effect)}
        row |= effect_sizes(row["ss_effect"], ss_subject, ss_error, df1, df2)
        return row | {"n": len(wide), "k": wide.shape[1]}

    def refuse_no_residual(self, wide: pd.DataFrame) -> None:
        """When every participant shows the same differences there is no error to test them against."""
        left = residuals(wide.to_numpy())
        total = float(((wide - wide.to_numpy().mean()) ** 2).to_numpy().sum())
        if total == 0:
            raise Undefined(f"{self.value} by {self.within}: all ratings are equal, so F has no value")
        if float((left**2).sum()) <= ROUNDING * total:
            raise Undefined(
                f"{self.value} by {self.within}: every {self.subject} shows exactly the same differences, "
                "so there is no error to test them against and F has no value"
            )


def library_anova(wide: pd.DataFrame) -> pd.DataFrame:
    """pingouin's table (effect, error) of a complete subjects x levels table."""
    # numbers for names: the library sorts and groups them many times over
    n, k = wide.shape
    frame = pd.DataFrame({"subject": np.tile(np.arange(n), k), "level": np.repeat(np.arange(k), n)})
    frame["value"] = wide.to_numpy().ravel(order="F")
    if wide.shape == (2, 3):  # pingouin 0.7.0 goes on to Mauchly's test, whose constants are 1/0 just there
        test = AnovaRM(frame, "value", "subject", ["level"]).fit().anova_table.iloc[0]
        between = 2 * float(((wide.mean() - wide.to_numpy().mean()) ** 2).sum())
        effect = {"SS": between, "DF": test["Num DF"], "F": test["F Value"], "p_unc": test["Pr > F"]}
        effect["eps"] = pingouin.epsilon(wide, correction="gg")
        return pd.DataFrame([effect, {"DF": test["Den DF"]}])
    with warnings.catch_warnings():
        # pingouin 0.7.0 calls DataFrame.dropna(inplace=True), which pandas 3.1 announces to remove
        warnings.filterwarnings("ignore", message="The inplace keyword in DataFrame.dropna", category=Pandas4Warning)
        found = pingouin.rm_anova(frame, dv="value", within="level", subject="subject", correction=True, detailed=True)
    return pd.DataFrame(found)


def sphericity(wide: pd.DataFrame, effect: pd.Series) -> dict[str, float]:
    """Both epsilons, the p values they give, and Mauchly's test where it means something.

    `effect`: the first row of `library_anova(wide)`, which has Greenhouse and Geisser's epsilon and Mauchly's test.
    """
    f, df1 = float(effect["F"]), int(effect["DF"])
    df2 = df1 * (len(wide) - 1)
    if wide.shape[1] == 2:
        p = not_zero(stats.f.sf(f, df1, df2))
        return {"epsilon_gg": 1.0, "p_gg": p, "epsilon_hf": 1.0, "p_hf": p, "mauchly_w": np.nan, "mauchly_p": np.nan}
    gg = float(effect["eps"])
    # of as many people as levels, an even spread leaves Huynh and Feldt's fraction nothing to divide by: its limit is 1
    spare = len(wide) - 1 - df1 * gg
    hf = float(pingouin.epsilon(wide, correction="hf")) if spare > ROUNDING else 1.0
    w = p_mauchly = np.nan
    if len(wide) > wide.shape[1] and not is_singular(wide.to_numpy(), float(effect["W_spher"])):
        w, p_mauchly = float(effect["W_spher"]), not_zero(effect["p_spher"])
    corrected = {f"p_{name}": not_zero(stats.f.sf(f, df1 * e, df2 * e)) for name, e in (("gg", gg), ("hf", hf))}
    return {"epsilon_gg": gg, "epsilon_hf": hf, **corrected, "mauchly_w": w, "mauchly_p": p_mauchly}


def is_singular(wide: Floats, w: float) -> bool:
    """Whether some comparison of levels is the same in everyone, so that Mauchly's W is 0 whatever the others do."""
    if w > ROUNDING * np.e:  # W is the product of variances over their mean: one of 0 makes it smaller
        return False
    left = residuals(wide)
    variances = np.linalg.eigvalsh(left.T @ left)  # the smallest belongs to the mean of all levels
    return bool(variances[1] <= ROUNDING * variances[-1])


def effect_sizes(effect: float, subject: float, error: float, df1: int, df2: int) -> dict[str, float]:
    """Partial and generalized eta squared (Olejnik & Algina 2003) with their intervals.

    The interval of partial eta squared is exact. A limit of it names the effect's sum of squares relative to the error;
    put in the place of the observed one, with error and subjects as observed, that gives the limit of generalized eta
    squared. The map rises from 0, so both intervals exclude 0 exactly when the uncorrected F test does.
    """
    partial = effect / (effect + error)
    partial_low, partial_high = eta_squared_interval(partial, df1, df2, EFFECT_LEVEL)
    low, high = (error * limit / (1 - limit) for limit in (partial_low, partial_high))
    return {
        "partial_eta_squared": partial,
        "partial_ci_low": partial_low,
        "partial_ci_high": partial_high,
        "generalized_eta_squared": effect / (effect + subject + error),
        "ci_low": low / (low + subject + error),
        "ci_high": high / (high + subject + error),
    }
