"""The report's section on models: what is fitted to which rows, its tables, and whether the tests agree."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from thesis_study import COMPARISON, stimulus, thesis_stimuli, write_manifest

from analysis import MixedModel, OrdinalRegression
from analysis.evidence import Evidence, gather
from analysis.ratings import read_ratings
from analysis.sample import draw_sample
from analysis.section import Section
from analysis.sections.models import models
from analysis.study import read_manifest
from analysis.verdicts import finders, verdict

DATA = Path(__file__).parents[1] / "data" / "statistics"
LEVELS = {"img01": (25, 0.8), "img02": (25, 1.2), "img03": (18, 0.8), "img04": (18, 1.2)}


def evidence_of(ratings: Path, folder: Path, stimuli: list[dict[str, Any]], plan: dict[str, Any]) -> Evidence:
    """Everything up to the sections."""
    study = read_manifest(write_manifest(folder / "study", stimuli, plan))
    frame = read_ratings(ratings)
    return gather(study, study.plan, draw_sample(frame, study.plan), frame)


def section_of(evidence: Evidence) -> Section:
    """The section, which is there."""
    found = models(evidence)
    assert found is not None
    return found


@pytest.fixture(scope="module")
def section(thesis: Evidence) -> Section:
    """What the report shows of them."""
    return section_of(thesis)


@pytest.fixture(scope="module")
def thesis(tmp_path_factory: pytest.TempPathFactory) -> Evidence:
    """The thesis-shaped ratings."""
    plan = {"alpha": 0.10, "comparison": [COMPARISON]}
    folder = tmp_path_factory.mktemp("thesis")
    return evidence_of(DATA / "thesis_shaped_repeated_n44.csv", folder, thesis_stimuli(), plan)


def factorial(folder: Path, plan: dict[str, Any], answer: Any = None) -> Evidence:
    """Two factors of two levels, twelve people, one question."""
    stimuli = [
        stimulus(
            int(name[3:]), role="factor", label=name, rows=["thickness exponent", "backlight"],
            factors={"thickness exponent": exponent, "backlight": light},
        )
        for name, (exponent, light) in LEVELS.items()
    ]  # fmt: skip
    manifest = write_manifest(folder / "study", stimuli, plan)
    data = json.loads(manifest.read_text())
    levels = {"thickness exponent": [25, 18], "backlight": [0.8, 1.2]}
    data["study"]["factors"] = [{"name": name, "path": "material.x", "levels": of} for name, of in levels.items()]
    data["study"]["design"] = {"kind": "full-factorial"}
    manifest.write_text(json.dumps(data))
    rng = np.random.default_rng(4)
    give = answer or (lambda who, place: int(np.clip(round(1 + place + who % 4 + rng.normal()), 1, 7)))
    rows = [
        (f"p{who}", name, "translucent", give(who, place)) for who in range(12) for place, name in enumerate(LEVELS)
    ]
    path = folder / "ratings.csv"
    pd.DataFrame(rows, columns=["participant", "stimulus", "question", "rating"]).to_csv(path, index=False)
    study = read_manifest(manifest)
    frame = read_ratings(path)
    return gather(study, study.plan, draw_sample(frame, study.plan), frame)


def test_every_row_has_its_models(section: Section) -> None:
    """The tables hold what the statistics say of the row's ratings; mixed chi-squared is df1 F of R."""
    ordinal, odds = section.tables["ordinal"], section.tables["odds_ratios"]
    assert len(ordinal) == len(section.tables["mixed"]) == 10 and len(odds) == 9 * 2 + 3
    ratings = pd.read_csv(DATA / "thesis_shaped_repeated_n44.csv")
    mine = ratings[(ratings["scale"] == "translucent") & ratings["image"].isin(["img01", "img02", "img03"])]
    direct = OrdinalRegression("rating", ("image",), "participant").fit(mine)
    assert ordinal["chi2"].iloc[0] == pytest.approx(direct.tests["chi2"].iloc[0], rel=1e-9)
    assert odds["odds_ratio"].tolist()[:2] == pytest.approx(direct.odds_ratios["odds_ratio"].tolist(), rel=1e-9)
    assert odds[["level", "against"]].to_numpy().tolist()[:2] == [["18", "25"], ["30", "25"]]
    first = section.tables["mixed"].iloc[0]
    assert first["chi2"] == pytest.approx(2 * 22.4277022412616, rel=1e-6)
    assert first["variance_residual"] == pytest.approx(2.83773784355179, rel=1e-6)
    assert "every cell is one picture" in first["left_out"]


def test_the_sentence_on_agreement_names_who_stands_apart(section: Section) -> None:
    """At 10% eight of ten rows agree; the two others are named with their tests, first in the report too."""
    assert section.summary[0] == (
        "At the 10% level, each p unadjusted, ANOVA, ranks, ordinal regression and mixed model agree in 8 of 10 rows; "
        "not in Realistic vs thickness exponent (only ranks find none) and Varnished vs thickness exponent (ANOVA and "
        "mixed model find an effect, ranks and ordinal regression find none)."
    )
    assert section.summary[0] in section.body
    assert section.sentences[0].startswith(
        "A proportional odds regression (participant-clustered standard errors, 44 participants, 132 ratings) showed a "
        "significant effect of thickness exponent on ratings of “translucent”, F(2, 42) = 17.68, p < .001 (against 25: "
        "18: OR = 0.42, 95% CI [0.25, 0.72]; 30: OR = 4.31"
    )


def test_equal_pictures_are_one_picture_and_shares_add_up(section: Section) -> None:
    """Images 1, 4 and 7 are the same: 13 pictures, not 15."""
    shares = section.tables["variance"]
    assert shares.groupby("question")["share"].sum().tolist() == pytest.approx([1, 1, 1])
    translucent = shares[shares["question"] == "translucent"].set_index("term")["share"]
    assert translucent["picture"] == pytest.approx(0.28156, abs=1e-4)  # with 15 pictures it would be another


def test_independent_samples_are_not_clustered(tmp_path: Path) -> None:
    """Plain errors, no variance of participants; one picture a sample leaves the mixed model nothing, by design."""
    plan = {"mode": "independent", "comparison": [COMPARISON]}
    found = evidence_of(DATA / "thesis_shaped_independent_n29.csv", tmp_path, thesis_stimuli(), plan)
    section = section_of(found)
    assert "variance" not in section.tables and section.tables["ordinal"]["participants"].isna().all()
    assert section.warnings == ()
    assert section.tables["mixed"]["reason"].str.startswith("every cell is one picture").all()
    assert section.tables["mixed"]["reason"].str.endswith("no random term is left to estimate").all()
    assert "clustered" not in section.sentences[0]
    ratings = pd.read_csv(DATA / "thesis_shaped_independent_n29.csv")
    mine = ratings[(ratings["scale"] == "translucent") & ratings["image"].isin(["img01", "img02", "img03"])]
    direct = OrdinalRegression("rating", ("image",))(mine)
    assert section.tables["ordinal"]["chi2"].iloc[0] == pytest.approx(direct["chi2"].iloc[0], rel=1e-9)


def test_a_factorial_is_one_model_with_its_interaction(tmp_path: Path) -> None:
    """All three rows come from it; complete data give the mixed model's main effects in closed form."""
    found = factorial(tmp_path, {})
    section = section_of(found)
    ordinal = section.tables["ordinal"].set_index("factor")
    names = ["thickness exponent", "backlight", "thickness exponent × backlight"]
    assert ordinal.index.tolist() == names and (ordinal["n"] == 48).all()
    assert ordinal["log_likelihood"].nunique() == 1
    frame = found.sample.ratings.assign(
        a=found.sample.ratings["stimulus"].map(lambda name: LEVELS[name][0]),
        b=found.sample.ratings["stimulus"].map(lambda name: LEVELS[name][1]),
    )
    direct = MixedModel("rating", ("a", "b"), "participant", "stimulus", interactions=True)(frame)
    assert section.tables["mixed"]["chi2"].tolist() == pytest.approx(direct["chi2"].tolist(), rel=1e-6)
    wide = frame.pivot(index="participant", columns="stimulus", values="rating").to_numpy()
    left = wide - wide.mean(axis=1, keepdims=True) - wide.mean(axis=0) + wide.mean()
    error = (left**2).sum() / (11 * 3)
    thickness = wide.mean(axis=0) @ [1, 1, -1, -1] / 2
    assert section.tables["mixed"]["chi2"].iloc[0] == pytest.approx(12 * thickness**2 / error, rel=1e-6)


def test_only_the_declared_tests_are_made(tmp_path: Path) -> None:
    """Without ordinal and mixed the section has the sentence on agreement alone."""
    section = section_of(factorial(tmp_path / "few", {"tests": ["ranks"]}))
    assert not section.tables and section.sentences == ()
    assert section.summary[0].startswith("At the 5% level, each p unadjusted, ANOVA and ranks agree")
    one = section_of(factorial(tmp_path / "one", {"tests": ["ordinal"]}))
    assert set(one.tables) == {"ordinal", "odds_ratios"}


def test_separated_ratings_are_said_not_shown(tmp_path: Path) -> None:
    """No odds ratio of 10^8: a warning, and the reason in the table."""
    section = section_of(factorial(tmp_path, {}, lambda who, place: 1 + who % 3 if place < 3 else 6 + who % 2))
    assert any("an odds ratio is infinite" in sentence for sentence in section.warnings)
    assert section.tables["ordinal"]["reason"].str.contains('"18 × 1.2" is at or above every rating elsewhere').all()
    assert "odds_ratios" not in section.tables


def test_ratings_all_equal_leave_sentences(tmp_path: Path) -> None:
    """Neither a model nor a traceback."""
    section = section_of(factorial(tmp_path, {}, lambda who, place: 4))
    assert [sentence.split(":")[-1].strip() for sentence in section.warnings] == [
        "all ratings are equal, so there is no order to model.",
        "all ratings are equal, so there is no variance to divide.",
        "all ratings are equal, so there is no variance to divide.",
    ]


@pytest.mark.parametrize(
    ("p", "by", "words"),
    [
        ({"anova": 0.01, "ranks": 0.02, "ordinal": 0.03}, "all", ""),
        ({"anova": 0.2, "ranks": 0.3}, "none", ""),
        ({"anova": 0.2, "ranks": 0.01, "mixed": 0.02}, "all but ANOVA", "only ANOVA finds none"),
        ({"anova": 0.2, "ranks": 0.01, "mixed": 0.2}, "ranks", "only ranks find an effect"),
        ({"anova": 0.2, "mixed": 0.01}, "mixed model", "mixed model finds an effect, ANOVA finds none"),
        ({}, "", ""),
    ],
)
def test_who_finds_an_effect(p: dict[str, float], by: str, words: str) -> None:
    """In the table, and in the sentence where tests part."""
    assert finders(p, 0.05) == by
    if words:
        assert verdict(p, 0.05) == words
