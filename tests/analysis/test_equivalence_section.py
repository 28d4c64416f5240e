"""The report's section on equivalence: declared margins only, verdicts in words, figure, files."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from thesis_study import COMPARISON, QUESTIONS, thesis_stimuli, write_manifest

from analysis import Equivalence, write_report
from analysis.evidence import gather
from analysis.ratings import read_ratings
from analysis.sample import draw_sample
from analysis.section import Section
from analysis.sections.equivalence import equivalence
from analysis.study import read_manifest

DATA = Path(__file__).parents[1] / "data" / "statistics"
REPEATED = DATA / "thesis_shaped_repeated_n44.csv"
Made = Callable[..., Section | None]


@pytest.fixture
def section(tmp_path: Path) -> Made:
    """The section on ratings of the thesis's study, of the given `[analysis]` keys."""

    def make(ratings: Path = REPEATED, stimuli: Any = None, **analysis: Any) -> Section | None:
        study = read_manifest(write_manifest(tmp_path / "study", stimuli or thesis_stimuli(), analysis))
        read = read_ratings(ratings)
        return equivalence(gather(study, study.plan, draw_sample(read, study.plan), read))

    return make


def pairs_of(section: Section | None) -> list[Mapping[Any, Any]]:
    """The rows of tables/equivalence.csv."""
    assert section is not None
    return section.tables["equivalence"].to_dict("records")


def test_without_a_margin_nothing_is_called_alike(section: Made) -> None:
    assert section(comparison=[COMPARISON]) is None


def test_one_margin_for_all(section: Made) -> None:
    """Every pair of factors and comparison, as the statistic says; words and figures."""
    made = section(comparison=[COMPARISON], equivalence={"margin": 0.5})
    pairs = pairs_of(made)
    assert made is not None and len(pairs) == 9 * 3 + 6
    mine = next(pair for pair in pairs if (pair["a"], pair["b"]) == ("img03", "img12"))
    frame = pd.read_csv(REPEATED).query("scale == 'translucent' and image in ('img03', 'img12')")
    alone = Equivalence("rating", "image", "participant", 0.5)(frame).iloc[0]
    for name in ("difference", "ci_low", "ci_high", "p_equivalence"):
        assert mine[name] == pytest.approx(alone[name])
    assert (mine["verdict"], mine["margin"], mine["samples"]) == ("undecided", 0.5, "M1 vs M4")
    assert [drawing.stem for drawing in made.drawings] == [f"figure-equivalence-{number}" for number in (1, 2, 3)]
    assert made.summary[0] == (
        "Translucent: of 15 pairs, 12 different and 3 undecided by a margin of ±0.5 steps. "
        "No pair was shown to be alike."
    )
    assert any("M = 0.45, t(43) = −0.16, p = .437, 90% CI [−0.03, 0.94], undecided" in s for s in made.sentences)
    assert "people to show two pictures alike" in made.body


def test_different_people(section: Made) -> None:
    """Welch's tests, and no number of people of a paired design."""
    made = section(DATA / "thesis_shaped_independent_n29.csv", mode="independent", equivalence={"margin": 0.5})
    assert made is not None and all("Welch’s t tests (margin ±0.5" in sentence for sentence in made.sentences)
    assert "people to show two pictures alike" not in made.body


def test_the_report_has_it(tmp_path: Path) -> None:
    """In page, results and files; equal input, equal bytes; the warning about "Non significant" stays."""
    analysis = {"comparison": [COMPARISON], "tests": [], "equivalence": {"margin": 1.0, "alpha": 0.1}}
    manifest = write_manifest(tmp_path / "study", thesis_stimuli(), analysis)
    results = write_report(REPEATED, tmp_path / "report", manifest=manifest)
    page = (tmp_path / "report" / "index.html").read_text(encoding="utf-8")
    assert len(results["equivalence"]) == 33 and "80% CI" in page and 'id="figure-equivalence-1-' in page
    assert '"Non significant" between two pictures is not evidence that they are rated alike.' in results["warnings"]
    files = [tmp_path / "report" / name for name in ("tables/equivalence.csv", "figures/figure-equivalence-1.svg")]
    before = [path.read_bytes() for path in files]
    write_report(REPEATED, tmp_path / "report", manifest=manifest)
    assert [path.read_bytes() for path in files] == before


def test_a_question_without_a_margin_has_a_sentence(section: Made) -> None:
    """And those with one are named."""
    made = section(equivalence={"margin": {"realistic": 1.0, "varnished": 1.5}})
    pairs = pairs_of(made)
    assert made is not None and {pair["question"] for pair in pairs} == set(QUESTIONS) - {"translucent"}
    assert made.warnings[0].startswith("Question “translucent” has no margin in [analysis.equivalence]")
    assert "±1 steps for “realistic” and ±1.5 steps for “varnished”" in made.body
    assert {"equivalent", "both"} & {pair["verdict"] for pair in pairs}


def test_a_pair_without_spread_has_a_sentence(section: Made, tmp_path: Path) -> None:
    """By the pictures' names; the other pairs of the row are tested."""
    frame = pd.read_csv(REPEATED)
    answers = frame.set_index(["scale", "participant", "image"])["rating"]
    same = (frame["image"] == "img11") & (frame["scale"] == "translucent")
    frame.loc[same, "rating"] = [answers["translucent", who, "img10"] for who in frame.loc[same, "participant"]]
    frame.to_csv(tmp_path / "changed.csv", index=False)
    made = section(tmp_path / "changed.csv", comparison=[COMPARISON], equivalence={"margin": {"translucent": 0.5}})
    sentence = (
        "Equivalence of Offline images vs ours: every participant rates “offline 1” and “offline 2” exactly 0 apart; "
        "without spread there is no test."
    )
    assert made is not None and sentence in made.warnings and sentence in made.body
    pairs = [pair for pair in pairs_of(made) if pair["factor"] == COMPARISON["name"]]
    assert [pair["verdict"] == "untested" for pair in pairs] == [False, False, False, True, False, False]
    assert pd.isna(pairs[3]["p_equivalence"]) and pairs[3]["reason"] in sentence


def test_more_than_eight_pictures_without_a_comparison(section: Made) -> None:
    """Nothing declared: 15 pictures make 105 pairs, and a sentence says how to choose."""
    stimuli = [{**entry, "role": "factor", "factors": {}, "rows": []} for entry in thesis_stimuli()]
    made = section(stimuli=stimuli, equivalence={"margin": 0.5})
    assert pairs_of(made) == [] and made is not None
    assert "15 levels make 105 pairs; none was tested for equivalence." in made.warnings[0]
