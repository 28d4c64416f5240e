"""Friedman's test, paired contrasts, intervals and effect sizes against published and R's values."""

import json
from pathlib import Path
from typing import Literal

import numpy as np
import pandas as pd
import pingouin
import pytest
from scipy import stats

from analysis import Friedman, MeanIntervals, PairedContrasts, SignedRanks
from analysis.statistics.effect_size import d_z_interval, eta_squared_interval

DATA = Path(__file__).parents[1] / "data" / "statistics"
R = json.loads((DATA / "effectsize_tost_padjust_R.json").read_text())
ROUNDING = pd.read_csv(DATA / "RoundingTimes.csv")
COLUMNS = {"value": "value", "within": "condition", "subject": "subject"}


def test_friedman_rounding_times() -> None:
    """Hollander & Wolfe (1973), p. 140: chi-squared 11.143, p .0038."""
    row = Friedman(**COLUMNS)(ROUNDING).iloc[0]
    assert row["chi2"] == pytest.approx(11.14286, abs=5e-6)
    assert row["p"] == pytest.approx(0.0038050, abs=5e-8)
    assert row["kendalls_w"] == pytest.approx(11.14286 / (22 * 2), rel=1e-5)


def signed_ranks(*pairs: tuple[float, float]) -> dict[str, float]:
    """Wilcoxon's test of pairs, one a person."""
    entries = [
        (f"p{who}", level, value) for who, pair in enumerate(pairs) for level, value in zip("ab", pair, strict=True)
    ]
    frame = pd.DataFrame(entries, columns=["subject", "condition", "value"])
    return dict(SignedRanks(**COLUMNS)(frame).iloc[0])


def test_signed_ranks_by_hand() -> None:
    """Ranks 1 to 5, of which 1 is negative: T = 1, p = 4/32, r = 13/15; an equal pair changes nothing."""
    row = signed_ranks((1, 2), (4, 2), (5, 2), (6, 2), (7, 2), (3, 3))
    assert (row["t"], row["n"], row["n_unequal"]) == (1, 6, 5)
    assert (row["p"], row["r"]) == pytest.approx((4 / 32, 13 / 15))


def test_signed_ranks_of_darwins_maize() -> None:
    """Fisher's The Design of Experiments, table 3: T = 24, exact p .0413 (R: wilcox.test)."""
    differences = (49, -67, 8, 16, 6, 23, 28, 41, 14, 29, 56, 24, 75, 60, -48)
    row = signed_ranks(*((value, 0) for value in differences))
    assert (row["t"], row["n_unequal"]) == (24, 15)
    assert row["p"] == pytest.approx(0.04125977, abs=5e-8)


def test_means_equal_but_for_the_last_bits_are_equal() -> None:
    """0.1 + 0.2 and 0.3 share no rank."""
    assert signed_ranks((0.1 + 0.2, 0.3), (2, 1), (3, 1))["n_unequal"] == 2


def test_contrasts_are_paired_t_tests_with_holm() -> None:
    """t, interval and d_z of each pair; Holm's p as multiplied by hand."""
    table = PairedContrasts(**COLUMNS)(ROUNDING)
    wide = ROUNDING.pivot(index="subject", columns="condition", values="value")
    for row in table.to_dict("records"):
        found = stats.ttest_rel(wide[row["a"]], wide[row["b"]])
        interval = found.confidence_interval(0.95)
        assert (row["t"], row["p"]) == pytest.approx((found.statistic, found.pvalue))
        assert (row["ci_low"], row["ci_high"]) == pytest.approx((interval.low, interval.high))
        assert row["d_z"] == pytest.approx(found.statistic / np.sqrt(22))
    smallest, middle, largest = table.sort_values("p")["p"]
    assert sorted(table["p_holm"]) == pytest.approx([3 * smallest, 2 * middle, max(2 * middle, largest)])


@pytest.mark.parametrize(("pairs", "chosen"), [("reference", ["ab", "ac", "ad"]), ("neighbours", ["ab", "bc", "cd"])])
def test_fewer_pairs_are_adjusted_for_fewer(pairs: Literal["reference", "neighbours"], chosen: list[str]) -> None:
    """The declared pairs alone, with the t tests that all pairs have; Holm's first factor is their number."""
    ratings = np.random.default_rng(5).integers(1, 8, (9, 4))
    cells = [(who, level, value) for who, row in enumerate(ratings) for level, value in zip("abcd", row, strict=True)]
    frame = pd.DataFrame(cells, columns=["subject", "condition", "value"])
    every = PairedContrasts(**COLUMNS)(frame).set_index(["a", "b"])
    table = PairedContrasts(**COLUMNS, pairs=pairs)(frame).set_index(["a", "b"])
    assert ["".join(pair) for pair in table.index] == chosen
    assert list(table["p"]) == list(every.loc[table.index, "p"])
    assert table["p_holm"].min() == pytest.approx(min(1, 3 * table["p"].min()))


def test_equal_differences_have_no_t() -> None:
    """Everyone differs by the same amount: no p for that pair, and Holm counts the other two."""
    values = {"a": [1.0, 2, 3, 4], "b": [2.0, 3, 4, 5], "c": [7.0, 2, 5, 4]}
    cells = [(i, name, value) for name, column in values.items() for i, value in enumerate(column)]
    frame = pd.DataFrame(cells, columns=["subject", "condition", "value"])
    table = PairedContrasts(**COLUMNS)(frame).set_index(["a", "b"])
    assert np.isnan(table.loc[("a", "b"), "p_holm"]) and table.loc[("a", "b"), "ci_low"] == -1
    assert table["p_holm"].notna().sum() == 2


@pytest.mark.parametrize("case", R["eta2"])
def test_intervals_of_partial_eta_squared(case: dict[str, float]) -> None:
    """R effectsize::F_to_eta2, 90%: to the accuracy of its optimiser."""
    interval = eta_squared_interval(case["eta2p"], case["df1"], case["df2"])
    assert interval == pytest.approx(case["eta2p_ci90"], abs=5e-8)


def test_cousineau_morey_for_two_conditions_is_the_paired_interval_over_root_two() -> None:
    """With k = 2 the corrected half-width is that of the mean difference divided by the square root of 2."""
    frame = ROUNDING[ROUNDING["condition"] != "Wide Angle"]
    table = MeanIntervals("value", "condition", "subject")(frame)
    wide = frame.pivot(index="subject", columns="condition", values="value")
    difference = wide.iloc[:, 0] - wide.iloc[:, 1]
    half = stats.t.ppf(0.975, 21) * difference.std() / np.sqrt(22)
    assert list(table["ci_high"] - table["mean"]) == pytest.approx([half / np.sqrt(2)] * 2)


def test_plain_intervals() -> None:
    """Without a subject: each sample's own t interval."""
    table = MeanIntervals("value", "condition")(ROUNDING).set_index("level")
    part = ROUNDING[ROUNDING["condition"] == "Round Out"]["value"]
    low, high = stats.t.interval(0.95, 21, part.mean(), stats.sem(part))
    assert tuple(table.loc["Round Out", ["ci_low", "ci_high"]]) == pytest.approx((low, high))


def test_interval_of_d_z() -> None:
    """R effectsize::cohens_d(paired = TRUE) on 103 people, to the accuracy of its optimiser; signs mirrored."""
    d_z, n = R["dz_carrots"]["dz"], R["cousineau_morey"]["n"]
    low, high = d_z_interval(np.array([d_z, -d_z, np.nan]), n)
    assert (low[0], high[0]) == pytest.approx(R["dz_carrots"]["ci"], abs=1e-7)
    assert (low[1], high[1]) == pytest.approx((-high[0], -low[0])) and np.isnan(low[2])


@pytest.mark.parametrize("n", [2, 5, 100])
def test_interval_of_a_huge_d_z(n: int) -> None:
    """The noncentral t at its limits; where the limit for large t takes over there is no step to see."""
    d_z = np.array([0.3, 3.0, 999.9 / np.sqrt(n), 1000.1 / np.sqrt(n), 1e12])
    low, high = d_z_interval(d_z, n)
    for limit, tail in ((low, 0.975), (high, 0.025)):
        assert stats.nct.cdf(d_z[:2] * np.sqrt(n), n - 1, limit[:2] * np.sqrt(n)) == pytest.approx(tail, abs=1e-6)
        assert limit[3] / limit[2] == pytest.approx(1.0002, abs=4e-4) and np.isfinite(limit[4])


def test_contrasts_carry_the_interval_of_d_z() -> None:
    """As the function gives it for t over the root of n."""
    table = PairedContrasts(**COLUMNS)(ROUNDING)
    low, high = d_z_interval(table["d_z"].to_numpy(), 22)
    assert table["d_z_low"].to_numpy() == pytest.approx(low) and table["d_z_high"].to_numpy() == pytest.approx(high)


def test_contrasts_are_pingouins() -> None:
    """t, p and Holm's p of every pair as pingouin.pairwise_tests has them."""
    random = np.random.default_rng(41)
    table = random.integers(1, 8, (17, 5)).astype(float)
    who, names = np.repeat(np.arange(17), 5), np.tile([*"abcde"], 17)
    frame = pd.DataFrame({"participant": who, "condition": names, "rating": table.ravel()})
    ours = PairedContrasts("rating", "condition", "participant")(frame)
    theirs = pingouin.pairwise_tests(frame, dv="rating", within="condition", subject="participant", padjust="holm")
    assert ours[["a", "b"]].to_numpy().tolist() == theirs[["A", "B"]].to_numpy().tolist()
    for name, other in (("t", "T"), ("df", "dof"), ("p", "p_unc"), ("p_holm", "p_corr")):
        assert ours[name].to_numpy(float) == pytest.approx(theirs[other].to_numpy(float), rel=1e-9)
