"""Tests of thousands of studies at once give the p values of the public objects, study by study."""

import numpy as np
import pandas as pd
import pytest
from scipy.linalg import helmert

from analysis.statistics.anova import OneWayAnova, RepeatedMeasuresAnova
from analysis.statistics.batches import (
    Moments,
    independent_p,
    paired_equivalence_p,
    repeated_p,
    welch_equivalence_p,
)
from analysis.statistics.equivalence import Equivalence
from analysis.statistics.undefined import Floats, Undefined

STUDIES = 5


def likert(people: int, pictures: int, seed: int = 1, studies: int = STUDIES) -> Floats:
    """Correlated answers 1..7 with unequal means and spreads, (people, studies, pictures)."""
    random = np.random.default_rng([seed, people, pictures])
    person = random.normal(0, 1, (people, studies, 1))
    noise = random.normal(0, np.linspace(0.5, 2, pictures), (people, studies, pictures))
    return np.clip(np.rint(4 + np.linspace(0, 0.6, pictures) + person + noise), 1, 7)


def long_frame(table: Floats) -> pd.DataFrame:
    """people x samples as a row per answer."""
    samples = table.shape[1]
    who, sample = np.divmod(np.arange(table.size), samples)
    return pd.DataFrame({"person": who, "sample": sample, "answer": table.ravel()})


@pytest.mark.parametrize(("people", "levels"), [(2, 2), (2, 4), (5, 3), (20, 2), (20, 3), (44, 6), (3, 9)])
def test_repeated_measures(people: int, levels: int) -> None:
    answers = likert(people, levels)
    found = repeated_p(Moments.of(answers))
    for study in range(STUDIES):
        try:
            table = RepeatedMeasuresAnova("answer", "sample", "person")(long_frame(answers[:, study]))
        except Undefined:
            assert np.isnan(found[study])
        else:
            assert found[study] == pytest.approx(table["p_gg"].iloc[0], rel=1e-9)


@pytest.mark.parametrize("people", [2, 3, 20])
def test_independent_samples_of_one_and_several_pictures(people: int) -> None:
    answers = likert(people, 5)
    samples = ((0,), (3, 1), (4, 2))
    found = independent_p(Moments.of(answers), samples)
    for study in range(STUDIES):
        parts = [(index, answers[:, study, list(places)].ravel()) for index, places in enumerate(samples)]
        frame = pd.concat([pd.DataFrame({"sample": index, "answer": part}) for index, part in parts])
        assert found[study] == pytest.approx(OneWayAnova("answer", "sample")(frame)["p"].iloc[0], rel=1e-9)


@pytest.mark.parametrize("paired", [True, False])
@pytest.mark.parametrize("people", [3, 44])
def test_equivalence(people: int, paired: bool) -> None:
    answers = likert(people, 2)
    moments = Moments.of(answers)
    found = paired_equivalence_p(moments, 0.5) if paired else welch_equivalence_p(moments, (0,), (1,), 0.5)
    for study in range(STUDIES):
        expect_equivalence(found[study], long_frame(answers[:, study]), "person" if paired else None)


@pytest.mark.parametrize("people", [2, 20])
def test_equivalence_of_independent_samples_of_several_pictures(people: int) -> None:
    """Answers are pooled, and samples differ in size and spread."""
    answers = likert(people, 5)
    found = welch_equivalence_p(Moments.of(answers), (4, 0), (1, 3, 2), 0.5)
    for study in range(STUDIES):
        parts = [(0, answers[:, study, [4, 0]].ravel()), (1, answers[:, study, [1, 3, 2]].ravel())]
        frame = pd.concat([pd.DataFrame({"sample": index, "answer": part}) for index, part in parts])
        expect_equivalence(found[study], frame, None)


def expect_equivalence(p: float, frame: pd.DataFrame, subject: str | None) -> None:
    try:
        table = Equivalence("answer", "sample", subject, margin=0.5)(frame)
    except Undefined:
        assert np.isnan(p)
    else:
        assert p == pytest.approx(table["p_equivalence"].iloc[0], rel=1e-9)


def test_effects_by_contrasts_and_averaged_levels() -> None:
    """Two by three: a main effect is one of averaged levels; a contrast of the interaction is a paired t test."""
    answers = likert(15, 6)
    moments = Moments.of(answers)
    average = np.kron(np.eye(2), np.full((3, 1), 1 / 3))
    main = repeated_p(moments, np.kron(helmert(2).T, np.full((3, 1), 3**-0.5)))
    assert main == pytest.approx(repeated_p(moments.combined(average)), rel=1e-9)
    interaction = np.kron(helmert(2).T, helmert(3).T)
    assert interaction.T @ interaction == pytest.approx(np.eye(2))
    one = repeated_p(moments, interaction[:, :1])
    for study in range(STUDIES):
        score = answers[:, study] @ interaction[:, 0]
        pair = long_frame(np.column_stack([score, np.zeros(15)]))
        table = RepeatedMeasuresAnova("answer", "sample", "person")(pair)
        assert one[study] == pytest.approx(table["p"].iloc[0], rel=1e-9)


def test_other_samples_in_each_study() -> None:
    answers = likert(10, 4)
    samples = np.array([[study % 4, (study + 1) % 4] for study in range(STUDIES)])
    found = Moments.of(answers).chosen(samples)
    picked = np.stack([answers[:, study, samples[study]] for study in range(STUDIES)], axis=1)
    expected = Moments.of(picked)
    assert found.mean == pytest.approx(expected.mean)
    assert found.covariance == pytest.approx(expected.covariance)


def test_what_has_no_value_is_nan() -> None:
    equal = np.full((5, 1, 3), 4.0)
    shifted = np.arange(5.0)[:, None, None] + np.array([0.0, 1.0, 2.0])
    for answers in (equal, shifted):
        assert np.isnan(repeated_p(Moments.of(answers))).all()
        assert np.isnan(paired_equivalence_p(Moments.of(answers[..., :2]), 0.5)).all()
    assert np.isnan(independent_p(Moments.of(equal), ((0,), (1,)))).all()
    assert np.isnan(welch_equivalence_p(Moments.of(equal), (0,), (1,), 0.5)).all()
    assert np.isnan(independent_p(Moments.of(equal + np.arange(3.0)), ((0,), (1,)))).all()
