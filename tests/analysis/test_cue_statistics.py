"""Slopes on image cues and what cues explain: independent computation, closed forms, sentences where there is none."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats
from statsmodels.formula.api import ols
from statsmodels.stats.multitest import multipletests

from analysis.statistics.cues import CueRegression, CueSlopes, ExplainedMeans, correlation_with, person_slopes
from analysis.statistics.undefined import Undefined
from fakesss.problem import BadInput

COLUMNS = ("rating", "participant", "picture")


def rated(people: int = 9, pictures: int = 8, seed: int = 1, missing: int = 0) -> pd.DataFrame:
    """Ratings 1..7 that rise with cue a, of people with slopes of their own; cues b and c are noise."""
    rng = np.random.default_rng(seed)
    cues = pd.DataFrame(rng.normal(size=(pictures, 3)), columns=["a", "b", "c"])
    rows = [
        {"participant": f"p{who}", "picture": f"img{place}", "at": place, "rating": 4 + slope * a + rng.normal()}
        for who, slope in enumerate(rng.normal(0.8, 0.4, people))
        for place, a in enumerate(cues["a"])
    ]
    frame = pd.DataFrame(rows).assign(rating=lambda table: table["rating"].round().clip(1, 7))
    frame = frame.merge(cues, left_on="at", right_index=True).drop(columns="at")
    return frame.sample(len(frame) - missing, random_state=seed).reset_index(drop=True)


def by_hand(frame: pd.DataFrame, cue: str) -> "pd.Series[float]":
    """Every person's slope on the standardised cue, by scipy."""
    values = frame.drop_duplicates("picture")[cue]
    z = (frame[cue] - values.mean()) / values.std()
    parts = frame.assign(z=z).groupby("participant")
    return pd.Series({who: stats.linregress(part["z"], part["rating"]).slope for who, part in parts})


@pytest.mark.parametrize("missing", [0, 11])
def test_slopes_are_a_t_test_of_each_persons_regression(missing: int) -> None:
    frame = rated(missing=missing)
    table = CueSlopes(*COLUMNS, ("a", "b", "c"))(frame).set_index("cue")
    for cue in ("a", "b", "c"):
        slopes = by_hand(frame, cue)
        expected = stats.ttest_1samp(slopes, 0.0)
        interval = expected.confidence_interval()
        found = table.loc[cue]
        assert [found["slope"], found["t"], found["p"], found["ci_low"], found["ci_high"]] == pytest.approx(
            [slopes.mean(), expected.statistic, expected.pvalue, interval.low, interval.high], rel=1e-10
        )
        means = frame.groupby("picture")["rating"].mean()
        values = frame.drop_duplicates("picture").set_index("picture")[cue]
        over_pictures = stats.linregress(values[means.index], means)
        assert [found["r"], found["p_pictures"]] == pytest.approx([over_pictures.rvalue, over_pictures.pvalue])
        assert (found["n"], found["df"], found["pictures"]) == (9, 8, 8)
    for p in ("p", "p_pictures"):
        assert list(table[f"{p}_holm"]) == pytest.approx(list(multipletests(table[p], method="holm")[1]))
    assert table["p"]["a"] < 0.01


@settings(max_examples=25)
@given(st.integers(0, 10**6), st.floats(0.001, 1000), st.floats(-100, 100), st.sampled_from([0, 5]))
def test_a_cues_unit_and_the_scales_origin_do_not_matter(seed: int, unit: float, origin: float, missing: int) -> None:
    frame = rated(5, 6, seed, missing)
    changed = frame.assign(a=frame["a"] * unit + origin * unit, rating=frame["rating"] + 1e6)
    mine, other = (CueSlopes(*COLUMNS, ("a",))(each).iloc[0] for each in (frame, changed.iloc[::-1]))
    names = ["slope", "r", "ci_low", "ci_high"]
    assert list(other[names].astype(float)) == pytest.approx(list(mine[names].astype(float)), rel=1e-6, abs=1e-7)


def test_who_saw_pictures_of_one_cue_value_has_no_slope() -> None:
    z = np.array([-1.0, -1.0, 2.0])
    ratings = np.array([[1.0, 5.0, np.nan], [1.0, 1.0, 4.0], [np.nan, 2.0, 5.0], [np.nan, np.nan, np.nan]])
    assert list(person_slopes(ratings, z)) == pytest.approx([1.0, 1.0])


def test_people_of_one_mind_have_a_slope_and_no_test() -> None:
    showings = [(who, k) for who in "xyz" for k in range(3)]
    frame = pd.DataFrame(
        [{"participant": w, "picture": f"i{k}", "rating": 1 + k, "a": k, "b": [1, 0, 1][k]} for w, k in showings]
    )
    table = CueSlopes(*COLUMNS, ("a", "b"))(frame)
    assert list(table["slope"]) == pytest.approx([1.0, 0.0]) and list(table["r"]) == pytest.approx([1.0, 0.0])
    assert table[["t", "p", "p_holm", "ci_low"]].isna().all(axis=None)


def test_two_pictures_and_means_on_a_line_tell_nothing_of_others() -> None:
    two = CueSlopes(*COLUMNS, ("a",))(rated(pictures=2)).iloc[0]
    assert abs(two["r"]) == pytest.approx(1) and np.isnan(two["p_pictures"]) and 0 < two["p"] < 1
    showings = [(who, k) for who in range(3) for k in range(4)]
    line = pd.DataFrame(
        [{"participant": w, "picture": f"i{k}", "rating": k + (w - 1) * (k == 2), "a": k} for w, k in showings]
    )
    found = CueSlopes(*COLUMNS, ("a",))(line).iloc[0]
    assert found["r"] == pytest.approx(1) and np.isnan(found["p_pictures"]) and np.isnan(found["p_pictures_holm"])


def test_a_cue_that_is_chance_is_beyond_it_in_these_people_and_not_in_pictures() -> None:
    """Nine pictures that differ, a cue drawn at random: the slopes' test rejects far too often, r's at its level."""
    people, small = 0, 0
    for seed in range(60):
        rng = np.random.default_rng([7, seed])
        who, at = (index.ravel() for index in np.indices((20, 9)))
        rating = np.clip(np.rint(4 + rng.normal(size=9)[at] + rng.normal(size=180)), 1, 7)
        frame = pd.DataFrame({"participant": who, "picture": at, "rating": rating, "a": rng.normal(size=9)[at]})
        found = CueSlopes(*COLUMNS, ("a",))(frame).iloc[0]
        people, small = people + (found["p"] < 0.05), small + (found["p_pictures"] < 0.05)
    assert people > 30 and small < 10


def test_one_cue_of_complete_data_has_the_same_slope_in_both() -> None:
    """The textbook identity: with equal designs the pooled slope is the mean of the people's."""
    frame = rated()
    pooled, own = (S(*COLUMNS, ("a",))(frame).iloc[0] for S in (CueRegression, CueSlopes))
    assert pooled["slope"] == pytest.approx(own["slope"], rel=1e-12)


@pytest.mark.parametrize("missing", [0, 7])
def test_the_regression_is_statsmodels_formula_clustered_by_person(missing: int) -> None:
    frame = rated(12, 10, missing=missing)
    one = frame.drop_duplicates("picture")
    z = frame.assign(**{cue: (frame[cue] - one[cue].mean()) / one[cue].std() for cue in "abc"})
    groups = pd.factorize(z["participant"])[0]
    expected = ols("rating ~ a + b + c", z).fit(cov_type="cluster", cov_kwds={"groups": groups}, use_t=True)
    found = CueRegression(*COLUMNS, ("a", "b", "c"))(frame).set_index("cue")
    for name, values in (("slope", expected.params), ("se", expected.bse), ("p", expected.pvalues)):
        assert list(found[name]) == pytest.approx(list(values[["a", "b", "c"]]), rel=1e-8)
    assert set(found["df"]) == {11}
    inverse = np.linalg.inv(np.corrcoef(one[["a", "b", "c"]].to_numpy().T))
    assert list(found["vif"]) == pytest.approx(list(np.diag(inverse)))


def test_explained_means() -> None:
    frame = rated()
    means = frame.groupby("picture")["rating"].mean()
    cues = frame.drop_duplicates("picture").set_index("picture").loc[means.index]
    expected = ols("rating ~ a + b", cues.assign(rating=means)).fit()
    found = ExplainedMeans(*COLUMNS, ("a", "b"))(frame).iloc[0]
    names = {
        "r2": expected.rsquared,
        "r2_adjusted": expected.rsquared_adj,
        "F": expected.fvalue,
        "p": expected.f_pvalue,
    }
    assert {name: found[name] for name in names} == pytest.approx(names)
    assert (found["pictures"], found["df1"], found["df2"]) == (8, 2, 5)


def test_an_exact_line_explains_all_and_has_no_f() -> None:
    frame = pd.DataFrame(
        [{"participant": w, "picture": f"i{k}", "rating": 2.0 * k + (w == "y"), "a": k} for w in "xy" for k in range(4)]
    )
    found = ExplainedMeans(*COLUMNS, ("a",))(frame).iloc[0]
    assert found["r2"] == 1 and np.isnan(found["F"]) and np.isnan(found["p"])


def flat(frame: pd.DataFrame) -> pd.DataFrame:
    return frame.assign(a=0.25)


def one_rating_each(frame: pd.DataFrame) -> pd.DataFrame:
    return frame.drop_duplicates("participant")


@pytest.mark.parametrize(
    ("statistic", "change", "sentence"),
    [
        (CueSlopes(*COLUMNS, ("a",)), flat, "a: is the same in all pictures, so nothing goes along with it"),
        (
            CueSlopes(*COLUMNS, ("a",)),
            one_rating_each,
            "rating by a: 0 participants rated pictures in which it differs",
        ),
        (CueRegression(*COLUMNS, ("a",)), flat, "a: is the same in all pictures"),
        (CueRegression(*COLUMNS, ("a",)), lambda f: f.assign(rating=4), "all ratings are equal"),
        (CueRegression(*COLUMNS, ("a",)), lambda f: f.assign(rating=f["a"]), "the cues leave no residual"),
        (CueRegression(*COLUMNS, ("a",)), lambda f: f[f["participant"] == "p0"], "one participant is no sample"),
        (
            CueRegression(*COLUMNS, ("a", "b", "c")),
            lambda f: f[f["picture"] < "img4"],
            "rating: 4 pictures for 3 predictors; at least 5 are needed, or they explain anything",
        ),
        (ExplainedMeans(*COLUMNS, ("a",)), lambda f: f.assign(rating=4), "all pictures have the same mean"),
        (ExplainedMeans(*COLUMNS, ("a", "b")), lambda f: f[f["picture"] < "img3"], "3 pictures for 2 predictors"),
    ],
)
def test_what_has_no_value_says_why(statistic: object, change: object, sentence: str) -> None:
    with pytest.raises(Undefined, match=sentence):
        statistic(change(rated()))  # type: ignore[operator]


def test_a_doubled_rating_is_refused() -> None:
    frame = rated()
    with pytest.raises(BadInput, match='has two values of "img'):
        CueSlopes(*COLUMNS, ("a",))(pd.concat([frame, frame.head(1)]))


def test_multiple_correlation() -> None:
    x = np.array([-1.0, -1.0, 1.0, 1.0])
    y = np.array([-1.0, 1.0, -1.0, 1.0])
    assert correlation_with(x, np.empty((4, 0))) == 0
    assert correlation_with(x + y, x[:, None]) == pytest.approx(np.sqrt(0.5))
    assert correlation_with(x + y, np.column_stack([x, y])) == pytest.approx(1)
