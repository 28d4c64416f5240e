"""Exact rationals for the statistics of ranks and agreement, and what must not change any number of the report."""

import random as standard
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from analysis import Friedman, IntraclassCorrelation, KrippendorffAlpha, SignedRanks, read_ratings
from analysis.evidence import gather
from analysis.levels import from_ratings
from analysis.plan import AnalysisPlan
from analysis.ratings import DEFAULT_SCALE
from analysis.sample import draw_sample
from analysis.statistics.undefined import Undefined

quick = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
NAMES = {"value": "rating", "within": "stimulus", "subject": "participant"}
Table = list[list[int]]


def tables(most: int = 5, fewest: int = 2) -> st.SearchStrategy[Table]:
    """People x pictures of Likert ratings."""
    return st.integers(fewest, most).flatmap(
        lambda k: st.lists(st.lists(st.integers(1, 7), min_size=k, max_size=k), min_size=3, max_size=10)
    )


def long(table: Table) -> pd.DataFrame:
    """One row per rating."""
    return pd.DataFrame(
        [(f"p{who}", f"c{what}", given) for who, row in enumerate(table) for what, given in enumerate(row)],
        columns=["participant", "stimulus", "rating"],
    )


def midranks(row: list[int]) -> list[Fraction]:
    """Ranks 1.. with ties sharing their mean."""
    return [Fraction(2 * sum(x < y for x in row) + sum(x == y for x in row) + 1, 2) for y in row]


@quick
@given(tables(fewest=3))
def test_friedman_is_exact_with_ties(table: Table) -> None:
    """Conover (1999), p. 370: T1 = (k - 1) sum (R_j - n (k + 1) / 2)^2 / (A1 - C1); W = T1 / (n (k - 1))."""
    n, k = len(table), len(table[0])
    ranks = [midranks(row) for row in table]
    squares = sum(rank**2 for row in ranks for rank in row)
    spare = squares - Fraction(n * k * (k + 1) ** 2, 4)
    assume(spare > 0)
    totals = [sum(column) for column in zip(*ranks, strict=True)]
    chi2 = (k - 1) * sum((total - Fraction(n * (k + 1), 2)) ** 2 for total in totals) / spare
    row = Friedman(**NAMES)(long(table)).iloc[0]
    assert row["chi2"] == pytest.approx(float(chi2), rel=1e-11, abs=1e-12)
    assert row["kendalls_w"] == pytest.approx(float(chi2 / (n * (k - 1))), rel=1e-11, abs=1e-12)


@quick
@given(tables())
def test_icc_is_exact(table: Table) -> None:
    """ICC(A,1) of McGraw & Wong (1996), table 4, case 2A, from mean squares that integers give."""
    k, n = len(table), len(table[0])  # raters, targets
    grand = Fraction(sum(map(sum, table)), n * k)
    raters = [Fraction(sum(row), n) for row in table]
    targets = [Fraction(sum(column), k) for column in zip(*table, strict=True)]
    rows = k * sum((mean - grand) ** 2 for mean in targets) / (n - 1)
    columns = n * sum((mean - grand) ** 2 for mean in raters) / (k - 1)
    left = sum((table[i][j] - raters[i] - targets[j] + grand) ** 2 for i in range(k) for j in range(n))
    error = Fraction(left) / ((n - 1) * (k - 1))
    assume(rows > 0 and error > 0)
    expected = (rows - error) / (rows + (k - 1) * error + Fraction(k, n) * (columns - error))
    found = IntraclassCorrelation("rating", "stimulus", "participant")(long(table)).set_index("type")
    assert found.loc["ICC(A,1)", "icc"] == pytest.approx(float(expected), rel=1e-9, abs=1e-10)


@quick
@given(tables(most=2))
def test_wilcoxons_t_is_exact(table: Table) -> None:
    """The smaller sum of midranks of unequal pairs."""
    gaps = [a - b for a, b in table if a != b]
    assume(gaps)
    ranks = midranks([abs(gap) for gap in gaps])
    up = sum((rank for rank, gap in zip(ranks, gaps, strict=True) if gap > 0), Fraction(0))
    total = sum(ranks, Fraction(0))
    row = SignedRanks(**NAMES)(long(table)).iloc[0]
    assert row["t"] == float(min(up, total - up)) and row["n_unequal"] == len(gaps)
    assert row["r"] == pytest.approx(float((2 * up - total) / total))


@quick
@given(tables())
def test_krippendorffs_nominal_alpha_is_exact(table: Table) -> None:
    """1 - D_o / D_e from the coincidence matrix of complete data (Krippendorff 2011, section A)."""
    units = list(zip(*table, strict=True))
    m, total = len(table), len(table) * len(units)
    observed = sum(Fraction(sum(a != b for a in unit for b in unit), m - 1) for unit in units)
    everything = [rating for unit in units for rating in unit]
    expected = sum(Fraction(sum(a != b for b in everything), total - 1) for a in everything)
    assume(expected > 0)
    statistic = KrippendorffAlpha("rating", "stimulus", "participant", level="nominal", resamples=10)
    assert statistic(long(table)).iloc[0]["alpha"] == pytest.approx(float(1 - observed / expected), abs=1e-12)


# Through the file and every statistic: what a row, a name or an origin is must not matter.


def answers(seed: int = 3, people: int = 9) -> pd.DataFrame:
    """Ratings of four pictures on two questions, with what looks like noise."""
    random = np.random.default_rng(seed)
    cells = [
        (f"p{who}", f"Image {what}", question, int(np.clip(random.integers(1, 5) + what % 3, 1, 7)))
        for who in range(people)
        for what in range(1, 5)
        for question in ("Shiny", "Flat")
    ]
    return pd.DataFrame(cells, columns=["participant", "stimulus", "question", "rating"])


def numbers(path: Path, scale: int | None = DEFAULT_SCALE) -> dict[str, list[float]]:
    """Every number that does not depend on the origin of the scale, by question."""
    frame = read_ratings(path, scale=scale)
    plan = AnalysisPlan(tests=("ranks",))
    evidence = gather(from_ratings(frame, "x", scale), plan, draw_sample(frame, plan), frame)
    found: dict[str, list[float]] = {}
    for each in (*evidence.main, *evidence.other):
        assert each.anova is not None
        values = [value for value in each.anova.values() if isinstance(value, float)]
        for table in (each.tukey, each.contrasts):
            values += [] if table is None else list(table.select_dtypes("number").to_numpy().ravel())
        for row in (each.friedman, each.wilcoxon):
            values += [] if row is None else [value for value in row.values() if isinstance(value, float)]
        found.setdefault(each.row.question.casefold(), []).extend(values)
    for question, part in frame.groupby("question"):
        icc = IntraclassCorrelation("rating", "stimulus", "participant")(part).select_dtypes("number")
        alpha = KrippendorffAlpha("rating", "stimulus", "participant", resamples=20)(part).select_dtypes("number")
        found[str(question).casefold()] += [*icc.to_numpy().ravel(), *alpha.to_numpy().ravel()]
    return found


def shuffled(frame: pd.DataFrame) -> pd.DataFrame:
    order = list(range(len(frame)))
    standard.Random(5).shuffle(order)
    return frame.iloc[order]


CHANGES: dict[str, Callable[[pd.DataFrame], pd.DataFrame]] = {
    "row order": shuffled,
    "names of people": lambda frame: frame.assign(participant="Ω " + frame["participant"].str[::-1]),
    "case of labels": lambda frame: frame.assign(
        stimulus=frame["stimulus"].str.lower(), question=frame["question"].str.upper()
    ),
    "spaces about labels": lambda frame: frame.assign(stimulus="  " + frame["stimulus"] + " "),
    "origin of the scale": lambda frame: frame.assign(rating=frame["rating"] + 1_000_000),
    "session and revision": lambda frame: frame.assign(session="s" + frame["participant"], revision=0),
}


@pytest.fixture(scope="module")
def before(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[float]]:
    """The numbers of the ratings as they are."""
    path = tmp_path_factory.mktemp("invariance") / "ratings.csv"
    answers().to_csv(path, index=False)
    return numbers(path, None)


@pytest.mark.parametrize("change", CHANGES)
def test_what_does_not_matter(change: str, before: dict[str, list[float]], tmp_path: Path) -> None:
    """Analyses of variance, Tukey, paired tests, ranks and agreement: the same numbers to 1e-8."""
    path = tmp_path / "ratings.csv"
    CHANGES[change](answers()).to_csv(path, index=False)
    after = numbers(path, None)
    assert set(after) == set(before)
    for question, values in before.items():
        assert after[question] == pytest.approx(values, rel=1e-8, abs=1e-8, nan_ok=True)


@quick
@given(tables(most=4, fewest=3), st.integers(-(10**6), 10**6))
def test_a_shift_changes_no_test(table: Table, shift: int) -> None:
    """Ranks and agreement of any Likert table, wherever its scale begins."""
    frame = long(table)
    moved = frame.assign(rating=frame["rating"] + shift)
    for statistic in (Friedman(**NAMES), IntraclassCorrelation("rating", "stimulus", "participant")):
        try:
            expected = statistic(frame).select_dtypes("number").to_numpy().ravel()
        except Undefined as reason:
            with pytest.raises(Undefined, match="^" + str(reason)[:12]):
                statistic(moved)
            continue
        assert statistic(moved).select_dtypes("number").to_numpy().ravel() == pytest.approx(
            expected, rel=1e-7, abs=1e-8, nan_ok=True
        )
