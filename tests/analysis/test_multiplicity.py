"""Holm's and Benjamini and Hochberg's adjustment against R, in one family and in several."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from statsmodels.stats.multitest import multipletests

from analysis import Adjusted
from analysis.statistics.multiplicity import Method, adjusted
from fakesss.problem import BadInput

R = json.loads((Path(__file__).parents[1] / "data" / "statistics" / "effectsize_tost_padjust_R.json").read_text())
P = R["padjust_input"]


@pytest.mark.parametrize(("method", "theirs"), [("holm", "holm"), ("fdr", "BH")])
def test_agrees_with_r(method: Method, theirs: str) -> None:
    """R's p.adjust to all its digits."""
    table = Adjusted("p", method)(pd.DataFrame({"p": P}))
    assert list(table[f"p_{method}"]) == pytest.approx(R["padjust"][theirs], rel=1e-12)


def test_families_are_adjusted_apart_and_a_test_without_a_value_is_none() -> None:
    """Two families of the same p values have the same adjusted ones; NaN stays and changes nothing."""
    frame = pd.DataFrame({"p": [*P, np.nan, *P], "question": ["a"] * 11 + ["b"] * 10}, index=range(5, 26))
    found = Adjusted("p", "holm", family="question")(frame)["p_holm"].tolist()
    assert found[:10] == pytest.approx(R["padjust"]["holm"]) and np.isnan(found[10]) and found[11:] == found[:10]


def test_one_test_is_adjusted_by_nothing() -> None:
    """A family of one; and of none."""
    assert Adjusted("p", "fdr")(pd.DataFrame({"p": [0.04]}))["p_fdr"].tolist() == [0.04]
    assert Adjusted("p", "holm")(pd.DataFrame({"p": [np.nan]}))["p_holm"].isna().all()


def test_a_column_that_is_not_there() -> None:
    with pytest.raises(BadInput, match='no column "p_value"'):
        Adjusted("p_value", "holm")(pd.DataFrame({"p": P}))


@pytest.mark.parametrize(("ours", "theirs"), [("holm", "holm"), ("fdr", "fdr_bh")])
def test_rows_of_tests_as_statsmodels_has_them(ours: Method, theirs: str) -> None:
    """Studies x tests: each row by itself, with and without tests that have no value."""
    random = np.random.default_rng(9)
    p = random.uniform(0, 1, (12, 7)) ** 3
    p[random.uniform(size=p.shape) < 0.2] = np.nan
    p[0], p[1] = np.nan, 0.01
    for given, found in zip(p, adjusted(p, ours), strict=True):
        there = ~np.isnan(given)
        assert np.isnan(found[~there]).all()
        if there.any():
            assert found[there] == pytest.approx(multipletests(given[there], method=theirs)[1], rel=1e-12)
