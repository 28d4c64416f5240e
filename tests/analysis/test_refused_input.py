"""What a user asks for that cannot be: one sentence that names the cause, never a traceback or a silent choice."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from hard_ratings import ratings, scattered

from analysis import write_report
from analysis.plan import AnalysisPlan, check_analysis
from fakesss.cli_analysis import report
from fakesss.cli_study import build_study, new
from fakesss.problem import BadInput

Write = Callable[[str], Path]
WIDE = "participant,img1,img2\np1,3,4\np2,4,5\np3,2,6\n"


def told(*words: str | Path) -> str:
    """What `fakesss report` says where it writes nothing."""
    result = CliRunner().invoke(report, [*map(str, words)])
    assert isinstance(result.exception, BadInput)
    return str(result.exception)


def refused(path: Path, **options: Any) -> str:
    """The sentence of `write_report`."""
    with pytest.raises(BadInput) as error:
        write_report(path, path.parent / "out", **options)
    assert not (path.parent / "out").exists()
    return str(error.value)


def test_a_place_stands_once_in_the_form_of_columns(csv_of: Write) -> None:
    """ "{stimulus}{stimulus}" says nothing that could be read."""
    sentence = refused(csv_of(WIDE), wide="{stimulus}{stimulus}")
    assert "{stimulus} stands twice in --wide" in sentence


def test_a_column_has_one_role(csv_of: Write) -> None:
    """Ratings that are pictures too."""
    path = csv_of("participant,rating\np1,3\np2,4\n")
    sentence = refused(path, columns={"rating": "rating", "stimulus": "rating"})
    assert 'column "rating" cannot be both rating and stimulus' in sentence


def test_columns_of_pictures_hold_the_ratings(csv_of: Write) -> None:
    """A wide file has no column of ratings to name."""
    assert "leave --column rating out" in refused(csv_of(WIDE), wide="img*", columns={"rating": "img1"})


@pytest.mark.parametrize("scale", ["1001", "99999999999999999999"])
def test_a_scale_has_an_upper_bound(csv_of: Write, scale: str) -> None:
    """In the shell and in Python."""
    sentence = "must be a whole number from 2 to 1000, or none"
    path = csv_of(ratings())
    assert sentence in told("--ratings", path, "--scale", scale)
    assert sentence in refused(path, scale=int(scale))


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--column", "rating=a", "--column", "rating=b"), "--column rating: is given twice"),
        (("--factor", "light=mat", "--factor", "light"), "--factor light: is given twice"),
    ],
)
def test_an_option_given_twice_is_no_choice(words: tuple[str, ...], sentence: str) -> None:
    """The first would be forgotten without a word."""
    assert sentence in told("--ratings", "y.csv", *words)


@pytest.mark.parametrize("value", ["1e150", "1e-150", "-1e51"])
def test_numbers_beyond_squaring(csv_of: Write, value: str) -> None:
    """On a free scale; the line is named."""
    text = ratings(lambda who, what: value if (who, what) == (0, 1) else scattered(who, what))
    assert f'line 3: rating "{value}"' in refused(csv_of(text), scale=None)


@pytest.mark.parametrize(("low", "high"), [(1e-50, 9e-50), (1e-50, 1e50), (1e-20, 1e20), (1e49, 1e50)])
def test_numbers_at_the_bounds(csv_of: Write, tmp_path: Path, low: float, high: float) -> None:
    """They are analysed, and what the page cannot print is said."""
    text = ratings(lambda who, what: low + scattered(who, what) / 7 * (high - low))
    results = write_report(csv_of(text), tmp_path / "out", scale=None)
    assert any("the page prints two decimals" in sentence for sentence in results["warnings"])


def test_who_is_left_out_by_which_rule(csv_of: Write) -> None:
    """Everybody completed: waiting for complete sessions would not help."""
    plan = AnalysisPlan.model_validate({"exclude": {"same_answer_share": 0.1}})
    sentence = refused(csv_of(ratings()), plan=plan)
    assert "9 completed, and nobody is left to analyse" in sentence
    assert "exclude.same_answer_share left out 9" in sentence and "wait for" not in sentence


def test_a_contrast_on_a_question_that_nobody_answered(csv_of: Write, tmp_path: Path) -> None:
    """The question is the slip, not the pictures."""
    plan = AnalysisPlan.model_validate({"contrast": [{"name": "x", "question": "nix", "weights": {"a": 1, "b": -1}}]})
    results = write_report(csv_of(ratings()), tmp_path / "out", plan=plan)
    said = next(sentence for sentence in results["warnings"] if sentence.startswith('contrast "x"'))
    assert said == 'contrast "x" on nix is left out: nobody answered that question; choose one of "shiny"'


def test_a_margin_of_a_question_that_is_not_asked(csv_of: Write, tmp_path: Path) -> None:
    """A typing mistake would leave a question without its equivalence."""
    plan = AnalysisPlan.model_validate({"equivalence": {"margin": {"shinny": 1}}})
    results = write_report(csv_of(ratings()), tmp_path / "out", plan=plan)
    assert 'equivalence margin: question "shinny" is not asked; did you mean "shiny"?' in results["warnings"]


@pytest.mark.parametrize("margin", [6, 1e9, {"shiny": 6}])
def test_a_margin_as_long_as_the_scale(csv_of: Write, margin: object) -> None:
    """Within it everything is alike, whatever people answer."""
    plan = AnalysisPlan.model_validate({"equivalence": {"margin": margin}})
    assert "must be below 6, the length of the scale 1 to 7" in refused(csv_of(ratings()), plan=plan)


def test_a_margin_on_a_free_scale(csv_of: Write, tmp_path: Path) -> None:
    """Of a scale without ends nobody knows what is long."""
    plan = AnalysisPlan.model_validate({"equivalence": {"margin": 6}})
    assert write_report(csv_of(ratings()), tmp_path / "out", plan=plan, scale=None)["equivalence"]


def study(**analysis: Any) -> dict[str, Any]:
    """study.toml as read."""
    return {"question": [{"name": "shiny", "scale": 5}, {"name": "soft"}], "analysis": analysis}


@pytest.mark.parametrize(
    ("analysis", "sentence"),
    [
        ({"equivalence": {"margin": 4}}, "must be below 4, the length of the scale 1 to 5 of shiny"),
        (
            {"comparison": [{"name": "c", "question": "soft", "stimuli": ["best", "imh01"]}]},
            'comparison "c": the study has no picture "imh01"; did you mean "img01"?',
        ),
        (
            {"contrast": [{"name": "c", "question": "soft", "weights": {"img01": 1, "img3": -1}}]},
            'contrast "c": the study has no picture "img3"',
        ),
    ],
)
def test_slips_are_found_before_the_first_picture_is_drawn(analysis: dict[str, Any], sentence: str) -> None:
    """Nobody learns only from the report that a comparison is left out."""
    with pytest.raises(BadInput) as error:
        check_analysis(study(**analysis), "study.toml", ["img01", "img02"])
    assert sentence in str(error.value)


def test_build_draws_nothing_for_a_picture_that_is_not_there(tmp_path: Path) -> None:
    """`fakesss build` knows the pictures before they are drawn."""
    study = tmp_path / "study"
    assert CliRunner().invoke(new, [str(study)]).exit_code == 0
    with (study / "study.toml").open("a") as file:
        file.write('\n[[analysis.comparison]]\nname = "x"\nquestion = "translucent"\nstimuli = ["best", "img99"]\n')
    with pytest.raises(BadInput, match='the study has no picture "img99"'):
        build_study(study)
    assert not (study / "stimuli").exists()
