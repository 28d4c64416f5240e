"""Equivalence tests against R's digits, hard cases by their sentences, and power against other ways to it."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy import integrate, stats
from statsmodels.stats.tests import test_tost as r_equivalence

from analysis import Equivalence
from analysis.statistics.equivalence_power import equivalence_power, people_for_equivalence
from analysis.statistics.undefined import Undefined
from fakesss.problem import BadInput

DATA = Path(__file__).parents[1] / "data" / "statistics"
R = json.loads((DATA / "effectsize_tost_padjust_R.json").read_text())


def long(columns: dict[str, list[float]]) -> pd.DataFrame:
    """A frame of one rating per person and level."""
    cells = [(f"p{who}", level, value) for level, given in columns.items() for who, value in enumerate(given)]
    return pd.DataFrame(cells, columns=["participant", "condition", "rating"])


def pairs_of(columns: dict[str, list[float]], margin: float = 0.5, paired: bool = True) -> pd.DataFrame:
    """The table of all pairs."""
    return Equivalence("rating", "condition", "participant" if paired else None, margin)(long(columns))


@pytest.mark.parametrize("case", R["tost_translucency"])
def test_both_one_sided_tests_agree_with_r(case: dict[str, float]) -> None:
    """t and p at both ends, df."""
    data = R["tost_translucency_data"]
    row = pairs_of({"static": data["static"], "x dynamic": data["dynamic"]}, case["bound"]).iloc[0]
    for name in ("t_low", "t_high", "p_low", "p_high"):
        assert row[name] == pytest.approx(case[name], rel=1e-9)
    assert (row["df"], row["n_a"], row["n_b"]) == (11, 12, 12)


@pytest.mark.parametrize("paired", [True, False])
@pytest.mark.parametrize("column", [2, 3])
def test_clinic_agrees_with_r(column: int, paired: bool) -> None:
    """R equivalence::tost of two columns of the clinic data, paired and Welch (the digits ship with statsmodels)."""
    kind, number = "paired" if paired else "indep", "_1" if column == 2 else ""
    expected = getattr(r_equivalence, f"tost_clinic_{kind}{number}")
    clinic = r_equivalence.clinic
    row = pairs_of({"a": list(clinic[:15, column]), "b": list(clinic[15:, column])}, 0.6, paired).iloc[0]
    assert row["p_equivalence"] == pytest.approx(expected.p_value, rel=1e-11)
    assert (row["ci_low"], row["ci_high"]) == pytest.approx(expected.ci_diff, rel=1e-11)
    assert row["df"] == pytest.approx(expected.df)
    assert (row["verdict"] in ("equivalent", "both")) is (expected.result == "rejected")


def test_the_four_verdicts() -> None:
    """A narrow and a wide spread, beside and away from 0."""
    wobble = [0.1, -0.1, 0.2, -0.2, 0.0, 0.05]
    far = [10 * each for each in wobble]
    columns = {"a": [0.0] * 6, "b": wobble, "c": [0.3 + each for each in wobble], "d": far, "e": [3 + w for w in far]}
    verdict = pairs_of(columns).set_index(["a", "b"])["verdict"]
    assert [verdict["a", level] for level in "bcde"] == ["equivalent", "both", "undecided", "different"]


def test_verdict_is_where_the_interval_lies() -> None:
    """Equivalent or both exactly where the 90% interval lies inside the margin; shift and order change nothing."""
    random = np.random.default_rng(4)
    columns = {name: list(random.integers(1, 8, 40).astype(float)) for name in "abcdef"}
    table = pairs_of(columns, 0.8)
    inside = (table["ci_low"] > -0.8) & (table["ci_high"] < 0.8)
    assert inside.any() and not inside.all()
    assert list(table["verdict"].isin(["equivalent", "both"])) == list(inside)
    shifted = {name: [value + 2.0**40 for value in given] for name, given in columns.items()}
    pd.testing.assert_frame_equal(table, pairs_of(shifted, 0.8))
    mixed = long(columns).sample(frac=1, random_state=1)
    pd.testing.assert_frame_equal(table, Equivalence("rating", "condition", "participant", 0.8)(mixed), rtol=1e-12)


def test_holm_over_the_pairs_tested() -> None:
    """A pair without spread is not counted, has its sentence, and leaves the others their tests."""
    columns = {"a": [1.0, 2, 3, 5], "b": [2.0, 3, 4, 6], "c": [1.5, 2, 3, 4]}
    table = pairs_of(columns, 2).set_index(["a", "b"])
    alone = table.loc[("a", "b")]
    assert alone["verdict"] == "untested" and np.isnan(alone["p_equivalence"]) and alone["difference"] == -1
    assert alone["reason"] == 'every participant rates "a" and "b" exactly -1 apart; without spread there is no test'
    others = table[table["verdict"] != "untested"]
    small, large = sorted(others["p_equivalence"])
    assert sorted(others["p_equivalence_holm"]) == pytest.approx([2 * small, max(2 * small, large)])
    assert (others["reason"] == "").all() and not others.isna().any().any()


def test_differences_equal_but_for_the_last_bits_have_no_spread() -> None:
    """0.1 + 0.2 less 0.3 is no spread to measure against."""
    with pytest.raises(Undefined, match="without spread there is no test"):
        pairs_of({"a": [0.1 + 0.2, 0.5, 0.7], "b": [0.3, 0.5, 0.7]})


@pytest.mark.parametrize(
    ("columns", "sentence"),
    [
        ({"a": [4, 4], "b": [5, 5]}, 'all ratings of "a" are equal and so are those of "b"'),
        ({"a": [4, 5], "b": [5]}, '"b" has one rating; a test of "a" and "b" needs at least two of each'),
        ({"a": [4, 5]}, "1 level with ratings; a comparison needs at least two"),
    ],
)
def test_different_people_without_a_test(columns: dict[str, list[float]], sentence: str) -> None:
    with pytest.raises(Undefined, match=sentence):
        pairs_of(columns, paired=False)


def test_one_constant_sample_of_two_is_tested() -> None:
    """Welch's test has a spread in the other; a missing rating is left out."""
    row = pairs_of({"a": [4.0, 4, 4, 4], "b": [4.1, 3.9, 4.0, np.nan]}, paired=False).iloc[0]
    assert (row["verdict"], row["n_b"]) == ("equivalent", 3)
    assert row["df"] == pytest.approx(2)


@pytest.mark.parametrize("alpha", [0, 0.5, 1.0])
def test_an_alpha_out_of_range(alpha: float) -> None:
    with pytest.raises(BadInput, match=r"alpha: .*: must lie between 0 and 0\.5"):
        Equivalence("rating", "condition", "participant", 0.5, alpha)(long({"a": [1, 2], "b": [2, 2]}))


def test_p_is_never_zero() -> None:
    """A margin of a million spreads gives a bound."""
    random = np.random.default_rng(1)
    columns: dict[str, Any] = {name: random.normal(0, 1e-6, 2000) for name in "ab"}
    assert pairs_of(columns, 100).iloc[0]["p_equivalence"] > 0


@pytest.mark.parametrize(("n", "difference"), [(5, 0.0), (44, 0.0), (152, 0.0), (152, 0.2), (30, 0.5)])
def test_power_by_another_integral(n: int, difference: float) -> None:
    """Over the mean instead of the spread: P(the spread found is small enough for that mean)."""
    sd, margin = 2.093, 0.9
    t, df = stats.t.isf(0.05, n - 1), n - 1

    def given(mean: float) -> float:
        most = ((margin - abs(mean)) * np.sqrt(n) / t / sd) ** 2 * df
        return float(stats.chi2.cdf(most, df) * stats.norm.pdf(mean, difference, sd / np.sqrt(n)))

    expected = sum(integrate.quad(given, *ends, epsabs=1e-12)[0] for ends in ((-margin, 0), (0, margin)))
    assert equivalence_power(n, sd, margin, difference) == pytest.approx(expected, abs=1e-8)


def test_power_at_the_margin_is_the_level() -> None:
    """With many people the far side does not matter: alpha."""
    assert equivalence_power(4000, 1, 0.5, difference=0.5) == pytest.approx(0.05, abs=1e-6)


@pytest.mark.parametrize(("sd", "margin"), [(2.093, 0.5), (1.0, 1.0), (0.01, 5.0)])
def test_fewest_people(sd: float, margin: float) -> None:
    """Enough, and one less is not."""
    n = people_for_equivalence(sd, margin)
    assert n is not None and equivalence_power(n, sd, margin) >= 0.8
    assert n == 2 or equivalence_power(n - 1, sd, margin) < 0.8


def test_too_many_people_are_none() -> None:
    assert people_for_equivalence(1, 1e-4) is None
