"""Tukey's honestly significant difference, between independent samples or within the same people."""

from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

import numpy as np
import pandas as pd
from scipy import stats

from analysis.statistics.anova import OneWayAnova, RepeatedMeasuresAnova
from analysis.statistics.undefined import complete_table, groups_of

P_FLOOR = 1e-10  # scipy's studentized range is accurate to about 1e-14 absolutely: smaller p values are bounds


@dataclass(frozen=True)
class TukeyHSD:
    """All pairwise differences of means with familywise p values.

    With `subject`, the error term and degrees of freedom are those of the repeated-measures analysis (the thesis's
    HSD); without it, those of independent samples (Tukey-Kramer where sizes differ). Returns a row per pair: `a, b,
    difference` (mean of a less mean of b), `q, p` (at least 1e-10: a bound below that), `ci_low, ci_high`
    (simultaneous, at `confidence`), `critical_05, critical_01` (unrounded smallest significant |difference|), `df,
    mse`. Agrees with R `TukeyHSD(aov(value ~ group))` without `subject`, and with `ptukey(q, k, df, lower.tail =
    FALSE)` at the repeated-measures error with it. Raises `Undefined` as the analyses do.
    """

    value: str
    group: str
    subject: str | None = None
    confidence: float = 0.95

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per rating."""
        samples, mse, df = self.error_term(frame)
        return pd.DataFrame(
            [self.pair(a, b, samples, mse, df) for a, b in combinations(samples, 2)],
        )

    def error_term(self, frame: pd.DataFrame) -> tuple[dict[object, tuple[float, int]], float, int]:
        """Level -> (mean, n), mean square of error, its degrees of freedom."""
        if self.subject is None:
            anova = OneWayAnova(self.value, self.group)(frame).iloc[0]
            parts = groups_of(frame, self.value, self.group)
            samples = {level: (float(part.mean()), len(part)) for level, part in parts.items()}
            return samples, float(anova["ms_within"]), int(anova["df2"])
        anova = RepeatedMeasuresAnova(self.value, self.group, self.subject)(frame).iloc[0]
        wide, _ = complete_table(frame, self.value, self.group, self.subject)
        samples = {level: (float(wide[level].mean()), len(wide)) for level in wide.columns}
        return samples, float(anova["ms_error"]), int(anova["df2"])

    def pair(
        self, a: object, b: object, samples: dict[object, tuple[float, int]], mse: float, df: int
    ) -> dict[str, object]:
        """The row of one pair."""
        (mean_a, n_a), (mean_b, n_b), k = samples[a], samples[b], len(samples)
        error = float(np.sqrt(mse / 2 * (1 / n_a + 1 / n_b)))
        difference = mean_a - mean_b
        half = studentized_quantile(self.confidence, k, df) * error
        q = abs(difference) / error
        return {
            "a": a,
            "b": b,
            "difference": difference,
            "q": q,
            "p": max(float(stats.studentized_range.sf(q, k, df)), P_FLOOR),
            "ci_low": difference - half,
            "ci_high": difference + half,
            "critical_05": studentized_quantile(0.95, k, df) * error,
            "critical_01": studentized_quantile(0.99, k, df) * error,
            "df": df,
            "mse": mse,
        }


@lru_cache(maxsize=1024)
def studentized_quantile(level: float, k: int, df: float) -> float:
    """q(k, df) at `level`. R: `qtukey(level, k, df)`. Kept, as each takes scipy about 70 ms."""
    return float(stats.studentized_range.ppf(level, k, df))
