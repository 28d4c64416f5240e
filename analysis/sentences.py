"""Findings in words: first for a reader in a hurry, then in the APA's form to paste."""

from collections.abc import Sequence
from dataclasses import dataclass

import pandas as pd

from analysis.families import NAMES
from analysis.interaction_sentences import interaction_sentence, meddlers, significant
from analysis.nothing_found import nothing_said
from analysis.plan import AnalysisPlan
from analysis.results import Analysed
from analysis.study import Question, StudyInfo
from analysis.wording import apa_df, apa_p, joined, no_zero, percent, sentence_case, share_interval, signed

ORDER = ("factor", "interaction", "comparison", "all")
LISTED = 12  # the means of more samples stand in tables/means.csv


@dataclass(frozen=True)
class Effect:
    """A finding in words, and the statistic behind it."""

    words: str
    statistic: str


@dataclass(frozen=True)
class Finding:
    """What the ratings of one question say."""

    question: Question
    effects: tuple[Effect, ...]
    nothing: str


def findings(study: StudyInfo, found: Sequence[Analysed], plan: AnalysisPlan) -> list[Finding]:
    """For each question which factors matter, in which direction and by how much; then those without a finding."""
    result = []
    for question in study.questions:
        mine = [each for each in found if each.row.question == question.name and each.p is not None]
        matter = [each for each in mine if significant(each, plan)]
        matter.sort(key=lambda each: (ORDER.index(each.row.kind), -gap(each)))
        rest = [each for each in mine if not significant(each, plan)]
        if mine:
            effects = tuple(Effect(words(each, mine, question, plan), apa_statistic(each, plan)) for each in matter)
            nothing = nothing_said(rest, matter, question, plan)
            result.append(Finding(question, effects, nothing))
    return result


def words(each: Analysed, mine: Sequence[Analysed], question: Question, plan: AnalysisPlan) -> str:
    """One finding; an effect that a larger interaction bends is said to be an average."""
    others = joined(meddlers(each, mine, plan))
    if each.row.kind == "interaction":
        said = interaction_sentence(each)
        return f"On average over {others}, {said[:1].lower()}{said[1:]}" if others else said
    said = effect_sentence(each, question, plan)
    return f"On average over {others} it {said[:1].lower()}{said[1:]}" if others else said


def ordered_means(each: Analysed) -> pd.DataFrame:
    """Label, value and mean of each sample, by level where levels are numbers."""
    assert each.means is not None
    by_code = {level.code: level for level in each.row.levels}
    table = each.means.assign(
        label=[by_code[code].printed for code in each.means["level"]],
        value=[by_code[code].value for code in each.means["level"]],
    )
    numeric = all(isinstance(v, int | float) and not isinstance(v, bool) for v in table["value"])
    return table.sort_values("value") if numeric and each.row.kind == "factor" else table


def gap(each: Analysed) -> float:
    """Highest mean less lowest."""
    return 0.0 if each.means is None else float(each.means["mean"].max() - each.means["mean"].min())


def effect_sentence(each: Analysed, question: Question, plan: AnalysisPlan) -> str:
    """Direction, the means, and the largest difference with its simultaneous interval."""
    table = ordered_means(each)
    top, bottom = table.iloc[int(table["mean"].argmax())], table.iloc[int(table["mean"].argmin())]
    named = table if len(table) <= LISTED else table.loc[[bottom.name, top.name]]
    at = [f"{mean:.2f} at {label}" for mean, label in zip(named["mean"], named["label"], strict=True)]
    head = f"{direction(each, table)}: {joined(at)}." if each.row.kind == "factor" else picture_head(each, top, bottom)
    low, high = pair_interval(each, top["level"], bottom["level"])
    what = "points"
    if question.scale is not None:
        what = f"{'steps' if question.scale <= 11 else 'points'} of the {question.scale}-point scale"
    return (
        f"{head} Highest less lowest: {gap(each):.2f} {what} "
        f"({percent(plan.confidence)} CI {signed(low)} to {signed(high)})."
    )


def direction(each: Analysed, table: pd.DataFrame) -> str:
    """Rises or falls where the means follow the levels, else depends."""
    name, means = each.row.name, table["mean"]
    numeric = all(isinstance(v, int | float) and not isinstance(v, bool) for v in table["value"])
    if numeric and means.is_monotonic_increasing:
        return f"Rises with {name}"
    if numeric and means.is_monotonic_decreasing:
        return f"Falls with {name}"
    return f"Depends on {name}, highest at {table['label'].iloc[int(means.argmax())]}"


def picture_head(each: Analysed, top: "pd.Series[float]", bottom: "pd.Series[float]") -> str:
    """Pictures have no direction: the ends are named."""
    where = f"{sentence_case(each.row.compared)}: the" if each.row.kind == "comparison" else "The"
    return (
        f"{where} pictures differ, from {bottom['mean']:.2f} ({bottom['label']}) to {top['mean']:.2f} ({top['label']})."
    )


def pair_interval(each: Analysed, top: object, bottom: object) -> tuple[float, float]:
    """Tukey's interval of top less bottom: it allows for having picked the extremes."""
    assert each.tukey is not None
    for pair in each.tukey.to_dict("records"):
        if {pair["a"], pair["b"]} == {top, bottom}:
            low, high = float(pair["ci_low"]), float(pair["ci_high"])
            return (low, high) if pair["a"] == top else (-high, -low)
    return 0.0, 0.0


def apa_statistic(each: Analysed, plan: AnalysisPlan) -> str:
    """F(1.93, 83.10) = 22.43, p < .001, with the adjusted p that decides, the effect size and its interval."""
    assert each.anova is not None and each.p is not None
    df1, df2 = each.df
    decides = each.deciding_p(plan)
    adjusted = "" if plan.adjust == "none" or decides is None else f", {NAMES[plan.adjust]}-adjusted {apa_p(decides)}"
    symbol = "η²G" if each.mode == "repeated" else "η²"
    _, size, low, high = each.effect
    return (
        f"F({apa_df(df1)}, {apa_df(df2)}) = {each.anova['F']:.2f}, {apa_p(each.p)}{adjusted}, "
        f"{symbol} = {no_zero(size, 3)}, 90% CI {share_interval(low, high)}"
    )


def apa_sentence(each: Analysed, plan: AnalysisPlan) -> str:
    """A sentence to paste into a paper."""
    assert each.anova is not None and each.means is not None
    corrected = " (Greenhouse–Geisser corrected)" if each.mode == "repeated" and each.anova["df1"] > 1 else ""
    what = {"factor": f"effect of {each.row.name}", "interaction": f"interaction {each.row.name}"}
    kind = "main " if each.row.kind == "factor" and each.row.crossed is not None and each.mode == "repeated" else ""
    verdict = "a significant" if significant(each, plan) else "no significant"
    cells = [
        f"{label}: M = {mean:.2f}, SD = {sd:.2f}"
        for label, mean, sd in ordered_means(each)[["label", "mean", "sd"]].itertuples(index=False)
    ]
    if len(cells) > LISTED:
        cells = [f"{len(cells)} means in tables/means.csv"]
    where = f" ({each.row.compared})" if each.row.kind == "comparison" else ""
    best = " The best own picture was picked by the same ratings, which flatters its mean."
    return (
        f"A {design(each)}{corrected} with {people(each)} showed {verdict} "
        f"{kind}{what.get(each.row.kind, 'effect of picture')} on ratings of “{each.row.question}”{where}, "
        f"{apa_statistic(each, plan)} ({'; '.join(cells)}).{best if each.row.picked_best else ''}"
    )


def design(each: Analysed) -> str:
    """repeated-measures ANOVA; of a factorial with its levels: 2 × 3 repeated-measures ANOVA."""
    if each.mode == "independent":
        return "one-way ANOVA"
    if each.row.crossed is None:
        return "repeated-measures ANOVA"
    return f"{' × '.join(str(len(factor.levels)) for factor in each.row.crossed.factors)} repeated-measures ANOVA"


def people(each: Analysed) -> str:
    """n, as the mode counts it."""
    if each.mode == "repeated":
        return f"{each.n[0]} participants"
    sizes = f"{each.n[0]}" if len(set(each.n)) == 1 else ", ".join(map(str, each.n))
    return f"{sizes} ratings a sample"
