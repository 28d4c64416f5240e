"""Tukey's honestly significant difference, between independent samples or within the same people."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from analysis.statistics.anova import OneWayAnova, RepeatedMeasuresAnova
from analysis.statistics.studentized_range import studentized_quantile, tail_probabilities
from analysis.statistics.undefined import complete_table, groups_of, residuals


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
        names = np.empty(len(samples), dtype=object)
        names[:] = list(samples)
        means, sizes = np.array(list(samples.values()), dtype=float).T
        a, b = np.triu_indices(len(samples), 1)
        error = np.sqrt(mse / 2 * (1 / sizes[a] + 1 / sizes[b]))
        difference = means[a] - means[b]
        q = np.abs(difference) / error
        half, at_05, at_01 = (studentized_quantile(x, len(samples), df) * error for x in (self.confidence, 0.95, 0.99))
        return pd.DataFrame(
            {
                "a": names[a],
                "b": names[b],
                "difference": difference,
                "q": q,
                "p": tail_probabilities(q, len(samples), df),
                "ci_low": difference - half,
                "ci_high": difference + half,
                "critical_05": at_05,
                "critical_01": at_01,
                "df": df,
                "mse": mse,
            }
        )

    def error_term(self, frame: pd.DataFrame) -> tuple[dict[object, tuple[float, int]], float, int]:
        """Level -> (mean, n), mean square of error, its degrees of freedom."""
        if self.subject is None:
            anova = OneWayAnova(self.value, self.group)(frame).iloc[0]
            parts = groups_of(frame, self.value, self.group)
            samples = {level: (float(part.mean()), len(part)) for level, part in parts.items()}
            return samples, float(anova["ms_within"]), int(anova["df2"])
        wide, _ = complete_table(frame, self.value, self.group, self.subject)
        RepeatedMeasuresAnova(self.value, self.group, self.subject).refuse_no_residual(wide)
        df = (wide.shape[0] - 1) * (wide.shape[1] - 1)
        mse = float((residuals(wide.to_numpy()) ** 2).sum()) / df
        return {level: (float(wide[level].mean()), len(wide)) for level in wide.columns}, mse, df
