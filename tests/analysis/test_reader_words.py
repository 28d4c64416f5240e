"""Words that a reader may rely on: no contradiction, no bound that bounds nothing, no internal name, no lost digit."""

from collections import Counter
from collections.abc import Callable
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from analysis.agreement_tables import table_of_stability
from analysis.evidence import Evidence, gather
from analysis.levels import from_ratings
from analysis.models import models_of
from analysis.nothing_found import nothing_said
from analysis.page import lead, sections_of
from analysis.plan import AnalysisPlan, EquivalencePlan, check_analysis
from analysis.ratings import read_ratings
from analysis.reasons import reader_words
from analysis.reliability import retest_table
from analysis.remarks import remarks
from analysis.sample import draw_sample
from analysis.sections.equivalence import equivalence, verdicts
from analysis.sentences import apa_sentence, findings
from analysis.standing_out import summary_of
from analysis.tables import Table, told_once
from analysis.verdicts import agreement_of_tests
from analysis.wording import percent, steps, true_minus
from fakesss.problem import BadInput

Rows = list[tuple[object, ...]]
Levels = dict[str, dict[str, Any]]


@pytest.fixture
def gathered(csv_of: Callable[[str], Path]) -> Callable[..., Evidence]:
    """What is computed of `participant, stimulus, question, rating` rows."""

    def make(rows: Rows, plan: AnalysisPlan | None = None, levels: Levels | None = None) -> Evidence:
        lines = [",".join(map(str, row)) for row in rows]
        read = read_ratings(csv_of("\n".join(["participant,stimulus,question,rating", *lines])))
        names = list(next(iter(levels.values()))) if levels else []
        study = from_ratings(read, "Ratings", 7, names, levels)
        used = plan or AnalysisPlan(tests=())
        return gather(study, used, draw_sample(read, used), read)

    return make


def six_questions() -> Rows:
    """Two pictures, six questions, 20 people: on the last, five rate `a` one step higher (p = .021), on the others the
    steps cancel."""
    return [
        (f"p{who}", picture, f"q{q}", 3 + who % 3 + (picture == "a") * step(q, who))
        for who, picture, q in product(range(20), "ab", range(6))
    ]


def step(question: int, who: int) -> int:
    """How much higher a person rates the first picture."""
    return int(who < 5) if question == 5 else (who == question) - (who == question + 1)


def test_what_came_close_is_a_hint_and_not_nothing(gathered: Callable[..., Evidence]) -> None:
    """Holm's p does not find it, the plain one does, and the interval excludes 0: all three are said."""
    evidence = gathered(six_questions())
    nothing = {
        finding.question.name: finding.nothing for finding in findings(evidence.study, evidence.main, evidence.plan)
    }
    assert nothing["q5"].startswith("Pictures: p = .021 by itself, p = .126 Holm-adjusted, and the 95% CI (")
    assert nothing["q5"].endswith(") of a minus b excludes 0. A hint, not a finding.")
    assert "No difference" not in nothing["q5"] and "remain inside" not in nothing["q5"]
    assert nothing["q0"].startswith(
        "No difference between pictures was found. That is not evidence of none: differences"
    )


def test_tests_side_by_side_say_that_p_is_unadjusted(gathered: Callable[..., Evidence]) -> None:
    """Otherwise they contradict what stands above them."""
    models = models_of(gathered(six_questions(), AnalysisPlan(tests=("ranks",))))
    said = "ANOVA and ranks agree in 5 of 6 rows; not in Q5 vs picture (ANOVA finds an effect, ranks find none)."
    assert agreement_of_tests(models, 0.05, adjusted=True) == f"At the 5% level, each p unadjusted, {said}"
    assert agreement_of_tests(models, 0.05) == f"At the 5% level {said}"


def factorial() -> tuple[Rows, Levels]:
    """2 x 2, 12 people, nothing but noise."""
    noise = np.random.default_rng(5)
    levels = {f"s{place}": {"a": a, "b": b} for place, (a, b) in enumerate(product((-35, 0), (1, 2)))}
    return [(f"p{who}", name, "shiny", noise.integers(2, 7)) for who in range(12) for name in levels], levels


def test_no_interval_of_main_effects_bounds_an_interaction(gathered: Callable[..., Evidence]) -> None:
    """Its sentence stands by itself."""
    rows, levels = factorial()
    evidence = gathered(rows, None, levels)
    said = nothing_said([e for e in evidence.main if e.p is not None], (), evidence.study.questions[0], evidence.plan)
    assert said.startswith("No effect of a and b was found. That is not evidence of none: differences of up to ")
    assert said.endswith(" intervals. No interaction a × b was found either; no interval bounds it.")
    alone = [each for each in evidence.main if each.row.kind == "interaction"]
    only = nothing_said(alone, (), evidence.study.questions[0], evidence.plan)
    assert only == "No interaction a × b was found. That is not evidence of none."


def test_factors_that_cross_are_without_effect_on_average_only(gathered: Callable[..., Evidence]) -> None:
    """Each reverses the other: the interaction stands above, and "no effect" would contradict it."""
    rows, levels = factorial()
    up = {name: 4 + 2 * ((cell["a"] == 0) == (cell["b"] == 2)) for name, cell in levels.items()}
    crossed = [(who, name, question, up[name] + noise % 2) for who, name, question, noise in rows]
    (finding,) = findings(*(lambda e: (e.study, e.main, e.plan))(gathered(crossed, None, levels)))
    assert finding.effects[0].words.startswith("The effect of ")
    assert finding.nothing.startswith("No average effect of a and b beside the interaction was found.")


def test_no_difference_is_larger_than_the_scale(gathered: Callable[..., Evidence]) -> None:
    """Two people: their interval is 13 steps wide on a scale of 6."""
    answers = {"p0": (3, 4, 5), "p1": (4, 4, 3)}
    evidence = gathered(
        [(who, name, "shiny", n) for who, given in answers.items() for name, n in zip("abc", given, strict=True)]
    )
    said = findings(evidence.study, evidence.main, evidence.plan)[0].nothing
    assert said.endswith("the 95% intervals allow any difference that the scale has.")


def test_factor_levels_have_a_true_minus_on_the_page_alone(gathered: Callable[..., Evidence]) -> None:
    """The files keep the hyphen that programs read."""
    rows, levels = factorial()
    evidence = gathered(rows, AnalysisPlan(tests=(), equivalence=EquivalencePlan(margin=1.0)), levels)
    each = evidence.main[0]
    assert each.row.levels[0].label == "-35" and "−35: M = " in apa_sentence(each, evidence.plan)
    made = equivalence(evidence)
    assert made is not None and "−35 minus 0: M = " in made.sentences[0]
    assert [true_minus(text) for text in ("-35", "light -.5", "(1, -2)", "img-35", "1e-05", "a - b")] == [
        "−35", "light −.5", "(1, −2)", "img-35", "1e-05", "a - b",
    ]  # fmt: skip


def test_equivalence_counts_each_pair_once_and_names_the_alike() -> None:
    """Both: alike, and counted there; a different pair is not said to differ by the margin."""
    assert verdicts(Counter(equivalent=1, both=1, different=7)) == [
        "2 alike (1 of them with a difference, smaller than the margin)",
        "7 different, perhaps by as much as the margin",
    ]
    assert verdicts(Counter(undecided=3)) == ["3 undecided"]
    assert (steps(1), steps(0.5)) == ("±1 step", "±0.5 steps")


def test_alike_levels_are_named_with_their_factor(gathered: Callable[..., Evidence]) -> None:
    """Or nobody can tell 1 and 2 from -35 and 0."""
    rows, levels = factorial()
    evidence = gathered(rows, AnalysisPlan(tests=(), equivalence=EquivalencePlan(margin=4.0)), levels)
    made = equivalence(evidence)
    assert made is not None
    assert made.summary == ("Shiny, margin ±4 steps: all 2 pairs alike. Alike: a −35 and 0; b 1 and 2.",)


@pytest.mark.parametrize(
    ("share", "text"),
    [(0.05, "5%"), (0.005, "0.5%"), (0.995, "99.5%"), (1 - 2 * 0.05, "90%"), (1 - 2 * 0.001, "99.8%")],
)
def test_a_declared_level_keeps_its_digits(share: float, text: str) -> None:
    """No significance level is 0%, no interval 100%."""
    assert percent(share) == text


def test_unusual_levels_stand_on_the_page_as_declared(gathered: Callable[..., Evidence]) -> None:
    """In every section's body and sentences."""
    rows, levels = factorial()
    evidence = gathered(
        rows, AnalysisPlan(alpha=0.005, confidence=0.995, equivalence=EquivalencePlan(margin=1.0, alpha=0.005)), levels
    )
    sections = sections_of(evidence)
    text = " ".join([*(s.body for s in sections), *(t for s in sections for t in (*s.summary, *s.sentences))])
    text += " ".join(drawing.caption for section in sections for drawing in section.drawings)
    assert "At the 0.5% level" in text and "99.5% CI" in text and "99% CI" in text
    assert "At the 0% level" not in text and "100% CI" not in text and "level 0%" not in text


def test_who_lacks_a_rating_is_said_first(gathered: Callable[..., Evidence]) -> None:
    """14 analysed is not what the tests rest on."""
    rows: Rows = [
        (f"p{who}", name, "shiny", 2 + (who * place + who) % 5)
        for who in range(14)
        for place, name in enumerate("abc", 1)
        if not (who in (0, 4, 11, 12) and name == "abc"[who % 3])
    ]
    plan = AnalysisPlan(tests=(), completers_only=False)
    evidence = gathered(rows, plan)
    assert "the people who rated all pictures that it compares: 10 of the 14, as the others lack" in lead(evidence)
    said = remarks(evidence.study, plan, evidence.sample, evidence.ratings, evidence.main, ())
    assert any("left out: p0, p4, p11 and p12." in sentence for sentence in said)
    assert "lack a rating" not in lead(gathered(six_questions()))


def test_every_table_of_tests_has_n_and_df(gathered: Callable[..., Evidence]) -> None:
    """In a column, or in the note where all rows share it."""
    rows, levels = factorial()
    evidence = gathered(rows, AnalysisPlan(tests=("ordinal",), equivalence=EquivalencePlan(margin=1.0)), levels)
    text = " ".join(section.body for section in sections_of(evidence))
    notes = {"table-tests": "n = 12", "table-pairs": "df = 11 and n = 12", "table-simple": "n = 12"}
    notes |= {"table-odds": "ratings = 48 and participants = 12", "table-equivalence": "df = 11 and n = 12"}
    for anchor, note in notes.items():
        figure = text.split(f'id="{anchor}"')[1].split("</figure>")[0]
        assert f"In every row {note}." in figure, anchor


def test_what_is_told_once_is_no_column() -> None:
    """And what differs stays one."""
    table = Table("t", "c", ("A", "n", "df"), (("x", "3", "2"), ("y", "3", "4")), note="More.")
    told = told_once(table, "n", "df")
    assert (told.head, told.rows) == (("A", "df"), (("x", "2"), ("y", "4")))
    assert told.note == "In every row n = 3. More."


def test_default_comparisons_name_their_question_once(gathered: Callable[..., Evidence]) -> None:
    """A row that stands alone has it, a sentence under the question has not; picking the best is said in the paper."""
    rows: Rows = [
        (f"p{who}", name, "shiny", 1 + place + (who * place) % 3)
        for who in range(12)
        for place, name in enumerate(("s0", "s1", "s2", "s3", "x"))
    ]
    levels: Levels = {f"s{place}": {"a": a, "b": b} for place, (a, b) in enumerate(product((1, 2), (1, 2)))}
    evidence = gathered(rows, None, levels)
    each = next(one for one in evidence.main if one.row.kind == "comparison")
    assert (each.row.title, each.row.compared) == ("Shiny: others vs ours", "others vs ours")
    pasted = apa_sentence(each, evidence.plan)
    assert "on ratings of “shiny” (others vs ours), F(" in pasted
    assert pasted.endswith("The best own picture was picked by the same ratings, which flatters its mean.")


def test_reasons_have_no_name_of_ours() -> None:
    """Neither columns nor codes."""
    reason = 'rating by condition: level "M1" has one rating; each level needs at least two'
    assert reader_words(reason, {"M1": "−35"}) == "level “−35” has one rating; each level needs at least two"
    assert reader_words('rating by stimulus: nobody rated "stimulus 1"') == 'nobody rated "stimulus 1"'
    assert reader_words("rating: every stimulus has the same mean") == "every picture has the same mean"


@pytest.mark.parametrize(
    ("margin", "sentence"),
    [
        (0, "equivalence.margin: 0: must be > 0"),
        ({"shiny": 0}, "equivalence.margin.shiny: 0: must be > 0"),
        ("wide", "equivalence.margin: 'wide': must be a valid number"),
    ],
)
def test_a_margin_is_refused_in_our_words(margin: object, sentence: str) -> None:
    """No branch of a union in the place."""
    with pytest.raises(BadInput) as raised:
        check_analysis({"analysis": {"equivalence": {"margin": margin}}}, "study.toml")
    assert str(raised.value) == f"study.toml: [analysis]: {sentence}"


def test_one_test_is_not_all_1_tests(gathered: Callable[..., Evidence]) -> None:
    """Nor are none of those who stand out "0 of them"."""
    rows: Rows = [
        (f"p{who}", name, "shiny", 1 + (who + place) % 3) for who in range(6) for place, name in enumerate("abc")
    ]
    assert "Holm-adjusted over the only test" in lead(gathered(rows))
    constant = gathered([(f"p{who}", name, "shiny", 4) for who in range(6) for name in "ab"])
    assert "all 0 tests" not in lead(constant) and "which has no value here" in lead(constant)
    quality = pd.DataFrame({"stands_out": ["too fast", "too fast", ""], "analysed": [False, False, True]})
    assert summary_of(quality) == "Answer quality: 2 of 3 participants stand out; none of them is analysed."


def test_the_first_showing_stands_first() -> None:
    """Whatever the alphabet says; and one pair a person is independent of the others."""
    shown = pd.DataFrame(
        [
            (f"p{who}", "b", name, "shiny", 1 + who % 3 + late)
            for who in range(5)
            for late, name in enumerate(("b", "a2"))
        ],
        columns=["participant", "picture", "showing", "question", "rating"],
    )
    table = retest_table(shown, from_ratings(shown.rename(columns={"showing": "stimulus"}), "t", 7))
    assert table.loc[0, "showings"] == "b, a2" and table.loc[0, "means"] == "1.80, 2.80"
    entry = {"question": "shiny", "n_pictures": 1, "n_people": 5, "icc_a1": 0.5, "icc_a1_low": 0.1, "icc_a1_high": 0.8}
    alone, several = (table_of_stability(pd.DataFrame([{**entry, "n_pairs": n}])) for n in (5, 10))
    assert alone is not None and several is not None
    assert "too narrow" not in alone.note and "too narrow" in several.note
