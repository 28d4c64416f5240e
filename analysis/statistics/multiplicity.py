"""p values adjusted for the number of tests they belong to."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import pandas as pd
from statsmodels.stats.multitest import multipletests

from analysis.statistics.undefined import require_columns

Method = Literal["holm", "fdr"]
LIBRARY: dict[Method, str] = {"holm": "holm", "fdr": "fdr_bh"}


@dataclass(frozen=True)
class Adjusted:
    """p values adjusted over a family of tests.

    `method`: "holm" (Holm 1979, Scand. J. Statist. 6: the chance of any false finding stays below alpha) or "fdr"
    (Benjamini & Hochberg 1995, J. R. Statist. Soc. B 57: the expected share of false ones among the findings does).
    `p`: the column of p values; `family`: a column whose equal values make a family, all rows being one without it.
    Returns the frame with a column `p_holm` or `p_fdr`. A test without a value (NaN) has none adjusted, and is not
    counted. Agrees with R `p.adjust(p, "holm")` and `p.adjust(p, "BH")`.
    """

    p: str
    method: Method
    family: str | None = None

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The frame, one row per test, with the adjusted column at its end."""
        require_columns(frame, self.p, *([self.family] if self.family else []))
        adjusted = pd.Series(np.nan, index=frame.index, dtype=float)
        tested = frame[frame[self.p].notna()]
        families = tested.groupby(self.family, sort=False) if self.family else [("", tested)]
        for _, tests in families:
            if len(tests):
                adjusted[tests.index] = multipletests(tests[self.p], method=LIBRARY[self.method])[1]
        return frame.assign(**{f"p_{self.method}": adjusted})
