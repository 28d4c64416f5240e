"""Ratings so well ordered by the factors that an odds ratio is infinite: found exactly, said in words."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy.optimize import linprog

from analysis.statistics.factorial import CROSS
from analysis.statistics.undefined import Floats
from analysis.wording import joined

SHOWN = 4
Codes = npt.NDArray[np.int64]


def separation(rows: pd.DataFrame, factors: Sequence[str], category: Codes, matrix: Floats) -> str:
    """Why the likelihood of a proportional odds model has no maximum; empty where it has one.

    `rows`: the distinct combinations of levels and category that occur, a column per factor; `category`: 0..K-1;
    `matrix`: the coded factors. A single factor, or the cells of a model with all interactions, are separated exactly
    when some levels lie at or above all others; other models are asked by linear programming (Konis 2007; R:
    `detectseparation`).
    """
    for names in dict.fromkeys([*((name,) for name in factors), tuple(factors)]):
        cells = rows.groupby(list(names), observed=True, sort=False).ngroup().to_numpy().astype(np.int64)
        saturated = cells.max() == matrix.shape[1]
        if len(names) == 1 or saturated:
            upper = upper_part(cells, category)
            if upper:
                labels = rows[list(names)].astype(str).agg(CROSS.join, axis=1).groupby(cells).first()
                some = joined([f'"{labels[cell]}"' for cell in upper[:SHOWN]])
                more = f" ({len(upper)} in all)" if len(upper) > SHOWN else ""
                return f"every rating at {CROSS.join(names)} {some}{more} is at or above every rating elsewhere"
        if saturated:
            return ""
    return "levels together order the ratings without a fault" if orders(category, matrix) else ""


def upper_part(cells: Codes, category: Codes) -> list[int]:
    """The cells at or above all others, those of the highest split; empty where ratings overlap."""
    ends = pd.Series(category).groupby(cells).agg(["min", "max"]).sort_values(["min", "max"], kind="stable")
    reached = ends["max"].cummax().to_numpy()[:-1]
    splits = np.flatnonzero(reached <= ends["min"].to_numpy()[1:])
    return sorted(int(cell) for cell in ends.index[splits[-1] + 1 :]) if len(splits) else []


def orders(category: Codes, matrix: Floats) -> bool:
    """Whether a direction of coefficients and thresholds makes no rating less likely and some more."""
    top = int(category.max())
    padded = np.vstack([np.zeros(top), np.eye(top), np.zeros(top)])
    # a rating's upper threshold may only move up against its level, its lower one only down
    above = np.hstack([-matrix, padded[category + 1]])[category < top]
    below = np.hstack([-matrix, padded[category]])[category > 0]
    rising = np.vstack([above, -below])
    found = linprog(-rising.sum(axis=0), A_ub=-rising, b_ub=np.zeros(len(rising)), bounds=(-1, 1), method="highs")
    return bool(found.fun is not None and found.fun < -1e-7)
