"""A full factorial from CSV to page: rows, tables, words, and what an incomplete one says."""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from thesis_study import stimulus, write_manifest

from analysis import FactorialAnova, write_report
from analysis.evidence import Evidence, gather
from analysis.figures.interaction import interaction_figures
from analysis.page import lead
from analysis.planned import planned_sentences, planned_table
from analysis.ratings import read_ratings
from analysis.remarks import remarks
from analysis.results import Analysed
from analysis.sample import draw_sample
from analysis.sentences import apa_sentence, findings
from analysis.study import read_manifest

FACTORS: dict[str, list[Any]] = {"exponent": [12, 25], "light": [-35, 0, 150], "participant": [False, True]}
Answer = Callable[..., float]


def factorial_study(folder: Path, count: int, analysis: dict[str, Any]) -> Path:
    """Every combination of the first `count` factors (the third has the name of a column), one picture compared, one
    shown again."""
    names = list(FACTORS)[:count]
    cells = list(product(*(FACTORS[name] for name in names)))
    entries: list[dict[str, Any]] = [
        stimulus(place, role="factor", rows=names, label=str(cell), factors=dict(zip(names, cell, strict=True)))
        for place, cell in enumerate(cells, 1)
    ]
    entries.append(stimulus(len(entries) + 1, role="compare", label="offline"))
    entries.append({**entries[0], "id": "img01r", "role": "repeat", "rows": []})
    manifest = write_manifest(folder / "study", entries, analysis)
    data = json.loads(manifest.read_text())
    data["study"]["design"] = {"kind": "full-factorial"}
    data["study"]["factors"] = [{"name": name, "path": "material.x", "levels": FACTORS[name]} for name in names]
    data["study"]["question"] = data["study"]["question"][:1]
    manifest.write_text(json.dumps(data))
    return manifest


def ratings(count: int, answer: Answer, people: int = 16, seed: int = 3) -> pd.DataFrame:
    """`answer(levels..., person term, noise)` of everyone to every picture, and to the one made elsewhere."""
    random = np.random.default_rng(seed)
    cells = list(product(*(FACTORS[name] for name in list(FACTORS)[:count])))
    rows = []
    for who in range(people):
        person = random.normal(0, 0.5)
        for place, cell in enumerate(cells, 1):
            given = int(np.clip(round(answer(*cell) + person + random.normal(0, 0.8)), 1, 7))
            rows.append((f"p{who}", f"img{place:02d}", "translucent", given))
        rows.append((f"p{who}", f"img{len(cells) + 1:02d}", "translucent", 4))
    return pd.DataFrame(rows, columns=["participant", "stimulus", "question", "rating"])


def gathered(tmp_path: Path, frame: pd.DataFrame, count: int = 2, **analysis: Any) -> Evidence:
    """Every row analysed, nothing drawn."""
    study = read_manifest(factorial_study(tmp_path, count, analysis))
    path = tmp_path / "ratings.csv"
    frame.to_csv(path, index=False)
    read = read_ratings(path)
    return gather(study, study.plan, draw_sample(read, study.plan), read)


def rows(evidence: Evidence, *kinds: str) -> list[Analysed]:
    """The rows of these kinds in the design's mode."""
    return [each for each in evidence.main if each.row.kind in kinds]


def said(evidence: Evidence) -> list[str]:
    """The warnings that rows and design give."""
    return remarks(evidence.study, evidence.plan, evidence.sample, evidence.ratings, evidence.main, evidence.notes)


def reported(tmp_path: Path, frame: pd.DataFrame, count: int = 2, **analysis: Any) -> tuple[dict[str, Any], str]:
    """results.json, and the page's words."""
    manifest = factorial_study(tmp_path, count, analysis)
    path = tmp_path / "ratings.csv"
    frame.to_csv(path, index=False)
    results = write_report(path, tmp_path / "out", manifest=manifest)
    page = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    page = re.sub(r"<svg.*?</svg>|<style.*?</style>|<script.*?</script>", "", page, flags=re.DOTALL)
    return results, re.sub(r"\s+", " ", re.sub(r"<[^>]*>", "", page)).replace("&lt;", "<")


def crossing(exponent: float, light: float, *_: Any) -> float:
    """Light matters with the large exponent alone."""
    return 3.0 + 2.5 * (exponent == 25 and light == 150)


def test_interactions_are_rows_with_the_factorials_numbers(tmp_path: Path) -> None:
    """anova and tests hold both main effects and the interaction, as `FactorialAnova` has them; Holm over all three."""
    frame = ratings(2, crossing)
    results, words = reported(tmp_path, frame)
    mine = [row for row in results["anova"] if row["method"] == "repeated measures"]
    assert [(row["factor"], row["kind"]) for row in mine[:3]] == [
        ("exponent", "factor"), ("light", "factor"), ("exponent × light", "interaction"),
    ]  # fmt: skip
    cells = dict(zip([f"img{i:02d}" for i in range(1, 7)], product(*list(FACTORS.values())[:2]), strict=True))
    own = frame[frame["stimulus"].isin(cells)]
    levels = own["stimulus"].map(cells)
    long = own.assign(exponent=[cell[0] for cell in levels], light=[cell[1] for cell in levels])
    expected = FactorialAnova("rating", ("exponent", "light"), "participant")(long)
    for row, (_, exact) in zip(mine, expected.iterrows(), strict=False):
        for name, theirs in (("F", "F"), ("p_gg", "p_gg"), ("effect_size", "generalized_eta_squared")):
            assert row[name] == pytest.approx(exact[theirs])
    tests = [row for row in results["tests"] if row["kind"] != "comparison"]  # which the plan does not declare
    p = sorted(row["p"] for row in tests)
    assert min(row["p_holm"] for row in tests) == pytest.approx(len(tests) * p[0])
    assert "On average over light it rises with exponent" in words
    assert "The effect of light depends on exponent: its highest and lowest mean are" in words
    assert (
        "A 2 × 3 repeated-measures ANOVA (Greenhouse–Geisser corrected) with 16 participants showed a significant"
        in words
    )
    assert (
        "Simple effects on ratings of “translucent” (Holm-adjusted within exponent × light): exponent at light −35"
        in words
    )
    simple = results["simple_effects"]
    assert [(row["factor"], row["at"]) for row in simple][2:4] == [("exponent", "light 150"), ("light", "exponent 12")]
    assert (tmp_path / "out" / "figures" / "figure-interaction.svg").is_file()


def test_a_picture_compared_or_shown_again_is_in_no_cell(tmp_path: Path) -> None:
    """Absurd answers to the picture made elsewhere change no factor's F."""
    frame = ratings(2, crossing)
    changed = frame.assign(rating=frame["rating"].where(frame["stimulus"] != "img07", 1))
    both = [gathered(tmp_path / name, each) for name, each in (("a", frame), ("b", changed))]
    one, other = ([each.anova["F"] for each in rows(found, "factor", "interaction") if each.anova] for found in both)
    assert one == other and len(one) == 3


def test_three_factors_one_of_them_named_like_a_column(tmp_path: Path) -> None:
    """Seven effects; a row of panels a level in the plot; words for the interaction of three."""
    evidence = gathered(tmp_path, ratings(3, lambda e, p, q: 2.0 + 3.5 * (e == 25 and p == 150 and q)), 3)
    assert (len(rows(evidence, "factor")), len(rows(evidence, "interaction"))) == (3, 4)
    last = rows(evidence, "interaction")[-1]
    assert last.row.name == "exponent × light × participant" and len(last.row.levels) == 12
    assert last.p_holm is not None and last.p_holm < 0.05
    assert last.simple is not None and len(last.simple) == 6 + 4 + 6
    words = [
        effect.words for finding in findings(evidence.study, evidence.main, evidence.plan) for effect in finding.effects
    ]
    assert any("How exponent and light work together depends on participant" in each for each in words)
    assert any("On average over participant, the effect of light depends on exponent" in each for each in words)
    assert any(each.startswith("Others vs ours: the pictures differ") for each in words)
    assert apa_sentence(last, evidence.plan).startswith("A 2 × 3 × 2 repeated-measures ANOVA")
    (drawing,) = interaction_figures(evidence.study, evidence.main, 0.95)
    assert "a row of panels for each level of participant" in drawing.caption


def test_without_one_picture_there_are_main_effects_and_a_sentence(tmp_path: Path) -> None:
    """A combination nobody rated: no interaction is invented."""
    frame = ratings(2, crossing)
    evidence = gathered(tmp_path, frame[frame["stimulus"] != "img05"])
    assert not rows(evidence, "interaction") and len(rows(evidence, "factor")) == 2
    assert evidence.notes == (
        "Interactions on translucent are not tested: nobody rated a picture with exponent 25 and light 0; the main "
        "effects average over unlike sets of pictures.",
    )


def test_people_with_a_missing_cell_leave_the_whole_factorial(tmp_path: Path) -> None:
    """They are named once, and main effects, means and interaction rest on the same people."""
    frame = ratings(2, crossing)
    gone = (frame["participant"] == "p3") & (frame["stimulus"] == "img02")
    evidence = gathered(tmp_path, frame[~gone], completers_only=False)
    for each in rows(evidence, "factor", "interaction"):
        assert set(each.n) == {15} and each.means is not None and set(each.means["n"]) == {15}
    assert [each for each in said(evidence) if "left out" in each] == [
        "Translucent: 1 participant with a missing cell left out: p3."
    ]


def test_equal_ratings_have_no_interaction(tmp_path: Path) -> None:
    """A reason for each row, no F, no p."""
    evidence = gathered(tmp_path, ratings(2, crossing).assign(rating=4))
    assert all(each.anova is None and each.p_holm is None for each in evidence.main)
    assert any("exponent × light" in each and "all ratings are equal" in each for each in said(evidence))


def test_between_people_interactions_are_not_tested(tmp_path: Path) -> None:
    """Everyone rated one picture: one-way main effects, and the sentence."""
    frame = ratings(2, crossing, people=42)
    own = frame[frame["participant"].str[1:].astype(int) % 6 + 1 == frame["stimulus"].str[3:].astype(int)]
    evidence = gathered(tmp_path, own)
    assert {each.row.kind for each in evidence.main} == {"factor"} and evidence.sample.mode == "independent"
    assert evidence.notes[0].startswith("Interactions are not tested between people")


def test_people_who_rated_unlike_combinations_show_no_main_effect(tmp_path: Path) -> None:
    """Only light matters, but exponent 25 was mostly seen with light 150: the averages would find an effect of it."""
    frame = ratings(2, lambda e, light: 3 + 2.0 * (light == 150), people=24)
    even = frame["participant"].str[1:].astype(int) % 2 == 0
    skipped = (even & frame["stimulus"].isin(["img03", "img04"])) | (~even & frame["stimulus"].isin(["img03", "img05"]))
    # one person more has the cell that all others lack, so that each is rated by somebody
    kept = frame[~skipped | ((frame["participant"] == "p0") & (frame["stimulus"] == "img03"))]
    results, words = reported(tmp_path, kept[kept["stimulus"] != "img07"], completers_only=False)
    mine = [row for row in results["anova"] if row["method"] == "repeated measures"]
    assert [(row["factor"], row["F"], row["p"]) for row in mine] == [
        (name, None, None) for name in ("exponent", "light", "exponent × light")
    ]
    assert "significant main effect" not in words
    assert "0 of 24 participants rated every combination; at least two must have" in words


@pytest.mark.parametrize(
    ("analysis", "words", "family"),
    [
        ({}, "Holm-adjusted over all 3 tests", 3),
        ({"adjust": "fdr", "family": "factor"}, "Benjamini–Hochberg-adjusted over the tests of each factor", 1),
        ({"adjust": "none"}, "not adjusted for the number of tests", 3),
    ],
)
def test_the_declared_p_decides(tmp_path: Path, analysis: dict[str, Any], words: str, family: int) -> None:
    """Which p decides stands at the head of the page; the family is as large as declared."""
    evidence = gathered(tmp_path, ratings(2, crossing), **analysis)
    assert words in lead(evidence)
    tested = [each for each in evidence.main if each.p is not None and each.row.kind != "comparison"]
    smallest = min(tested, key=lambda each: each.p or 0)
    assert smallest.p is not None and smallest.p_holm == pytest.approx(family * smallest.p)
    decides = {"none": smallest.p, "fdr": smallest.p_fdr}.get(evidence.plan.adjust, smallest.p_holm)
    assert smallest.deciding_p(evidence.plan) == decides


def test_a_finding_that_the_adjustment_takes_back(tmp_path: Path) -> None:
    """p just below .05, twice that after Holm: no effect is named, and the sentence gives both."""
    evidence = gathered(tmp_path, ratings(2, crossing))
    each = replace(evidence.main[0], p_holm=0.2)
    assert each.p is not None and each.p < 0.05
    assert "no significant main effect of exponent" in apa_sentence(each, evidence.plan)
    assert "p < .001, Holm-adjusted p = .200" in apa_sentence(each, evidence.plan)
    plain = evidence.plan.model_copy(update={"adjust": "none"})
    assert "a significant main effect" in apa_sentence(each, plain) and "adjusted" not in apa_sentence(each, plain)


def test_planned_contrasts_are_reported_and_unknown_pictures_said(tmp_path: Path) -> None:
    """The difference of differences is the interaction's t; a picture nobody knows leaves one contrast out."""
    good = {"name": "behind", "question": "translucent", "weights": {"img06": 1, "img05": -1, "img03": -1, "img02": 1}}
    bad = {"name": "typo", "question": "translucent", "weights": {"img06": 1, "img55": -1}}
    frame = ratings(2, crossing)
    evidence = gathered(tmp_path, frame, contrast=[good, bad])
    table, notes = planned_table(evidence.sample, evidence.plan)
    wide = frame.pivot(index="participant", columns="stimulus", values="rating")
    sums = wide["img06"] - wide["img05"] - wide["img03"] + wide["img02"]
    (row,) = table.to_dict("records")
    assert row["estimate"] == pytest.approx(sums.mean()) and row["t"] == pytest.approx(sums.mean() / sums.sem())
    (sentence,) = planned_sentences(table, evidence.plan)
    assert sentence.startswith("The planned contrast “behind” (1 img06 − 1 img05 − 1 img03 + 1 img02)")
    assert len(notes) == 1 and 'contrast "typo" on translucent' in notes[0] and '"img55"' in notes[0]
