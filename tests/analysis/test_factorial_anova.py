"""The factorial analysis against Maxwell & Delaney (2004), exact rationals, and two libraries that share no code."""

import warnings
from collections.abc import Iterator
from fractions import Fraction
from itertools import product
from math import prod
from pathlib import Path

import numpy as np
import pandas as pd
import pingouin
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from statsmodels.stats.anova import AnovaRM

from analysis import FactorialAnova
from analysis.statistics.factorial import effects_of
from analysis.statistics.undefined import Undefined
from fakesss.problem import BadInput

DATA = Path(__file__).parents[1] / "data" / "statistics"
quick = settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow])
Table = dict[tuple[int, ...], Fraction]  # (person, level of A, level of B, ...) -> value


def long(ratings: np.ndarray) -> pd.DataFrame:
    """People x A x B x ... as a long frame."""
    names = ["A", "B", "C", "D"][: ratings.ndim - 1]
    cells = [(f"p{place[0]}", *(f"l{level}" for level in place[1:]), float(v)) for place, v in np.ndenumerate(ratings)]
    return pd.DataFrame(cells, columns=["participant", *names, "rating"])


def analysed(frame: pd.DataFrame) -> pd.DataFrame:
    """The table by effect."""
    within = tuple(name for name in "ABCD" if name in frame)
    return FactorialAnova("rating", within, "participant")(frame).set_index("effect")


def random_ratings(*shape: int, seed: int = 4) -> np.ndarray:
    return np.random.default_rng(seed).integers(1, 8, shape)


def test_maxwell_and_delaney_12_1() -> None:
    """Noise x angle: F 33.77, 40.72, 45.31; Greenhouse-Geisser .9616 and .9041, as R's afex prints them."""
    table = FactorialAnova("rt", ("noise", "angle"), "id")(pd.read_csv(DATA / "md_12.1.csv")).set_index("effect")
    assert list(table.index) == ["noise", "angle", "noise × angle"]
    assert [(row.df1, row.df2) for row in table.itertuples()] == [(1, 9), (2, 18), (2, 18)]
    assert list(table["F"]) == pytest.approx([33.766, 40.719, 45.310], abs=5e-4)
    assert list(table["epsilon_gg"]) == pytest.approx([1, 0.9616365, 0.9040], abs=5e-5)
    assert list(table["generalized_eta_squared"]) == pytest.approx([0.387, 0.390, 0.188], abs=5e-4)
    assert table.loc["angle", "p_gg"] == pytest.approx(3.4017e-7, rel=5e-5)


def subsets(axes: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
    return (
        tuple(a for a, taken in zip(axes, mask, strict=True) if taken) for mask in product((0, 1), repeat=len(axes))
    )


def marginal(table: Table, axes: tuple[int, ...]) -> Table:
    """Means over all axes but these."""
    sums: dict[tuple[int, ...], list[Fraction]] = {}
    for place, value in table.items():
        sums.setdefault(tuple(place[axis] for axis in axes), []).append(value)
    return {place: sum(values, Fraction()) / len(values) for place, values in sums.items()}


def exact_ss(table: Table, shape: tuple[int, ...], axes: tuple[int, ...]) -> Fraction:
    """The sum of squares of the effect on `axes` (0 is the person), by inclusion and exclusion of marginal means."""
    means = {own: marginal(table, own) for own in subsets(axes)}
    repeats = prod(shape) // prod(shape[axis] for axis in axes)
    total = Fraction()
    for place in product(*(range(shape[axis]) for axis in axes)):
        at = dict(zip(axes, place, strict=True))
        signs = ((-1) ** (len(axes) - len(own)) * means[own][tuple(at[a] for a in own)] for own in means)
        total += sum(signs, Fraction()) ** 2
    return repeats * total


@quick
@given(st.data())
def test_every_effect_is_exact_on_likert_data(data: st.DataObject) -> None:
    """Sums of squares, F, both eta squared of main effects and of interactions of two and three factors."""
    shape = tuple(data.draw(st.lists(st.integers(2, 3), min_size=2, max_size=3)))
    people = data.draw(st.integers(3, 6))
    count = people * prod(shape)
    given_ratings = data.draw(st.lists(st.integers(1, 7), min_size=count, max_size=count))
    ratings = np.array(given_ratings).reshape(people, *shape)
    exact = {place: Fraction(int(value)) for place, value in np.ndenumerate(ratings)}
    axes = [tuple(place + 1 for place in effect) for effect in effects_of(len(shape))]
    errors = {own: exact_ss(exact, ratings.shape, (0, *own)) for own in axes}
    assume(all(errors.values()))
    people_ss = exact_ss(exact, ratings.shape, (0,))
    for own, (_, row) in zip(axes, analysed(long(ratings)).iterrows(), strict=True):
        effect, error, df1 = exact_ss(exact, ratings.shape, own), errors[own], prod(shape[a - 1] - 1 for a in own)
        assert (row["df1"], row["df2"]) == (df1, df1 * (people - 1))
        assert row["ss_effect"] == pytest.approx(float(effect), rel=1e-11, abs=1e-11)
        assert row["ss_error"] == pytest.approx(float(error), rel=1e-11)
        assert row["F"] == pytest.approx(float(effect / error * (people - 1)), rel=1e-9, abs=1e-9)
        assert row["partial_eta_squared"] == pytest.approx(float(effect / (effect + error)), abs=1e-11)
        everything = effect + people_ss + sum(errors.values())
        assert row["generalized_eta_squared"] == pytest.approx(float(effect / everything), abs=1e-11)


def test_two_factors_agree_with_pingouin() -> None:
    """F, p, corrected p and epsilon of pingouin's two-way analysis and of its epsilon."""
    frame = long(random_ratings(9, 3, 4))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # pingouin 0.7.0 on pandas 3: see analysis.statistics.anova
        theirs = pingouin.rm_anova(frame, "rating", ["A", "B"], "participant").set_index("Source")
        of_all = {
            name: pingouin.epsilon(frame, "rating", ["A", "B"], "participant", correction=name) for name in ("gg", "hf")
        }
    mine = analysed(frame)
    for effect, other in (("A", "A"), ("B", "B"), ("A × B", "A * B")):
        pairs = (("F", "F"), ("p", "p_unc"), ("p_gg", "p_GG_corr"), ("epsilon_gg", "eps"), ("mauchly_w", "W_spher"))
        for ours, name in (*pairs, ("generalized_eta_squared", "ng2")):
            if (effect, ours) != ("A × B", "mauchly_w"):  # nine people leave six contrasts a test; pingouin's too
                assert mine.loc[effect, ours] == pytest.approx(theirs.loc[other, name], rel=1e-9)
    assert (mine.loc["A × B", "epsilon_gg"], mine.loc["A × B", "epsilon_hf"]) == pytest.approx(
        (of_all["gg"], of_all["hf"])
    )


def test_three_factors_agree_with_statsmodels() -> None:
    """F and p of all seven effects."""
    frame = long(random_ratings(8, 2, 3, 2))
    plain = frame.rename(columns={"C": "D"})  # statsmodels takes C for its own
    theirs = AnovaRM(plain, "rating", "participant", ["A", "B", "D"]).fit().anova_table
    mine = analysed(frame)
    assert len(mine) == 7
    for effect, row in mine.iterrows():
        other = theirs.loc[str(effect).replace(" × ", ":").replace("C", "D")]
        assert (row["F"], row["p"]) == pytest.approx((other["F Value"], other["Pr > F"]), rel=1e-8)


def test_nothing_but_the_ratings_counts() -> None:
    """Order of rows, names of people, order of factors and a shift of the scale change no F."""
    frame = long(random_ratings(7, 3, 2))
    before = analysed(frame)["F"]
    other = frame.sample(frac=1, random_state=1).assign(rating=frame["rating"] + 1e6)
    other["participant"] = other["participant"].map({f"p{i}": f"{(5 * i) % 7} “x”" for i in range(7)})
    assert list(analysed(other)["F"]) == pytest.approx(list(before), rel=1e-7)
    turned = FactorialAnova("rating", ("B", "A"), "participant")(frame)
    assert list(turned["F"]) == pytest.approx([before["B"], before["A"], before["A × B"]])


def test_the_incomplete_are_dropped_and_named() -> None:
    """A person without one cell leaves the whole analysis."""
    ratings = random_ratings(6, 2, 3)
    frame = long(ratings)
    frame = frame[~((frame["participant"] == "p4") & (frame["A"] == "l1") & (frame["B"] == "l2"))]
    table = analysed(frame)
    assert (table["n"] == 5).all() and (table["dropped"] == "p4").all()
    assert list(table["F"]) == pytest.approx(list(analysed(long(np.delete(ratings, 4, axis=0)))["F"]))


def test_an_effect_everybody_shows_alike_has_a_reason() -> None:
    """A shifts everyone by 2: no error for A, while the others keep their F."""
    first = random_ratings(6, 1, 3)
    table = analysed(long(np.concatenate([first, first + 2], axis=1)))
    assert (
        np.isnan(table.loc["A", "F"]) and "every participant shows exactly the same effect" in table.loc["A", "reason"]
    )
    assert table.loc["B", "F"] >= 0 and table.loc["B", "reason"] == ""


def test_sentences() -> None:
    """Equal ratings, a cell nobody rated, one level, one person, a doubled cell."""
    frame = long(random_ratings(5, 2, 2))
    with pytest.raises(Undefined, match="rating by A × B: all ratings are equal, so F has no value"):
        analysed(frame.assign(rating=4.0))
    with pytest.raises(Undefined, match="nobody rated A l1, B l0; interactions need every combination"):
        analysed(frame[(frame["A"] != "l1") | (frame["B"] != "l0")])
    with pytest.raises(Undefined, match="A has fewer than two levels with ratings"):
        analysed(frame[frame["A"] == "l0"])
    with pytest.raises(Undefined, match="1 of 1 participants rated every combination"):
        analysed(frame[frame["participant"] == "p0"])
    with pytest.raises(BadInput, match='participant "p0" has two values at A l0, B l0; average first'):
        analysed(pd.concat([frame, frame.iloc[:1]]))
