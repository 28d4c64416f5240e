"""Simulated power agrees with closed forms within its Monte-Carlo error, and so does the number of people."""

from collections.abc import Callable
from dataclasses import replace
from math import ceil
from typing import Literal

import numpy as np
import pytest
from scipy import integrate, stats
from statsmodels.stats.power import FTestAnovaPower, TTestPower

from analysis.planned_tests import PlannedTest
from analysis.power import MEMORY, Bracket, Draw, Search, Simulation
from analysis.power_table import as_frame, as_text, found_rows
from analysis.statistics.batches import Moments, independent_p, paired_equivalence_p, repeated_p
from analysis.statistics.undefined import Floats

STUDIES = 4000


def normal(means: list[float], person: float = 0.0, noise: float = 1.0) -> Draw:
    """Answers that are not rounded: a person term shared by the pictures, and noise."""

    def draw(question: str, people: int, studies: int, random: np.random.Generator) -> Floats:
        drawn = random.standard_normal((people, studies, 1 + len(means)))
        return np.array(means) + person * drawn[..., :1] + noise * drawn[..., 1:]

    return draw


def planned(
    p: Callable[[Moments], Floats], difference: float = 1.0, alpha: float = 0.05, margin: float | None = None
) -> PlannedTest:
    return PlannedTest("Row", "question", "row", "difference", p, alpha, difference, margin)


def simulated(test: PlannedTest, draw: Draw, pictures: int, seed: int = 1) -> Simulation:
    return Simulation([test], draw, pictures, STUDIES, seed)


def expect(test: PlannedTest, draw: Draw, pictures: int, people: int, power: float) -> None:
    """Simulated power within 3.5 standard errors of `power`."""
    simulation = simulated(test, draw, pictures)
    simulation.simulate(people)
    assert simulation.power(0, people).share == pytest.approx(power, abs=3.5 * (power * (1 - power) / STUDIES) ** 0.5)


@pytest.mark.parametrize(("people", "means"), [(5, [0, 0.5, 1.5]), (20, [0, 0.5, 0.8]), (40, [0.0, 0.0, 0.0, 0.45])])
@pytest.mark.parametrize("alpha", [0.05, 0.10])
def test_independent_samples_by_the_noncentral_f(people: int, means: list[float], alpha: float) -> None:
    groups = tuple((place,) for place in range(len(means)))
    power = FTestAnovaPower().power(np.std(means), people * len(means), alpha, len(means))
    test = planned(lambda moments: independent_p(moments, groups), alpha=alpha)
    expect(test, normal(means), len(means), people, power)


@pytest.mark.parametrize(("people", "difference"), [(6, 2.0), (44, 0.6)])
def test_two_levels_within_people_by_the_noncentral_t(people: int, difference: float) -> None:
    """The person term drops out of the difference, whose variance is twice the noise's."""
    power = TTestPower().power(difference / 2**0.5, people, 0.05)
    expect(planned(repeated_p), normal([0, difference], person=3.0), 2, people, power)


@pytest.mark.parametrize(("people", "means"), [(60, [0.0, 0.25, 0.5]), (80, [0.0, 0.3, 0.0, 0.3, 0.0])])
def test_more_levels_within_people_by_the_noncentral_f(people: int, means: list[float]) -> None:
    """Under sphericity, with so many people that the correction hardly costs power."""
    df1 = len(means) - 1
    df2, noncentrality = df1 * (people - 1), people * len(means) * float(np.var(means))
    power = stats.ncf.sf(stats.f.isf(0.05, df1, df2), df1, df2, noncentrality)
    expect(planned(repeated_p), normal(means, person=1.0), len(means), people, power)


def tost_power(people: int, difference: float, deviation: float, margin: float, alpha: float) -> float:
    """Of two one-sided paired t tests, exact: over the distribution of the observed spread (Phillips 1990)."""
    df, error = people - 1, deviation / people**0.5

    def given(chi: float) -> float:
        half = margin - stats.t.isf(alpha, df) * error * chi / df**0.5
        if half <= 0:
            return 0.0
        inside = stats.norm.cdf((half - difference) / error) - stats.norm.cdf((-half - difference) / error)
        return float(inside * stats.chi.pdf(chi, df))

    return float(integrate.quad(given, 0, df**0.5 * 4, points=[df**0.5], limit=200)[0])


THESIS_DEVIATION = 0.53 * 44**0.5 / stats.t.isf(0.05, 43)  # the 90% interval of 44 people has a half-width of .53


@pytest.mark.parametrize(("people", "difference"), [(44, 0.0), (151, 0.0), (151, 0.2)])
def test_equivalence_by_the_exact_power_of_two_one_sided_tests(people: int, difference: float) -> None:
    test = planned(lambda moments: paired_equivalence_p(moments, 0.5), difference, margin=0.5)
    draw = normal([0, difference], person=1.0, noise=THESIS_DEVIATION / 2**0.5)
    expect(test, draw, 2, people, tost_power(people, difference, THESIS_DEVIATION, 0.5, 0.05))


def test_the_thesis_needed_about_151_people_to_show_that_pictures_are_alike() -> None:
    exact = next(people for people in range(140, 160) if tost_power(people, 0, THESIS_DEVIATION, 0.5, 0.05) >= 0.8)
    assert exact == 152  # docs/equivalence.md: 149 to 154 by what the printed HSD leaves open
    test = planned(lambda moments: paired_equivalence_p(moments, 0.5), 0.0, margin=0.5)
    search = Search(simulated(test, normal([0, 0], noise=THESIS_DEVIATION / 2**0.5), 2), 0.8, 1000)
    search.run()
    row = found_rows(search, (), 0.86)[0]
    assert row["people_low"] <= exact <= row["people_high"]
    assert row["people_high"] - row["people_low"] < 20
    assert row["start"] == ceil(row["people"] / 0.86)


@pytest.mark.parametrize(("difference", "target"), [(2.5, 0.8), (0.7, 0.9), (0.3, 0.8)])
def test_the_number_of_people_is_that_of_the_noncentral_t(difference: float, target: float) -> None:
    exact = ceil(TTestPower().solve_power(difference / 2**0.5, alpha=0.05, power=target))
    search = Search(simulated(planned(repeated_p), normal([0, difference]), 2), target, 1000)
    search.run()
    row = found_rows(search, (), 1.0)[0]
    assert row["people_low"] <= exact <= row["people_high"]
    assert row["people_low"] <= row["people"] <= row["people_high"]
    found = {people: count[0].rejections for people, count in search.simulation.found.items()}
    assert found[row["people"]] >= target * STUDIES > found[row["people"] - 1]
    assert len(found) < 30


def test_without_an_effect_tests_reject_at_alpha() -> None:
    expect(planned(repeated_p), normal([0, 0]), 2, 20, 0.05)


def test_no_number_of_people_has_its_reason() -> None:
    reasons = {
        "no effect is stated": planned(repeated_p, difference=0.0),
        "not reached with 32 participants: power .0": planned(repeated_p, difference=0.01),
        "the expected difference of 0.70 is not below the margin of 0.5": planned(repeated_p, 0.7, margin=0.5),
    }
    simulation = Simulation(list(reasons.values()), normal([0, 0]), 2, 200, 1)
    search = Search(simulation, 0.8, 32)
    search.run((20,))
    rows = found_rows(search, (20,), 1.0)
    for row, reason in zip(rows, reasons, strict=True):
        assert row["people"] is row["people_low"] is row["start"] is row["power"] is None
        assert row["note"].startswith(reason)
        assert row["with"][0]["people"] == 20
    text = as_text(rows, 0.8, 1.0, 32)
    assert "with 20" in text and "start" not in text and "nan" not in text.lower()
    frame = as_frame(rows)
    assert frame["people"].isna().all()
    assert list(frame.filter(like="with_20")) == ["power_with_20", "power_with_20_low", "power_with_20_high"]


def test_what_was_found_before_an_interruption_is_told() -> None:
    sizes: list[int] = []

    def interrupt(people: int, studies: int) -> None:
        sizes.append(people)
        if len(sizes) > 3:
            raise KeyboardInterrupt

    search = Search(simulated(planned(repeated_p), normal([0, 0.3]), 2), 0.8, 1000)
    with pytest.raises(KeyboardInterrupt):
        search.run((), interrupt)
    row = found_rows(search, (44,), 1.0)[0]
    assert row["people"] is None
    assert row["note"].startswith("stopped before it was known: power .")
    assert row["with"] == []


def test_more_people_are_the_same_studies_continued() -> None:
    """Common random numbers: the power of neighbouring sizes differs by far less than chance would let it."""
    simulation = simulated(planned(repeated_p), normal([0, 0.5]), 2)
    for people in range(40, 60):
        simulation.simulate(people)
    steps = np.diff([simulation.power(0, people).share for people in range(40, 60)])
    assert np.abs(steps).max() < 0.02
    assert steps.std() < 0.5 * (2 * 0.8 * 0.2 / STUDIES) ** 0.5


def test_the_seed_decides() -> None:
    def rejections(seed: int) -> int:
        simulation = simulated(planned(repeated_p), normal([0, 0.5]), 2, seed)
        simulation.simulate(30)
        return simulation.found[30][0].rejections

    assert rejections(1) == rejections(1) != rejections(2)


def test_a_bracket_doubles_then_closes() -> None:
    assert Bracket(None, None).next(0.8, 1000) == 8
    assert Bracket(8, None).next(0.8, 1000) == 16
    assert Bracket(600, None).next(0.8, 1000) == 1000
    assert Bracket(1000, None).next(0.8, 1000) is None
    assert Bracket(None, None).next(0.8, 3) == 3
    assert Bracket(None, 8, 0.0, 0.9).next(0.8, 1000) in range(2, 8)
    assert Bracket(None, 2).closed and Bracket(16, 17).closed and not Bracket(15, 17).closed
    assert Bracket(795, 800, grain=0.01).closed and not Bracket(785, 800, grain=0.01).closed
    for at in (0.0, 0.5, 0.79):
        assert 8 < (Bracket(8, 16, at, 0.999).next(0.8, 1000) or 0) < 16
        assert Bracket(8, 10, at, 0.8).next(0.8, 1000) == 9


def test_no_test_is_left_open_by_sizes_simulated_for_another() -> None:
    """Two like tests: sizes that the second needs may show the first a smaller number, which then is followed up."""
    draw = normal([0, 0.25, 0.26])
    pairs = [(0, 1), (0, 2), (1, 2)]
    tests = [
        planned(lambda moments, pair=pair: repeated_p(moments.combined(np.eye(3)[:, list(pair)])), 0.25)  # type: ignore[misc]
        for pair in pairs[:2]
    ]
    search = Search(Simulation(tests, draw, 3, 300, 3), 0.8, 1000)
    search.run()
    for row in found_rows(search, (), 1.0):
        assert row["people_low"] <= row["people"] <= row["people_high"]


def two_questions(adjust: Literal["none", "holm"]) -> tuple[Simulation, set[tuple[str, int]]]:
    """Two tests of question a and one of b, in a family of one method; and which (question, people) were drawn."""
    drawn: set[tuple[str, int]] = set()
    of = {"a": normal([0, 0.5]), "b": normal([0, 0.3])}

    def draw(question: str, people: int, studies: int, random: np.random.Generator) -> Floats:
        drawn.add((question, people))
        return np.asarray(of[question](question, people, studies, random))

    plain = planned(repeated_p)
    tests = [replace(plain, question=question, family="rows", adjust=adjust) for question in "aab"]
    return Simulation(tests, draw, 2, 200, 1), drawn


def test_only_questions_that_decide_a_test_are_drawn() -> None:
    """Other tests of the same answers are counted along, with the same counts as if all had been drawn."""
    whole, _ = two_questions("none")
    whole.simulate(40)
    simulation, drawn = two_questions("none")
    simulation.simulate(40, 2)
    assert drawn == {("b", 40)} and simulation.sizes(0) == [] and simulation.sizes(2) == [40]
    simulation.simulate(40, 0)
    assert drawn == {("b", 40), ("a", 40)} and simulation.found == whole.found
    family, drawn = two_questions("holm")
    family.simulate(40, 2)
    assert drawn == {("b", 40), ("a", 40)}
    assert family.found[40][2].rejections < whole.found[40][2].rejections


def test_memory_is_bounded_for_any_number_of_people() -> None:
    held: list[int] = []

    def draw(question: str, people: int, studies: int, random: np.random.Generator) -> Floats:
        held.append(people * studies * 2)
        return random.standard_normal((people, studies, 2))

    for largest in (10, 1000, 50_000):
        Simulation([planned(repeated_p)], draw, 2, 100, 1, largest).simulate(largest)
    assert max(held) <= MEMORY
    assert sum(held) == 2 * 100 * (10 + 1000 + 50_000)


def test_tests_without_a_value_in_any_study_say_so() -> None:
    """Where all differ by the same there is no spread to test against; of four random pairs of 1 and 2 in 7%."""

    def draw(question: str, people: int, studies: int, random: np.random.Generator) -> Floats:
        return random.integers(1, 8, (people, studies, 1)) + np.array([0.0, 1.0])

    def lucky(question: str, people: int, studies: int, random: np.random.Generator) -> Floats:
        return random.integers(1, 3, (people, studies, 2)).astype(float)

    for drawn, share in ((draw, "all 300"), (lucky, "19 of the 300")):
        search = Search(Simulation([planned(repeated_p)], drawn, 2, 300, 1), 0.8, 4)
        search.run()
        note = found_rows(search, (), 1.0)[0]["note"]
        assert note.startswith("not reached with 4 participants: power .")
        assert f"in {share} studies with 4 participants it has no value" in note
    still = Simulation([planned(repeated_p, difference=0.0)], draw, 2, 300, 1)
    search = Search(still, 0.8, 4)
    search.run((3,))
    assert "; in all 300 studies with 3 participants it has no value" in found_rows(search, (3,), 1.0)[0]["note"]
