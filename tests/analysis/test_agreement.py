"""Agreement and equivalence against Shrout & Fleiss (1979), Krippendorff (2011) and R."""

import json
from pathlib import Path

import krippendorff
import numpy as np
import pandas as pd
import pytest

from analysis import Equivalence, IntraclassCorrelation, KrippendorffAlpha
from analysis.reliability import agreement, icc_entry
from analysis.statistics.undefined import Undefined
from fakesss.problem import BadInput

DATA = Path(__file__).parents[1] / "data" / "statistics"
R = json.loads((DATA / "effectsize_tost_padjust_R.json").read_text())
EXAMPLE = json.loads((DATA / "agreement.json").read_text())["krippendorff_2011"]
SHROUT_FLEISS = {"ICC(1,1)": 0.166, "ICC(A,1)": 0.290, "ICC(C,1)": 0.715} | {
    "ICC(1,k)": 0.443, "ICC(A,k)": 0.620, "ICC(C,k)": 0.909,
}  # fmt: skip


def test_shrout_and_fleiss() -> None:
    """The six coefficients of the paper's example, intervals at full precision."""
    frame = pd.read_csv(DATA / "shrout_fleiss_1979.csv")
    table = IntraclassCorrelation(value="score", target="target", rater="judge")(frame).set_index("type")
    for name, expected in SHROUT_FLEISS.items():
        assert table.loc[name, "icc"] == pytest.approx(expected, abs=5e-4)
    # R psych::ICC: .29 [.019, .761]
    assert tuple(table.loc["ICC(A,1)", ["ci_low", "ci_high"]]) == pytest.approx((0.019, 0.761), abs=1e-3)


@pytest.mark.parametrize("level", ["nominal", "ordinal", "interval", "ratio"])
def test_krippendorff_2011(level: str) -> None:
    """Section C's example with missing data, at each level of measurement."""
    cells = [
        {"rater": rater, "unit": unit, "value": value}
        for rater, row in enumerate(EXAMPLE["data"])
        for unit, value in enumerate(row)
        if value is not None
    ]
    statistic = KrippendorffAlpha(value="value", target="unit", rater="rater", level=level, resamples=200)  # type: ignore[arg-type]
    row = statistic(pd.DataFrame(cells)).iloc[0]
    assert row["alpha"] == pytest.approx(EXAMPLE["published"][level], abs=5e-4)
    assert row["ci_low"] < row["alpha"] < row["ci_high"]


@pytest.mark.parametrize("case", R["tost_translucency"])
def test_equivalence_agrees_with_r(case: dict[str, float]) -> None:
    """Both one-sided p values and the 90% interval."""
    data = R["tost_translucency_data"]
    frame = pd.DataFrame(
        [(who, name, value) for name in ("static", "dynamic") for who, value in enumerate(data[name])],
        columns=["participant", "condition", "rating"],
    )
    frame["condition"] = pd.Categorical(frame["condition"], ["static", "dynamic"])
    row = Equivalence("rating", "condition", "participant", margin=case["bound"])(frame).iloc[0]
    for mine, theirs in (("difference", "diff"), ("p_low", "p_low"), ("p_high", "p_high"), ("p_equivalence", "p_tost")):
        assert row[mine] == pytest.approx(case[theirs], rel=1e-9)
    assert (row["ci_low"], row["ci_high"]) == pytest.approx(case["ci90"], rel=1e-9)
    assert row["verdict"] == ("equivalent" if case["bound"] == 0.5 else "undecided")


def test_sentences() -> None:
    """No margin, no spread, no variation."""
    frame = pd.DataFrame({"who": [1, 1, 2, 2], "what": ["a", "b"] * 2, "value": [3.0, 4, 5, 6]})
    with pytest.raises(BadInput, match="margin: 0: must be above 0"):
        Equivalence("value", "what", "who", margin=0)(frame)
    with pytest.raises(Undefined, match='rates "a" and "b" exactly -1 apart; without spread there is no test'):
        Equivalence("value", "what", "who", margin=1)(frame)
    for statistic in (IntraclassCorrelation("value", "what", "who"), KrippendorffAlpha("value", "what", "who")):
        with pytest.raises(Undefined, match="all ratings are equal, so agreement has no value"):
            statistic(frame.assign(value=4.0))
    alone = frame.assign(what=["a", "b", "c", "d"])
    with pytest.raises(Undefined, match="no what was rated by two whos"):
        KrippendorffAlpha("value", "what", "who")(alone)


def ratings_by(people: list[list[int]]) -> pd.DataFrame:
    cells = [(who, picture, given) for who, row in enumerate(people) for picture, given in enumerate(row)]
    return pd.DataFrame(cells, columns=["rater", "target", "value"])


def test_agreement_without_residual_is_one_and_has_no_interval() -> None:
    found = IntraclassCorrelation("value", "target", "rater")(ratings_by([[1, 2, 3], [2, 3, 4]])).set_index("type")
    assert found.loc["ICC(C,1)", "icc"] == pytest.approx(1)
    assert np.isnan(found.loc["ICC(C,1)", "ci_low"])


def test_pictures_of_one_mean_have_no_icc() -> None:
    with pytest.raises(Undefined, match="every target has the same mean"):
        IntraclassCorrelation("value", "target", "rater")(ratings_by([[1, 2, 3], [3, 2, 1], [2, 2, 2]]))


def test_the_bootstrap_is_seeded() -> None:
    """Same seed, same interval."""
    random = np.random.default_rng(3)
    frame = pd.DataFrame(
        [(who, what, random.integers(1, 8)) for who in range(6) for what in range(8)], columns=list("abc")
    )
    first, second = (KrippendorffAlpha("c", "b", "a", resamples=50, seed=9)(frame) for _ in range(2))
    pd.testing.assert_frame_equal(first, second)


def test_the_report_shows_absolute_agreement() -> None:
    """ICC(A,1) and ICC(A,k) of Shrout and Fleiss: judges' levels count against them, as in ICC(C,.) they do not."""
    frame = pd.read_csv(DATA / "shrout_fleiss_1979.csv")
    entry = icc_entry(frame.rename(columns={"score": "rating", "target": "stimulus", "judge": "participant"}))
    assert (entry["icc_a1"], entry["icc_ak"]) == pytest.approx((0.290, 0.620), abs=5e-4)
    assert (entry["icc_a1_low"], entry["icc_a1_high"]) == pytest.approx((0.019, 0.761), abs=1e-3)


def test_within_sd_is_the_root_of_the_mean_variance() -> None:
    """Variances 2, 0 and 8 of three people: not the mean of their roots."""
    entry = agreement(pd.DataFrame({"a": [1.0, 2, 5], "b": [3.0, 2, 9]}))
    assert entry["within_sd"] == pytest.approx((10 / 3) ** 0.5)


def test_alphas_interval_holds_95_of_100_resamples() -> None:
    """Percentiles 2.5 and 97.5 of the library's alpha of the pictures drawn, from their raw ratings."""
    table = np.random.default_rng(19).integers(1, 6, (5, 9)).astype(float)
    row = KrippendorffAlpha("value", "target", "rater", resamples=200, seed=4)(
        ratings_by(table.astype(int).tolist())
    ).iloc[0]
    draws = np.random.default_rng(4).integers(0, 9, (200, 9))
    resampled = [krippendorff.alpha(reliability_data=table[:, draw], level_of_measurement="ordinal") for draw in draws]
    assert (row["ci_low"], row["ci_high"]) == pytest.approx(tuple(np.quantile(resampled, [0.025, 0.975])), abs=1e-9)


def test_who_shares_no_picture_is_no_rater() -> None:
    """A fourth person whose only picture nobody else rated."""
    frame = ratings_by([[1, 2, 3], [2, 3, 5], [1, 4, 4]])
    alone = pd.DataFrame({"rater": [3], "target": [9], "value": [4]})
    statistic = KrippendorffAlpha("value", "target", "rater", resamples=20)
    pd.testing.assert_frame_equal(statistic(pd.concat([frame, alone])), statistic(frame))
    assert statistic(frame)["n_raters"].iloc[0] == 3


def test_alpha_of_one_picture_and_of_an_unknown_level() -> None:
    """Of one picture alpha is 0 whatever people answer."""
    with pytest.raises(Undefined, match=r"one target was rated by several raters; .* needs two"):
        KrippendorffAlpha("value", "target", "rater")(ratings_by([[1], [5], [3], [7]]))
    with pytest.raises(BadInput, match='level: "ordnial": did you mean "ordinal"'):
        KrippendorffAlpha("value", "target", "rater", level="ordnial")(ratings_by([[1, 2], [3, 4]]))  # type: ignore[arg-type]
