"""Factorial analysis of variance within people: main effects and every interaction of two and more factors."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
import pandas as pd
from scipy.linalg import helmert

from analysis.labels import levels_of
from analysis.statistics.anova import ROUNDING, effect_sizes, library_anova, sphericity
from analysis.statistics.undefined import Floats, Undefined, not_zero, require_columns
from fakesss.problem import BadInput

CROSS = " × "
NOTHING = ("F", "p", "epsilon_gg", "p_gg", "epsilon_hf", "p_hf", "mauchly_w", "mauchly_p")
NO_SIZE = ("partial_eta_squared", "partial_ci_low", "partial_ci_high", "generalized_eta_squared", "ci_low", "ci_high")


@dataclass(frozen=True)
class FactorialAnova:
    """Complete within-subject analysis of variance: every person rated every combination of levels.

    Each effect is tested on its own orthonormal contrasts: people x df1 scores, turned into a table of df1 + 1 columns,
    of which pingouin's one-way analysis has the sums of squares, degrees of freedom, F and epsilon of the effect
    (Maxwell & Delaney 2004, chapter 12). Returns a row per effect, main effects first: `effect` ("A", "A × B"),
    `factors` (tuple), `F, df1, df2, ss_effect, ss_error, ms_error, p`, the corrected p values and effect sizes of
    `RepeatedMeasuresAnova`, `n, dropped`. `generalized_eta_squared` has all variation between people and every error
    term in its denominator (Olejnik & Algina 2003, eq. 4, all factors manipulated within). An effect without error has
    NaN and a sentence in `reason`, which is empty elsewhere. Mauchly's p is that of a one-way table of df1 + 1 levels.
    Agrees with R `afex::aov_ez(subject, value, within = within)`, pingouin.rm_anova and statsmodels AnovaRM (whose
    dense design takes the cube of people x cells). Raises `Undefined` where no effect has a value: a combination nobody
    rated, fewer than two complete people, all ratings equal. Not for designs with factors between people.
    """

    value: str
    within: tuple[str, ...]
    subject: str

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per participant and combination of levels."""
        wide, shape, dropped = crossed_table(frame, self.value, self.within, self.subject)
        ratings = wide.to_numpy()
        total = float(((ratings - ratings.mean()) ** 2).sum())
        if total == 0:
            raise Undefined(f"{self.where}: all ratings are equal, so F has no value")
        between = float(ratings.shape[1] * ((ratings.mean(axis=1) - ratings.mean()) ** 2).sum())
        scores = {effect: ratings @ contrasts_of(effect, shape) for effect in effects_of(len(shape))}
        errors = {effect: float(((own - own.mean(axis=0)) ** 2).sum()) for effect, own in scores.items()}
        rows = []
        for effect, own in scores.items():
            names = tuple(self.within[place] for place in effect)
            others = between + sum(errors.values()) - errors[effect]
            rows.append({"effect": CROSS.join(names), "factors": names, **self.effect(own, errors[effect], others)})
        return pd.DataFrame(rows).assign(n=len(wide), dropped="; ".join(dropped))

    @property
    def where(self) -> str:
        """What is analysed, for sentences."""
        return f"{self.value} by {CROSS.join(self.within)}"

    def effect(self, scores: Floats, ss_error: float, others: float) -> dict[str, object]:
        """One effect from its people x df1 contrast scores. `others`: variation of people and of the other errors."""
        n, df1 = scores.shape
        df2 = df1 * (n - 1)
        ss_effect = float(n * (scores.mean(axis=0) ** 2).sum())
        row = {"df1": df1, "df2": df2, "ss_effect": ss_effect, "ss_error": ss_error, "ms_error": ss_error / df2}
        if ss_error <= ROUNDING * (ss_effect + ss_error + others):
            why = f"{self.where}: every {self.subject} shows exactly the same effect, so F has no value"
            return {**row, **dict.fromkeys((*NOTHING, *NO_SIZE), np.nan), "reason": why}
        table = pd.DataFrame(scores @ helmert(df1 + 1))
        found = library_anova(table).iloc[0]
        sizes = effect_sizes(ss_effect, others, ss_error, df1, df2)
        row = {"F": float(found["F"]), **row, "p": not_zero(found["p_unc"]), **sphericity(table, found)}
        return {**row, **sizes, "reason": ""}


def effects_of(count: int) -> Iterator[tuple[int, ...]]:
    """Main effects, then interactions of two, of three and so on, as places among `count` factors."""
    for order in range(1, count + 1):
        yield from combinations(range(count), order)


def contrasts_of(effect: tuple[int, ...], shape: tuple[int, ...]) -> Floats:
    """Cells x df1: the orthonormal contrasts of an effect, for cells in the order of `itertools.product`."""
    matrix: Floats = np.ones((1, 1))
    for place, levels in enumerate(shape):
        part = helmert(levels).T if place in effect else np.full((levels, 1), levels**-0.5)
        matrix = np.asarray(np.kron(matrix, part), dtype=np.float64)
    return matrix


def crossed_table(
    frame: pd.DataFrame, value: str, within: tuple[str, ...], subject: str
) -> tuple[pd.DataFrame, tuple[int, ...], list[str]]:
    """Complete people x cells (values less the first of all), the number of levels of each factor, and who was dropped.

    Cells stand in the order of `itertools.product` over the factors' levels. Raises `BadInput` for a doubled cell,
    `Undefined` for a factor with one level, a cell without ratings, or fewer than two complete people.
    """
    require_columns(frame, value, subject, *within)
    where = f"{value} by {CROSS.join(within)}"
    present = frame.dropna(subset=[value, *within])
    levels = [levels_of(present[name]) for name in within]
    alone = next((name for name, found in zip(within, levels, strict=True) if len(found) < 2), None)
    if alone is not None:
        raise Undefined(f"{where}: {alone} has fewer than two levels with ratings; an effect needs at least two")
    twice = present.duplicated([subject, *within])
    if twice.any():
        row = present[twice].iloc[0]
        raise BadInput(f'frame: {subject} "{row[subject]}" has two values at {cell_name(row, within)}; average first')
    cells = list(product(*levels))
    plain = present.astype(dict.fromkeys(within, object))
    wide = plain.pivot(index=subject, columns=list(within), values=value).astype(float)
    missing = next((cell for cell in cells if cell not in wide.columns), None)
    if missing is not None:
        at = cell_name(dict(zip(within, missing, strict=True)), within)
        raise Undefined(f"{where}: nobody rated {at}; interactions need every combination of levels")
    everyone = list(frame[subject].unique())
    wide = wide[cells].reindex(everyone)
    kept = wide.dropna()
    if len(kept) < 2:
        raise Undefined(
            f"{where}: {len(kept)} of {len(wide)} {subject}s rated every combination; at least two must have"
        )
    dropped = [str(who) for who in wide.index[wide.isna().any(axis=1)]]
    return kept - kept.iloc[0, 0], tuple(map(len, levels)), dropped


def cell_name(cell: "pd.Series[str] | dict[str, object]", within: tuple[str, ...]) -> str:
    """exponent 25, light 0.8: the levels of a cell by the names of their factors."""
    return ", ".join(f"{name} {cell[name]}" for name in within)
