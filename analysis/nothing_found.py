"""What is said where no effect was found: what the ratings still allow, and what came close."""

from collections.abc import Sequence

import numpy as np

from analysis.families import NAMES
from analysis.plan import AnalysisPlan
from analysis.results import Analysed
from analysis.study import Question
from analysis.wording import apa_p, joined, percent, sentence_case, signed


def nothing_said(rest: Sequence[Analysed], matter: Sequence[Analysed], question: Question, plan: AnalysisPlan) -> str:
    """Absence of a finding in `rest`, the rows without one, with the differences that the intervals still allow. A row
    whose p was below alpha before it was adjusted, or one of whose intervals excludes 0, is a hint and said to be.

    `matter`: the rows with a finding: a factor of an interaction among them has no effect on average at the most.
    """
    entangled = {name for each in matter if each.row.kind == "interaction" for name in each.row.factors}
    hints = [(each, why) for each in rest if (why := hint(each, plan))]
    near = [each for each, _ in hints]
    said = [f"{sentence_case(subject(each))}: {why}. A hint, not a finding." for each, why in hints]
    return " ".join([*none_found([each for each in rest if each not in near], entangled, question, plan), *said])


def none_found(rest: Sequence[Analysed], entangled: set[str], question: Question, plan: AnalysisPlan) -> list[str]:
    """Rows without any sign of an effect: the pairs of factors and pictures bound it, interactions have none."""
    bent = [each.row.name for each in rest if each.row.kind == "interaction"]
    whole = [each for each in rest if each.row.kind != "interaction"]
    none = f"No interaction {joined(bent)} was found"
    if not whole:
        return [f"{none}. That is not evidence of none."] if bent else []
    evidence = f"That is not evidence of none{allowed(whole, question, plan)}."
    said = [f"No {' and no '.join(names_of(whole, entangled))} was found. {evidence}"]
    return [*said, f"{none} either; no interval bounds it."] if bent else said


def names_of(rest: Sequence[Analysed], entangled: set[str]) -> list[str]:
    """effect of A and B; average effect of C, which interacts; difference in “others vs ours”; difference between
    pictures."""
    named = [each.row.name for each in rest if each.row.kind == "factor"]
    factors = [name for name in named if name not in entangled]
    average = [name for name in named if name in entangled]
    compared = [f"“{each.row.compared}”" for each in rest if each.row.kind == "comparison"]
    names = [f"effect of {joined(factors)}"] if factors else []
    names += [f"average effect of {joined(average)} beside the interaction"] if average else []
    names += [f"difference in {joined(compared)}"] if compared else []
    return names + ["difference between pictures" for each in rest if each.row.kind == "all"]


def subject(each: Analysed) -> str:
    """What a sentence about one row begins with."""
    kinds = {"comparison": f"“{each.row.compared}”", "all": "pictures", "interaction": f"interaction {each.row.name}"}
    return kinds.get(each.row.kind, each.row.name)


def allowed(rest: Sequence[Analysed], question: Question, plan: AnalysisPlan) -> str:
    """The largest difference inside the intervals of the rows' pairs; no more than the scale has."""
    tables = [each.tukey[["ci_low", "ci_high"]] for each in rest if each.tukey is not None]
    if not tables:
        return ""
    widest = max(table.abs().to_numpy().max() for table in tables)
    intervals = f"the {percent(plan.confidence)} intervals"
    if question.scale is not None and widest >= question.scale - 1:
        return f": {intervals} allow any difference that the scale has"
    return f": differences of up to {widest:.2f} remain inside {intervals}"


def hint(each: Analysed, plan: AnalysisPlan) -> str:
    """Why a row without a finding is not without a sign of one; empty where it is."""
    said = []
    decides = each.deciding_p(plan)
    if each.p is not None and each.p < plan.alpha and decides is not None and plan.adjust != "none":
        said.append(f"{apa_p(each.p)} by itself, {apa_p(decides)} {NAMES[plan.adjust]}-adjusted")
    if apart := farthest_from_zero(each):
        interval = f"{percent(plan.confidence)} CI ({signed(apart[1])} to {signed(apart[2])})"
        said.append(f"the {interval} of {apart[0]} excludes 0")
    return ", and ".join(said)


def farthest_from_zero(each: Analysed) -> tuple[str, float, float] | None:
    """The pair whose Tukey interval is farthest from 0 and its interval, the higher mean first; None where all
    intervals hold 0."""
    if each.tukey is None:
        return None
    low, high = (each.tukey[name].to_numpy(np.float64) for name in ("ci_low", "ci_high"))
    distance = np.maximum(low, -high)
    place = int(distance.argmax())
    if not distance[place] > 0:
        return None
    pair, names = each.tukey.iloc[place], each.row.labels
    if low[place] > 0:
        return f"{names[pair['a']]} minus {names[pair['b']]}", float(low[place]), float(high[place])
    return f"{names[pair['b']]} minus {names[pair['a']]}", float(-high[place]), float(-low[place])
