"""Many pictures: what is done at once for all of them is what was done one by one, and the report stays readable."""

import json
import math
from pathlib import Path

import krippendorff
import numpy as np
import pandas as pd
import pytest
from scipy import stats

from analysis import IntraclassCorrelation, KrippendorffAlpha, PairedContrasts, TukeyHSD, read_ratings, write_report
from analysis.files import json_lines, plain
from analysis.statistics.undefined import SMALLEST_P, Undefined

PEOPLE, PICTURES = 30, 40


def frame(people: int = PEOPLE, pictures: int = PICTURES) -> pd.DataFrame:
    """Likert answers of everyone to every picture; two pictures that everyone rates one apart."""
    random = np.random.default_rng(3)
    wide = random.integers(1, 7, (people, pictures)) + (np.arange(pictures) > pictures / 2)
    wide[:, 1] = np.minimum(wide[:, 0], 6) + 1
    wide[:, 0] = wide[:, 1] - 1
    rows = [(f"p{i}", f"img{j}", "q", int(wide[i, j])) for i in range(people) for j in range(pictures)]
    return pd.DataFrame(rows, columns=["participant", "stimulus", "question", "rating"])


def wide_of(ratings: pd.DataFrame) -> pd.DataFrame:
    return ratings.pivot(index="participant", columns="stimulus", values="rating").astype(float)


def test_all_pairs_at_once_are_each_pairs_t_test() -> None:
    """780 pairs, more than are computed at a call: t, p, interval of each; none where all differences are equal."""
    ratings = frame()
    wide = wide_of(ratings)
    table = PairedContrasts("rating", "stimulus", "participant")(ratings)
    assert len(table) == math.comb(PICTURES, 2)
    for row in table.sample(60, random_state=1).to_dict("records"):
        found = stats.ttest_rel(wide[row["a"]], wide[row["b"]])
        interval = found.confidence_interval()
        assert (row["t"], row["p"]) == pytest.approx((found.statistic, found.pvalue), rel=1e-12)
        assert (row["ci_low"], row["ci_high"]) == pytest.approx((interval.low, interval.high), rel=1e-12)
    constant = table.iloc[0]
    assert (constant["a"], constant["b"]) == ("img0", "img1")
    assert constant["difference"] == constant["ci_low"] == constant["ci_high"] == -1
    assert table["p"].isna().sum() == 1 and np.isnan(constant["t"])


def test_no_p_is_zero() -> None:
    """A t of 8,000 has a p that no float64 holds: the bound stands there."""
    ratings = frame(400, 3)
    ratings["rating"] = ratings["rating"] + (ratings["stimulus"] == "img2") * 1000
    contrasts = PairedContrasts("rating", "stimulus", "participant")(ratings)
    assert contrasts["p"].min() == SMALLEST_P
    assert TukeyHSD("rating", "stimulus", "participant")(ratings)["p"].min() == 1e-10


@pytest.mark.parametrize("level", ["nominal", "ordinal", "interval", "ratio"])
def test_alpha_from_counts_is_alpha_from_ratings(level: str) -> None:
    """Also of each resample, with missing ratings and answers that a resample lacks."""
    ratings = frame(12, 9)
    ratings = ratings[np.random.default_rng(8).random(len(ratings)) < 0.7]
    statistic = KrippendorffAlpha("rating", "stimulus", "participant", level=level, resamples=40, seed=5)  # type: ignore[arg-type]
    row = statistic(ratings).iloc[0]
    data = wide_of(ratings).to_numpy()
    draws = np.random.default_rng(5).integers(0, data.shape[1], (40, data.shape[1]))
    alphas = [krippendorff.alpha(data[:, draw], level_of_measurement=level) for draw in draws]
    low, high = np.quantile(alphas, [0.025, 0.975])
    expected = (krippendorff.alpha(data, level_of_measurement=level), low, high)
    assert (row["alpha"], row["ci_low"], row["ci_high"]) == pytest.approx(expected, rel=1e-12)


def test_more_answers_than_alpha_can_compare() -> None:
    """A continuous scale: a sentence instead of gigabytes; the intraclass correlation stands."""
    random = np.random.default_rng(1)
    rows = [(f"p{i}", f"img{j}", random.normal()) for i in range(60) for j in range(60)]
    ratings = pd.DataFrame(rows, columns=["participant", "stimulus", "rating"])
    with pytest.raises(Undefined, match="3600 different ratings of 60 stimuluss are too many"):
        KrippendorffAlpha("rating", "stimulus", "participant")(ratings)
    assert len(IntraclassCorrelation("rating", "stimulus", "participant")(ratings)) == 6


def test_report_of_many_pictures(tmp_path: Path) -> None:
    """All pairs in the files, a page that opens, results.json as returned and a line a record."""
    path = tmp_path / "ratings.csv"
    frame(15, 20).to_csv(path, index=False)
    results = write_report(path, tmp_path / "out")
    text = (tmp_path / "out" / "results.json").read_text(encoding="utf-8")
    assert json.loads(text) == results
    assert len(results["tukey"]) == 2 * math.comb(20, 2)
    assert all(line.count('"question"') <= 1 for line in text.splitlines())
    assert {"question", "factor", "a", "b", "difference", "q", "p", "ci_low", "ci_high"} <= results["tukey"][0].keys()
    assert min(entry["p"] for name in ("tukey", "anova") for entry in results[name]) > 0
    assert (tmp_path / "out" / "index.html").stat().st_size < 2e6


def test_records_are_plain() -> None:
    """numpy's numbers as Python's, no value as null; an object is indented, a list of records has a line for each."""
    table = pd.DataFrame({"a": np.array([1, 2]), "b": [0.5, np.nan], "c": ["x", None], "d": [[1.5], None]})
    records = plain(table.assign(e=[True, False]))
    assert records == [
        {"a": 1, "b": 0.5, "c": "x", "d": [1.5], "e": True},
        {"a": 2, "b": None, "c": None, "d": None, "e": False},
    ]
    assert all(type(record["a"]) is int for record in records)
    text = "".join(json_lines({"n": 1, "rows": records, "none": [], "deep": {"x": {"y": "ü"}}}))
    assert json.loads(text) == {"n": 1, "rows": records, "none": [], "deep": {"x": {"y": "ü"}}}
    assert len(text.splitlines()) == 3 + 4 + 6


def test_rows_in_any_order_of_many_people(tmp_path: Path) -> None:
    """What is worked out for distinct texts comes back to its own rows."""
    ratings = frame().sample(frac=1, random_state=2)
    path = tmp_path / "ratings.csv"
    ratings.assign(participant=" " + ratings["participant"] + " ").to_csv(path, index=False)
    found = read_ratings(path)
    assert list(found["participant"].unique()) == [f"p{who}" for who in range(PEOPLE)]
    assert list(found["stimulus"][:PICTURES]) == [f"img{picture}" for picture in range(PICTURES)]
    key = ["participant", "stimulus"]
    assert (
        found.set_index(key)["rating"] == ratings.set_index(key)["rating"].reindex(found.set_index(key).index)
    ).all()
