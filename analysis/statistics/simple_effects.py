"""What an interaction consists of: the effect of each factor at each combination of levels of the others."""

from dataclasses import dataclass
from itertools import product

import numpy as np
import pandas as pd

from analysis.statistics.anova import RepeatedMeasuresAnova
from analysis.statistics.factorial import cell_name, crossed_table
from analysis.statistics.multiplicity import Adjusted
from analysis.statistics.undefined import Undefined

SHOWN = ("F", "df1", "df2", "epsilon_gg", "p_gg", "partial_eta_squared", "partial_ci_low", "partial_ci_high")


@dataclass(frozen=True)
class SimpleEffects:
    """Repeated-measures analyses of parts of a crossed design, each with its own error term (Keppel & Wickens 2004,
    chapter 18), Greenhouse-Geisser corrected and adjusted together by Holm.

    Returns a row per factor and combination of the others' levels: `factor, at` ("light 0.8"), `F, df1, df2,
    epsilon_gg, p_gg, p_holm, partial_eta_squared, partial_ci_low, partial_ci_high` (90%), `n`, `reason` (a sentence
    where F has no value: NaN there, and not counted by Holm). People without a rating of every combination are left
    out of all. Agrees with R `emmeans::joint_tests(model, by = ...)` on `afex::aov_ez(..., within = factor)` of each
    part. Raises `Undefined` as `FactorialAnova` does.
    """

    value: str
    within: tuple[str, ...]
    subject: str

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per participant and combination of levels."""
        wide, _, _ = crossed_table(frame, self.value, self.within, self.subject)
        cells = wide.columns
        assert isinstance(cells, pd.MultiIndex)
        rows = []
        for factor in self.within:
            others = [name for name in self.within if name != factor]
            for at in product(*(cells.unique(name) for name in others)):
                held = dict(zip(others, at, strict=True))
                chosen = np.all([cells.get_level_values(name) == level for name, level in held.items()], axis=0)
                levels = cells[chosen].get_level_values(factor)
                part = pd.DataFrame(wide.to_numpy()[:, chosen], index=wide.index, columns=levels)
                rows.append({"factor": factor, "at": cell_name(held, tuple(others)), **self.of_part(part, factor)})
        return Adjusted("p_gg", "holm")(pd.DataFrame(rows)).assign(n=len(wide))

    def of_part(self, wide: pd.DataFrame, factor: str) -> dict[str, object]:
        """The analysis of one people x levels part, or why it has none."""
        try:
            row = RepeatedMeasuresAnova(self.value, factor, self.subject).of_table(wide - wide.iloc[0, 0])
        except Undefined as reason:
            return {**dict.fromkeys(SHOWN, np.nan), "reason": str(reason)}
        return {**{name: row[name] for name in SHOWN}, "reason": ""}
