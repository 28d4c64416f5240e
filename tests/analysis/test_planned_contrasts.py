"""Planned contrasts against exact rationals; simple effects against analyses of the parts by themselves."""

from fractions import Fraction

import numpy as np
import pandas as pd
import pingouin
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy import stats

from analysis import PlannedContrast, RepeatedMeasuresAnova, SimpleEffects
from analysis.statistics.undefined import Undefined
from fakesss.problem import BadInput

quick = settings(max_examples=30, deadline=None)


def long(rows: list[list[int]]) -> pd.DataFrame:
    """People x pictures as a long frame."""
    cells = [(f"p{who}", f"img{place}", value) for who, row in enumerate(rows) for place, value in enumerate(row)]
    return pd.DataFrame(cells, columns=["participant", "stimulus", "rating"])


def contrast(frame: pd.DataFrame, *weights: float) -> "pd.Series[float]":
    """The only row; weights of img0, img1, ..."""
    named = {f"img{place}": weight for place, weight in enumerate(weights)}
    return PlannedContrast("rating", "stimulus", "participant", named)(frame).iloc[0]


@quick
@given(
    st.lists(st.lists(st.integers(1, 7), min_size=4, max_size=4), min_size=2, max_size=9),
    st.lists(st.integers(-3, 3), min_size=3, max_size=3),
)
def test_exact_on_likert_data(rows: list[list[int]], first: list[int]) -> None:
    """Estimate, t and d_z equal what rationals of the weighted sums give."""
    weights = [*first, -sum(first)]
    sums = [Fraction(sum(w * value for w, value in zip(weights, row, strict=True))) for row in rows]
    mean = sum(sums) / len(sums)
    variance = sum((each - mean) ** 2 for each in sums) / (len(sums) - 1)
    assume(any(weights) and variance > 0)
    row = contrast(long(rows), *weights)
    assert row["estimate"] == pytest.approx(float(mean), rel=1e-12, abs=1e-12)
    assert row["t"] ** 2 == pytest.approx(float(mean**2 * len(sums) / variance), rel=1e-10, abs=1e-12)
    assert row["d_z"] ** 2 == pytest.approx(float(mean**2 / variance), rel=1e-10, abs=1e-12)
    assert (row["n"], row["df"]) == (len(rows), len(rows) - 1)


def test_two_pictures_are_a_paired_t_test() -> None:
    """t, interval and p of scipy's, pingouin's d_av; shifted and doubled weights change what they must."""
    rows = np.random.default_rng(2).integers(1, 8, (12, 3)).tolist()
    a, b, _ = np.array(rows).T
    row = contrast(long(rows), 1, -1, 0)
    found = stats.ttest_rel(a, b)
    interval = found.confidence_interval(0.95)
    assert tuple(row[["t", "p", "ci_low", "ci_high"]]) == pytest.approx(
        (found.statistic, found.pvalue, interval.low, interval.high)
    )
    assert row["d_av"] == pytest.approx(pingouin.compute_effsize(a, b, paired=True, eftype="cohen"))
    twice = contrast(long(rows), 2, -2, 0)
    assert twice["estimate"] == pytest.approx(2 * row["estimate"])
    assert tuple(twice[["t", "p", "d_z", "d_av"]]) == pytest.approx(tuple(row[["t", "p", "d_z", "d_av"]]))


def test_a_person_without_one_of_the_pictures_is_dropped_and_named() -> None:
    """Other pictures may be missing."""
    frame = long([[1, 4, 2], [3, 3, 1], [2, 6, 3], [5, 6, 7]])
    gone = (frame["participant"] == "p1") & (frame["stimulus"] == "img1")
    gone |= (frame["participant"] == "p2") & (frame["stimulus"] == "img2")
    row = contrast(frame[~gone], 1, -1, 0)
    assert (row["n"], row["dropped"]) == (3, "p1")


def test_sentences() -> None:
    """An unknown picture, sums without spread, one person, weights of a mean."""
    frame = long([[1, 4, 2], [3, 6, 1], [2, 5, 3]])
    with pytest.raises(Undefined, match='nobody rated "img3"; did you mean "img'):
        contrast(frame, 1, 0, 0, -1)
    with pytest.raises(Undefined, match="every participant's weighted sum is -3; without spread there is no test"):
        contrast(frame, 1, -1, 0)
    with pytest.raises(Undefined, match="1 participants rated all"):
        contrast(frame[frame["participant"] == "p0"], 1, -1, 0)
    with pytest.raises(BadInput, match="weights: add up to 1; they must add up to 0"):
        contrast(frame, 1, 0, 0)
    with pytest.raises(BadInput, match="two values at one stimulus"):
        contrast(pd.concat([frame, frame]), 1, -1, 0)


def test_simple_effects_are_the_analyses_of_the_parts() -> None:
    """Each factor at each level of the other, Holm over all five; a part without spread has its reason."""
    ratings = np.random.default_rng(8).integers(1, 8, (10, 2, 3))
    cells = [(f"p{who}", f"a{a}", f"b{b}", value) for (who, a, b), value in np.ndenumerate(ratings)]
    frame = pd.DataFrame(cells, columns=["participant", "A", "B", "rating"])
    table = SimpleEffects("rating", ("A", "B"), "participant")(frame)
    assert list(zip(table["factor"], table["at"], strict=True)) == [
        ("A", "B b0"), ("A", "B b1"), ("A", "B b2"), ("B", "A a0"), ("B", "A a1"),
    ]  # fmt: skip
    part = RepeatedMeasuresAnova("rating", "B", "participant")(frame[frame["A"] == "a1"]).iloc[0]
    for name in ("F", "p_gg", "epsilon_gg", "partial_eta_squared"):
        assert table[name].iloc[4] == pytest.approx(part[name])
    assert table["p_holm"].min() == pytest.approx(min(1, 5 * table["p_gg"].min()))
    flat = frame.assign(rating=frame["rating"].where(frame["A"] == "a1", 4))
    told = SimpleEffects("rating", ("A", "B"), "participant")(flat)
    assert np.isnan(told["F"].iloc[3]) and "all ratings are equal" in told["reason"].iloc[3]
    assert told["p_holm"].notna().sum() == 4
