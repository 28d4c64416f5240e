"""What an analysis of variance takes for granted, measured: residuals, equal spread, room at the ends of the scale."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats

from analysis.statistics.undefined import Floats, Undefined, complete_table, groups_of, not_zero, residuals, spreadless

LARGEST = 5000  # residuals; scipy's p of Shapiro and Wilk's test is not accurate for more


@dataclass(frozen=True)
class Residuals:
    """The shape of what levels (and with `subject`, people) leave unexplained.

    Returns one row: `skewness, kurtosis` (excess; both 0 for a normal distribution), `shapiro_w, shapiro_p` (Shapiro &
    Wilk 1965; p is a description: residuals of one person are not independent; NaN above 5,000 residuals), `n`.
    Agrees with R `shapiro.test(residuals(aov(...)))`. Raises `Undefined` where nothing is left, and as the analysis
    does where it has no value.
    """

    value: str
    group: str
    subject: str | None = None

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The row for a long `frame`, one row per rating."""
        left = self.left(frame)
        if left.size < 3 or spreadless(left, frame[self.value].dropna().to_numpy(np.float64)):
            raise Undefined(f"{self.value} by {self.group}: no residual is left whose shape could be described")
        w, p = stats.shapiro(left / np.ptp(left)) if left.size <= LARGEST else (np.nan, np.nan)
        row = {"skewness": float(stats.skew(left)), "kurtosis": float(stats.kurtosis(left))}
        return pd.DataFrame([{**row, "shapiro_w": float(w), "shapiro_p": not_zero(p), "n": left.size}])

    def left(self, frame: pd.DataFrame) -> Floats:
        """All residuals."""
        if self.subject is None:
            return np.concatenate([part - part.mean() for part in groups_of(frame, self.value, self.group).values()])
        wide, _ = complete_table(frame, self.value, self.group, self.subject)
        return residuals(wide.to_numpy()).ravel()


@dataclass(frozen=True)
class EqualSpread:
    """Whether independent samples scatter alike: Levene's test about the medians (Brown & Forsythe 1974).

    Returns one row: `levene_w, df1, df2, p`, `variance_ratio` (largest over smallest variance, infinite where a sample
    does not scatter). Agrees with R `car::leveneTest(center = median)`. Raises `Undefined` where no sample scatters
    about its median in its own way.
    """

    value: str
    group: str

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The row for a long `frame`, one row per rating."""
        parts = list(groups_of(frame, self.value, self.group).values())
        distances = [np.abs(part - np.median(part)) for part in parts]
        if all(spreadless(part, np.concatenate(parts)) for part in distances):
            raise Undefined(
                f"{self.value} by {self.group}: no sample varies in its scatter, so Levene's test has no value"
            )
        found = stats.levene(*parts, center="median")
        variances = [float(part.var(ddof=1)) for part in parts]
        ratio = max(variances) / min(variances) if min(variances) > 0 else np.inf
        df = {"df1": len(parts) - 1, "df2": sum(map(len, parts)) - len(parts)}
        row = {"levene_w": float(found.statistic), **df, "p": not_zero(found.pvalue), "variance_ratio": ratio}
        return pd.DataFrame([row])


@dataclass(frozen=True)
class ScaleEnds:
    """How many ratings stand at the ends of the scale, where it has no room for more.

    Returns a row per level: `level, floor, ceiling` (shares, 0..1), `n`. `lowest`, `highest`: the ends.
    """

    value: str
    group: str
    lowest: float
    highest: float

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per rating."""
        present = frame.dropna(subset=[self.value, self.group])
        by_level = present.assign(
            floor=present[self.value] <= self.lowest, ceiling=present[self.value] >= self.highest
        ).groupby(self.group, sort=False, observed=True)
        table = by_level[["floor", "ceiling"]].mean().assign(n=by_level.size())
        return table.rename_axis("level").reset_index()
