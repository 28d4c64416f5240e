"""The full factorial of a question, tested once for all of its rows."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import pandas as pd

from analysis.crossed import Crossed
from analysis.rows import Row
from analysis.statistics.factorial import FactorialAnova
from analysis.statistics.simple_effects import SimpleEffects
from analysis.statistics.undefined import Undefined


@dataclass(frozen=True)
class Factorial:
    """Ratings of a question by all of its factors. `cells`: a row per person and combination, as `Crossed.frame`."""

    crossed: Crossed
    cells: pd.DataFrame

    @cached_property
    def people(self) -> frozenset[str]:
        """Who rated every combination."""
        count = self.cells.groupby(self.crossed.subject).size()
        return frozenset(count.index[count == len({cell for _, cell in self.crossed.cells})])

    @cached_property
    def tests(self) -> dict[str, dict[str, Any]] | str:
        """Effect ("A × B") -> its row of `FactorialAnova`, or the sentence why none has a value."""
        anova = FactorialAnova(self.crossed.value, self.crossed.names, self.crossed.subject)
        try:
            records = anova(self.cells).to_dict("records")
        except Undefined as reason:
            return str(reason)
        return {record["effect"]: {str(name): value for name, value in record.items()} for record in records}

    def effect(self, name: str) -> dict[str, Any] | str:
        """A main effect or an interaction, or the sentence why it has no value."""
        if isinstance(self.tests, str):
            return self.tests
        return self.tests[name]["reason"] or self.tests[name]

    def simple(self, factors: tuple[str, ...]) -> pd.DataFrame:
        """Simple effects of an interaction of `factors`, averaged over the levels of the others."""
        subject, value = self.crossed.subject, self.crossed.value
        part = self.cells[self.cells[subject].isin(self.people)]
        if factors != self.crossed.names:
            part = part.groupby([subject, *factors], observed=True)[value].mean().reset_index()
        return SimpleEffects(value, factors, subject)(part)


def factorials_of(rows: Sequence[Row], ratings: pd.DataFrame) -> dict[str, Factorial]:
    """Question -> its full factorial, of the questions that have one."""
    crossed = {row.question: row.crossed for row in rows if row.crossed is not None}
    return {question: Factorial(whole, whole.frame(ratings)) for question, whole in crossed.items()}
