"""Tukey's HSD against scipy's own routine and against R; the floor of its p values."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from analysis import TukeyHSD
from analysis.statistics.studentized_range import P_FLOOR, studentized_quantile


def uneven() -> pd.DataFrame:
    """Three samples of 5, 9 and 7 Likert answers."""
    random = np.random.default_rng(5)
    parts = [random.integers(1, 8, n) + shift for n, shift in ((5, 0), (9, 1), (7, 3))]
    return pd.DataFrame(
        [{"condition": f"picture {i}", "rating": float(r)} for i, part in enumerate(parts) for r in part]
    )


def test_independent_samples_agree_with_scipy() -> None:
    """Unequal sizes: Tukey-Kramer p values and intervals."""
    frame = uneven()
    table = TukeyHSD(value="rating", group="condition")(frame)
    parts = [part["rating"].to_numpy() for _, part in frame.groupby("condition")]
    theirs = stats.tukey_hsd(*parts)
    interval = theirs.confidence_interval(0.95)
    for row, (i, j) in zip(table.to_dict("records"), [(0, 1), (0, 2), (1, 2)], strict=True):
        assert row["difference"] == pytest.approx(parts[i].mean() - parts[j].mean())
        assert row["p"] == pytest.approx(theirs.pvalue[i, j], abs=1e-9)
        assert (row["ci_low"], row["ci_high"]) == pytest.approx((interval.low[i, j], interval.high[i, j]), rel=1e-7)


def test_quantiles_of_the_studentized_range() -> None:
    """q(3, 10) of the tables in every textbook; R's HSD of the thesis-shaped ratings."""
    assert round(studentized_quantile(0.95, 3, 10), 2) == 3.88
    assert round(studentized_quantile(0.99, 3, 10), 2) == 5.27
    assert studentized_quantile(0.95, 4, 129) * np.sqrt(2.19326990838619 / 44) == pytest.approx(0.821829079656403)


def test_p_is_never_zero() -> None:
    """Differences far outside the distribution give the bound, not 0."""
    frame = pd.DataFrame({"condition": ["a"] * 5 + ["b"] * 5, "rating": [1, 1, 1, 1, 2, 700, 700, 701, 700, 700]})
    assert TukeyHSD(value="rating", group="condition")(frame)["p"].iloc[0] == P_FLOOR


def test_labels_in_natural_order() -> None:
    """ "image 10" comes after "image 2"."""
    random = np.random.default_rng(2)
    names = ["image 10", "image 2", "image 1"] * 6
    frame = pd.DataFrame({"condition": names, "rating": random.integers(1, 8, 18)})
    table = TukeyHSD(value="rating", group="condition")(frame)
    assert list(zip(table["a"], table["b"], strict=True)) == [
        ("image 1", "image 2"),
        ("image 1", "image 10"),
        ("image 2", "image 10"),
    ]
