"""Interactions in words: how the effect of one factor depends on another, and its simple effects."""

from collections.abc import Sequence

import pandas as pd

from analysis.plan import AnalysisPlan
from analysis.results import Analysed
from analysis.wording import apa_df, apa_p, joined, level_text, no_zero, true_minus

SAID = 8  # simple effects beyond these stand in the table alone


def significant(each: Analysed, plan: AnalysisPlan) -> bool:
    """Whether the p that decides is below alpha."""
    p = each.deciding_p(plan)
    return p is not None and p < plan.alpha


def meddlers(each: Analysed, found: Sequence[Analysed], plan: AnalysisPlan) -> list[str]:
    """The factors that change a factor's effect: those it interacts with significantly on the same question. None for
    pictures compared."""
    mine = [
        other
        for other in found
        if other.row.kind == "interaction" and other.row.question == each.row.question and significant(other, plan)
    ]
    names = [
        name for other in mine if set() < set(each.row.factors) < set(other.row.factors) for name in other.row.factors
    ]
    return [name for name in dict.fromkeys(names) if name not in each.row.factors]


def interaction_sentence(each: Analysed) -> str:
    """Of two factors: what the first does at each level of the second; of more, that it depends."""
    *firsts, last = each.row.factors
    if len(firsts) > 1:
        return f"How {joined(firsts)} work together depends on {last}: their effects must be read for each combination."
    moved, held = turned(each)
    spread = spreads(each, held)
    at = joined([f"{value:.2f} apart at {held} {true_minus(level)}" for level, value in spread.items()])
    return f"The effect of {moved} depends on {held}: its highest and lowest mean are {at}."


def turned(each: Analysed) -> tuple[str, str]:
    """Of two factors the one whose effect is told and the one that it is told at: the one with fewer levels."""
    assert each.row.crossed is not None
    first, second = each.row.crossed.of(each.row.factors).factors
    return (second.name, first.name) if len(first.levels) < len(second.levels) else (first.name, second.name)


def spreads(each: Analysed, held: str) -> dict[str, float]:
    """Level of `held` -> highest less lowest mean over the levels of the other factor."""
    assert each.means is not None
    place = each.row.factors.index(held)
    values = {level.code: level_text(level.value[place]) for level in each.row.levels}
    by_level = each.means.groupby(each.means["level"].map(values), sort=False, observed=True)["mean"]
    return {str(level): float(means.max() - means.min()) for level, means in by_level}


def simple_effects_sentence(each: Analysed, plan: AnalysisPlan) -> str:
    """The simple effects of a significant interaction, in the APA's form; empty where there is nothing to follow up."""
    if each.simple is None or not significant(each, plan):
        return ""
    tested = each.simple.dropna(subset="F")
    if len(tested) > SAID or tested.empty:
        return ""
    parts = [simple_text(part, plan) for part in tested.to_dict("records")]
    where = f"on ratings of “{each.row.question}” (Holm-adjusted within {each.row.name})"
    return f"Simple effects {where}: {'; '.join(parts)}."


def simple_text(part: "dict[object, float] | pd.Series[float]", plan: AnalysisPlan) -> str:
    """thickness exponent at light azimuth 150, F(1, 37) = 9.11, p = .012, η²p = .198."""
    df1, df2 = (apa_df(part[name] * part["epsilon_gg"]) for name in ("df1", "df2"))
    verdict = "" if part["p_holm"] < plan.alpha else " (not significant)"
    return (
        f"{part['factor']} at {true_minus(str(part['at']))}, F({df1}, {df2}) = {part['F']:.2f}, "
        f"{apa_p(part['p_holm'])}, η²p = {no_zero(part['partial_eta_squared'], 3)}{verdict}"
    )
