"""The calibration study's quick judges give the numbers of the public objects, study by study."""

import numpy as np
import pandas as pd
import pytest
from scipy.linalg import helmert

from analysis.statistics.anova import OneWayAnova, RepeatedMeasuresAnova
from analysis.statistics.batches import Moments, independent_p, paired_equivalence_p, repeated_p, welch_equivalence_p
from analysis.statistics.contrasts import PairedContrasts
from analysis.statistics.equivalence import Equivalence
from analysis.statistics.factorial import FactorialAnova
from analysis.statistics.friedman import Friedman
from analysis.statistics.intervals import MeanIntervals
from analysis.statistics.tukey import TukeyHSD
from analysis.statistics.undefined import Floats
from benchmarks import calibration_batches as batches
from benchmarks.calibration_cases import BETWEEN, UNEQUAL, WITHIN, Crowd

STUDIES = 6
EXACT = {"rel": 1e-9}
SAME_PEOPLE = [
    Crowd("normal", 20, (4.0,) * 4, noises=UNEQUAL),
    Crowd("7 steps", 20, (4.0,) * 4, steps=True),
    Crowd("ceiling", 20, (6.3,) * 4, steps=True),
    Crowd("few", 8, (4.0,) * 4, steps=True),
    Crowd("two pictures", 8, (4.0,) * 2, steps=True),
]
OTHER_PEOPLE = [
    Crowd("normal", 20, (4.0,) * 3, independent=True),
    Crowd("ceiling", 20, (6.3,) * 3, steps=True, independent=True),
]


def answers_of(crowd: Crowd) -> Floats:
    """(people, studies, pictures)."""
    return crowd.answers(np.random.default_rng([1, crowd.people]), STUDIES)


def name_of(crowd: Crowd) -> str:
    return crowd.name


@pytest.mark.parametrize("crowd", SAME_PEOPLE, ids=name_of)
def test_of_the_same_people(crowd: Crowd) -> None:
    answers = answers_of(crowd)
    levels = Moments.of(answers)
    found = [batches.uncorrected_p(levels), repeated_p(levels), batches.huynh_feldt_p(levels)]
    found += [batches.smallest_holm_p(levels), batches.range_of_repeated(levels)]
    ranks = batches.friedman_p(answers)
    said = batches.no_effect_within(answers)
    for study in range(STUDIES):
        frame = crowd.long(answers[:, study])
        anova = RepeatedMeasuresAnova(**WITHIN)(frame).iloc[0]
        tukey = TukeyHSD("rating", "condition", "participant")(frame)
        holm = PairedContrasts(**WITHIN)(frame)["p_holm"]
        expected = [anova["p"], anova["p_gg"], anova["p_hf"], holm.min(), tukey["q"].max()]
        assert [column[study] for column in found] == pytest.approx(expected, **EXACT)
        verdicts = [bool(p < 0.05) for p in expected[:4]]
        if len(crowd.means) > 2:
            friedman = Friedman(**WITHIN)(frame)["p"].iloc[0]
            assert ranks[study] == pytest.approx(friedman, **EXACT)
            verdicts.insert(3, bool(friedman < 0.05))
        else:
            verdicts.insert(3, bool(said["Friedman"][study]))
        assert [bool(each[study]) for each in said.values()] == [*verdicts, bool((tukey["p"] < 0.05).any())]


@pytest.mark.parametrize("crowd", OTHER_PEOPLE, ids=name_of)
def test_of_different_people(crowd: Crowd) -> None:
    answers = answers_of(crowd)
    pictures = Moments.of(answers)
    p, q = independent_p(pictures, ((0,), (1,), (2,))), batches.range_of_independent(pictures)
    low, high = batches.mean_interval(pictures)
    said = batches.no_effect_between(answers, crowd.truth)
    for study in range(STUDIES):
        frame = crowd.long(answers[:, study])
        anova, tukey = OneWayAnova(**BETWEEN)(frame).iloc[0], TukeyHSD(**BETWEEN)(frame)
        mean = MeanIntervals(**BETWEEN)(frame).iloc[0]
        expected = [anova["p"], tukey["q"].max(), mean["ci_low"], mean["ci_high"]]
        assert [p[study], q[study], low[study], high[study]] == pytest.approx(expected, **EXACT)
        holds = mean["ci_low"] <= crowd.truth[0] <= mean["ci_high"]
        verdicts = [anova["p"] < 0.05, (tukey["p"] < 0.05).any(), holds]
        assert [bool(each[study]) for each in said.values()] == list(map(bool, verdicts))


def holds(row: "pd.Series[float]", truth: float) -> bool:
    return bool(row["ci_low"] <= truth <= row["ci_high"])


def pairs_hold(table: pd.DataFrame, crowd: Crowd) -> bool:
    """Whether every pair's interval holds the true difference."""
    truth = {f"M{place}": mean for place, mean in enumerate(crowd.truth, 1)}
    return all(holds(row, truth[row["a"]] - truth[row["b"]]) for _, row in table.iterrows())


@pytest.mark.parametrize("noises", [None, UNEQUAL[1:]])
def test_intervals_of_the_same_people(noises: tuple[float, ...] | None) -> None:
    """A claim is missed at times: forty studies have both."""
    crowd = Crowd("", 8, (3.7, 4.0, 4.6), steps=True, noises=noises)
    answers = crowd.answers(np.random.default_rng(3), 40)
    levels = Moments.of(answers)
    halves, pair = batches.halves_within(levels), batches.half_of_pair(levels)
    said = batches.effect_within(answers, crowd.truth)
    for study in range(40):
        frame = crowd.long(answers[:, study])
        means = MeanIntervals("rating", "condition", "participant")(frame)
        half = (means["ci_high"] - means["mean"]).to_numpy()
        first = PairedContrasts(**WITHIN)(frame).iloc[0]
        assert list(halves[study]) == pytest.approx(list(half), **EXACT)
        assert pair[study] == pytest.approx((first["ci_high"] - first["ci_low"]) / 2, **EXACT)
        gap = means["mean"].iloc[0] - means["mean"].iloc[1] - (crowd.truth[0] - crowd.truth[1])
        assert [bool(each[study]) for each in said.values()] == [
            holds(first, crowd.truth[0] - crowd.truth[1]),
            pairs_hold(TukeyHSD("rating", "condition", "participant")(frame), crowd),
            holds(means.iloc[0], crowd.truth[0]),
            abs(gap) <= np.sqrt(2) * half[:2].mean(),
        ]
    assert min(each.min() for each in said.values()) == 0


def test_intervals_of_different_people() -> None:
    crowd = Crowd("", 8, (3.7, 4.0, 4.6), steps=True, independent=True)
    answers = crowd.answers(np.random.default_rng(3), 60)
    (said,) = batches.effect_between(answers, crowd.truth).values()
    frames = [crowd.long(answers[:, study]) for study in range(60)]
    assert list(said) == [pairs_hold(TukeyHSD(**BETWEEN)(frame), crowd) for frame in frames]
    assert said.min() == 0


@pytest.mark.parametrize("independent", [True, False])
def test_at_the_margin(independent: bool) -> None:
    crowd = Crowd("", 44, (4.0, 4.8), steps=True, independent=independent)
    answers, margin = answers_of(crowd), float(crowd.truth[1] - crowd.truth[0])
    pair = Moments.of(answers)
    p = welch_equivalence_p(pair, (0,), (1,), margin) if independent else paired_equivalence_p(pair, margin)
    public = Equivalence("rating", "condition", None if independent else "participant", margin)
    for study in range(STUDIES):
        table = public(crowd.long(answers[:, study]))
        assert p[study] == pytest.approx(table["p_equivalence"].iloc[0], **EXACT)
    (said,) = batches.at_the_margin(answers, crowd.truth, independent).values()
    assert list(said) == list((p < 0.05).astype(float))


def test_interaction() -> None:
    crowd = Crowd("", 20, (4.0,) * 6, steps=True)
    answers = answers_of(crowd)
    p = repeated_p(Moments.of(answers), np.kron(helmert(2).T, helmert(3).T))
    for study in range(STUDIES):
        frame = crowd.long(answers[:, study])
        place = frame["condition"].str[1:].astype(int) - 1
        table = FactorialAnova("rating", ("a", "b"), "participant")(frame.assign(a=place // 3, b=place % 3))
        assert p[study] == pytest.approx(table["p_gg"].iloc[-1], **EXACT)
    assert list(*batches.crossed(answers).values()) == list((p < 0.05).astype(float))


def test_the_picked_best_and_a_control() -> None:
    crowd = Crowd("", 20, (4.0,) * 6, steps=True)
    answers = answers_of(crowd)
    p = batches.picked_p(Moments.of(answers))
    for study in range(STUDIES):
        table = answers[:, study]
        best = table[:, :-1].mean(axis=0).argmax()
        anova = RepeatedMeasuresAnova(**WITHIN)(crowd.long(table[:, [best, 5]])).iloc[0]
        assert p[study] == pytest.approx(anova["p_gg"], **EXACT)
    assert list(*batches.picked(answers).values()) == list((p < 0.05).astype(float))


def test_what_has_no_value_is_nan() -> None:
    """Everybody alike: equal answers, or each picture a step above the last."""
    for answers in (np.full((5, 1, 3), 4.0), np.arange(5.0)[:, None, None] + np.arange(3.0)):
        said = batches.no_effect_within(answers)
        silent = [claim for claim, held in said.items() if np.isnan(held).all()]
        assert silent == [claim for claim in said if claim != "Friedman" or np.ptp(answers) == 0]
    assert all(
        np.isnan(held).all() for held in batches.no_effect_between(np.full((5, 1, 3), 4.0), np.zeros(3)).values()
    )
