"""What float64 leaves of equal decimals is no spread; what is spread stays one wherever the scale begins."""

import numpy as np
import pandas as pd
import pingouin
import pytest
from scipy import stats
from scipy.linalg import helmert

from analysis import (
    Equivalence,
    Friedman,
    IntraclassCorrelation,
    KrippendorffAlpha,
    MeanIntervals,
    OneWayAnova,
    PairedContrasts,
    RepeatedMeasuresAnova,
    TukeyHSD,
)
from analysis.statistics.diagnostics import EqualSpread, Residuals
from analysis.statistics.planned import PlannedContrast
from analysis.statistics.undefined import Floats, Undefined
from fakesss.problem import BadInput

ANOVA = RepeatedMeasuresAnova("rating", "condition", "participant")


def long(table: Floats) -> pd.DataFrame:
    """People x conditions M1.. as one row per rating."""
    people, conditions = table.shape
    who = np.repeat([f"p{number}" for number in range(people)], conditions)
    frame = pd.DataFrame(
        {"participant": who, "condition": np.tile([f"M{n}" for n in range(1, conditions + 1)], people)}
    )
    return frame.assign(rating=table.ravel())


@pytest.fixture
def decimals() -> pd.DataFrame:
    """Twelve people who rate M2 exactly 0.1 above M1: 6.1 - 6.0 and 3.1 - 3.0 differ in float64."""
    random = np.random.default_rng(3)
    base = np.round(random.uniform(1, 7, 12), 1)
    frame = long(np.column_stack([base, np.round(base + 0.1, 1), np.round(random.uniform(1, 7, 12), 1)]))
    wide = frame.pivot(index="participant", columns="condition", values="rating")
    assert np.ptp(wide["M2"] - wide["M1"]) > 0
    return frame


def test_decimals_the_same_distance_apart_have_no_t(decimals: pd.DataFrame) -> None:
    """No t of 1e14; the same word from the test of equivalence and from a planned contrast."""
    row = PairedContrasts("rating", "condition", "participant")(decimals).iloc[0]
    assert row[["t", "p", "p_holm", "d_z", "d_z_low", "d_z_high"]].isna().all()
    assert row["difference"] == pytest.approx(-0.1)
    alike = Equivalence("rating", "condition", "participant", 0.5)(decimals).iloc[0]
    assert alike["verdict"] == "untested" and "exactly -0.1 apart" in alike["reason"]
    with pytest.raises(Undefined, match=r"every participant's weighted sum is 0\.1"):
        PlannedContrast("rating", "condition", "participant", {"M2": 1, "M1": -1})(decimals)


def test_samples_constant_but_for_the_last_bit_have_no_f() -> None:
    """(0.1 + 0.2) + 0.3 is not 0.1 + (0.2 + 0.3) in float64."""
    frame = pd.DataFrame({"condition": list("aaabbb"), "rating": [(0.1 + 0.2) + 0.3, 0.6, 0.6, 0.8, 0.7 + 0.1, 0.8]})
    assert frame["rating"].nunique() > 2
    for statistic in (OneWayAnova("rating", "condition"), TukeyHSD("rating", "condition")):
        with pytest.raises(Undefined, match="within each level all ratings are equal"):
            statistic(frame)
    with pytest.raises(Undefined, match="all ratings are equal, so F"):
        OneWayAnova("rating", "condition")(frame.assign(rating=frame["rating"].where(frame["condition"] == "a", 0.6)))
    everywhere = long(np.array([[0.6, 0.6, (0.1 + 0.2) + 0.3], [0.6, (0.1 + 0.2) + 0.3, 0.6]]))
    with pytest.raises(Undefined, match="all ratings are equal"):
        ANOVA(everywhere)


def test_a_small_spread_is_one() -> None:
    """Differences of a millionth of the range are tested, as scipy does."""
    random = np.random.default_rng(5)
    base = random.uniform(1, 7, 12)
    table = np.column_stack([base, base + 1 + 1e-6 * random.normal(size=12), random.uniform(1, 7, 12)])
    row = PairedContrasts("rating", "condition", "participant")(long(table)).iloc[0]
    assert row["t"] == pytest.approx(stats.ttest_rel(table[:, 0], table[:, 1]).statistic, rel=1e-6)


def test_an_offset_hides_no_residual() -> None:
    """Values between 0 and 1 have the same skewness above 1e6 and 1e12 (as far as float64 holds them)."""
    random = np.random.default_rng(7)
    table = random.integers(0, 257, (14, 4)) / 256  # exact at 1e12 too
    for statistic, name in (
        (Residuals("rating", "condition", "participant"), "skewness"),
        (Residuals("rating", "condition"), "kurtosis"),
        (EqualSpread("rating", "condition"), "levene_w"),
    ):
        expected = statistic(long(table)).iloc[0][name]
        for offset in (1e6, 1e12):
            assert statistic(long(table + offset)).iloc[0][name] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("constant", [True, False])
def test_mauchlys_test_of_a_difference_that_does_not_vary(constant: bool) -> None:
    """Two pictures at 7 by everybody, or rated alike: W would be 0 whatever the other pictures do."""
    random = np.random.default_rng(11)
    table = random.integers(1, 8, (12, 4)).astype(float)
    table[:, 1] = table[:, 0]
    if constant:
        table[:, :2] = 7.0
    row = ANOVA(long(table)).iloc[0]
    assert np.isnan(row["mauchly_w"]) and np.isnan(row["mauchly_p"])
    assert np.isfinite(row[["F", "epsilon_gg", "p_gg"]].astype(float)).all()


def test_mauchlys_p_is_that_of_the_chi_squared_approximation() -> None:
    """Mauchly (1940) from the determinant itself: the library's second-order term moves p by less than a thousandth."""
    table = np.random.default_rng(23).normal(size=(30, 4)) * [1.0, 1.3, 1.0, 0.7]
    row = ANOVA(long(table)).iloc[0]
    contrasts = helmert(4)
    covariance = np.cov(contrasts @ table.T)
    w = np.linalg.det(covariance) / (np.trace(covariance) / 3) ** 3
    chi2 = -(29 - (2 * 9 + 3 + 2) / 18) * np.log(w)
    assert row["mauchly_w"] == pytest.approx(w, rel=1e-9)
    assert row["mauchly_p"] == pytest.approx(stats.chi2.sf(chi2, 5), abs=1e-3)
    assert row["mauchly_p"] == pytest.approx(pingouin.sphericity(pd.DataFrame(table)).pval, rel=1e-9)


def test_mauchlys_test_of_very_unequal_differences_stays() -> None:
    """A W of 1e-8 is one: nothing in it is 0."""
    random = np.random.default_rng(13)
    table = random.normal(size=(30, 3)) * [1.0, 100.0, 0.01]
    expected = pingouin.sphericity(pd.DataFrame(table))
    row = ANOVA(long(table)).iloc[0]
    assert row["mauchly_w"] == pytest.approx(expected.W, rel=1e-6) and row["mauchly_w"] < 1e-3


WITHIN = (
    ANOVA,
    Friedman("rating", "condition", "participant"),
    IntraclassCorrelation("rating", "condition", "participant"),
    KrippendorffAlpha("rating", "condition", "participant", resamples=20),
    MeanIntervals("rating", "condition", "participant"),
    PairedContrasts("rating", "condition", "participant"),
)


@pytest.mark.parametrize("statistic", WITHIN, ids=lambda each: type(each).__name__)
def test_rows_of_no_condition_person_or_value_change_nothing(statistic: object) -> None:
    """Two rows without a condition are no doubled cell, nor is one without a value; who has no name is nobody."""
    frame = long(np.random.default_rng(17).integers(1, 8, (6, 3)).astype(float))
    more = [("p0", None, 3.0), ("p0", None, 4.0), ("p0", "M1", np.nan), (None, "M2", 5.0), (None, "M2", 6.0)]
    added = pd.concat([pd.DataFrame(more, columns=frame.columns), frame], ignore_index=True)
    pd.testing.assert_frame_equal(statistic(added), statistic(frame))  # type: ignore[operator]


@pytest.mark.parametrize("statistic", WITHIN, ids=lambda each: type(each).__name__)
def test_two_values_of_one_cell_are_refused(statistic: object) -> None:
    """With the person's name and the condition's."""
    frame = long(np.random.default_rng(17).integers(1, 8, (6, 3)).astype(float))
    with pytest.raises(BadInput, match='"p2" has two values at condition "M1"; average them first'):
        statistic(pd.concat([frame, frame.iloc[[6]]]))  # type: ignore[operator]
