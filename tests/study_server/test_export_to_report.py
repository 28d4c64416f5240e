"""What the export holds of instructed items, repeats and blocks, and what the report makes of it."""

import json
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from exported_study import write_hostile_study
from survey_client import Participant

from analysis.levels import from_ratings
from analysis.plan import AnalysisPlan, Exclusions
from analysis.ratings import is_check, is_first_showing, is_repeat, read_ratings
from analysis.sample import draw_sample
from study_server.exports.export import export_ratings
from study_server.serve import served

PEOPLE = 6


def answer_all(url: str, number: int) -> None:
    """Person `number` gives answers of 1 to 5 that differ from picture to picture.

    The first three heed every instructed item, the fourth one, the others none; the last leaves after four trials.
    """
    person = Participant(url).consent()
    for step in ("about", "screen", "instructions"):
        if person.state["step"] == step:
            person.post(step, age="25-34")
    person.post("ready")
    heeded = 0
    for _ in range(4 if number == PEOPLE - 1 else 1000):
        if person.state["step"] != "trials":
            break
        body = person.answers()
        for given, question in zip(body["answers"], person.state["questions"], strict=True):
            given["rating"] = 1 + (person.state["place"] * (number + 1) + len(question["name"])) % 5
            if question["name"] == "check":
                asked = int(re.findall(r"\d+", question["text"])[0])
                heed = number < 3 or (number == 3 and not heeded)
                heeded += heed
                given["rating"] = asked if heed else 3  # the middle, which is never asked for
        reply = person.send(body)
        assert reply.status_code == 200, reply.text
        person.state = reply.json()["next"]


def export_of(folder: Path, blocks: str) -> Path:
    """The export of a study with repeats and two instructed items, of six people; the study lies beside it."""
    study = write_hostile_study(folder / "study", practice=0, blocks=blocks)
    with served(study) as url:
        for number in range(PEOPLE):
            answer_all(url, number)
    export_ratings(study, folder / "out")
    return folder / "out"


@pytest.fixture(scope="module", params=["together", "by-question"])
def exported(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """`export_of` both arrangements."""
    return export_of(tmp_path_factory.mktemp("rows"), request.param)


@pytest.fixture(scope="module")
def by_question(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same, by question only, for the reports, which take seconds."""
    return export_of(tmp_path_factory.mktemp("report"), "by-question")


def report(*arguments: str | Path) -> dict[str, Any]:
    """The results of `fakesss report`."""
    command = [sys.executable, "-m", "fakesss", "report", *map(str, arguments), "--json"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def test_rows(exported: Path) -> None:
    """Each picture once on each question, each repeat too; instructed items in rows of their own."""
    rows = pd.read_csv(exported / "ratings.csv")
    together = Counter(rows.groupby(["session", "trial"]).size()).keys() != {1, 2}
    for _, session in rows.groupby("session"):
        ordinary, checks = session[session.check_expected.isna()], session[session.check_expected.notna()]
        assert (len(ordinary), len(checks)) == (12, 2)
        assert not ordinary.duplicated(["stimulus", "question"]).any()
        assert set(checks.question) == {"check"}
        assert set(ordinary.question) == {'looks, "soft"', "translucent"}
        assert sorted(session.trial.unique()) == list(range(1, (6 if together else 12) + 1))
        repeats = ordinary[ordinary.repeat_of.notna()]
        assert dict(zip(repeats.stimulus, repeats.repeat_of, strict=True)) == {"img01r": "img01", "img02r": "img02"}
        for (_, question), shown in ordinary.groupby([ordinary.repeat_of.fillna(ordinary.stimulus), "question"]):
            order = shown.sort_values("trial").presentation.tolist()
            assert order == sorted(order), question
            assert len(shown) == (2 if shown.repeat_of.notna().any() else 1)


def test_failed_checks_are_columns(exported: Path) -> None:
    rows = pd.read_csv(exported / "ratings.csv")
    checks = rows[rows.question == "check"].groupby("session", sort=False)
    failed = [int((shown.check_passed == 0).sum()) for _, shown in checks]
    assert failed[:5] == [0, 0, 0, 1, 2]
    assert pd.read_csv(exported / "participants.csv").checks_failed.tolist() == failed
    wide = pd.read_csv(exported / "wide.csv")
    assert wide.checks_failed.tolist() == failed
    assert (wide[["check_1", "check_2"]] == 0).sum(axis=1).tolist() == failed
    assert rows.check_passed[rows.question != "check"].isna().all()


def test_the_analysis_tells_checks_and_repeats_from_ratings(exported: Path) -> None:
    ratings = read_ratings(exported / "ratings.csv", scale=None)
    assert set(ratings[is_check(ratings)].question) == {"check"}
    assert set(ratings[is_repeat(ratings) & ~is_check(ratings)].stimulus) == {"img01r", "img02r"}
    assert Counter(ratings[is_first_showing(ratings)].question) == {'looks, "soft"': 24, "translucent": 24}


def test_failed_checks_leave_out_only_where_the_plan_says_so(exported: Path) -> None:
    ratings = read_ratings(exported / "ratings.csv", scale=None)
    for rules, people in ((Exclusions(), PEOPLE - 1), (Exclusions(failed_checks=2), PEOPLE - 2)):
        sample = draw_sample(ratings, AnalysisPlan(exclude=rules), exported / "participants.csv")
        assert (sample.n_started, sample.n_completed, sample.n_analysed) == (PEOPLE, PEOPLE - 1, people)


def test_without_the_study_instructed_items_are_no_question(exported: Path) -> None:
    ratings = read_ratings(exported / "ratings.csv")
    assert {q.name for q in from_ratings(ratings, "elsewhere", 7).questions} == {'looks, "soft"', "translucent"}


def test_the_report_counts_failed_checks_and_is_the_same_on_the_wide_table(by_question: Path, tmp_path: Path) -> None:
    study = by_question.parent / "study"
    long = report(study, "-o", tmp_path / "long")
    assert (long["n_started"], long["n_completed"]) == (PEOPLE, PEOPLE - 1)
    assert {row["question"] for row in long["anova"]} == {'looks, "soft"', "translucent"}
    assert not [warning for warning in long["warnings"] if '"check"' in warning]
    people = pd.read_csv(by_question / "participants.csv").set_index("participant")
    quality = pd.read_csv(tmp_path / "long" / "tables" / "participants.csv").set_index("participant")
    assert quality.failed_checks.to_dict() == people.checks_failed.to_dict()
    assert (quality.ratings + quality.missing == 8).all()
    file = ("--ratings", by_question / "wide.csv", "--wide", "{stimulus}__{question}")
    wide = report(study, *file, "-o", tmp_path / "wide")
    for part in ("n_started", "n_completed", "n_analysed", "cells", "anova", "tukey", "means", "agreement", "retest"):
        assert wide[part] == long[part], part
