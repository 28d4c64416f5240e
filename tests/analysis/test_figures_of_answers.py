"""Figures of answers and people: shares, pieces of the scale, who goes against the trend, and pictures kept once."""

import re
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from thesis_study import stimulus, write_manifest

from analysis import write_report
from analysis.figures.profiles import along_trend
from analysis.figures.stacked import LABELLED, by_picture, stacked_figures, steps_of
from analysis.statistics.shares import AnswerShares
from analysis.study import Picture, Question, StudyInfo, read_manifest


@given(st.lists(st.tuples(st.integers(1, 3), st.integers(1, 5)), min_size=1, max_size=40))
def test_shares_are_the_counted_fractions(answers: list[tuple[int, int]]) -> None:
    frame = pd.DataFrame(answers, columns=["picture", "rating"]).astype({"rating": float})
    table = AnswerShares("rating", "picture", 5)(frame)
    for entry in table.to_dict("records"):
        mine = [rating for picture, rating in answers if picture == entry["group"]]
        assert entry["n"] == mine.count(int(entry["answer"]))
        assert entry["share"] == float(Fraction(mine.count(int(entry["answer"])), len(mine)))
    assert len(table) == 5 * len({picture for picture, _ in answers})


def test_shares_leave_out_missing_answers_and_keep_a_declared_order() -> None:
    frame = pd.DataFrame({"picture": ["b", "b", "a"], "rating": [1.0, np.nan, 2.0]})
    frame["picture"] = pd.Categorical(frame["picture"], ["b", "a", "c"])
    table = AnswerShares("rating", "picture", 2)(frame)
    assert table["group"].tolist() == ["b", "b", "a", "a"] and table["share"].tolist() == [1, 0, 0, 1]


def test_a_fine_scale_is_drawn_in_fifths() -> None:
    assert steps_of(7).names == ("1", "2", "3", "4", "5", "6", "7")
    fine = steps_of(100)
    assert fine.names == ("1–20", "21–40", "41–60", "61–80", "81–100")
    assert np.bincount(fine.piece).tolist() == [20] * 5
    assert sorted(np.bincount(steps_of(12).piece)) == [2, 2, 2, 3, 3]


@pytest.mark.parametrize("scale", [2, 5, 6, 7, 11])
def test_pieces_lean_from_orange_to_blue_and_the_middle_is_grey(scale: int) -> None:
    colours = np.asarray(steps_of(scale).colours)[:, :3]
    assert colours[0][0] > colours[0][2] and colours[-1][2] > colours[-1][0]
    if scale % 2:
        assert np.ptp(colours[scale // 2]) < 0.03


def luminance(colour: tuple[float, ...]) -> float:
    """WCAG 2.2 relative luminance."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in colour[:3]]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def shares_of(pictures: int, scale: int, questions: int = 1) -> tuple[StudyInfo, pd.DataFrame]:
    """A study without files, and every answer given once to every picture."""
    study = read_manifest_free(pictures, scale, questions)
    rows = [
        (question.name, picture.id, answer, 1, 1 / scale)
        for question in study.questions
        for picture in study.pictures
        for answer in range(1, scale + 1)
    ]
    return study, pd.DataFrame(rows, columns=["question", "stimulus", "answer", "n", "share"])


def read_manifest_free(pictures: int, scale: int, questions: int) -> StudyInfo:
    """Questions of one scale about pictures known by name."""
    from analysis.plan import AnalysisPlan

    asked = tuple(Question(f"q{i}", scale=scale) for i in range(questions))
    shown = tuple(Picture(f"img{i}", f"picture {i}") for i in range(pictures))
    return StudyInfo("t", "unknown", (), asked, shown, AnalysisPlan())


@pytest.mark.parametrize(
    ("pictures", "questions", "figures"), [(1, 1, 1), (20, 1, 1), (21, 1, 2), (60, 1, 3), (61, 1, 0), (2, 4, 2)]
)
def test_many_pictures_and_questions_are_split_or_left_to_the_table(
    pictures: int, questions: int, figures: int
) -> None:
    study, shares = shares_of(pictures, 5, questions)
    drawn = stacked_figures(study, shares)
    assert len(drawn) == figures and len({each.stem for each in drawn}) == figures


def test_the_middle_of_the_scale_stands_at_zero() -> None:
    study, shares = shares_of(2, 7)
    table = by_picture(shares, study.pictures, steps_of(7))
    assert table == pytest.approx(np.full((2, 7), 1 / 7))
    (figure,) = stacked_figures(study, shares)
    assert "4 is centred on the line" in figure.caption and "7 to each question" in figure.caption
    (even,) = stacked_figures(*shares_of(2, 6))
    assert "the halves of the scale meet at the line" in even.caption
    assert 0 < LABELLED < 1 / 7


def test_who_goes_against_the_trend() -> None:
    people = np.array([[1.0, 2, 5], [2, 2, 6], [4, 3, 2], [3, 7, 3], [np.nan, 1, 1]])
    along = along_trend(people)  # means 2.5, 3.5, 4: from the first level to the last
    assert along[:4].tolist() == [4, 4, -2, 0] and np.isnan(along[4])
    assert np.isnan(along_trend(people[4:])).all()


@pytest.fixture
def crossed(tmp_path: Path, csv_of: Callable[[str], Path]) -> Callable[..., Path]:
    """The folder of a report on `levels` levels of one factor rated by `people`."""

    def report(levels: int, people: int) -> Path:
        stimuli: list[dict[str, Any]] = [
            stimulus(i, role="factor", label=f"level {i}", rows=["backlight"], factors={"backlight": i})
            for i in range(1, levels + 1)
        ]
        manifest = write_manifest(tmp_path / "study", stimuli, {"tests": ["ranks"]})
        text = manifest.read_text().replace("[1.2, 0.8, 1.6]", str(list(range(1, levels + 1))))
        manifest.write_text(text)
        assert read_manifest(manifest).factors[1].levels[-1] == levels
        rows = [
            f"p{who},img{i:02d},translucent,{1 + (who * i * i + who + i) % 7}\n"
            for who in range(people)
            for i in range(1, levels + 1)
        ]
        write_report(
            csv_of("participant,stimulus,question,rating\n" + "".join(rows)), tmp_path / "out", manifest=manifest
        )
        return tmp_path / "out"

    return report


def test_two_people_one_question(crossed: Callable[..., Path]) -> None:
    figures = {path.name for path in (crossed(3, 2) / "figures").glob("*.svg")}
    assert figures >= {"figure-4-5-factors.svg", "figure-answers.svg", "figure-people.svg"}


def test_a_factor_of_thirty_levels(crossed: Callable[..., Path]) -> None:
    """Its labels are thinned, its thumbnails left to the bars."""
    out = crossed(30, 5)
    means = (out / "figures" / "figure-4-5-factors.svg").read_text()
    assert '<use xlink:href="#picture-' not in means
    assert len(list((out / "figures").glob("figure-answers-*.svg"))) == 2


def test_a_picture_stands_once_in_page_and_figure(crossed: Callable[..., Path]) -> None:
    out = crossed(3, 4)
    svg = (out / "figures" / "figure-4-5-factors.svg").read_text()
    assert len(re.findall(r"data:image", svg)) == 3 == len(set(re.findall(r'<use xlink:href="#(picture-\w+)"', svg)))
    page = (out / "index.html").read_text()
    assert len(re.findall(r"<image [^>]*data:image", page)) == 3
    assert page.count('href="#picture-') == 6  # means and answers; per-person lines have none


def test_a_hundred_pictures_without_factors(csv_of: Callable[[str], Path], tmp_path: Path) -> None:
    """Ranked, with the ends named; the bars are left to the table, and the page says so."""
    rows = "".join(f"p{who},img{i},translucent,{1 + (who * i) % 7}\n" for who in range(4) for i in range(100))
    write_report(csv_of("participant,stimulus,question,rating\n" + rows), tmp_path / "out")
    assert (tmp_path / "out" / "figures" / "figure-ranked-1.svg").is_file()
    page = (tmp_path / "out" / "index.html").read_text()
    assert "100 pictures are too many for bars" in page and 'href="tables/answers.csv"' in page
