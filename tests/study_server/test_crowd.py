"""Many raters at once answer as single raters do."""

from pathlib import Path

import numpy as np
import pytest
from study_fixture import write_study

from study_server.manifest import BuiltStudy, load_study
from study_server.simulation.crowd import Crowd
from study_server.simulation.raters import Effects, QuestionEffects, Rater, default_effects

STRONG = Effects(
    person_sd=1.1,
    noise_sd=0.6,
    question={"translucent": QuestionEffects(slopes={"backlight": -2.0}, pictures={"img02": 0.7}, intercept=5.0)},
)


@pytest.fixture
def built(tmp_path: Path) -> BuiltStudy:
    return load_study(write_study(tmp_path / "nine", 9))


@pytest.mark.parametrize("effects", [None, STRONG], ids=["default", "clipped"])
def test_the_distribution_is_that_of_single_raters(built: BuiltStudy, effects: Effects | None) -> None:
    """Means, spreads and correlations of 1500 single raters lie within 4 standard errors of 40 000 of a crowd."""
    effects = effects or default_effects(built)
    single = np.array(
        [
            [rater.rating(stimulus, "translucent") for stimulus in built.stimuli[:6]]
            for rater in (Rater(built, effects, 3, number) for number in range(1500))
        ]
    )
    crowd = Crowd(built, effects).answers("translucent", 40_000, 1, np.random.default_rng(1))[:, 0, :6]
    error = np.sqrt(crowd.var(axis=0) * (1 / 1500 + 1 / 40_000))
    assert np.all(np.abs(single.mean(axis=0) - crowd.mean(axis=0)) < 4 * error)
    assert single.std(axis=0) == pytest.approx(crowd.std(axis=0), rel=4 / np.sqrt(2 * 1500) * 1.3)
    assert np.corrcoef(single.T) == pytest.approx(np.corrcoef(crowd.T), abs=4 / np.sqrt(1500))


@pytest.mark.parametrize("strangers", [False, True])
@pytest.mark.parametrize("effects", [None, STRONG], ids=["default", "clipped"])
def test_expected_means_are_those_drawn(built: BuiltStudy, effects: Effects | None, strangers: bool) -> None:
    crowd = Crowd(built, effects or default_effects(built), strangers)
    drawn = crowd.answers("translucent", 200, 400, np.random.default_rng(4)).reshape(-1, 9)
    error = drawn.std(axis=0) / np.sqrt(len(drawn))
    assert np.all(np.abs(drawn.mean(axis=0) - list(crowd.means("translucent").values())) < 4 * error)


def test_expected_means_without_any_spread(built: BuiltStudy) -> None:
    effects = Effects(person_sd=0, noise_sd=0, question={"translucent": QuestionEffects(pictures={"img02": 9.0})})
    crowd = Crowd(built, effects)
    assert list(crowd.means("translucent").values()) == [4, 7, *[4] * 7]
    assert np.all(crowd.answers("translucent", 2, 3, np.random.default_rng(1))[..., :3] == [4, 7, 4])


def test_strangers_share_no_person_term(built: BuiltStudy) -> None:
    effects = Effects(person_sd=1.0, noise_sd=0.5)
    for strangers, correlation in ((False, 0.7), (True, 0.0)):
        drawn = Crowd(built, effects, strangers).answers("realistic", 20_000, 1, np.random.default_rng(5))[:, 0]
        between = np.corrcoef(drawn.T)[np.triu_indices(9, 1)]
        assert between == pytest.approx(np.full(36, correlation), abs=0.08)


def test_more_people_begin_with_the_same_ones(built: BuiltStudy) -> None:
    crowd = Crowd(built, default_effects(built))
    few, many = (crowd.answers("translucent", n, 5, np.random.default_rng(6)) for n in (4, 9))
    assert np.array_equal(few, many[:4])
    assert set(np.unique(many)) <= set(range(1, 8))
