"""The report's words for ratings that do not fit the study, names that do not fit a plot, and two levels."""

import re
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
from thesis_study import stimulus, write_manifest

from analysis import write_report

Write = Callable[[str], Path]
LEVELS: dict[str, list[float]] = {"thickness exponent": [25, 18], "backlight": [1.2, 0.8, 1.6]}


def small_study(folder: Path, labels: str = "") -> Path:
    """Pictures img01..img05: two levels of one factor, three of the other; `labels` goes before each label."""
    cells = [(name, level) for name, levels in LEVELS.items() for level in levels]
    entries: list[dict[str, Any]] = [
        stimulus(place, role="factor", rows=[name], label=f"{labels}{name} {level}", factors={name: level})
        for place, (name, level) in enumerate(cells, 1)
    ]
    return write_manifest(folder / "study", entries, {"tests": ["ranks"]})


def answers(people: int = 12, questions: tuple[str, ...] = ("translucent", "realistic", "varnished")) -> str:
    """Complete ratings of the five pictures."""
    rows = [
        f"p{who},img0{place},{question},{1 + (who * place + who + 3 * (place == 1 and who > 0)) % 7}\n"
        for who in range(people)
        for place in range(1, 6)
        for question in questions
    ]
    return "participant,stimulus,question,rating\n" + "".join(rows)


def page_text(out: Path) -> str:
    """The page without tags and with its characters."""
    return re.sub(r"<[^>]*>", "", (out / "index.html").read_text(encoding="utf-8"))


def test_a_misspelt_question_is_named(csv_of: Write, tmp_path: Path) -> None:
    """Nothing is dropped in silence, and no false sentence about agreement stands in its place."""
    path = csv_of(answers().replace("realistic", "realistc"))
    said = write_report(path, tmp_path / "out", manifest=small_study(tmp_path))["warnings"]
    assert said[0] == 'Rated but not a question of the study: "realistc" (did you mean "realistic"?); not analysed.'
    assert said[1] == "Never answered: realistic."
    assert not any("Agreement on realistic" in sentence for sentence in said)


def test_a_stray_question_does_not_undo_completion(csv_of: Write, tmp_path: Path) -> None:
    """One row of another question asks no more of the others."""
    path = csv_of(answers() + "p1,img01,pretty,4\n")
    results = write_report(path, tmp_path / "out", manifest=small_study(tmp_path))
    assert (results["n_completed"], results["n_analysed"]) == (12, 12)
    assert 'not a question of the study: "pretty"; not analysed' in results["warnings"][0]


def test_a_question_answered_only_by_dropouts(csv_of: Write, tmp_path: Path) -> None:
    """Its answers exist, and nobody's count."""
    text = answers(questions=("translucent", "varnished")) + "p99,img01,realistic,4\n"
    people = tmp_path / "participants.csv"
    people.write_text("participant,status\n" + "".join(f"p{who},finished\n" for who in range(12)) + "p99,dropped\n")
    results = write_report(csv_of(text), tmp_path / "out", manifest=small_study(tmp_path), participants=people)
    assert "Answered only by people who were left out: realistic." in results["warnings"]


def test_two_levels_get_wilcoxons_test(csv_of: Write, tmp_path: Path) -> None:
    """No warning about Friedman's three levels; both tests have their table, and all rows have a test of ranks."""
    results = write_report(csv_of(answers()), tmp_path / "out", manifest=small_study(tmp_path))
    assert not any("Friedman" in sentence for sentence in results["warnings"])
    text = page_text(tmp_path / "out")
    assert "Friedman's test: ranks instead of means" in text.replace("&#39;", "'")
    assert "Wilcoxon’s signed-rank test: ranks of two samples instead of means" in text
    assert "25 minus 18" in text and "agree in all 6 rows" in text


def test_agreement_counts_only_rows_that_have_both(csv_of: Write, tmp_path: Path) -> None:
    """A row without values is in no agreement."""
    frame = pd.read_csv(csv_of(answers()))
    frame.loc[frame["question"] != "translucent", "rating"] = 4
    write_report(csv_of(frame.to_csv(index=False)), tmp_path / "out", manifest=small_study(tmp_path))
    assert re.search(r"agree in both rows", page_text(tmp_path / "out"))


def test_the_most_serious_warning_comes_first(csv_of: Write, tmp_path: Path) -> None:
    """Simulated answers before a question unknown, that before a test without value, cautions last."""
    frame = pd.read_csv(csv_of(answers().replace("realistic", "realistc"))).assign(mode="simulated")
    frame.loc[frame["question"] == "varnished", "rating"] = 4
    path = csv_of(frame.to_csv(index=False))
    said = write_report(path, tmp_path / "out", manifest=small_study(tmp_path))["warnings"]
    order = ["simulated", "not a question", "Never answered", "all ratings are equal"]
    places = [next(i for i, sentence in enumerate(said) if words in sentence) for words in order]
    assert places == sorted(places) and places[0] == 0


def test_dollars_in_names_are_dollars(csv_of: Write, tmp_path: Path) -> None:
    """A name is no formula: not of a factor, not of a picture, not of a question."""
    manifest = small_study(tmp_path, labels=r"thick $\frac$ ")
    manifest.write_text(manifest.read_text().replace("backlight", r"back $\\frac$ light"))
    path = csv_of(answers())
    results = write_report(path, tmp_path / "out", manifest=manifest)
    assert r"back $\frac$ light" in {row["factor"] for row in results["anova"]}


def test_letters_without_a_font_are_said_once(csv_of: Write, tmp_path: Path) -> None:
    """No noise for the terminal: drawn where a font is installed, else one sentence."""
    manifest = small_study(tmp_path)
    manifest.write_text(manifest.read_text().replace("backlight", "背光 \U00013080"))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        said = write_report(csv_of(answers()), tmp_path / "out", manifest=manifest)["warnings"]
    assert not [each for each in caught if "Glyph" in str(each.message)]
    sentences = [sentence for sentence in said if "No font on this machine has the letters" in sentence]
    assert len(sentences) == 1 and "\U00013080" in sentences[0]
