"""Ratings as people's and pictures' own levels around the factors' effects: linear mixed models."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from analysis.statistics.containment import denominators
from analysis.statistics.design_matrix import coding_of, refuse_empty_cells
from analysis.statistics.reml import Codes, Estimate, estimate
from analysis.statistics.undefined import Undefined, require_columns
from analysis.statistics.wald import against, wald_tests
from analysis.wording import joined

MOST_WORK = 1.5e8  # about 4 s, measured: see `work`
WORK_OF_A_PERSON = 2e4


class NoRandomTerm(Undefined):
    """Neither people nor pictures have a variance that these ratings can tell."""


@dataclass(frozen=True)
class MixedFit:
    """A fitted model. `tests`: a row per factor and interaction (`term, chi2, df, F, df2, p`). `variances`: a row per
    random term and the residual (`term, variance, share`). `left_out`: why the model lacks a random term. `at_zero`:
    terms of variance 0, fitted without."""

    tests: pd.DataFrame
    variances: pd.DataFrame
    n: int
    left_out: tuple[str, ...]
    at_zero: tuple[str, ...]


@dataclass(frozen=True)
class MixedModel:
    """Linear mixed model of `value`: fixed `factors`, random intercepts of `participant` and `picture`, crossed; REML.

    `interactions`: with all of them. A column given as None has no random intercept. Tests are Wald's as F with the
    containment degrees of freedom (`analysis.statistics.containment`): exact where every cell was rated equally often,
    near where ratings lack; not those of Satterthwaite or Kenward and Roger. Where every cell of the factors is one
    picture, its variance cannot be told from the fixed effects: the model has none and says so. A variance of 0 is left
    out and said. Agrees with R `lme4::lmer` (estimates, variances). Not a model of slopes: effects are taken as equal
    in all people.

    `__call__` returns `fit(frame).tests`. Raises `Undefined` where all ratings are equal, no random term is left, a
    cell is empty, nothing is left over as residual, the search fails, or the model would take too long.
    """

    value: str
    factors: tuple[str, ...]
    participant: str | None
    picture: str | None
    interactions: bool = False

    def __call__(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The joint Wald test of every term for a long `frame`, one row per rating."""
        return self.fit(frame).tests

    def fit(self, frame: pd.DataFrame) -> MixedFit:
        """Tests and variances."""
        asked = [name for name in (self.participant, self.picture) if name]
        used = list(
            dict.fromkeys([self.value, *self.factors, *asked])
        )  # pictures may be the factor and the random term
        require_columns(frame, *used)
        present = frame[used].dropna()
        coding = coding_of(present, self.value, self.factors, self.interactions)
        cells = present[list(self.factors)].drop_duplicates()
        refuse_empty_cells(coding, cells, self.value)
        random, left_out = self.estimable(present)
        columns = coding.terms[-1].columns.stop + 1
        refuse_work(self.title, len(present), columns, random)
        place = present.groupby(list(self.factors), observed=True, sort=False).ngroup().to_numpy()
        fixed = np.column_stack([np.ones(len(cells)), coding.matrix(cells)])[place]
        found = estimate(self.title, present[self.value].to_numpy(float), fixed, random)
        tests = wald_tests(coding, found.effects[1:], found.covariance[1:, 1:], self.title)
        tests = against(tests, denominators(coding, fixed, list(random.values())))
        variances = variance_table(found, tuple(random))
        variances["term"] = variances["term"].map(noun)
        return MixedFit(tests, variances, len(present), tuple(left_out), tuple(map(noun, found.dropped)))

    @property
    def title(self) -> str:
        """rating by thickness and backlight."""
        return f"{self.value} by {' and '.join(self.factors)}"

    def estimable(self, present: pd.DataFrame) -> tuple[dict[str, Codes], list[str]]:
        """The random terms that these ratings can tell apart, coded; and why one cannot be."""
        random: dict[str, Codes] = {}
        left_out = []
        for name in (self.participant, self.picture):
            if name is None:
                continue
            codes = codes_of(present[name])
            if name == self.picture and self.one_a_cell(present, name):
                left_out.append(
                    f"every cell is one {noun(name)}, so the variance of {noun(name)}s cannot be told from the "
                    "factors' effects"
                )
            elif repeats(codes):
                random[name] = codes
            else:
                gave = "gave" if name == self.participant else "has"
                found = f"there is one {noun(name)}" if codes.max() == 0 else f"no {noun(name)} {gave} two ratings"
                left_out.append(f"{found}, so {noun(name)}s have no variance")
        if not random:
            raise NoRandomTerm(f"{self.title}: {'; '.join(left_out)}; no random term is left to estimate")
        return random, left_out

    def one_a_cell(self, present: pd.DataFrame, picture: str) -> bool:
        """Whether every cell of the factors shows a single picture."""
        cells = present.groupby(list(self.factors), observed=True)
        return int(cells[picture].nunique().max()) == 1


def noun(column: str) -> str:
    """What a column holds, in a sentence: apostrophes keep its name apart from a factor's, and are no part of it."""
    return column.rstrip("'")


def codes_of(column: "pd.Series[str]") -> Codes:
    """Labels as numbers from 0, in the order in which they occur."""
    return np.asarray(pd.factorize(column)[0], dtype=np.int64)


def repeats(codes: Codes) -> bool:
    """Whether there are at least two labels, and one that occurs twice."""
    return 0 < int(codes.max()) < len(codes) - 1


def work(rows: int, columns: int, random: Mapping[str, Codes]) -> float:
    """Rows times squared columns of the matrices statsmodels handles: with one random term person by person."""
    levels = [int(codes.max()) + 1 for codes in random.values()]
    if len(levels) == 1:
        return float(rows) * (columns + 1) ** 2 + WORK_OF_A_PERSON * levels[0]
    return float(rows) * (columns + sum(levels)) ** 2


def refuse_work(title: str, rows: int, columns: int, random: Mapping[str, Codes]) -> None:
    """`Undefined` for a model that would take minutes."""
    if work(rows, columns, random) > MOST_WORK:
        size = joined([f"{int(codes.max()) + 1} {name}s" for name, codes in random.items()])
        raise Undefined(
            f"{title}: a mixed model of {rows} ratings, {columns} fixed effects and {size} would take minutes, so it "
            "is not fitted"
        )


def variance_table(found: Estimate, terms: tuple[str, ...]) -> pd.DataFrame:
    """`term, variance, share` of the random terms (0 for those dropped) and of the residual."""
    parts = {name: found.variances.get(name, 0.0) for name in terms} | {"residual": found.residual}
    total = sum(parts.values())
    rows = [{"term": name, "variance": part, "share": part / total} for name, part in parts.items()]
    return pd.DataFrame(rows)
