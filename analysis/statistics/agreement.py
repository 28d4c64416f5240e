"""How far people agree about the pictures: intraclass correlation and Krippendorff's alpha."""

import warnings
from dataclasses import dataclass
from typing import Literal, get_args

import krippendorff
import numpy as np
import numpy.typing as npt
import pandas as pd
import pingouin
from pandas.errors import Pandas4Warning

from analysis.statistics.undefined import Undefined, complete_table, not_zero, refuse_doubled, require_columns
from fakesss.problem import BadInput, nearest

FEWEST = 5  # ratings; pingouin stops below
Level = Literal["nominal", "ordinal", "interval", "ratio"]
LEVELS: tuple[Level, ...] = get_args(Level)
MOST = 10**8  # numbers that krippendorff holds at once (pictures x values x values): 0.8 GB


@dataclass(frozen=True)
class IntraclassCorrelation:
    """The six intraclass correlations of Shrout & Fleiss (1979).

    Returns a row per type in pingouin's naming (`type`: ICC(1,1), ICC(A,1), ICC(C,1), ICC(1,k), ICC(A,k), ICC(C,k)):
    `icc, ci_low, ci_high` (95%), `F, df1, df2, p, n_targets, n_raters`. ICC(A,1) and ICC(A,k) are absolute agreement
    of one and of all raters. Raters with a missing cell are left out (`dropped`). Agrees with R `psych::ICC`. Raises
    `Undefined` where all ratings or all targets' means are equal. Limits are NaN where raters agree without residual.
    """

    value: str
    target: str
    rater: str

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The table for a long `frame`, one row per rating."""
        wide, dropped = complete_table(frame, self.value, self.target, self.rater)
        if np.ptp(wide.to_numpy()) == 0:
            raise Undefined(f"{self.value} by {self.target}: all ratings are equal, so agreement has no value")
        if np.ptp(wide.to_numpy().sum(axis=0)) == 0:
            raise Undefined(f"{self.value}: every {self.target} has the same mean, so the ICC has no value")
        if wide.size < FEWEST:
            raise Undefined(
                f"{self.value} by {self.target}: {wide.size} ratings in complete rows; the ICC needs at least {FEWEST}"
            )
        plain = pd.DataFrame(wide.to_numpy()).rename_axis("rater").reset_index()
        long = plain.melt("rater", var_name="target", value_name="value")
        found = unrounded_icc(long)
        low, high = zip(*found["CI95"], strict=True)
        names = {"Type": "type", "ICC": "icc", "F": "F", "df1": "df1", "df2": "df2", "pval": "p"}
        table = found[list(names)].rename(columns=names)
        table.insert(2, "ci_low", np.array(low, dtype=float))
        table.insert(3, "ci_high", np.array(high, dtype=float))
        table["p"] = not_zero(table["p"])
        return table.assign(n_targets=wide.shape[1], n_raters=wide.shape[0], dropped="; ".join(dropped))


def unrounded_icc(long: pd.DataFrame) -> pd.DataFrame:
    """pingouin's table with its confidence limits at full precision (it rounds them to two places by default)."""
    before = pingouin.options["round.column.CI95"]
    pingouin.options["round.column.CI95"] = None
    try:
        # where raters differ by constants alone the residual is 0, and limits that divide by it are NaN
        with warnings.catch_warnings(), np.errstate(divide="ignore", invalid="ignore"):
            # pingouin 0.7.0 uses inplace arguments that pandas 3.1 announces to remove
            warnings.filterwarnings("ignore", message="The inplace keyword", category=Pandas4Warning)
            found = pingouin.intraclass_corr(long, targets="target", raters="rater", ratings="value")
    finally:
        pingouin.options["round.column.CI95"] = before
    return pd.DataFrame(found).reset_index(drop=True)


@dataclass(frozen=True)
class KrippendorffAlpha:
    """Krippendorff's alpha with a bootstrap interval over the pictures; missing ratings are allowed.

    Returns one row: `alpha, ci_low, ci_high` (95%, percentile), `level, n_targets, n_raters`. `seed` fixes the
    bootstrap; `n_raters` counts who rated a picture that somebody else rated too, `n_targets` such pictures. Agrees
    with R `irr::kripp.alpha`. Krippendorff (2011). Raises `Undefined` where fewer than two pictures are shared by two
    raters (of one picture alpha is 0 whatever they answer), where all ratings are equal, and where there are more
    different ratings than the library can hold (more than 447 on 500 pictures); `BadInput` for a doubled cell.
    """

    value: str
    target: str
    rater: str
    level: Level = "ordinal"
    resamples: int = 1000
    seed: int = 0

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The row for a long `frame`, one row per rating."""
        require_columns(frame, self.value, self.target, self.rater)
        if self.level not in LEVELS:
            raise BadInput(f'level: "{self.level}": {nearest(self.level, LEVELS)}')
        present = frame.dropna(subset=[self.value, self.target, self.rater])
        refuse_doubled(present, self.rater, self.target)
        wide = present.pivot(index=self.rater, columns=self.target, values=self.value).astype(float)
        shared = wide.loc[:, wide.notna().sum() > 1].dropna(how="all")
        data = shared.to_numpy()
        where = f"{self.value} by {self.target}"
        if data.size == 0:
            raise Undefined(f"{where}: no {self.target} was rated by two {self.rater}s, so agreement has no value")
        if np.nanmin(data) == np.nanmax(data):
            raise Undefined(f"{where}: all ratings are equal, so agreement has no value")
        if data.shape[1] < 2:
            raise Undefined(
                f"{where}: one {self.target} was rated by several {self.rater}s; Krippendorff's alpha compares "
                f"disagreement within {self.target}s with that between them, and needs two"
            )
        values = np.unique(data[~np.isnan(data)])
        if data.shape[1] * len(values) ** 2 > MOST:
            raise Undefined(
                f"{where}: {len(values)} different ratings of {data.shape[1]} {self.target}s are too many to compare "
                "each with each, so Krippendorff's alpha has no value; round the ratings to fewer steps"
            )
        # of each picture alpha needs only how often each answer was given: a thousand resamples of that are quick
        counts = np.stack([(data == value).sum(axis=0) for value in values], axis=1)
        random = np.random.default_rng(self.seed)
        draws = random.integers(0, len(counts), (self.resamples, len(counts)))
        resampled = [self.alpha(counts[draw], values) for draw in draws]
        low, high = np.nanquantile(resampled, [0.025, 0.975])
        row = {"alpha": self.alpha(counts, values), "ci_low": float(low), "ci_high": float(high), "level": self.level}
        return pd.DataFrame([{**row, "n_targets": data.shape[1], "n_raters": data.shape[0]}])

    def alpha(self, counts: npt.NDArray[np.int64], values: npt.NDArray[np.float64]) -> float:
        """Alpha of how often each of `values` was given to each picture (pictures x values); NaN for one value only."""
        if np.count_nonzero(counts.sum(axis=0)) < 2:
            return float("nan")
        found = krippendorff.alpha(value_counts=counts, value_domain=values, level_of_measurement=self.level)
        return float(found)
