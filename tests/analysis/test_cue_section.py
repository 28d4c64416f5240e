"""The section on cues: what it leaves out and why, twins counted once, sentences a reader gets."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from thesis_study import stimulus, thesis_stimuli, write_manifest

from analysis.cue_findings import CueFindings, equal_slopes, factor_columns, find_cues, fitted_together
from analysis.evidence import Evidence
from analysis.sample import draw_sample
from analysis.section import Section
from analysis.sections.cues import apa_cue, cues, strongest
from analysis.statistics.multiplicity import adjusted
from analysis.study import Factor, read_manifest

QUESTION = "translucent"


def cue_values(number: int) -> dict[str, float | None]:
    """Contrast rises from picture to picture, skew is twice as much, thickness the same everywhere."""
    rng = np.random.default_rng(number)
    values = {"rms_contrast": 0.1 * number, "luminance_skew": 0.2 * number, "mean_thickness": 0.3}
    return {**values, "gradient_energy": float(rng.uniform()), "highlight_share": float(rng.uniform())}


def sweep(pictures: int) -> list[dict[str, Any]]:
    """Pictures of one factor, with cues."""
    return [
        stimulus(
            k, role="factor", rows=["backlight"], factors={"backlight": k / 10}, label=f"b {k}", cues=cue_values(k)
        )
        for k in range(1, pictures + 1)
    ]


def evidence_of(folder: Path, stimuli: list[dict[str, Any]], slope: float = 0.5, people: int = 8) -> Evidence:
    """People who rate higher what has more contrast."""
    study = read_manifest(write_manifest(folder, stimuli, {}))
    rng = np.random.default_rng(5)
    rows = [
        {"participant": f"p{who}", "stimulus": p.id, "question": QUESTION}
        | {"rating": float(np.clip(round(2 + slope * place + rng.normal()), 1, 7))}
        for who in range(people)
        for place, p in enumerate(study.pictures)
    ]
    ratings = pd.DataFrame(rows)
    return Evidence(study, study.plan, draw_sample(ratings, study.plan), ratings, (), ())


def found(evidence: Evidence) -> CueFindings:
    findings = find_cues(evidence, QUESTION)
    assert findings is not None
    return findings


def section(evidence: Evidence) -> Section:
    made = cues(evidence)
    assert made is not None
    return made


def test_a_sweep_of_twelve_pictures(tmp_path: Path) -> None:
    made = section(evidence_of(tmp_path / "s", sweep(12)))
    assert len(made.drawings) == 1 and made.drawings[0].caption.startswith(
        "Translucent: mean rating of every different"
    )
    assert {"cues", "cue_slopes", "cue_regression", "cue_explained"} == set(made.tables)
    assert made.tables["cues"].shape == (12, 8)
    (sentence,) = made.summary
    assert sentence.startswith("Translucent goes along most with contrast: rated 1.")
    assert "more of it between pictures (p < .001, Holm over 4 cues); r = .9" in sentence
    assert sentence.endswith("means of 12 pictures, p < .001, Holm over 4 cues; an association, not a cause.")
    (paste,) = made.sentences
    assert (
        "over 12 different pictures; of the significant mean slopes the steepest was that on contrast, b = 1." in paste
    )
    assert "Holm over 4 cues, a test that takes these pictures as given; over pictures, r = .9" in paste
    body = str(made.body)
    assert "Left out, as the same in all pictures: mean thickness." in body
    assert "skew of luminance cannot be told from contrast (r = 1.000)" in body
    assert list(made.tables["cue_regression"]["cue"]) == ["rms_contrast", "gradient_energy", "highlight_share"]
    explained = made.tables["cue_explained"].set_index("explained_by")["r2"]
    assert explained["the factors"] == pytest.approx(explained["contrast"])  # the factor rises with the contrast
    assert explained["the cues at once"] >= explained["contrast"]


def test_few_pictures_hold_one_cue_at_a_time(tmp_path: Path) -> None:
    findings = found(evidence_of(tmp_path / "s", sweep(4)))
    assert "4 different pictures cannot hold a regression on 3 cues at once: one cue at a time." in findings.said
    assert findings.joint is None and findings.slopes is not None and len(findings.slopes) == 4


def test_cues_that_others_determine_are_named() -> None:
    rng = np.random.default_rng(2)
    table = pd.DataFrame(rng.normal(size=(30, 2)), columns=["rms_contrast", "luminance_skew"])
    table["gradient_energy"] = table["rms_contrast"] + table["luminance_skew"]
    kept, said = fitted_together(table)
    assert kept == ["rms_contrast", "luminance_skew"]
    assert said == [
        "On these pictures sharpness (gradient energy) follows from other cues (multiple R = 1.000).",
        "Fitted at once are therefore contrast and skew of luminance.",
    ]


def test_a_cue_is_not_left_out_for_one_that_is_left_out_itself() -> None:
    """c and d are as good as one (r = .992), but only c follows from a and b (R = .962; d: .921)."""
    a, b, n = np.repeat([1, -1], 4), np.tile([1, 1, -1, -1], 2), np.tile([1, -1], 4)
    table = pd.DataFrame({"a": a, "b": b, "c": a + b + 0.4 * n, "d": a + b + 0.6 * n}).astype(float)
    kept, said = fitted_together(table)
    assert kept == ["a", "b", "d"]
    assert said[0] == "On these pictures c follows from other cues (multiple R = 0.962)."


def test_a_picture_shown_more_than_once_counts_once(tmp_path: Path) -> None:
    """The thesis's images 1, 4 and 7: each person's three ratings are averaged."""
    stimuli = thesis_stimuli()[:9]
    for entry in stimuli:
        first = entry["same_picture_as"] or entry["id"]
        entry["cues"] = cue_values(int(first.removeprefix("img")))
    findings = found(evidence_of(tmp_path / "s", stimuli))
    assert set(findings.frame["picture"]) == {f"img0{n}" for n in (1, 2, 3, 5, 6, 8, 9)}
    assert len(findings.frame) == 8 * 7
    evidence = evidence_of(tmp_path / "t", stimuli)
    ratings = evidence.ratings[evidence.ratings["participant"] == "p0"].set_index("stimulus")["rating"]
    mine = findings.frame[(findings.frame["participant"] == "p0") & (findings.frame["picture"] == "img01")]
    assert mine["rating"].item() == pytest.approx(ratings[["img01", "img04", "img07"]].mean())


def test_pictures_made_elsewhere_are_listed_only_and_controls_are_in(tmp_path: Path) -> None:
    other = stimulus(9, role="compare", label="other", cues={**cue_values(9), "mean_thickness": None})
    control = stimulus(10, role="control", label="opaque", cues=cue_values(10))
    made = section(evidence_of(tmp_path / "s", [*sweep(8), other, control]))
    assert set(made.tables["cue_slopes"]["pictures"]) == {9}  # eight and the control
    assert set(made.tables["cue_explained"]["pictures"]) == {8}  # those of the factor
    assert len(made.tables["cues"]) == 10
    assert "Pictures of other origin have cues of their whole area" in str(made.body)
    assert "controls in a frame" in made.drawings[0].caption


def test_a_cue_that_a_picture_lacks_is_left_out(tmp_path: Path) -> None:
    stimuli = sweep(6)
    stimuli[2]["cues"]["highlight_share"] = None
    findings = found(evidence_of(tmp_path / "s", stimuli))
    assert "Left out, as not every picture has it: share of highlights." in findings.said
    assert "highlight_share" not in findings.used


def test_ratings_that_no_cue_goes_along_with(tmp_path: Path) -> None:
    (sentence,) = section(evidence_of(tmp_path / "s", sweep(12), slope=0.0)).summary
    assert sentence == "Translucent: no image cue goes along with it beyond chance (Holm over 4 cues)."


def test_equal_ratings_are_said_and_drawn(tmp_path: Path) -> None:
    evidence = evidence_of(tmp_path / "s", sweep(5))
    same = evidence.ratings.assign(rating=4.0)
    made = section(Evidence(evidence.study, evidence.plan, draw_sample(same, evidence.plan), same, (), ()))
    assert made.summary == () and made.sentences == () and len(made.drawings) == 1
    assert "all ratings are equal, so there is nothing to explain" in str(made.body)
    assert made.tables["cue_slopes"][["t", "p"]].isna().all(axis=None) and set(made.tables["cue_slopes"]["slope"]) == {
        0
    }


def test_one_rating_each_has_no_slopes(tmp_path: Path) -> None:
    evidence = evidence_of(tmp_path / "s", sweep(8))
    ratings = pd.DataFrame(
        [part.iloc[[place]].iloc[0] for place, (_, part) in enumerate(evidence.ratings.groupby("participant"))]
    )
    sample = draw_sample(ratings, evidence.plan)
    made = section(Evidence(evidence.study, evidence.plan, sample, ratings, (), ()))
    assert "0 participants rated pictures in which it differs" in str(made.body) and "cue_slopes" not in made.tables


def slopes_of(**columns: list[float]) -> CueFindings:
    """Findings with a table of slopes alone, a cue per entry of the columns."""
    cues_ = ["rms_contrast", "luminance_skew", "gradient_energy"][: len(columns["slope"])]
    table = pd.DataFrame({"cue": cues_, "pictures": 9, "r": 0.5, "t": 2.0, "df": 7, "n": 8, **columns})
    table = table.assign(ci_low=table["slope"] - 1, ci_high=table["slope"] + 1)
    for p in ("p", "p_pictures"):
        table[f"{p}_holm"] = adjusted(table[p], "holm")
    return CueFindings(QUESTION, pd.DataFrame(), tuple(cues_), table, None, pd.DataFrame(), ())


def test_a_steep_slope_that_is_chance_does_not_hide_one_that_is_none() -> None:
    one = slopes_of(slope=[2.0, -0.3, 0.1], p=[0.4, 0.001, 0.01], p_pictures=[0.2, 0.001, 0.01])
    assert strongest(one, 0.05) == (
        "Translucent goes along most with skew of luminance: rated 0.30 less for each standard deviation more of it "
        "between pictures (p = .003, Holm over 3 cues); r = .50 with the means of 9 pictures, p = .003, Holm over 3 "
        "cues; an association, not a cause."
    )
    assert "of the significant mean slopes the steepest was that on skew of luminance, b = −0.30" in apa_cue(
        one, 0.05, "95% CI"
    )


def test_what_these_pictures_show_is_not_claimed_of_others() -> None:
    one = slopes_of(slope=[0.5, 0.4], p=[0.001, 0.3], p_pictures=[0.2, 0.6])
    assert strongest(one, 0.05) == (
        "Translucent: on these pictures it goes along most with contrast, rated 0.50 more for each standard deviation "
        "more of it between pictures (p = .002, Holm over 2 cues), but other pictures may not show it: r = .50 with "
        "the means of 9 pictures, p = .400, Holm over 2 cues."
    )
    two = slopes_of(slope=[0.5, 0.4], p=[0.001, 0.3], p_pictures=[np.nan, np.nan], pictures=[2, 2], r=[1.0, 1.0])
    assert strongest(two, 0.05).endswith("but other pictures may not show it: two pictures allow no test of that.")
    line = slopes_of(slope=[0.5, 0.4], p=[0.001, 0.3], p_pictures=[np.nan, 0.2], r=[1.0, 0.4])
    assert strongest(line, 0.05).endswith(
        "cues); the pictures’ means are on a line, so no test; an association, not a cause."
    )


def test_what_few_people_show_is_not_claimed_of_others() -> None:
    one = slopes_of(slope=[0.5, 0.4], p=[0.3, 0.4], p_pictures=[0.001, 0.6])
    assert strongest(one, 0.05) == (
        "Translucent: these participants’ means go along most with contrast (r = .50 with the means of 9 pictures, "
        "p = .002, Holm over 2 cues), but other participants may not show it: rated 0.50 more for each standard "
        "deviation more of it between pictures, p = .600, Holm over 2 cues."
    )
    assert "the steepest mean slope was that on contrast" in apa_cue(one, 0.05, "95% CI")


def test_equal_slopes_are_named_and_not_counted() -> None:
    one = slopes_of(slope=[0.5, 0.4], p=[np.nan, 0.4], p_pictures=[0.001, 0.6])
    assert strongest(one, 0.05).startswith(
        "Translucent goes along most with contrast: rated 0.50 more for each standard deviation more of it between "
        "pictures (the same slope in everybody, so no test); r = .50"
    )
    assert one.slopes is not None and equal_slopes(QUESTION, one.slopes) == [
        "Every participant’s slope of “translucent” on contrast is 0.50; without spread there is no test of it, and "
        "Holm’s adjustment does not count it."
    ]
    chance = slopes_of(slope=[0.0, 0.4], p=[np.nan, 0.4], p_pictures=[0.8, 0.6])
    assert strongest(chance, 0.05) == "Translucent: no image cue goes along with it beyond chance (Holm over 1 cue)."


def test_a_share_that_is_not_explained_is_said(tmp_path: Path) -> None:
    findings = found(evidence_of(tmp_path / "s", sweep(2)))
    assert findings.explained.empty
    (sentence,) = [said for said in findings.said if said.startswith("Share explained")]
    assert sentence.startswith("Share explained of “translucent”: none by the factors, contrast, skew of luminance")
    assert "(rating: 2 pictures for 1 predictors; at least 3 are needed" in sentence


def test_a_factor_without_levels_everywhere_is_said(tmp_path: Path) -> None:
    stimuli = sweep(8)
    for entry in stimuli:
        entry["factors"] = {"thickness exponent": 25 + int(entry["id"][3:]), **entry["factors"]}
    del stimuli[0]["factors"]["backlight"]
    assert (
        "Share explained of “translucent”: the factor backlight is left out, as not every picture has a level of it."
        in found(evidence_of(tmp_path / "s", stimuli)).said
    )


def test_a_question_of_one_picture_is_said(tmp_path: Path) -> None:
    evidence = evidence_of(tmp_path / "s", sweep(8))
    one = evidence.ratings[evidence.ratings["stimulus"] == "img01"].assign(question="realistic")
    ratings = pd.concat([evidence.ratings, one], ignore_index=True)
    sample = draw_sample(ratings, evidence.plan)
    made = section(Evidence(evidence.study, evidence.plan, sample, ratings, (), ()))
    assert "“realistic” is not analysed here: fewer than two different pictures" in str(made.body)


def test_a_manifest_without_cues_has_no_section(tmp_path: Path) -> None:
    assert cues(evidence_of(tmp_path / "s", thesis_stimuli())) is None


def test_a_level_that_is_a_word_is_a_predictor_of_its_own(tmp_path: Path) -> None:
    stimuli = sweep(6)
    for place, entry in enumerate(stimuli):
        entry["factors"] = {"backlight": [1.2, 0.8, 1.6][place % 3], "diffuse weight": [0.2, "none"][place % 2]}
    study = read_manifest(write_manifest(tmp_path / "s", stimuli, {}))
    study = replace(study, factors=(*study.factors[:2], Factor("diffuse weight", (0.2, "none"))))
    table, said = factor_columns(study)
    assert said == []
    assert list(table["backlight"]) == [1.2, 0.8, 1.6] * 2
    assert list(table["diffuse weight none"]) == [0, 1] * 3
    assert list(table) == ["picture", "backlight", "diffuse weight none"]
