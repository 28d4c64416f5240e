"""Both analyses of variance against published examples, exact rationals and what must not change them."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import scipy.stats
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from analysis import OneWayAnova, RepeatedMeasuresAnova
from analysis.statistics.anova import effect_sizes, library_anova, sphericity
from analysis.statistics.undefined import Undefined

DATA = Path(__file__).parents[1] / "data" / "statistics"
NIST = Path(scipy.stats.__file__).parent / "tests" / "data" / "nist_anova"
# correct digits of F that float64 data allow (the certified values stand in the files)
DIGITS = {"SiRstv": 13, "AtmWtAg": 10} | {f"SmLs0{i}": 14 for i in (1, 2, 3)} | {f"SmLs0{i}": 10 for i in (4, 5, 6)}
DIGITS |= {f"SmLs0{i}": 4 for i in (7, 8, 9)}
quick = settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.too_slow])
ONE_WAY = OneWayAnova(value="rating", group="condition")
REPEATED = RepeatedMeasuresAnova(value="rating", within="condition", subject="participant")


def long(table: list[list[int]]) -> pd.DataFrame:
    """Participants x conditions as a long frame."""
    return pd.DataFrame(
        [
            {"participant": f"p{who}", "condition": f"c{what}", "rating": rating}
            for who, row in enumerate(table)
            for what, rating in enumerate(row)
        ]
    )


likert_tables = st.integers(2, 5).flatmap(
    lambda k: st.lists(st.lists(st.integers(1, 7), min_size=k, max_size=k), min_size=3, max_size=12)
)


@pytest.mark.parametrize("name", DIGITS)
def test_nist_certified_f(name: str) -> None:
    """NIST StRD one-way sets: as many correct digits as float64 data can give."""
    lines = (NIST / f"{name}.dat").read_text().splitlines()
    certified = float(next(line for line in lines if line.startswith("Between")).split()[-1])
    values = np.array([line.split()[:2] for line in lines[60:] if line.strip()], dtype=float)
    row = ONE_WAY(pd.DataFrame(values, columns=["condition", "rating"])).iloc[0]
    error = abs(row["F"] / certified - 1)
    assert error == 0 or -np.log10(error) >= DIGITS[name]


def test_maxwell_and_delaney_12_1() -> None:
    """Main effect of angle: F(2, 18) = 40.719, Greenhouse-Geisser epsilon .9616365, p 3.4017e-7."""
    data = pd.read_csv(DATA / "md_12.1.csv").groupby(["id", "angle"], as_index=False)["rt"].mean()
    row = RepeatedMeasuresAnova(value="rt", within="angle", subject="id")(data).iloc[0]
    assert (row["df1"], row["df2"]) == (2, 18)
    assert row["F"] == pytest.approx(40.71910, abs=5e-6)
    assert row["epsilon_gg"] == pytest.approx(0.9616365, abs=5e-8)
    assert row["p_gg"] == pytest.approx(3.4017e-7, rel=5e-5)


@quick
@given(likert_tables)
def test_one_way_is_exact_on_likert_data(table: list[list[int]]) -> None:
    """Sums of squares and F equal the rationals that integers give."""
    columns = list(zip(*table, strict=True))
    everything = [Fraction(rating) for row in table for rating in row]
    grand = sum(everything) / len(everything)
    means = [Fraction(sum(column), len(column)) for column in columns]
    between = sum(len(table) * (mean - grand) ** 2 for mean in means)
    within = sum((rating - mean) ** 2 for column, mean in zip(columns, means, strict=True) for rating in column)
    assume(within > 0)
    row = ONE_WAY(long(table)).iloc[0]
    f = (between / (len(columns) - 1)) / (within / (len(everything) - len(columns)))
    assert row["ss_between"] == pytest.approx(float(between), rel=1e-12, abs=1e-12)
    assert row["ss_within"] == pytest.approx(float(within), rel=1e-12)
    assert row["F"] == pytest.approx(float(f), rel=1e-11, abs=1e-12)


@quick
@given(likert_tables)
def test_repeated_measures_is_exact_on_likert_data(table: list[list[int]]) -> None:
    """Effect, subject and error sums of squares, F and generalized eta squared."""
    n, k = len(table), len(table[0])
    grand = Fraction(sum(map(sum, table)), n * k)
    rows = [Fraction(sum(row), k) for row in table]
    columns = [Fraction(sum(column), n) for column in zip(*table, strict=True)]
    effect = n * sum((mean - grand) ** 2 for mean in columns)
    subject = k * sum((mean - grand) ** 2 for mean in rows)
    error = sum((table[i][j] - rows[i] - columns[j] + grand) ** 2 for i in range(n) for j in range(k))
    assume(error > 0)
    row = REPEATED(long(table)).iloc[0]
    f = (effect / (k - 1)) / (error / ((k - 1) * (n - 1)))
    for name, exact in (("ss_effect", effect), ("ss_subject", subject), ("ss_error", error)):
        assert row[name] == pytest.approx(float(exact), rel=1e-11, abs=1e-11)
    assert row["F"] == pytest.approx(float(f), rel=1e-9, abs=1e-9)
    assert row["generalized_eta_squared"] == pytest.approx(float(effect / (effect + subject + error)), abs=1e-11)


@quick
@given(likert_tables)
def test_effect_intervals_agree_with_p(table: list[list[int]]) -> None:
    """No 90% interval starts above its estimate; both exclude 0 exactly when the F test is significant at .05."""
    try:
        row = REPEATED(long(table)).iloc[0]
    except Undefined:
        assume(False)
    assume(abs(row["p"] - 0.05) > 1e-9)
    assert (row["ci_low"] > 0) == (row["partial_ci_low"] > 0) == (row["p"] < 0.05)
    for name, estimate in (("", "generalized_eta_squared"), ("partial_", "partial_eta_squared")):
        assert row[f"{name}ci_low"] - 1e-9 <= row[estimate] <= 1 and row[f"{name}ci_low"] <= row[f"{name}ci_high"] <= 1


def test_as_many_people_as_levels_spread_evenly() -> None:
    """Huynh and Feldt's epsilon is a fraction over 0 there; held to 1, which is its limit."""
    row = REPEATED(long([[1, 1, 1], [1, 1, 2], [2, 3, 3]])).iloc[0]
    assert row["epsilon_gg"] == pytest.approx(1) and row["epsilon_hf"] == 1 and row["p_hf"] == pytest.approx(row["p"])


def test_people_who_differ_much_leave_a_sure_effect_sure() -> None:
    """F(2, 78) = 31.9, p < .0001 with subjects of 40 times the error: a small generalized effect, surely not none."""
    found = effect_sizes(31.9 * 2 / 78, 40.0, 1.0, 2, 78)
    assert 0.01 < found["ci_low"] < found["generalized_eta_squared"] < found["ci_high"] < 0.04


def test_coverage_of_the_generalized_interval() -> None:
    """Sums of squares drawn from their distributions: the 90% interval holds the population's value about as often."""
    random = np.random.default_rng(4)
    n, k, noncentrality, subject_variance, draws = 30, 3, 15.0, 3.0, 400
    df1, df2 = k - 1, (k - 1) * (n - 1)
    truth = noncentrality / (noncentrality + (n - 1) * k * (1 + subject_variance))
    hits = 0
    for _ in range(draws):
        effect, error = random.noncentral_chisquare(df1, noncentrality), random.chisquare(df2)
        subject = (1 + k * subject_variance) * random.chisquare(n - 1)
        found = effect_sizes(effect, subject, error, df1, df2)
        hits += found["ci_low"] <= truth <= found["ci_high"]
    assert 0.86 <= hits / draws <= 0.94


@quick
@given(likert_tables, st.randoms(use_true_random=False))
def test_order_names_and_shift_do_not_matter(table: list[list[int]], random: object) -> None:
    """Rows shuffled, people renamed, ratings shifted by 1e6: the same numbers."""
    frame = long(table)
    try:
        before = REPEATED(frame).iloc[0]
    except Undefined:
        assume(False)
    seed = abs(hash(str(table))) % 2**32
    other = frame.sample(frac=1, random_state=seed)
    other = other.assign(participant="Ω " + other["participant"], rating=other["rating"] + 1e6)
    after = REPEATED(other).iloc[0]
    for name in ("F", "p", "p_gg", "epsilon_gg", "ss_error", "ci_low", "ci_high"):
        assert after[name] == pytest.approx(before[name], rel=1e-8, abs=1e-8, nan_ok=True)


def test_the_missing_are_dropped_and_named() -> None:
    """A person with a missing cell leaves the analysis, and the table says who."""
    table = [[1, 4, 5], [2, 4, 7], [3, 3, 6], [1, 5, 5]]
    frame = long(table)
    frame.loc[(frame["participant"] == "p1") & (frame["condition"] == "c2"), "rating"] = np.nan
    row = REPEATED(frame).iloc[0]
    assert (row["n"], row["dropped"]) == (3, "p1")
    assert row["F"] == pytest.approx(REPEATED(long([table[0], *table[2:]])).iloc[0]["F"])


def test_two_levels_are_a_paired_t_test() -> None:
    """F = t squared, no correction, no sphericity test."""
    table = [[1, 4], [2, 4], [3, 3], [1, 5], [6, 7]]
    row = REPEATED(long(table)).iloc[0]
    found = scipy.stats.ttest_rel(*np.array(table).T)
    assert (row["F"], row["p"], row["p_gg"]) == pytest.approx((found.statistic**2, found.pvalue, found.pvalue))
    assert row["epsilon_gg"] == 1 and np.isnan(row["mauchly_p"])


def test_no_sphericity_test_with_fewer_people_than_levels() -> None:
    """Libraries answer p = 1 there; it means nothing."""
    wide = pd.DataFrame(np.random.default_rng(1).integers(1, 8, (3, 4)).astype(float))
    assert np.isnan(sphericity(wide, library_anova(wide).iloc[0])["mauchly_p"])


def test_two_people_and_three_levels_have_an_f() -> None:
    """The library divides by zero there, in the constants of Mauchly's test. By hand: F = (73 / 6) / (1 / 2)."""
    row = REPEATED(long([[1, 2, 5], [2, 2, 7]])).iloc[0]
    assert (row["F"], row["df1"], row["df2"], row["ss_effect"]) == pytest.approx((73 / 3, 2, 2, 73 / 3))
    assert np.isnan(row["mauchly_p"])
