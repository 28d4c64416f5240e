"""Means with confidence intervals, for figures: between people, or within them."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats

from analysis.statistics.undefined import complete_table, require_columns


def first_of(values: "pd.Series[float]") -> float:
    """The first value there is: what others are counted from, so that squares keep their digits."""
    present = values.dropna()
    return float(present.iloc[0]) if len(present) else 0.0


@dataclass(frozen=True)
class MeanIntervals:
    """The mean of each level with its t interval.

    With `subject`, Cousineau's interval with Morey's correction (2008): differences between people are taken out, and
    the variance multiplied by k / (k - 1); agrees with R `Rmisc::summarySEwithin`. Without it, the plain interval of
    each sample. Returns a row per level: `level, mean, ci_low, ci_high, sd, n`. A single value has no interval (NaN).
    """

    value: str
    group: str
    subject: str | None = None
    confidence: float = 0.95

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per rating."""
        require_columns(frame, self.value, self.group)
        if self.subject is None:
            origin = first_of(frame[self.value])
            samples = {
                level: part.dropna() - origin for level, part in frame.groupby(self.group, observed=True)[self.value]
            }
            return pd.DataFrame([self.row(level, part, part, origin) for level, part in samples.items()])
        complete_table(frame, self.value, self.group, self.subject)  # refuses what has no within-person interval
        origin = first_of(frame[self.value])
        present = frame.dropna(subset=[self.value, self.group, self.subject])
        wide = present.pivot(index=self.subject, columns=self.group, values=self.value).dropna() - origin
        k = wide.shape[1]
        centred = wide.sub(wide.mean(axis=1), axis=0) * np.sqrt(k / (k - 1))
        return pd.DataFrame([self.row(level, wide[level], centred[level], origin) for level in wide.columns])

    def row(
        self, level: object, raw: "pd.Series[float]", spread: "pd.Series[float]", origin: float
    ) -> dict[str, object]:
        """Mean (`raw` counts from `origin`) and SD of `raw`, interval from the variance of `spread`."""
        n = len(raw)
        mean = origin + float(raw.mean())
        half = float(stats.t.ppf((1 + self.confidence) / 2, n - 1) * spread.std() / np.sqrt(n)) if n > 1 else np.nan
        return {
            "level": level,
            "mean": mean,
            "ci_low": mean - half,
            "ci_high": mean + half,
            "sd": float(raw.std()) if n > 1 else np.nan,
            "n": n,
        }
