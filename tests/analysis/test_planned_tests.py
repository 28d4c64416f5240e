"""Simulated studies are tested as the report tests them: every p value and every decision is compared."""

import json
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from statsmodels.stats.multitest import multipletests
from thesis_study import QUESTIONS, stimulus, thesis_stimuli, write_manifest

from analysis.evidence import BETWEEN, Evidence
from analysis.factorials import factorials_of
from analysis.families import adjusted, family_words
from analysis.margins import equivalence_table, judge
from analysis.plan import Comparison, Mode
from analysis.planned import deciding, planned_table
from analysis.planned_tests import PlannedTest, planned_tests
from analysis.power import Simulation
from analysis.results import analyse
from analysis.rows import rows_of
from analysis.sample import draw_sample
from analysis.statistics.undefined import Floats
from analysis.study import StudyInfo, read_manifest

PEOPLE, STUDIES = 9, 2
COMPARED = {"name": "others", "question": "translucent", "stimuli": ["img10", "best", "img12", "img11"]}
CONTRASTS = [
    {"name": "exponents", "question": "translucent", "weights": {"img02": -1.0, "img01": -0.5, "img03": 1.5}},
    {"name": "lights", "question": "translucent", "weights": {"img05": 1.0, "img06": -1.0}},
    {"name": "weights", "question": "realistic", "weights": {"img07": 1.0, "img08": -1.0}},
]


def one_at_a_time(folder: Path, **analysis: Any) -> StudyInfo:
    """The thesis's study."""
    return read_manifest(write_manifest(folder, thesis_stimuli(), analysis))


def factorial(folder: Path, **analysis: Any) -> StudyInfo:
    """Exponent by backlight, one combination of which is shown as two pictures."""
    cells = [*product([25, 18], [1.2, 0.8, 1.6]), (25, 1.2)]
    names = ("thickness exponent", "backlight")
    entries = [
        stimulus(number, role="factor", rows=list(names), factors=dict(zip(names, cell, strict=True)), label=f"{cell}")
        for number, cell in enumerate(cells, 1)
    ]
    path = write_manifest(folder, entries, analysis)
    data = json.loads(path.read_text())
    data["study"]["design"] = {"kind": "full-factorial"}
    data["study"]["factors"] = [
        {"name": names[0], "path": "material.x", "levels": [25, 18]},
        {"name": names[1], "path": "material.y", "levels": [1.2, 0.8, 1.6]},
    ]
    path.write_text(json.dumps(data))
    return read_manifest(path)


def answers(question: str, people: int, studies: int, random: np.random.Generator, pictures: int) -> Floats:
    """Small whole numbers, so that pictures tie for the best; one picture stands out."""
    shift = 2.0 * (np.arange(pictures) == len(question) % pictures)
    person = random.normal(0, 1, (people, studies, 1))
    return np.clip(np.rint(4 + shift + person + random.normal(0, 1, (people, studies, pictures))), 1, 7)


def simulation_means(study: StudyInfo) -> dict[str, dict[str, float]]:
    return {name: {picture.id: 4.0 for picture in study.pictures} for name in QUESTIONS}


def simulation_of(study: StudyInfo, mode: Mode) -> tuple[Simulation, list[str]]:
    tests, notes = planned_tests(study, study.plan, mode, simulation_means(study))
    pictures = len(study.pictures)
    return Simulation(tests, lambda *given: answers(*given, pictures), pictures, STUDIES, 5), notes


def reported(study: StudyInfo, mode: Mode) -> Evidence:
    """The report's evidence on the last of the studies simulated, in its own mode alone."""
    names = [picture.id for picture in study.pictures]
    rows = []
    for number, question in enumerate(QUESTIONS):
        drawn = answers(question, PEOPLE, STUDIES, np.random.default_rng([5, number, 0]), len(names))[:, -1]
        rows += [
            (f"{name if mode == 'independent' else ''}P{person}", name, question, drawn[person, place])
            for person in range(PEOPLE)
            for place, name in enumerate(names)
        ]
    ratings = pd.DataFrame(rows, columns=["participant", "stimulus", "question", "rating"])
    sample = draw_sample(ratings, study.plan)
    listed, _ = rows_of(study, study.plan, sample.ratings)
    factorials = factorials_of(listed, sample.ratings)
    found = [
        analyse(row, sample, study.plan, mode, factorials)
        for row in listed
        if mode == "repeated" or row.kind != "interaction"
    ]
    return Evidence(study, study.plan, sample, ratings, adjusted(found, study.plan), ())


def check(study: StudyInfo, evidence: Evidence) -> list[str]:
    """Every p value and decision as the report's; returns the titles of the tests, in their order."""
    simulation, _ = simulation_of(study, evidence.sample.mode)
    p = simulation.p_values(PEOPLE, 0, STUDIES)
    expected, yes = report_says(evidence)
    assert [test.kind for test in simulation.tests] == [kind for kind, _ in expected]
    assert p[-1] == pytest.approx([value for _, value in expected], rel=1e-9)
    assert list(simulation.decided(p)[-1]) == yes
    return [test.title for test in simulation.tests]


def report_says(evidence: Evidence) -> tuple[list[tuple[str, float]], list[bool]]:
    """(kind, p) of every test of the report, and whether it decides for an effect (or for equivalence)."""
    plan = evidence.plan
    tests = [("difference", float(each.p or "nan")) for each in evidence.main]
    yes = [(each.deciding_p(plan) or 1.0) < plan.alpha for each in evidence.main]
    if evidence.sample.mode == "repeated":
        contrasts, _ = planned_table(evidence.sample, plan)
        tests += [("contrast", float(row["p"])) for _, row in contrasts.iterrows()]
        yes += [deciding(row, plan) < plan.alpha for _, row in contrasts.iterrows()]
    if plan.equivalence is not None:
        pairs = equivalence_table(judge(evidence.main, plan.equivalence)[0])
        tests += [("equivalence", float(value)) for value in pairs["p_equivalence"]]
        yes += [value in ("equivalent", "both") for value in pairs["verdict"]]
    return tests, yes


def test_a_comparison_with_the_best_contrasts_and_equivalence(tmp_path: Path) -> None:
    study = one_at_a_time(
        tmp_path,
        alpha=0.2,
        comparison=[COMPARED],
        contrast=CONTRASTS,
        equivalence={"margin": {"translucent": 1.5}, "alpha": 0.1},
    )
    titles = check(study, reported(study, "repeated"))
    assert len(titles) == 9 + 1 + 3 + 3 * 3 + 6
    assert titles[9:11] == ["Others", "translucent: exponents"]
    assert titles[13] == "Translucent vs thickness exponent: 25 like 18"


def test_families_and_adjustments(tmp_path: Path) -> None:
    study = one_at_a_time(tmp_path, alpha=0.4, contrast=CONTRASTS)
    evidence = reported(study, "repeated")
    decisions = set()
    for family, adjust in (("all", "none"), ("all", "holm"), ("question", "fdr"), ("factor", "holm")):
        plan = study.plan.model_copy(update={"family": family, "adjust": adjust})
        declared = replace(evidence, plan=plan, main=adjusted(evidence.main, plan))
        check(replace(study, plan=plan), declared)
        decisions.add(tuple(report_says(declared)[1]))
    assert len(decisions) == 4  # so that a wrong family or method would have been seen


def test_independent_samples(tmp_path: Path) -> None:
    study = one_at_a_time(tmp_path, alpha=0.2, mode="independent", comparison=[COMPARED], equivalence={"margin": 1.5})
    assert len(check(study, reported(study, "independent"))) == 9 + 1 + 3 * 3 * 3 + 6


def test_a_factorial_with_its_interaction(tmp_path: Path) -> None:
    study = factorial(tmp_path, alpha=0.3, equivalence={"margin": 1.5})
    titles = check(study, reported(study, "repeated"))
    assert len(titles) == 9 + 3 * (1 + 3)
    assert titles[6] == "Translucent vs thickness exponent × backlight"


def test_a_factorial_between_people_has_no_interactions(tmp_path: Path) -> None:
    """Its levels' answers are pooled: each picture of a level has people of its own."""
    study = factorial(tmp_path, mode="independent", equivalence={"margin": 1.5})
    assert len(check(study, reported(study, "independent"))) == 6 + 3 * (1 + 3)
    assert simulation_of(study, "independent")[1] == [BETWEEN]


def test_expected_differences(tmp_path: Path) -> None:
    """Of main effects between means over equally weighted combinations, of interactions what no sum explains."""
    study = factorial(tmp_path, equivalence={"margin": 1.0})
    means = dict.fromkeys((picture.id for picture in study.pictures), 4.0)
    tests, _ = planned_tests(study, study.plan, "repeated", dict.fromkeys(QUESTIONS, means | {"img04": 4.6}))
    found = {test.title: test.difference for test in tests if test.question == "translucent"}
    assert found["Translucent vs thickness exponent"] == pytest.approx(0.2)
    assert found["Translucent vs backlight"] == pytest.approx(0.3)
    assert found["Translucent vs thickness exponent × backlight"] == pytest.approx(0.6 * 0.5 * 2 / 3)
    assert found["Translucent vs backlight: 1.2 like 0.8"] == pytest.approx(0.2)  # of three pictures that weigh alike
    assert found["Translucent vs backlight: 0.8 like 1.6"] == pytest.approx(0.0)
    tests, _ = planned_tests(study, study.plan, "independent", dict.fromkeys(QUESTIONS, means | {"img04": 4.6}))
    found = {test.title: test.difference for test in tests if test.question == "translucent"}
    assert found["Translucent vs backlight"] == pytest.approx(0.2)


def test_what_chance_picks_has_no_expected_difference(tmp_path: Path) -> None:
    study = one_at_a_time(tmp_path, comparison=[COMPARED], contrast=CONTRASTS, equivalence={"margin": 0.5})
    means = dict.fromkeys((picture.id for picture in study.pictures), 4.0) | {"img05": 5.0}
    tests, _ = planned_tests(study, study.plan, "repeated", dict.fromkeys(QUESTIONS, means))
    found = {test.title: test.difference for test in tests}
    assert found["Others"] is None
    assert found["Others: offline 1 like best own, backlight 0.8"] is None
    assert found["Others: offline 1 like offline 2"] == 0
    assert found["translucent: lights"] == 1
    assert [test.hopeless for test in tests if test.title == "Others"] == [""]


def test_without_factors_every_picture_is_compared_but_no_repeat(tmp_path: Path) -> None:
    pictures = [stimulus(number, role="compare", label=f"{number}") for number in (1, 2, 3)]
    again = stimulus(4, role="repeat", label="3 (again)", same_picture_as="img03")
    path = write_manifest(tmp_path, [*pictures, again], {})
    data = json.loads(path.read_text())
    data["study"]["factors"] = []
    path.write_text(json.dumps(data))
    study = read_manifest(path)
    means = {"img01": 4.0, "img02": 4.5, "img03": 4.0, "img04": 9.0}
    tests, _ = planned_tests(study, study.plan, "repeated", dict.fromkeys(QUESTIONS, means))
    assert [test.difference for test in tests if test.kind == "difference"] == [0.5] * 3


def planned(study: StudyInfo, mode: Mode = "repeated") -> tuple[list[PlannedTest], list[str]]:
    return planned_tests(study, study.plan, mode, simulation_means(study))


def test_contrasts_of_pictures_that_nobody_rates_are_left_out(tmp_path: Path) -> None:
    """As in the report; a picture shown again has its first showing alone in the tests."""
    wrong = [
        {"name": "unknown", "question": "translucent", "weights": {"img01": 1.0, "img99": -1.0}},
        {"name": "again", "question": "translucent", "weights": {"img01": 1.0, "img01r": -1.0}},
        {"name": "no weight", "question": "translucent", "weights": {"img01": 1.0, "img02": -1.0, "img99": 0.0}},
    ]
    again = stimulus(1, role="repeat", label="25 (again)", same_picture_as="img01") | {"id": "img01r"}
    path = write_manifest(tmp_path, [*thesis_stimuli(), again], {"contrast": wrong})
    tests, notes = planned(read_manifest(path))
    assert [test.name for test in tests if test.kind == "contrast"] == ["no weight"]
    assert notes[0].startswith('contrast "unknown" on translucent is left out: nobody rates "img99"; did you mean "img')
    assert 'contrast "again" on translucent is left out: nobody rates "img01r"; did you mean "img01"?' in notes


def test_between_people_contrasts_are_left_out_with_a_sentence(tmp_path: Path) -> None:
    tests, notes = planned(one_at_a_time(tmp_path, mode="independent", contrast=CONTRASTS), "independent")
    assert not [test for test in tests if test.kind == "contrast"]
    assert any('Left out: "exponents", "lights" and "weights".' in note for note in notes)
    without = one_at_a_time(tmp_path / "without", mode="independent")
    assert not any("contrasts" in note for note in planned(without, "independent")[1])


def test_one_picture_has_no_test(tmp_path: Path) -> None:
    path = write_manifest(tmp_path, [stimulus(1, role="control", label="alone")], {})
    data = json.loads(path.read_text())
    data["study"]["factors"] = []
    path.write_text(json.dumps(data))
    tests, notes = planned(read_manifest(path))
    assert tests == []
    assert "Translucent vs picture: one picture; a test needs at least two" in notes


def test_comparisons_that_nobody_declared_take_nothing_from_the_planned_tests(tmp_path: Path) -> None:
    """They are adjusted among themselves, in simulated studies as in the report."""
    study = one_at_a_time(tmp_path, alpha=0.2, family="all", adjust="holm")
    evidence = reported(study, "repeated")
    titles = check(study, evidence)
    assert len(titles) == 9 + 3 and titles[9] == "Translucent: others vs ours"
    for mine in (evidence.main[:9], evidence.main[9:]):
        p = [each.p for each in mine if each.p is not None]
        assert [each.p_holm for each in mine if each.p is not None] == pytest.approx(
            list(multipletests(p, method="holm")[1])
        )
    added = "all 9 tests, and apart from them over 3 comparisons that [analysis] does not declare"
    assert family_words(study.plan, evidence.main) == added
    declaring = study.plan.model_copy(update={"comparison": (Comparison.model_validate(COMPARED),)})
    assert family_words(declaring, evidence.main) == "all 12 tests"


def test_a_picture_picked_by_the_ratings_is_said_to_differ_by_chance(tmp_path: Path) -> None:
    study = one_at_a_time(tmp_path, alpha=0.1, comparison=[COMPARED])
    assert planned(study)[1] == [
        "Others: the same ratings pick the best of 9 own pictures, so that the test finds a difference by chance alone "
        "in more than 10% of studies (before any adjustment); not all of its power is an effect's."
    ]
    named = COMPARED | {"stimuli": ["img10", "img11"]}
    assert planned(one_at_a_time(tmp_path / "named", comparison=[named]))[1] == []
