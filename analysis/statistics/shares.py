"""How the answers to one question are spread, group by group."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from analysis.labels import levels_of


@dataclass(frozen=True)
class AnswerShares:
    """The share of every answer 1..`scale` in each group: R's `prop.table(table(group, value), 1)`.

    Called on a long frame with columns `value` (whole numbers in 1..scale; missing ones are not counted) and `group`;
    returns `group, answer, n, share` with a row for each group and answer, those that nobody gave included. A group
    without answers is left out. The groups stand in the order of a categorical column, else in natural order.
    """

    value: str
    group: str
    scale: int

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """One row per group and answer; `share` is of the group's answers, 0..1."""
        given = frame[[self.group, self.value]].dropna()
        groups, answers = levels_of(given[self.group]), np.arange(1, self.scale + 1)
        counts = given.groupby([self.group, self.value], observed=True).size()
        table = counts.unstack(fill_value=0).reindex(index=groups, columns=answers, fill_value=0)
        n = table.to_numpy(dtype=np.int64)
        return pd.DataFrame(
            {
                "group": np.repeat(np.asarray(groups, dtype=object), self.scale),
                "answer": np.tile(answers, len(groups)),
                "n": n.ravel(),
                "share": (n / n.sum(axis=1, keepdims=True)).ravel(),
            }
        )
