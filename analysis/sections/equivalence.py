"""Are pictures rated alike? Two one-sided tests against the declared margin; without a margin no such claim is made."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from analysis.evidence import Evidence
from analysis.figures.equivalence import equivalence_figures
from analysis.margins import Judged, equivalence_table, judge
from analysis.plan import EquivalencePlan
from analysis.section import Section, rendered
from analysis.statistics.equivalence import UNTESTED
from analysis.statistics.equivalence_power import people_for_equivalence
from analysis.tables import Table, sizes_text, told_once
from analysis.wording import apa_df, apa_p, counted, interval, joined, percent, sentence_case, signed, steps, thesis_p

NAMED = 3  # pairs that a sentence names; more are counted
PASTED = 10  # pairs that a sentence to paste holds


def equivalence(evidence: Evidence) -> Section | None:
    """Every pair's verdict, drawn against the margin. None where the plan declares no margin."""
    plan = evidence.plan.equivalence
    if plan is None:
        return None
    judged, said = judge(evidence.main, plan)
    drawings = equivalence_figures(judged, evidence.study)
    body = rendered(
        "equivalence",
        margins=margins(judged),
        alpha=plan.alpha,
        level=percent(1 - 2 * plan.alpha),
        table=table_of_equivalence(judged, plan),
        drawings=drawings,
        people=people_needed(judged),
        said=said,
    )
    tables = {"equivalence": equivalence_table(judged)}
    sentences = tuple(apa_equivalence(one) for one in judged)
    return Section("equivalence", "Equivalence", body, tables, drawings, summaries(judged), sentences, tuple(said))


def margins(judged: Sequence[Judged]) -> str:
    """The margin of every question, in words."""
    by_question = {one.each.row.question: one.margin for one in judged}
    if len(set(by_question.values())) == 1:
        return f"{steps(next(iter(by_question.values())))} of the scale"
    return joined([f"{steps(margin)} for “{question}”" for question, margin in by_question.items()])


def summaries(judged: Sequence[Judged]) -> tuple[str, ...]:
    """One sentence per question: what its pairs turned out to be, the alike ones by name."""
    said = []
    for question, margin in dict.fromkeys((one.each.row.question, one.margin) for one in judged):
        mine = [(one, pair) for one in judged if one.each.row.question == question for pair in one.records]
        found = verdicts(Counter(str(pair["verdict"]) for _, pair in mine))
        pairs = counted(len(mine), "pair")
        every = "the only pair" if len(mine) == 1 else f"all {pairs}"
        told = f"{every} {found[0].split(' ', 1)[1]}" if len(found) == 1 else f"of {pairs} {'; '.join(found)}"
        said.append(f"{sentence_case(question)}, margin {steps(margin)}: {told}.{alike_by_name(mine)}")
    return tuple(said)


def verdicts(count: Mapping[str, int]) -> list[str]:
    """How many pairs are alike, different and neither: each pair in one of them."""
    alike, both = count["equivalent"] + count["both"], count["both"]
    smaller = f" ({both} of them with a difference, smaller than the margin)" if both else ""
    found = [
        (alike, f"alike{smaller}"),
        (count["different"], "different, perhaps by as much as the margin"),
        (count["undecided"], "undecided"),
        (count[UNTESTED], "without a test"),
    ]
    return [f"{n} {words}" for n, words in found if n]


def alike_by_name(mine: Sequence[tuple[Judged, dict[str, Any]]]) -> str:
    """Alike: backlight 1.2 and 0.8; diffuse weight 0.2 and 0.5. Empty where they are many."""
    found = [(one, pair) for one, pair in mine if pair["verdict"] in ("equivalent", "both")]
    if not found:
        return " No pair was shown to be alike."
    named = [f"{of_factor(one)}{one.labels[pair['a']]} and {one.labels[pair['b']]}" for one, pair in found]
    return f" Alike: {'; '.join(named)}." if len(found) <= NAMED else ""


def of_factor(one: Judged) -> str:
    """What a level is a level of; pictures need no more than their names."""
    return f"{one.each.row.name} " if one.each.row.kind == "factor" else ""


def people_needed(judged: Sequence[Judged]) -> list[str]:
    """One sentence per question: how many people would show its undecided pairs to be alike."""
    said = []
    for question, margin, alpha in dict.fromkeys((one.each.row.question, one.margin, one.alpha) for one in judged):
        spreads = [spread for one in judged if one.each.row.question == question for spread in one.spreads]
        if spreads:
            few, many = (people_for_equivalence(end(spreads), margin, alpha=alpha) for end in (min, max))
            number = f"{few}" if few == many else f"{few} to {many}"
            said.append(
                f"{sentence_case(question)}: with the spread of the undecided pairs it takes {number} people to show "
                "two pictures alike (in 80% of studies, if they are exactly alike)."
            )
    return said


def table_of_equivalence(judged: Sequence[Judged], plan: EquivalencePlan) -> Table | None:
    """Every pair of the rows that a page can hold."""
    rows = [
        (one.each.row.title if place == 0 else "", one.named(pair), str(pair["verdict"]), *cells(pair))
        for one in judged
        if one.shown
        for place, pair in enumerate(one.records)
    ]
    level = f"{percent(1 - 2 * plan.alpha)} CI"
    head = ("Configuration", "Pair", "Verdict", "Difference", level, "df", "n", "p TOST", "Holm", "p diff.")
    note = (
        "p TOST: the larger of the two one-sided tests; it decides with p diff., the two-sided t test, each at "
        f"α = {plan.alpha:g}. Holm: p TOST adjusted for the number of pairs of the row. One pair chosen after seeing "
        "all needs the adjusted p; the claim that all pairs of a row are alike does not."
    )
    caption = "Two one-sided tests of every pair"
    table = Table("table-equivalence", caption, head, tuple(rows), text_columns=3, note=note)
    return told_once(table, "df", "n") if rows else None


def cells(pair: dict[str, Any]) -> tuple[str, ...]:
    """The numbers of one pair; dashes where it has no test."""
    difference, n = signed(pair["difference"]), sizes_text((pair["n_a"], pair["n_b"]))
    if pair["verdict"] == UNTESTED:
        return (difference, "–", "–", n, *["–"] * 3)
    return (
        difference,
        interval(pair["ci_low"], pair["ci_high"]),
        apa_df(pair["df"]),
        n,
        *(thesis_p(pair[p]) for p in ("p_equivalence", "p_equivalence_holm", "p_difference")),
    )


def apa_equivalence(one: Judged) -> str:
    """A sentence to paste: the row's pairs with t, df and p of the larger one-sided test, and the interval."""
    row, first = one.each.row, one.records[0]
    kind = "paired" if one.each.mode == "repeated" else "Welch’s"
    people = f"n = {first['n_a']}, " if one.each.mode == "repeated" else ""
    tested = [pair for pair in one.records if pair["verdict"] != UNTESTED]
    pasted = tested if len(tested) <= PASTED else [p for p in tested if p["verdict"] in ("equivalent", "both")]
    level = f"{percent(1 - 2 * one.alpha)} CI"
    parts = [f"{one.named(pair)}: {apa_pair(pair, level)}" for pair in pasted]
    if len(pasted) < len(tested):
        parts.append(f"the other {len(tested) - len(pasted)} pairs were not shown to be equivalent")
    where = f" ({row.compared})" if row.kind == "comparison" else f" by {row.name}"
    return (
        f"Two one-sided {kind} t tests ({people}margin ±{one.margin:g}, α = {one.alpha:g}, "
        f"{counted(len(tested), 'pair')}, p unadjusted) of ratings of “{row.question}”{where}: {'; '.join(parts)}."
    )


def apa_pair(pair: dict[str, Any], level: str) -> str:
    """M = 0.45, t(43) = −0.14, p = .443, 90% CI [−0.08, 0.99], undecided."""
    side = "low" if pair["p_low"] >= pair["p_high"] else "high"
    bounds = interval(pair["ci_low"], pair["ci_high"])
    test = f"t({apa_df(pair['df'])}) = {signed(pair[f't_{side}'])}, {apa_p(pair['p_equivalence'])}"
    verdict = {"both": "equivalent and different"}.get(pair["verdict"], pair["verdict"])
    return f"M = {signed(pair['difference'])}, {test}, {level} {bounds}, {verdict}"
