"""The calibration study in small: rates within what chance allows, truths checked, runs taken up where they ended."""

import gc
import re
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from benchmarks import calibration, calibration_page
from benchmarks.calibration import Tally, counts_of, simulate
from benchmarks.calibration_cases import NOISE_SD, PERSON_SD, UNEQUAL, Crowd, Gallery
from benchmarks.calibration_experiments import Experiment, experiments
from benchmarks.calibration_page import LISTED, MARKED, TABLE, Count, stated, updated

SMALL = {
    "normal, 3 x 20 people": 2000,
    "7 steps, ceiling, 20 people x 4": 2000,
    "normal, sphericity broken, 20 people x 4": 2000,
    "7 steps, 44 people x 2": 60,
    "7 steps, 44 people x 2, 0.8 apart": 2000,
    "normal, 2 x 44 people, 0.8 apart": 2000,
    "models: 7 steps, 44 people x 4": 20,
    "crossed: 7 steps, 20 people x 6": 2000,
    "7 steps, 20 people x 9 random pictures, three cues": 30,
    "normal, 20 people x 15 random pictures": 30,
    "normal, unlike means, 3 x 20 people": 2000,
    "effect sizes: normal, unlike means, 3 x 20 people": 20,
    "effect sizes: normal, unlike means, sphericity broken, 20 people x 4": 20,
}
OFF = {  # known not to keep their level on these ratings: docs/calibration.md says so
    ("repeated-measures F, uncorrected", "normal, sphericity broken, 20 people x 4"),
    ("Tukey, repeated measures, any pair", "normal, sphericity broken, 20 people x 4"),
    ("a cue drawn at random, slopes of people", "7 steps, 20 people x 9 random pictures, three cues"),
    ("a cue drawn at random, regression clustered by person", "7 steps, 20 people x 9 random pictures, three cues"),
}
PAGE = calibration_page.PAGE.read_text(encoding="utf-8")


@pytest.fixture(autouse=True)
def frozen() -> Iterator[None]:
    """As the program does: statsmodels collects garbage at every adjustment."""
    gc.freeze()
    yield
    gc.unfreeze()


def named(name: str) -> Experiment:
    """The experiment of that name."""
    return next(each for each in experiments() if each.name == name)


def run(name: str, studies: int, seed: int = 1) -> Tally:
    """A tally of that many studies."""
    tally, each = Tally(), named(name)
    simulate(tally, each, studies, seed)
    return tally


def broken(name: str, tally: Tally, chance: float) -> list[str]:
    """Promises broken by more than what happens with that chance if they are kept: a test that rejects too often, an
    interval that covers too seldom (the other side harms nobody)."""
    found = []
    for claim, hits in tally.hits.items():
        goal, n = stated(claim), tally.done - tally.silent
        tail = stats.binom.sf(hits - 1, n, goal) if goal < 0.5 else stats.binom.cdf(hits, n, goal)
        if tail < chance and (claim, name) not in OFF:
            found.append(f"{claim}: {hits} of {n}")
    return found


@pytest.mark.parametrize("name", SMALL)
def test_rates_in_small(name: str) -> None:
    """No promise broken by more than chance does once in ten thousand runs."""
    tally = run(name, SMALL[name])
    assert tally.hits and broken(name, tally, 1e-4) == []


@pytest.mark.long
@pytest.mark.parametrize("name", ["normal, 3 x 20 people", "normal, spherical, 20 people x 4", *SMALL])
def test_rates_in_large(name: str) -> None:
    """The same with a tenth of a full run; and what is known to break does break."""
    tally = run(name, named(name).studies // 10)
    assert broken(name, tally, 1e-4) == []
    for claim in [claim for claim, where in OFF if where == name]:
        assert tally.hits[claim] / tally.done > 0.07


def test_a_broken_promise_is_found() -> None:
    """Where the uncorrected F is not excused, 60 rejections of 600 are too many, and 540 of 600 too few to cover."""
    tally = Tally(600, 0, Counter({"one-way F": 60, "Friedman": 34, "95% CI of a mean": 540}))
    assert broken("", tally, 1e-4) == ["one-way F: 60 of 600", "95% CI of a mean: 540 of 600"]


def test_truth_of_rounded_answers() -> None:
    """Means of 1..7 by simulation; symmetric about the middle; ICC as a correlation of two people's answers."""
    crowd = Crowd("", 200_000, (4.0, 5.2, 6.3), steps=True, noises=(0.4, 0.9, 2.0))
    ratings = crowd.frame(np.random.default_rng(1)).groupby("condition")["rating"]
    assert list(ratings.mean()) == pytest.approx(list(crowd.truth), abs=0.012)
    assert crowd.truth[0] == pytest.approx(4)
    pictures = Gallery("", 2, 100_000, steps=True)
    means = 4 + np.random.default_rng(2).standard_normal(100_000)
    noise = np.hypot(PERSON_SD, NOISE_SD) * np.random.default_rng(3).standard_normal((2, 100_000))
    answers = np.clip(np.rint(means + noise), 1, 7)
    assert np.corrcoef(answers)[0, 1] == pytest.approx(pictures.icc, abs=0.01)


def test_unequal_noise_breaks_sphericity() -> None:
    """Greenhouse and Geisser's epsilon of the population: .405, where 1 is sphericity and 1/3 the least."""
    contrast = np.eye(4) - 0.25
    covariance = contrast @ np.diag(np.square(UNEQUAL)) @ contrast
    assert np.trace(covariance) ** 2 / (3 * np.trace(covariance @ covariance)) == pytest.approx(0.405, abs=0.001)


@pytest.mark.parametrize(("name", "half"), [("normal, 44 people x 2, 0.8 apart", 1000), ("7 steps, 44 people x 2", 4)])
def test_a_stopped_run_is_taken_up(tmp_path: Path, name: str, half: int) -> None:
    """Half and half after reading the file is the same tally; another seed, or other statistics, begin anew."""
    each, whole, tally, file = named(name), run(name, 2 * half), run(name, half), tmp_path / "c.json"
    calibration.write(file, 1, "these", {name: tally})
    again = calibration.read(file, 1, "these")
    simulate(again[name], each, 2 * half, 1)
    assert again == {name: whole} and whole.done == 2 * half
    assert calibration.read(file, 2, "these") == {} and calibration.read(file, 1, "those") == {}
    assert calibration.read(file, 1) == {name: tally}


def test_a_comment_changes_no_statistic_and_a_number_does() -> None:
    source = '"""What."""\n\ndef f():\n    """How."""\n    return 0.05  # why\n'
    same = "def f():\n\n    return 0.05\n"
    assert calibration.code_of(source) == calibration.code_of(same)
    assert calibration.code_of(source) != calibration.code_of(source.replace("0.05", "0.06"))
    assert calibration.fingerprint() == calibration.fingerprint()


def test_a_study_without_a_value_counts_for_no_claim() -> None:
    tally = Tally()
    tally.add({"a": np.array([1.0, 1.0, 0.0]), "b": np.array([1.0, np.nan, 1.0])}, 3)
    tally.add({"a": True, "b": False})
    tally.add(None)
    assert (tally.done, tally.silent, tally.hits) == (5, 2, {"a": 2, "b": 2})


@pytest.mark.parametrize(
    ("claim", "hits", "words"),
    [
        ("Friedman", 500, "keeps its level"), ("Friedman", 545, "keeps its level"),
        ("Friedman", 570, "slightly liberal"), ("Friedman", 1000, "liberal"),
        ("Friedman", 430, "slightly cautious"), ("Friedman", 100, "cautious"),
        ("95% CI of a mean", 9500, "covers"), ("95% CI of a mean", 9455, "covers"),
        ("95% CI of a mean", 9300, "slightly too narrow"), ("95% CI of a mean", 9000, "too narrow"),
        ("90% CI of eta squared", 9800, "wider than need be"),
    ],
)  # fmt: skip
def test_verdicts(claim: str, hits: int, words: str) -> None:
    assert Count(claim, "", hits, 10_000).verdict == words


def kept() -> list[Count]:
    """What benchmarks/calibration.json says."""
    return counts_of(calibration.read(calibration.RESULTS, calibration.SEED))


def test_the_page_is_that_of_the_run_that_is_kept() -> None:
    """Table and rates of benchmarks/calibration.json, of all experiments there are; and no sentence against them."""
    assert list(calibration.read(calibration.RESULTS, calibration.SEED)) == [each.name for each in experiments()]
    assert updated(PAGE, kept()) == (PAGE, [])
    assert f"seed {calibration.SEED}" in PAGE


def test_every_rate_in_the_words_is_marked() -> None:
    words = PAGE.split(TABLE)[0]
    assert len(re.findall(r"\d\.\d%", words)) == len(MARKED.findall(words)) > 20
    marks = [mark for mark, *_ in LISTED.findall(PAGE)]
    assert sorted(marks) == sorted(set(marks))


def test_a_sentence_that_no_longer_fits_is_named() -> None:
    page = "Good: 1.0%<!--a-->.\nBad: 1.0%<!--b-->, 1.0%<!--c-->.\n" + TABLE + "old" + calibration_page.END
    page += (
        "\na = Friedman | x | keeps its level\nb = Friedman | y | liberal or slightly liberal\nd = F | x | liberal\n"
    )
    text, unfit = updated(page, [Count("Friedman", "x", 50, 1000), Count("Friedman", "y", 52, 1000)])
    assert "Good: 5.0%<!--a-->.\nBad: 5.2%<!--b-->, 1.0%<!--c-->.\n" in text and "old" not in text
    assert unfit == [
        "line 2, b: Friedman | y: 5.2%, keeps its level; not liberal or slightly liberal",
        "mark c: stands in the words and not in the list",
        "mark d: stands in the list and not in the words",
    ]
    (missing,) = updated(page.replace("c-->", "a-->").replace("d = ", "b = "), [])[1][:1]
    assert missing == "mark a: the table has no row Friedman | x"


def test_one_command_writes_results_and_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    few = [named("7 steps, 3 x 20 people"), named("7 steps, 44 people x 2")]
    monkeypatch.setattr(calibration, "experiments", lambda: few)
    monkeypatch.setattr("sys.argv", ["c", "--share", "0.005", "--out", str(tmp_path / "c.json")])
    page = tmp_path / "page.md"
    page.write_text("words\n" + TABLE + calibration_page.END, encoding="utf-8")
    monkeypatch.setattr("sys.argv", [*sys.argv, "--page", str(page)])
    assert calibration.main() == 0
    tallies = calibration.read(tmp_path / "c.json", calibration.SEED, calibration.fingerprint())
    assert [tally.done for tally in tallies.values()] == [1000, 20]
    assert "| one-way F | 7 steps, 3 x 20 people | 1,000 | 5% | " in page.read_text(encoding="utf-8")
