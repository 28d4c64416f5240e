"""A whole study: from an empty folder to a report that finds what was planted. Real pictures, server and database."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest


def fakesss(*arguments: str | Path) -> dict[str, Any]:
    command = [sys.executable, "-m", "fakesss", *map(str, arguments), "--json"]
    result = subprocess.run(command, capture_output=True, text=True, timeout=280, env=dict(os.environ))
    assert result.returncode == 0, result.stderr
    return dict(json.loads(result.stdout))


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The thesis's study, its pictures small: what happens to them is what is tested."""
    folder = tmp_path_factory.mktemp("studies") / "thesis"
    fakesss("new", folder, "--template", "thesis")
    text = (folder / "study.toml").read_text(encoding="utf-8")
    small = text.replace('object = "figure"', 'object = "figure:4000"').replace("[512, 512]", "[96, 96]")
    small = small.replace("samples = 1024", "samples = 8").replace("denoise = true", "denoise = false")
    (folder / "study.toml").write_text(small, encoding="utf-8")
    manifest = fakesss("build", folder)
    assert [entry["role"] for entry in manifest["stimuli"]] == 9 * ["factor"] + 6 * ["compare"]
    return folder


@pytest.fixture(scope="module")
def simulated(study: Path) -> dict[str, Any]:
    return fakesss("simulate", study, "--started", "44", "--completed", "38", "--seed", "2011")


@pytest.fixture(scope="module")
def results(study: Path, simulated: dict[str, Any]) -> dict[str, Any]:
    fakesss("report", study)
    return dict(json.loads((study / "report" / "results.json").read_text(encoding="utf-8")))


def test_no_answer_is_lost_or_doubled(simulated: dict[str, Any]) -> None:
    assert (simulated["started"], simulated["completed"]) == (44, 38)
    assert (simulated["lost"], simulated["duplicated"]) == (0, 0)
    assert simulated["stored"] == simulated["acknowledged"] >= 38 * 15 * 3


def test_the_report_counts_what_the_server_counted(results: dict[str, Any]) -> None:
    assert (results["n_started"], results["n_completed"]) == (44, 38)


def test_the_report_recovers_the_planted_effects(results: dict[str, Any]) -> None:
    """The default raters: more exponent looks more translucent, more backlight less, no diffuse weight less."""
    p = {(row["question"], row["factor"]): row["p"] for row in results["anova"] if row["method"].startswith("repeated")}
    assert p["translucent", "thickness exponent"] < 0.001
    assert p["translucent", "backlight"] < 0.01
    assert p["translucent", "diffuse weight"] < 0.01
    for factor in ("thickness exponent", "backlight", "diffuse weight"):
        assert p["varnished", factor] > 0.01  # nothing was planted there


def test_the_planted_effects_have_their_direction(results: dict[str, Any]) -> None:
    """Means by level, as planted: a slope of the other sign, or a level raised instead of lowered, is another study."""
    exponent = means(results, "translucent", "thickness exponent")
    assert exponent[18] < exponent[25] < exponent[30]
    backlight = means(results, "translucent", "backlight")
    assert backlight[0.8] > backlight[1.2] > backlight[1.6]
    diffuse = means(results, "translucent", "diffuse weight")
    assert diffuse[0] < diffuse[0.5]
    realistic = means(results, "realistic", "thickness exponent")
    assert realistic[18] > realistic[30]


def test_the_report_has_the_thesis_s_last_row(results: dict[str, Any]) -> None:
    """Table 4.4: our best picture beside the offline ones, in which nothing was planted."""
    (row,) = (
        row
        for row in results["anova"]
        if row["factor"] == "offline images vs ours" and row["method"].startswith("repeated")
    )
    assert (row["question"], row["df1"]) == ("translucent", 6)
    pairs = {(row["a"], row["b"]) for row in results["tukey"] if row["factor"] == "offline images vs ours"}
    assert len(pairs) == 21 and {f"img{n}" for n in range(10, 16)} <= {name for pair in pairs for name in pair}


def means(results: dict[str, Any], question: str, factor: str) -> dict[float, float]:
    """Level -> mean rating."""
    return {
        float(row["label"]): row["mean"]
        for row in results["means"]
        if (row["question"], row["factor"]) == (question, factor) and row["method"].startswith("repeated")
    }


def test_a_study_edited_after_the_build_is_told_to_be_so(study: Path, results: dict[str, Any], tmp_path: Path) -> None:
    edited = shutil.copytree(study, tmp_path / "edited")
    with (edited / "study.toml").open("a", encoding="utf-8") as file:
        file.write("# an afterthought\n")
    command = [sys.executable, "-m", "fakesss", "report", str(edited)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert result.returncode == 0
    assert "has changed since the pictures were built" in result.stderr


def test_simulated_answers_are_said_to_be_simulated(study: Path, results: dict[str, Any]) -> None:
    assert "simulated" in (study / "report" / "index.html").read_text(encoding="utf-8").lower()
