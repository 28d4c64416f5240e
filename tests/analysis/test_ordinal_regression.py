"""Ordinal regression: published digits of the wine data and of UCLA's example, closed forms, and what it refuses."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import statsmodels.miscmodels
from scipy import stats
from statsmodels.miscmodels.ordinal_model import OrderedModel
from statsmodels.tools.numdiff import approx_fprime, approx_hess

from analysis import OrdinalRegression
from analysis.statistics.proportional_odds import CountedOrderedModel
from analysis.statistics.separation import orders
from analysis.statistics.undefined import Undefined

# Randall (1989), as R's `ordinal::wine`: nine judges' ratings of bottles 1-8, two of each temperature and contact
WINE = """23344455 12132354 23325544 32323253 23433333 32322454 11222323 22233334 12323244"""


@pytest.fixture(scope="module")
def wine() -> pd.DataFrame:
    """72 ratings of bitterness."""
    rows = [
        (int(answer), "cold" if bottle < 4 else "warm", "no" if bottle % 4 < 2 else "yes", f"judge {judge}")
        for judge, answers in enumerate(WINE.split())
        for bottle, answer in enumerate(answers)
    ]
    return pd.DataFrame(rows, columns=["rating", "temp", "contact", "judge"])


def cells(**counts: list[int]) -> pd.DataFrame:
    """Level -> how often answers 1, 2, ... were given."""
    rows = [(level, answer) for level, of in counts.items() for answer, times in enumerate(of, 1) for _ in range(times)]
    return pd.DataFrame(rows, columns=["level", "rating"])


def test_wine_as_published(wine: pd.DataFrame) -> None:
    """Christensen's vignette of `ordinal`, clm(rating ~ temp + contact): all it prints."""
    fit = OrdinalRegression("rating", ("temp", "contact")).fit(wine)
    odds = fit.odds_ratios.set_index("factor")
    assert odds["log_odds"].to_numpy() == pytest.approx([2.5031, 1.5278], abs=5e-5)
    assert odds["se"].to_numpy() == pytest.approx([0.5287, 0.4766], abs=5e-5)
    assert fit.thresholds["value"].to_numpy() == pytest.approx([-1.3444, 1.2508, 3.4669, 5.0064], abs=5e-5)
    assert fit.thresholds["threshold"].tolist() == ["1|2", "2|3", "3|4", "4|5"]
    assert fit.log_likelihood == pytest.approx(-86.49192, abs=5e-6)
    assert (fit.n, fit.clusters) == (72, 0)
    assert fit.tests["chi2"].to_numpy() == pytest.approx((odds["log_odds"] / odds["se"]).to_numpy() ** 2)


def test_wine_with_interaction(wine: pd.DataFrame) -> None:
    """The interaction's deviance is .1514 (published), which Wald's test of it nearly is."""
    fit = OrdinalRegression("rating", ("temp", "contact"), interactions=True).fit(wine)
    plain = OrdinalRegression("rating", ("temp", "contact")).fit(wine)
    assert 2 * (fit.log_likelihood - plain.log_likelihood) == pytest.approx(0.1514, abs=5e-5)
    assert fit.tests["term"].tolist() == ["temp", "contact", "temp × contact"]
    assert fit.tests["chi2"].iloc[2] == pytest.approx(0.1514, abs=5e-4)


def test_ucla_as_stata() -> None:
    """UCLA's page on Stata's ologit; MASS::polr, which stops earlier, has the same to four digits."""
    folder = Path(statsmodels.miscmodels.__file__).parent / "tests" / "results"
    frame = pd.read_csv(folder / "ologit_ucla.csv")
    code = frame["apply"].map({"unlikely": 0, "somewhat likely": 1, "very likely": 2}).to_numpy()
    model = CountedOrderedModel(code, frame[["pared", "public", "gpa"]].to_numpy(float), np.ones(400))
    params = model.fit(method="newton", disp=0).params
    assert params[:3] == pytest.approx([1.047664, -0.0586828, 0.6157458], abs=5e-7)
    assert model.transform_threshold_params(params)[1:-1] == pytest.approx([2.203323, 4.298767], abs=5e-7)
    errors = np.sqrt(np.diag(np.linalg.inv(-model.hessian(params))))[:3]
    assert errors == pytest.approx([0.2657891, 0.2978588, 0.2606311], abs=5e-6)
    assert model.loglike(params) == pytest.approx(-358.51244, abs=5e-6)


def test_two_answers_and_two_levels_are_a_table_of_four_cells() -> None:
    """The log odds ratio ad/bc and Woolf's standard error, exactly."""
    row = OrdinalRegression("rating", ("level",)).fit(cells(a=[7, 13], b=[5, 31])).odds_ratios.iloc[0]
    assert row["odds_ratio"] == pytest.approx(7 * 31 / (13 * 5), rel=1e-10)
    assert row["se"] == pytest.approx(np.sqrt(1 / 7 + 1 / 13 + 1 / 5 + 1 / 31), rel=1e-10)
    assert (row["level"], row["against"]) == ("b", "a")
    reach = stats.norm.ppf(0.975) * row["se"]
    assert (row["ci_low"], row["ci_high"]) == pytest.approx(tuple(row["odds_ratio"] * np.exp([-reach, reach])))


def test_derivatives_are_those_of_the_likelihood() -> None:
    """Score and second derivatives against differences, away from the maximum."""
    rng = np.random.default_rng(11)
    answers, exog = np.repeat(np.arange(5), 7), rng.normal(size=(35, 3))
    model = CountedOrderedModel(answers, exog, rng.integers(1, 9, 35).astype(float))
    params = model.start_params + rng.normal(scale=0.3, size=7)
    assert model.score(params) == pytest.approx(approx_fprime(params, model.loglike, centered=True), abs=1e-5)
    assert model.hessian(params) == pytest.approx(approx_hess(params, model.loglike), abs=2e-3)


def test_clustered_errors_are_statsmodels_row_by_row(wine: pd.DataFrame) -> None:
    """The same sandwich from every rating, but for statsmodels' factor (n - 1) / (n - parameters)."""
    exog = np.column_stack([wine["temp"] == "warm", wine["contact"] == "yes"]).astype(float)
    groups = {"groups": pd.factorize(wine["judge"])[0]}
    reference = OrderedModel(wine["rating"].to_numpy(), exog, distr="logit").fit(
        method="newton", disp=0, cov_type="cluster", cov_kwds=groups
    )
    fit = OrdinalRegression("rating", ("temp", "contact"), "judge").fit(wine)
    assert fit.odds_ratios["se"].to_numpy() == pytest.approx(reference.bse[:2] * np.sqrt(66 / 71), rel=1e-5)
    assert fit.clusters == 9 and fit.cautions == ()


def test_clustered_tests_are_hotellings(wine: pd.DataFrame) -> None:
    """T squared of q means of G judges is (G - 1) q / (G - q) times F; one coefficient has t with G - 1."""
    bottles = wine.assign(bottle=[f"b{number % 8 // 2}" for number in range(72)])
    (row,) = OrdinalRegression("rating", ("bottle",), "judge")(bottles).to_dict("records")
    assert (row["df"], row["df2"]) == (3, 6)
    assert row["F"] == pytest.approx(6 / (8 * 3) * row["chi2"], rel=1e-12)
    assert row["p"] == pytest.approx(stats.f.sf(row["F"], 3, 6), rel=1e-12)
    fit = OrdinalRegression("rating", ("temp",), "judge", confidence=0.9).fit(wine)
    (odds,), (test,) = fit.odds_ratios.to_dict("records"), fit.tests.to_dict("records")
    t = odds["log_odds"] / odds["se"]
    assert (test["F"], test["df2"]) == (pytest.approx(t**2), 8)
    assert test["p"] == pytest.approx(2 * stats.t.sf(abs(t), 8), rel=1e-9)
    reach = stats.t.ppf(0.95, 8) * odds["se"]
    expected = np.exp([odds["log_odds"] - reach, odds["log_odds"] + reach])
    assert (odds["ci_low"], odds["ci_high"]) == pytest.approx(tuple(expected))
    alone = OrdinalRegression("rating", ("temp",))(wine).iloc[0]
    assert np.isnan(alone["F"]) and alone["p"] == pytest.approx(stats.chi2.sf(alone["chi2"], 1))


def test_many_pictures_of_few_people_are_no_effect() -> None:
    """20 people, 9 pictures, no effect: chi-squared would find one in more than a quarter of studies."""
    random, found, taken = np.random.default_rng(29), 0, 0
    for _ in range(40):
        answers = np.clip(np.round(4 + random.normal(0, 1, (20, 1)) + random.normal(0, 1.2, (20, 9))), 1, 7)
        frame = pd.DataFrame(
            {"rating": answers.ravel(), "who": np.repeat(np.arange(20), 9), "level": [*"abcdefghi"] * 20}
        )
        row = OrdinalRegression("rating", ("level",), "who")(frame).iloc[0]
        found += row["p"] < 0.05
        taken += stats.chi2.sf(row["chi2"], 8) < 0.05
    assert found <= 5 and taken >= 8


def test_row_order_names_and_a_shift_of_the_scale_change_nothing(wine: pd.DataFrame) -> None:
    """Also not the gap that an unused answer leaves."""
    statistic = OrdinalRegression("rating", ("temp", "contact"), "judge", interactions=True)
    expected = statistic(wine)["chi2"].to_numpy()
    shuffled = wine.sample(frac=1, random_state=3)
    assert statistic(shuffled)["chi2"].to_numpy() == pytest.approx(expected, rel=1e-9)
    renamed = wine.assign(judge=wine["judge"].str.upper() + ' "x"', rating=wine["rating"].map(lambda r: 100 + r * r))
    assert statistic(renamed)["chi2"].to_numpy() == pytest.approx(expected, rel=1e-9)


def test_a_higher_answer_is_an_odds_ratio_above_one() -> None:
    """The direction, which a sign would turn."""
    row = OrdinalRegression("rating", ("level",)).fit(cells(low=[9, 5, 2], high=[2, 5, 9])).odds_ratios.iloc[0]
    assert row["level"] == "low" and row["odds_ratio"] < 1


@pytest.mark.parametrize(
    ("frame", "sentence"),
    [
        (cells(a=[3, 4, 0], b=[0, 5, 2]), 'every rating at level "b" is at or above every rating elsewhere'),
        (cells(a=[3, 4, 1], b=[2, 5, 2], c=[0, 0, 4]), 'every rating at level "c" is at or above'),
        (cells(a=[0, 0, 4], b=[0, 0, 4]), "all ratings are equal"),
        (cells(a=[3, 4]), "1 level with ratings"),
        (cells(a=[1] * 60, b=[1] * 60), "60 different answers"),
    ],
)
def test_what_has_no_value_is_said(frame: pd.DataFrame, sentence: str) -> None:
    """Never a NaN, never an odds ratio of 10^8."""
    with pytest.raises(Undefined, match=sentence):
        OrdinalRegression("rating", ("level",))(frame)


def test_levels_that_only_together_order_the_ratings(wine: pd.DataFrame) -> None:
    """No factor alone separates, no cell does; linear programming finds the direction, and none in the wine."""
    cells = {("a", "x"): (1, 2), ("a", "y"): (2, 3), ("b", "x"): (2, 3), ("b", "y"): (3, 4)}
    rows = [(*cell, answer) for cell, answers in cells.items() for answer in answers]
    frame = pd.DataFrame(rows, columns=["one", "two", "rating"])
    with pytest.raises(Undefined, match="levels together order the ratings without a fault"):
        OrdinalRegression("rating", ("one", "two"))(frame)
    exog = np.column_stack([wine["temp"] == "warm", wine["contact"] == "yes"]).astype(float)
    assert not orders(wine["rating"].to_numpy() - 1, exog)


def test_people_too_few_for_clustered_errors(wine: pd.DataFrame) -> None:
    """One, fewer than the test has degrees of freedom, and fewer than parameters."""
    with pytest.raises(Undefined, match="one judge; clustered standard errors need at least two"):
        OrdinalRegression("rating", ("temp",), "judge")(wine.assign(judge="me"))
    bottles = wine.assign(bottle=[str(number % 8) for number in range(72)])
    three = bottles.assign(judge=wine["judge"].str[-1].astype(int) // 3)
    with pytest.raises(Undefined, match=r"3 judges for the 7 degrees of freedom of bottle; .* need more judges"):
        OrdinalRegression("rating", ("bottle",), "judge")(three)
    fit = OrdinalRegression("rating", ("temp",), "judge").fit(three)
    assert fit.cautions == ("3 judges for 5 parameters; clustered standard errors are too small then",)


def test_an_empty_cell_is_named() -> None:
    """Interactions need every combination."""
    frame = pd.DataFrame({"one": list("aabb") * 3, "two": list("xyxx") * 3, "rating": [1, 2, 3, 2, 1, 3] * 2})
    with pytest.raises(Undefined, match=r'1 of 4 cells have no rating .such as one "b", two "y"'):
        OrdinalRegression("rating", ("one", "two"), interactions=True)(frame)


def test_too_many_levels_are_not_fitted() -> None:
    """A sentence at once instead of minutes."""
    frame = pd.DataFrame({"level": np.repeat(np.arange(1500), 3), "rating": np.tile([1, 2, 3], 1500)})
    with pytest.raises(Undefined, match="1501 parameters of 4500 distinct rows would take minutes"):
        OrdinalRegression("rating", ("level",))(frame)
