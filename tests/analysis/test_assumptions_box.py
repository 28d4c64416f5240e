"""What the tests take for granted: the statistics against R and by hand, and the sentences of the box."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hard_ratings import HEAD, ratings, scattered

from analysis import RepeatedMeasuresAnova, write_report
from analysis.plan import AnalysisPlan
from analysis.statistics.diagnostics import EqualSpread, Residuals, ScaleEnds
from analysis.statistics.undefined import Undefined

Write = Callable[[str], Path]
# Brownlee (1965), p. 560: R's InsectSprays is too long; these are PlantGrowth's weights (Dobson 1983)
PLANTS = {
    "ctrl": (4.17, 5.58, 5.18, 6.11, 4.50, 4.61, 5.17, 4.53, 5.33, 5.14),
    "trt1": (4.81, 4.17, 4.41, 3.59, 5.87, 3.83, 6.03, 4.89, 4.32, 4.69),
    "trt2": (6.31, 5.12, 5.54, 5.50, 5.37, 5.29, 4.92, 6.15, 5.80, 5.26),
}
GROWTH = pd.DataFrame([(name, weight) for name, part in PLANTS.items() for weight in part], columns=["group", "weight"])


def test_plant_growth_agrees_with_r() -> None:
    """car::leveneTest: F(2, 27) = 1.1192, p = .3412; shapiro.test(residuals(aov)): W = .96607, p = .4379."""
    levene = EqualSpread("weight", "group")(GROWTH).iloc[0]
    assert (levene["levene_w"], levene["p"]) == (pytest.approx(1.1192, abs=5e-5), pytest.approx(0.3412, abs=5e-5))
    assert (levene["df1"], levene["df2"]) == (2, 27)
    shape = Residuals("weight", "group")(GROWTH).iloc[0]
    assert (shape["shapiro_w"], shape["shapiro_p"]) == (
        pytest.approx(0.96607, abs=5e-6),
        pytest.approx(0.4379, abs=5e-5),
    )


def test_residuals_within_people_have_no_people_in_them() -> None:
    """Adding a constant to each person changes nothing."""
    random = np.random.default_rng(5)
    frame = pd.DataFrame(
        [(who, what, float(random.integers(1, 8))) for who in range(9) for what in "abc"],
        columns=["who", "what", "value"],
    )
    shape = Residuals("value", "what", "who")
    shifted = frame.assign(value=frame["value"] + 100 * frame["who"])
    pd.testing.assert_frame_equal(shape(frame), shape(shifted), rtol=1e-9)
    wide = frame.pivot(index="who", columns="what", values="value").to_numpy()
    left = wide - wide.mean(axis=0) - wide.mean(axis=1, keepdims=True) + wide.mean()
    assert shape(frame).iloc[0]["skewness"] == pytest.approx((left**3).mean() / (left**2).mean() ** 1.5)


def test_no_residual_no_shape_no_scatter() -> None:
    frame = pd.DataFrame(
        [(who, what, who + what) for who in range(5) for what in range(3)], columns=["who", "what", "value"]
    )
    with pytest.raises(Undefined, match="no residual is left whose shape could be described"):
        Residuals("value", "what", "who")(frame)
    with pytest.raises(Undefined, match="no sample varies in its scatter, so Levene's test has no value"):
        EqualSpread("value", "group")(pd.DataFrame({"group": [*"aabb"], "value": [1, 2, 3, 4]}))


def test_many_residuals_have_no_p() -> None:
    """scipy's p is not accurate above 5,000."""
    random = np.random.default_rng(5)
    frame = pd.DataFrame({"group": np.repeat(["a", "b"], 3000), "value": random.normal(size=6000)})
    assert np.isnan(Residuals("value", "group")(frame).iloc[0]["shapiro_p"])


def test_ends_of_the_scale() -> None:
    frame = pd.DataFrame({"what": [*"aaaab"], "value": [1, 1, 7, 4, 7]})
    table = ScaleEnds("value", "what", 1, 7)(frame)
    assert table.to_dict("records") == [
        {"level": "a", "floor": 0.5, "ceiling": 0.25, "n": 4},
        {"level": "b", "floor": 0.0, "ceiling": 1.0, "n": 1},
    ]


def test_p_that_changes_sides_with_the_correction(csv_of: Write, tmp_path: Path) -> None:
    """Two contrasts of very different spread: alpha is set between both p, and the sentence gives both."""
    rule: Callable[[int, int], int] = lambda who, what: 4 + (what == 2) * ((who * 5) % 7 - 1) // 2  # noqa: E731
    path = csv_of(ratings(rule, people=11))
    frame = pd.read_csv(path)
    row = RepeatedMeasuresAnova("rating", "stimulus", "participant")(frame).iloc[0]
    assert row["p"] < row["p_gg"]
    plan = AnalysisPlan(alpha=float((row["p"] + row["p_gg"]) / 2))
    said = write_report(path, tmp_path / "out", plan=plan)["warnings"]
    sentence = next(each for each in said if "Greenhouse–Geisser correction; the corrected one counts" in each)
    assert sentence.startswith("Shiny vs picture: p = ")


def test_samples_that_scatter_differently(csv_of: Write, tmp_path: Path) -> None:
    """Independent samples: Levene's test and the ratio of variances in the table, a caution among the warnings."""
    rows = [f"p{who},{'ab'[who % 2]},shiny,{4 + (who % 2) * (who % 3 - 1) * 3}\n" for who in range(40)]
    results = write_report(csv_of(HEAD + "".join(rows)), tmp_path / "out")
    assert any("the samples scatter differently (Levene’s test, p < .001)" in each for each in results["warnings"])
    box = results["assumptions"][0]
    assert box["variance_ratio"] is None and "a sample does not scatter at all" in box["reason"]
    assert "mauchly_w" not in box


@pytest.mark.parametrize(("people", "pictures"), [(3, "abcd"), (4, "abcde"), (9, "ab"), (2, "ab")])
def test_sphericity_that_cannot_be_judged(csv_of: Write, tmp_path: Path, people: int, pictures: str) -> None:
    """No p of 1 where the libraries print one: a dash and the reason."""
    results = write_report(csv_of(ratings(people=people, pictures=tuple(pictures))), tmp_path / "out")
    box = results["assumptions"][0]
    why = "two levels have but one difference" if len(pictures) == 2 else "sphericity cannot be judged"
    assert box["mauchly_p"] is None and why in box["reason"]
    warned = any("sphericity cannot be judged" in said for said in results["warnings"])
    assert warned is (len(pictures) > 2)  # two levels: it holds


def test_a_difference_that_nobody_varies_in_has_no_mauchly(csv_of: Write, tmp_path: Path) -> None:
    """Two of four pictures at 7 by all twelve people: the reason, not W = 0."""
    text = ratings(lambda who, what: 7 if what < 2 else scattered(who, what), 12, ("a", "b", "c", "d"))
    box = write_report(csv_of(text), tmp_path / "out")["assumptions"][0]
    assert box["mauchly_w"] is None and "the same in everyone, so Mauchly’s test has no value" in box["reason"]
