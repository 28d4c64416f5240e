"""How much of what we see lies in the picture, how much in the person, and how much in neither."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from analysis.statistics.mixed import codes_of, refuse_work, repeats, variance_table
from analysis.statistics.reml import estimate
from analysis.statistics.undefined import Undefined, require_columns


@dataclass(frozen=True)
class VarianceComponents:
    """Shares of the variance of `value` between people, between pictures, and in neither (crossed, no fixed effects).

    Returns a row for `participant`, `picture` and "residual": `term, variance, share`. REML: where everyone rated every
    picture once these are the mean squares' estimates, and the picture's share is ICC(A,1). A variance below 0 is 0.
    Agrees with R `lme4::lmer(value ~ 1 + (1 | participant) + (1 | picture))`. Raises `Undefined` where people or
    pictures cannot be told from the residual, all ratings are equal, or the model would take too long.
    """

    value: str
    participant: str
    picture: str

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per rating."""
        require_columns(frame, self.value, self.participant, self.picture)
        present = frame[[self.value, self.participant, self.picture]].dropna()
        title = f"variance of {self.value}"
        random = {}
        for name in (self.participant, self.picture):
            random[name] = codes_of(present[name])
            if not repeats(random[name]):
                raise Undefined(f"{title}: {name}s cannot be told from the residual; several must have several ratings")
        refuse_work(title, len(present), 1, random)
        found = estimate(title, present[self.value].to_numpy(float), np.ones((len(present), 1)), random)
        return variance_table(found, (self.participant, self.picture))
