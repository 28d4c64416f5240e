"""`fakesss power` as a user meets it: the table, the document, the file, and a sentence for what cannot be."""

import csv
import json
import sys
from pathlib import Path
from typing import Any

import pytest
from study_fixture import write_study

import fakesss.cli_power
from analysis.power import Simulation
from fakesss.cli import main
from fakesss.problem import BadInput

EFFECTS = """
person_sd = 0.8
noise_sd = 1.0
[question.translucent.slopes]
backlight = -0.5
[question.realistic.pictures]
img02 = 0.05
"""


@pytest.fixture
def study(tmp_path: Path) -> Path:
    analysis = {"alpha": 0.1, "equivalence": {"margin": {"realistic": 0.6}}}
    (tmp_path / "effects.toml").write_text(EFFECTS, encoding="utf-8")
    return write_study(tmp_path / "study", 9, analysis=analysis)


def power(study: Path, *arguments: str, capsys: pytest.CaptureFixture[str]) -> tuple[int, str, str]:
    """Exit code, standard output and standard error of `fakesss power STUDY ...` with 400 studies of each size."""
    argv = ["fakesss", "power", str(study), "--simulations", "400", *arguments]
    with pytest.MonkeyPatch.context() as patch, pytest.raises(SystemExit) as end:
        patch.setattr(sys, "argv", argv)
        main()
    said = capsys.readouterr()
    return int(end.value.code or 0), said.out, said.err


def test_the_document_the_table_and_the_file(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = study / "power.csv"
    options = (
        "--effects",
        str(study.parent / "effects.toml"),
        "--people",
        "44",
        "--most",
        "60",
        "--completing",
        "0.86",
    )
    code, out, err = power(study, *options, "--json", "-o", str(table), capsys=capsys)
    assert code == 0
    document = json.loads(out)
    tests = {(test["title"], test["kind"]): test for test in document["tests"]}
    found = tests["Translucent vs backlight", "difference"]
    assert found["people_low"] <= found["people"] <= found["people_high"] < 60
    assert found["power_low"] < 0.8 <= found["power"] < found["power_high"]
    assert found["start"] > found["people"]
    assert [entry["people"] for entry in found["with"]] == [44]
    assert found["with"][0]["share"] > found["power"]
    assert "no effect is stated" in tests["Translucent vs diffuse weight", "difference"]["note"]
    assert "not reached with 60 participants" in tests["Realistic vs thickness exponent", "difference"]["note"]
    alike = tests["Realistic vs backlight: 1.2 like 0.8", "equivalence"]
    assert (alike["margin"], alike["alpha"], alike["difference"]) == (0.6, 0.05, 0)
    assert 20 < alike["people"] < 60
    assert document["analysis"] == {"mode": "repeated", "alpha": 0.1, "adjust": "holm", "family": "all"}
    assert document["stopped"] is False
    assert err == ""
    rows = list(csv.DictReader(table.read_text(encoding="utf-8").splitlines()))
    assert [row["title"] for row in rows] == [test["title"] for test in document["tests"]]
    assert rows[2]["people"] == str(found["people"])
    code, text, _ = power(study, *options, capsys=capsys)
    assert text.splitlines()[0].split("  ")[0] == "" and "people for 80%" in text and "to start" in text
    assert f"{found['people']} ({found['people_low']} to {found['people_high']})" in text
    assert power(study, *options, capsys=capsys)[1] == text


def test_default_effects_are_said_to_be_invented(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = power(study, capsys=capsys)
    assert code == 0
    assert "state yours with --effects FILE" in err
    assert "Translucent vs backlight" in out


def test_an_interruption_prints_what_is_known(
    study: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    simulate = Simulation.simulate

    def interrupted(self: Simulation, people: int, *others: Any, **progress: Any) -> None:
        if len(self.found) == 2:
            raise KeyboardInterrupt
        simulate(self, people, *others, **progress)

    monkeypatch.setattr(Simulation, "simulate", interrupted)
    code, out, err = power(study, "--people", "30", capsys=capsys)
    assert code == 130
    assert "1.00 (.99 to 1.00)" in out
    assert "stopped before it was known: power ." in out
    assert "fakesss: stopped; the table says what was known by then, and the same command begins anew" in err
    assert "kept" not in err


def test_an_interruption_before_anything_is_known(
    study: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*others: Any, **options: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(fakesss.cli_power, "power_of", interrupted)
    code, out, err = power(study, capsys=capsys)
    assert (code, out) == (130, "")
    assert err == "fakesss: stopped before anything was known; the same command begins anew\n"


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("--target", "0.1"), "--target 0.1: must lie between the study's alpha, 0.1, and 1"),
        (("--target", "1"), "--target 1: must lie between"),
        (("--completing", "0"), "--completing 0: must lie between 0.01 and 1"),
        (("--completing", "1e-300"), "--completing 1e-300: must lie between 0.01 and 1"),
        (("--people", "100001"), "100001 is not in the range 2<=x<=100000"),
        (("--most", "100001"), "100001 is not in the range 2<=x<=100000"),
        (("--people", "1"), "Invalid value for '--people': 1 is not in the range 2<=x<=100000"),
        (("--effects", "none.toml"), "none.toml: cannot be read"),
        (("-o", "table.txt"), 'table.txt: ".txt" is no format of tables'),
    ],
)
def test_what_cannot_be_is_said(
    study: Path, options: tuple[str, ...], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, err = power(study, *options, capsys=capsys)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert sentence in err


def test_effects_of_another_study(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = study.parent / "other.toml"
    path.write_text("[question.shiny]\nintercept = 3\n", encoding="utf-8")
    code, _, err = power(study, "--effects", str(path), capsys=capsys)
    assert code == 2
    assert "question.shiny: the study asks no such question" in err


def test_a_study_that_is_not_built(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="no such file; run `fakesss build"):
        fakesss.cli_power.power_of(tmp_path, None, (), 0.8, 1.0, 1000, 100, 1)


def test_a_study_of_independent_samples(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study = write_study(tmp_path / "study", 9, analysis={"mode": "independent"})
    code, out, err = power(study, "--json", capsys=capsys)
    assert code == 0
    assert "every picture has people of its own" in err
    independent = {test["title"]: test["people"] for test in json.loads(out)["tests"]}
    code, out, _ = power(write_study(tmp_path / "other", 9), "--json", capsys=capsys)
    for test in json.loads(out)["tests"]:
        if test["people"]:
            assert independent[test["title"]] > test["people"]


def test_rules_that_leave_people_out_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rules = {"exclude": {"same_answer_share": 0.9, "failed_checks": 1}}
    _, _, err = power(write_study(tmp_path / "study", 9, analysis=rules), "--most", "4", capsys=capsys)
    assert "[analysis.exclude] failed_checks, same_answer_share: nobody is left out here" in err


def test_one_picture_has_nothing_to_test(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = power(write_study(tmp_path / "study", 1), capsys=capsys)
    assert (code, out) == (2, "")
    assert "nothing to test: Translucent vs picture: one picture; a test needs at least two" in err


def test_effects_that_drown_everything_leave_no_value(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """All answers lie at the ends of the scale: not an effect that is missed, but one that no test is needed for."""
    path = study.parent / "huge.toml"
    path.write_text("person_sd = 0.1\nnoise_sd = 0.1\n[question.translucent.slopes]\nbacklight = 400\n")
    code, out, _ = power(study, "--effects", str(path), "--most", "10", capsys=capsys)
    assert code == 0
    assert "not reached with 10 participants: power .00; in all 400 studies with 10 participants it has no value" in out
