"""The report's section on equivalence: declared margins only, verdicts in words, figure, files."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from thesis_study import COMPARISON, QUESTIONS, thesis_stimuli, write_manifest

from analysis import Equivalence, write_report
from analysis.evidence import Evidence, gather
from analysis.plan import EquivalencePlan
from analysis.ratings import read_ratings
from analysis.sample import draw_sample
from analysis.section import Section
from analysis.sections.equivalence import equivalence
from analysis.study import read_manifest

REPEATED = Path(__file__).parents[1] / "data" / "statistics" / "thesis_shaped_repeated_n44.csv"
DECLARED = {"comparison": [COMPARISON], "tests": [], "equivalence": {"margin": 0.5}}
Made = Callable[..., Section]


@pytest.fixture(scope="module")
def manifest(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The thesis's study with a margin of half a step."""
    return write_manifest(tmp_path_factory.mktemp("margins") / "study", thesis_stimuli(), DECLARED)


@pytest.fixture(scope="module")
def evidence(manifest: Path) -> Evidence:
    """What is computed for its report."""
    study, read = read_manifest(manifest), read_ratings(REPEATED)
    return gather(study, study.plan, draw_sample(read, study.plan), read)


@pytest.fixture
def section(evidence: Evidence) -> Made:
    """The section under other margins, and of other rows."""

    def make(margin: Any = 0.5, **parts: Any) -> Section:
        plan = evidence.plan.model_copy(update={"equivalence": EquivalencePlan(margin=margin)})
        made = equivalence(replace(evidence, plan=plan, **parts))
        assert made is not None
        return made

    return make


def pairs_of(section: Section) -> list[Mapping[Any, Any]]:
    """The rows of tables/equivalence.csv."""
    return section.tables["equivalence"].to_dict("records")


def test_without_a_margin_nothing_is_called_alike(evidence: Evidence) -> None:
    plan = evidence.plan.model_copy(update={"equivalence": None})
    assert equivalence(replace(evidence, plan=plan)) is None


def test_one_margin_for_all(section: Made) -> None:
    """Every pair of factors and comparison, as the statistic says; words and figures."""
    made = section()
    pairs = pairs_of(made)
    assert len(pairs) == 9 * 3 + 6
    mine = next(pair for pair in pairs if (pair["a"], pair["b"]) == ("img03", "img12"))
    frame = pd.read_csv(REPEATED).query("scale == 'translucent' and image in ('img03', 'img12')")
    alone = Equivalence("rating", "image", "participant", 0.5)(frame).iloc[0]
    for name in ("difference", "ci_low", "ci_high", "p_equivalence"):
        assert mine[name] == pytest.approx(alone[name])
    assert (mine["verdict"], mine["margin"], mine["samples"]) == ("undecided", 0.5, "M1 vs M4")
    assert [drawing.stem for drawing in made.drawings] == [f"figure-equivalence-{number}" for number in (1, 2, 3)]
    assert made.summary[0] == (
        "Translucent, margin ±0.5 steps: of 15 pairs 12 different, perhaps by as much as the margin; 3 undecided. "
        "No pair was shown to be alike."
    )
    assert any("M = 0.45, t(43) = −0.16, p = .437, 90% CI [−0.03, 0.94], undecided" in s for s in made.sentences)
    assert "people to show two pictures alike" in made.body


def test_different_people(section: Made, evidence: Evidence) -> None:
    """Welch's tests, and no number of people of a paired design."""
    made = section(main=evidence.other)
    assert all("Welch’s t tests (margin ±0.5" in sentence for sentence in made.sentences)
    assert "people to show two pictures alike" not in made.body


def test_the_report_has_it(manifest: Path, section: Made, tmp_path: Path) -> None:
    """In page, results and files, with the bytes of another run; the warning about "Non significant" stays."""
    results = write_report(REPEATED, tmp_path, manifest=manifest)
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert len(results["equivalence"]) == 33 and 'id="equivalence"' in page
    assert '"Non significant" between two pictures is not evidence that they are rated alike.' in results["warnings"]
    assert (tmp_path / "tables" / "equivalence.csv").is_file()
    for drawing in section().drawings:
        assert (tmp_path / "figures" / f"{drawing.stem}.svg").read_text(encoding="utf-8") == drawing.svg


def test_a_question_without_a_margin_has_a_sentence(section: Made) -> None:
    """And those with one are named."""
    made = section({"realistic": 1.0, "varnished": 1.5})
    pairs = pairs_of(made)
    assert {pair["question"] for pair in pairs} == set(QUESTIONS) - {"translucent"}
    assert made.warnings[0].startswith("Question “translucent” has no margin in [analysis.equivalence]")
    assert "±1 step for “realistic” and ±1.5 steps for “varnished”" in made.body
    assert {"equivalent", "both"} & {pair["verdict"] for pair in pairs}


def test_a_pair_without_spread_has_a_sentence(section: Made, evidence: Evidence) -> None:
    """By the pictures' names; the other pairs of the row are tested."""
    each = evidence.main[-1]
    wide = each.answers.pivot(index="participant", columns="condition", values="rating").astype(float)
    wide["M3"] = wide["M2"]
    answers = wide.reset_index().melt("participant", var_name="condition", value_name="rating")
    made = section(main=(replace(each, answers=answers),))
    sentence = (
        "Equivalence of Offline images vs ours: every participant rates “offline 1” and “offline 2” exactly 0 apart; "
        "without spread there is no test."
    )
    assert sentence in made.warnings and sentence in made.body
    pairs = pairs_of(made)
    assert [pair["verdict"] == "untested" for pair in pairs] == [False, False, False, True, False, False]
    assert pd.isna(pairs[3]["p_equivalence"]) and pairs[3]["reason"] in sentence


def test_all_equal_ratings_have_a_sentence(section: Made, evidence: Evidence) -> None:
    """No pair, no table, no figure; why stands on the page."""
    each = evidence.main[-1]
    made = section(main=(replace(each, answers=each.answers.assign(rating=4.0)),))
    assert made.drawings == () and pairs_of(made) == []
    sentence = "“best own, thickness exponent 30” and “offline 1” exactly 0 apart; without spread there is no test."
    assert made.warnings[0].endswith(sentence) and sentence in made.body


def test_more_than_eight_levels_without_a_comparison(section: Made, evidence: Evidence) -> None:
    """15 levels make 105 pairs, and a sentence says how to choose."""
    each = evidence.main[0]
    many = replace(each, row=replace(each.row, levels=each.row.levels * 5))
    made = section(main=(many,))
    assert pairs_of(made) == []
    assert "15 levels make 105 pairs; none was tested for equivalence." in made.warnings[0]
