"""Answer quality: each measure on answers whose value is known; and who stands out for it."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analysis import read_ratings, write_report
from analysis.levels import from_ratings
from analysis.plan import AnalysisPlan
from analysis.quality import quality_table, showings
from analysis.reliability import rater_table, retest_table, stability_table
from analysis.sample import draw_sample
from analysis.standing_out import with_reasons

Write = Callable[[str], Path]
HEAD = "participant,trial,stimulus,question,rating,rt_ms,focus_lost_ms,repeat_of,check_expected,check_passed\n"
ROWS = [
    # in order of presentation: 4 4 4 1, then the first again; three fast answers
    "p1,1,c,q,4,900,0,,,", "p1,2,a,q,4,200,40000,,,", "p1,3,b,q,4,200,0,,,", "p1,4,d,q,1,100,0,,,",
    "p1,5,c,q,6,800,0,c,,", "p1,6,x,q,2,800,0,,2,1",
    "p2,1,a,q,1,1000,0,,,", "p2,2,b,q,2,1000,0,,,", "p2,3,c,q,3,1000,0,,,", "p2,4,d,q,7,2000,0,,,",
    "p2,5,c,q,3,3000,0,c,,", "p2,6,x,q,5,800,0,,2,0",
    "p3,1,a,q,2,1000,0,,,", "p3,2,b,q,3,1000,0,,,", "p3,3,c,q,,,0,,,", "p3,4,d,q,6,1000,0,,,",
]  # fmt: skip


@pytest.fixture
def table(csv_of: Write) -> pd.DataFrame:
    """The measures of the three people above."""
    frame = read_ratings(csv_of(HEAD + "\n".join(ROWS)))
    return quality_table(frame, from_ratings(frame, "x", 7)).set_index("participant")


def test_counts_checks_and_times(table: pd.DataFrame) -> None:
    """Repeats and checks are no missing answers, checks no answers; p3 had no check and no repeat."""
    assert table["ratings"].tolist() == [4, 4, 3] and table["missing"].tolist() == [0, 0, 1]
    assert table["failed_checks"].tolist() == [0, 1, 0] and table["checks"].tolist() == [1, 1, 0]
    assert table["median_rt_ms"].tolist() == [200, 1000, 1000] and table["shortest_rt_ms"].tolist() == [100, 1000, 1000]
    assert table["too_fast_share"].tolist() == [0.6, 0, 0] and table["focus_lost_ms"].tolist() == [40000, 0, 0]


def test_runs_and_shares_follow_the_order_of_presentation(table: pd.DataFrame) -> None:
    assert table["longest_run"].tolist() == [3, 1, 1]
    assert table["same_answer_share"].tolist() == pytest.approx([0.6, 0.4, 1 / 3])
    assert table["retest_difference"].tolist()[:2] == [2, 0] and np.isnan(table["retest_difference"]["p3"])


def test_person_rest_correlation(table: pd.DataFrame) -> None:
    """p1 against the means of p2 and p3, of p2 alone where p3 is silent."""
    assert table["person_rest_r"]["p1"] == pytest.approx(np.corrcoef([4, 4, 4, 1], [1.5, 2.5, 3, 6.5])[0, 1])
    assert table["person_rest_r"]["p3"] == pytest.approx(np.corrcoef([2, 3, 6], [2.5, 3, 4])[0, 1])


def test_question_means_are_taken_out() -> None:
    """Two questions of very different means make no agreement where there is none within them."""
    cells = [
        (who, what, question, level + given)
        for who, answers in (("p1", (1, 2, 3)), ("p2", (3, 2, 1)))
        for question, level in (("q", 0), ("r", 100))
        for what, given in zip("abc", answers, strict=True)
    ]
    frame = pd.DataFrame(cells, columns=["participant", "stimulus", "question", "rating"])
    table = quality_table(frame, from_ratings(frame, "x", None))
    assert table["person_rest_r"].tolist() == pytest.approx([-1, -1])
    assert np.isnan(table["longest_run"]).all() and np.isnan(table["failed_checks"]).all()


def test_those_who_stand_out_are_shown_and_kept(csv_of: Write, tmp_path: Path) -> None:
    """The page names them and why; the numbers stand in participants.csv; nobody is removed for it."""
    results = write_report(csv_of(HEAD + "\n".join(ROWS)), tmp_path / "out", plan=AnalysisPlan(completers_only=False))
    why = {row["participant"]: row["stands_out"] for row in results["participants"]}
    assert why["p1"] == "too fast; looked away"
    assert why["p2"] == "failed 1 check" and why["p3"] == "1 answer missing"
    assert results["n_analysed"] == 3 and results["excluded"] == []
    page = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    assert (
        "Answer quality: 3 of 3 participants stand out; all are analysed, as only declared rules leave anybody out."
        in page
    )
    assert "No [analysis] was declared" not in page and "Nobody was left out." in page


def test_who_rates_against_the_others_stands_out() -> None:
    """Eleven agree roughly, one turns the scale round; where nobody agrees nobody stands out for it."""
    random = np.random.default_rng(2)
    order = np.arange(1, 8)

    def found(agree: bool) -> list[str]:
        rows = [
            np.clip(order + random.integers(-1, 2, 7), 1, 7) if agree else random.permutation(order) for _ in range(11)
        ]
        cells = [
            (f"p{who}", f"c{what}", "q", v)
            for who, row in enumerate([*rows, order[::-1]])
            for what, v in enumerate(row)
        ]
        frame = pd.DataFrame(cells, columns=["participant", "stimulus", "question", "rating"])
        study = from_ratings(frame, "x", 7)
        table = with_reasons(quality_table(frame, study), study).set_index("participant")["stands_out"]
        return [str(who) for who in table.index[table == "rates against the others"]]

    assert found(agree=True) == ["p11"] and found(agree=False) == []


def test_cells_count_who_saw_and_who_is_analysed(csv_of: Write, tmp_path: Path) -> None:
    """p3 did not answer c, and without completers_only their other answers count."""
    path = csv_of(HEAD + "\n".join(ROWS))
    everybody = write_report(path, tmp_path / "a", plan=AnalysisPlan(completers_only=False))
    counts = {
        row["stimulus"]: (row["n_expected"], row["n_answered"], row["n_missing"], row["n_analysed"])
        for row in everybody["cells"]
    }
    assert (counts["a"], counts["c"]) == ((3, 3, 0, 3), (3, 2, 1, 2))
    completers = write_report(path, tmp_path / "b")
    assert {row["n_analysed"] for row in completers["cells"] if row["stimulus"] in "abcd"} == {2}
    assert completers["excluded"] == [{"participant": "p3", "rule": "completers_only", "reason": "did not complete"}]
    assert "No [analysis] was declared: the rules are the defaults." in (tmp_path / "b" / "index.html").read_text()


def test_agreement_with_missing_answers(csv_of: Write) -> None:
    """The ICC drops p3, alpha keeps everybody, and both say how many."""
    frame = read_ratings(csv_of(HEAD + "\n".join(ROWS)))
    study = from_ratings(frame, "x", 7)
    found, notes = rater_table(draw_sample(frame, AnalysisPlan(completers_only=False)), study)
    row = found.iloc[0]
    assert (row["n_raters"], row["icc_dropped"], row["alpha_n_raters"], row["n_missing"]) == (2, 1, 3, 1)
    assert notes == []


def test_test_retest_of_repeats(csv_of: Write) -> None:
    """First against second showing over people and pictures: ICC(A,1) of (4, 6), (3, 3) and (1, 1), (7, 6)."""
    more = ["p1,7,d,q,1,800,0,d,,", "p2,7,d,q,6,800,0,d,,"]
    frame = read_ratings(csv_of(HEAD + "\n".join([*ROWS, *more])))
    study = from_ratings(frame, "x", 7)
    found, notes = stability_table(showings(frame, study), study)
    pairs = np.array([(4, 6), (3, 3), (1, 1), (7, 6)], dtype=float)
    assert found.iloc[0]["icc_a1"] == pytest.approx(icc_by_hand(pairs))
    assert (found.iloc[0]["n_pairs"], found.iloc[0]["n_people"], found.iloc[0]["n_pictures"]) == (4, 2, 2) and not notes
    assert len(retest_table(showings(frame, study), study)) == 2


def icc_by_hand(table: np.ndarray) -> float:
    """ICC(A,1) of a targets x raters table: McGraw & Wong (1996), table 4, case 2A."""
    n, k = table.shape
    grand = table.mean()
    rows = k * ((table.mean(axis=1) - grand) ** 2).sum() / (n - 1)
    columns = n * ((table.mean(axis=0) - grand) ** 2).sum() / (k - 1)
    total = ((table - grand) ** 2).sum()
    error = (total - rows * (n - 1) - columns * (k - 1)) / ((n - 1) * (k - 1))
    return float((rows - error) / (rows + (k - 1) * error + k * (columns - error) / n))
