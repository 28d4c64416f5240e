"""Mixed models and variance components: lme4's published Penicillin, closed forms of balanced data, and refusals."""

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from analysis import MixedModel, RepeatedMeasuresAnova, VarianceComponents
from analysis.statistics.undefined import Undefined

# Davies & Goldsmith (1972), as R's `lme4::Penicillin`: diameters of 24 plates (rows) by 6 samples
PENICILLIN = """
27 23 26 23 23 21  27 23 26 23 23 21  25 21 25 24 24 20  26 23 25 23 23 20  25 22 26 22 23 20  24 22 25 23 22 19
24 20 23 21 22 19  26 22 26 24 24 21  24 21 24 22 22 20  24 21 24 23 22 19  26 23 26 24 24 21  25 22 26 24 24 20
26 24 26 24 25 22  26 23 26 23 23 20  26 23 25 24 24 22  25 22 25 23 23 20  25 21 24 23 23 20  25 22 24 23 23 19
24 21 23 21 21 19  26 23 26 24 24 21  25 21 24 22 22 18  25 22 25 22 22 20  24 21 24 22 24 19  24 21 24 22 21 18
"""
THESIS = Path(__file__).parents[1] / "data" / "statistics" / "thesis_shaped_repeated_n44.csv"
CROSSED = {"value": "rating", "participant": "participant", "picture": "picture"}


def crossed(table: np.ndarray) -> pd.DataFrame:
    """People x pictures as one row per rating."""
    people, pictures = table.shape
    return pd.DataFrame(
        {
            "participant": np.repeat([f"p{who}" for who in range(people)], pictures),
            "picture": np.tile([f"i{which}" for which in range(pictures)], people),
            "rating": table.ravel(),
        }
    )


def simulated(people: int, pictures: int, of_people: float, of_pictures: float, seed: int = 5) -> np.ndarray:
    """Ratings with standard deviations of people and pictures, and a residual of 1."""
    rng = np.random.default_rng(seed)
    rows, columns = rng.normal(size=(people, 1)) * of_people, rng.normal(size=(1, pictures)) * of_pictures
    return rows + columns + rng.normal(size=(people, pictures))


def mean_squares(table: np.ndarray) -> tuple[Fraction, Fraction, Fraction]:
    """Of people, of pictures and of what is left, exactly."""
    exact = [[Fraction(float(cell)) for cell in row] for row in table]
    n, k = table.shape
    rows = [sum(row) / k for row in exact]
    columns = [sum(row[j] for row in exact) / n for j in range(k)]
    grand = sum(rows) / n
    left = sum((exact[i][j] - rows[i] - columns[j] + grand) ** 2 for i in range(n) for j in range(k))
    people = k * sum((row - grand) ** 2 for row in rows) / (n - 1)
    return people, n * sum((column - grand) ** 2 for column in columns) / (k - 1), left / ((n - 1) * (k - 1))


def test_penicillin_as_lme4_prints_it() -> None:
    """Bates et al. (2015): standard deviations .8467 (plate), 1.9316 (sample), .5499 (residual)."""
    table = np.array(PENICILLIN.split(), dtype=float).reshape(24, 6)
    found = VarianceComponents(**CROSSED)(crossed(table))
    assert np.sqrt(found["variance"]).tolist() == pytest.approx([0.84671, 1.93156, 0.54992], abs=1e-5)
    assert found["term"].tolist() == ["participant", "picture", "residual"]
    assert found["share"].sum() == pytest.approx(1)


@pytest.mark.parametrize("shape", [(12, 5), (30, 9)])
def test_balanced_ratings_have_the_mean_squares_estimates(shape: tuple[int, int]) -> None:
    """REML is the analysis of variance's estimator where that is positive; so is ICC(A,1) then the pictures' share."""
    table = np.round(2 * simulated(*shape, 0.8, 0.6)) / 2
    people, pictures, left = mean_squares(table)
    expected = [(people - left) / shape[1], (pictures - left) / shape[0], left]
    found = VarianceComponents(**CROSSED)(crossed(table))
    assert found["variance"].tolist() == pytest.approx([float(part) for part in expected], rel=1e-6)


def test_complete_rows_have_the_f_of_repeated_measures() -> None:
    """chi-squared is df1 F, and the residual the mean square of error: the thesis's rows, against R's."""
    frame = pd.read_csv(THESIS)
    frame = frame[(frame["scale"] == "translucent") & frame["image"].isin(["img01", "img02", "img03"])]
    fit = MixedModel("rating", ("image",), "participant", "image").fit(frame)
    anova = RepeatedMeasuresAnova("rating", "image", "participant")(frame).iloc[0]
    assert fit.tests["chi2"].iloc[0] == pytest.approx(2 * 22.4277022412616, rel=1e-7)
    assert fit.tests["chi2"].iloc[0] == pytest.approx(2 * anova["F"], rel=1e-7)
    residual = fit.variances.set_index("term")["variance"]["residual"]
    assert residual == pytest.approx(2.83773784355179, rel=1e-7)
    assert fit.left_out == (
        "every cell is one image, so the variance of images cannot be told from the factors' effects",
    )


def dense_likelihood(frame: pd.DataFrame, fixed: np.ndarray, variances: tuple[float, float, float]) -> float:
    """REML log-likelihood from the whole covariance matrix, but for a constant."""
    who, which = (pd.get_dummies(frame[name]).to_numpy(float) for name in ("participant", "picture"))
    covariance = variances[0] * who @ who.T + variances[1] * which @ which.T + variances[2] * np.eye(len(frame))
    inverse = np.linalg.inv(covariance)
    precision = fixed.T @ inverse @ fixed
    y = frame["rating"].to_numpy()
    left = y - fixed @ np.linalg.solve(precision, fixed.T @ inverse @ y)
    parts = np.linalg.slogdet(covariance)[1], np.linalg.slogdet(precision)[1], left @ inverse @ left
    return float(-sum(parts) / 2)


def test_incomplete_ratings_reach_the_likelihoods_maximum() -> None:
    """Pictures within levels, some cells missing: no step from the estimate climbs the likelihood written out anew."""
    frame = crossed(simulated(14, 8, 0.7, 0.5)).sample(80, random_state=1)
    frame["level"] = frame["picture"].map(lambda name: "abcd"[int(name[1]) % 4])
    fit = MixedModel("rating", ("level",), "participant", "picture").fit(frame)
    at = tuple(fit.variances["variance"])
    assert min(at) > 0 and fit.left_out == () and fit.at_zero == ()
    fixed = pd.get_dummies(frame["level"]).to_numpy(float)
    best = dense_likelihood(frame, fixed, at)
    for place in range(3):
        for factor in (0.99, 1.01):
            moved = [part * factor if place == index else part for index, part in enumerate(at)]
            assert dense_likelihood(frame, fixed, (moved[0], moved[1], moved[2])) < best


def test_a_variance_of_zero_is_said_and_left_out() -> None:
    """Where people's mean square is below the residual's, REML ends at 0; the rest is then one-way."""
    table = simulated(10, 6, 0.0, 0.9)
    table -= 0.9 * (table.mean(axis=1, keepdims=True) - table.mean())
    people, _, left = mean_squares(table)
    assert people < left
    found = VarianceComponents(**CROSSED)(crossed(table)).set_index("term")["variance"]
    assert found["participant"] == 0 and found["picture"] > 0
    fit = MixedModel("rating", ("picture",), "participant", None).fit(crossed(table))
    assert fit.at_zero == ("participant",)
    within = sum(((table - table.mean(axis=0)) ** 2).ravel()) / (60 - 6)
    assert fit.variances.set_index("term")["variance"]["residual"] == pytest.approx(within)


def test_both_variances_may_be_zero() -> None:
    """Rows and columns without differences: all is residual."""
    table = simulated(6, 4, 0, 0)
    table = table - table.mean(axis=0) - table.mean(axis=1, keepdims=True) + table.mean()
    assert VarianceComponents(**CROSSED)(crossed(table))["share"].tolist() == [0, 0, 1]


@pytest.mark.parametrize("change", [lambda y: y + 1e12, lambda y: 1e-6 * y, lambda y: -y])
def test_shares_do_not_depend_on_the_scale(change: Callable[[np.ndarray], np.ndarray]) -> None:
    """Half points on a scale a million times as fine, or far from 0."""
    table = np.round(2 * simulated(12, 6, 0.8, 0.6)) / 2
    expected = VarianceComponents(**CROSSED)(crossed(table))["share"].tolist()
    assert VarianceComponents(**CROSSED)(crossed(change(table)))["share"].tolist() == pytest.approx(expected, rel=1e-6)


def test_row_order_and_names_change_nothing() -> None:
    """Beyond the last digits."""
    frame = crossed(simulated(9, 6, 0.7, 0.5))
    frame["level"] = frame["picture"].map(lambda name: "ab"[int(name[1]) % 2])
    statistic = MixedModel("rating", ("level",), "participant", "picture")
    expected = statistic(frame)["chi2"].iloc[0]
    other = frame.assign(participant=frame["participant"] + ' "C"').sample(frac=1, random_state=2)
    assert statistic(other)["chi2"].iloc[0] == pytest.approx(expected, rel=1e-6)


ONE_EACH = crossed(simulated(3, 1, 1, 1)).assign(picture=["a", "b", "a"])


@pytest.mark.parametrize(
    ("frame", "sentence"),
    [
        (crossed(np.full((5, 3), 4.0)), "all ratings are equal"),
        (crossed(np.arange(5.0)[:, None] + np.arange(3.0)), "leave no residual or cannot be told apart"),
        (crossed(simulated(1, 6, 1, 1)), "there is one participant|participants cannot be told"),
        (ONE_EACH, "no participant gave two ratings|participants cannot be told"),
        (crossed(np.resize([1.0, 2, 4, 3], (4000, 200))), "800000 ratings, .* would take minutes, so it is not fitted"),
    ],
)
def test_what_has_no_value_is_said(frame: pd.DataFrame, sentence: str) -> None:
    """In both statistics, without a warning of a library."""
    for statistic in (VarianceComponents(**CROSSED), MixedModel("rating", ("picture",), "participant", "picture")):
        with pytest.raises(Undefined, match=sentence):
            statistic(frame)


def test_independent_samples_of_one_picture_each_have_no_random_term() -> None:
    """The sentence says why the analysis of variance is all there is."""
    with pytest.raises(Undefined, match=r"every cell is one picture.*no random term is left to estimate"):
        MixedModel("rating", ("picture",), None, "picture")(crossed(simulated(5, 3, 1, 1)))


def answers(people: int, levels: int, pictures: int) -> pd.DataFrame:
    """Everyone's ratings of `pictures` at each of `levels`."""
    random, count = np.random.default_rng(31), levels * pictures
    numbers = 4 + random.normal(0, 1, (people, 1)) + random.normal(0, 0.6, count) + random.normal(size=(people, count))
    names = {
        "who": np.repeat([f"p{n}" for n in range(people)], count),
        "picture": np.tile([f"i{n}" for n in range(count)], people),
        "level": np.tile(np.repeat([f"L{n}" for n in range(levels)], pictures), people),
    }
    return pd.DataFrame({**names, "rating": numbers.ravel()})


def test_f_has_the_repeated_measures_degrees_of_freedom() -> None:
    """One picture a level, all ratings there: F, df2 and p are those of the analysis of variance, not chi-squared's."""
    frame = answers(7, 4, 1)
    row = MixedModel("rating", ("level",), "who", "picture")(frame).iloc[0]
    anova = RepeatedMeasuresAnova("rating", "level", "who")(frame).iloc[0]
    assert (row["F"], row["df"], row["df2"]) == (pytest.approx(anova["F"], rel=1e-6), 3, 18)
    assert row["p"] == pytest.approx(anova["p"], rel=1e-5)
    lacking = MixedModel("rating", ("level",), "who", "picture")(frame.iloc[2:]).iloc[0]
    assert lacking["df2"] == 26 - 7 - 3


def test_pictures_stand_against_the_factor_they_were_made_by() -> None:
    """Three levels of four pictures each: 12 - 3, however many people; a factor within pictures has the ratings."""
    frame = answers(9, 3, 4)
    row = MixedModel("rating", ("level",), "who", "picture")(frame).iloc[0]
    assert (row["df"], row["df2"]) == (2, 9)
    assert row["p"] == pytest.approx(stats.f.sf(row["chi2"] / 2, 2, 9))
    half = frame.assign(time=["first" if place % 24 < 12 else "second" for place in range(len(frame))])
    tests = MixedModel("rating", ("level", "time"), "who", "picture")(half).set_index("term")
    assert tests["df2"].to_dict() == {"level": 9, "time": 7}  # each person came at one time: 9 people - 2 times
    crossed = frame.assign(side=["left" if (place * 7) % 5 < 2 else "right" for place in range(len(frame))])
    assert MixedModel("rating", ("side",), "who", "picture")(crossed)["df2"].iloc[0] == 108 - (9 + 12 - 1) - 1


def test_the_covariance_is_the_generalised_least_squares_one() -> None:
    """X' V^-1 X of a V written anew, with a third of the ratings missing: statsmodels' own is up to 1% larger."""
    frame = answers(6, 3, 2).sample(frac=0.67, random_state=5)
    fit = MixedModel("rating", ("level",), "who", "picture").fit(frame)
    parts = fit.variances.set_index("term")["variance"]
    labels = {name: pd.get_dummies(frame[name]).to_numpy(float) for name in ("who", "picture")}
    v = np.eye(len(frame)) * parts["residual"] + sum(parts[name] * z @ z.T for name, z in labels.items())
    x = np.column_stack([np.ones(len(frame)), pd.get_dummies(frame["level"]).to_numpy(float)[:, 1:]])
    covariance = np.linalg.inv(x.T @ np.linalg.solve(v, x))
    beta = covariance @ x.T @ np.linalg.solve(v, frame["rating"].to_numpy())
    chi2 = beta[1:] @ np.linalg.solve(covariance[1:, 1:], beta[1:])
    assert fit.tests["chi2"].iloc[0] == pytest.approx(chi2, rel=1e-6)


def test_a_small_variance_is_not_none() -> None:
    """Mean squares that make people's variance .0009 of the residual's exactly: kept, where 0 is left out."""
    random, n, k = np.random.default_rng(37), 10, 6
    left = random.normal(size=(n, k))
    left -= left.mean(axis=0) + left.mean(axis=1, keepdims=True) - left.mean()
    left /= np.sqrt((left**2).sum() / ((n - 1) * (k - 1)))
    people, pictures = random.normal(size=n), random.normal(size=k)
    people -= people.mean()
    people *= np.sqrt((1 / k + 0.0009) / people.var(ddof=1))
    pictures -= pictures.mean()
    pictures *= np.sqrt((1 / n + 1) / pictures.var(ddof=1))
    frame = crossed(left + people[:, None] + pictures)
    table = VarianceComponents(**CROSSED)(frame).set_index("term")["variance"]
    assert table.to_numpy() == pytest.approx([0.0009, 1, 1], rel=1e-3)
