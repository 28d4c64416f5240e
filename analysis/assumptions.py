"""What each test takes for granted, row by row: measured, put in a table, and said where it matters."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from analysis.plan import AnalysisPlan, Mode
from analysis.reasons import reader_words
from analysis.results import METHODS, Analysed, Statistic
from analysis.statistics.diagnostics import LARGEST, EqualSpread, Residuals, ScaleEnds
from analysis.statistics.undefined import Undefined
from analysis.study import StudyInfo
from analysis.tables import Table
from analysis.wording import apa_p, counted, joined, sentence_case, signed, thesis_p

CROWDED = 0.25  # share of the answers at one end of the scale
LAST = {"floor": "lowest", "ceiling": "highest"}
MOST_NAMED = 6
UNEVEN = 4.0  # largest over smallest variance
RESIDUALS = ("skewness", "kurtosis", "shapiro_w", "shapiro_p")
SPHERICITY = ("mauchly_w", "mauchly_p", "epsilon_gg", "epsilon_hf")
SPREAD = ("levene_w", "levene_p", "variance_ratio")


def assumption_table(found: Sequence[Analysed]) -> pd.DataFrame:
    """A row per analysis that has a value.

    Columns: `question, factor, method, n` (people, or ratings of the smallest sample), `k` (samples), `SPHERICITY`
    (within people), `SPREAD` (between them), `RESIDUALS`; NaN where something does not apply or has no value: `reason`
    says why.
    """
    return pd.DataFrame([assumption_entry(each, each.anova) for each in found if each.anova is not None])


def assumption_entry(each: Analysed, anova: Mapping[str, Any]) -> dict[str, Any]:
    """One analysis."""
    entry: dict[str, Any] = {"question": each.row.question, "factor": each.row.name, "method": METHODS[each.mode]}
    own = SPHERICITY if each.mode == "repeated" else SPREAD
    entry |= {"n": min(each.n), "k": len(each.n), **dict.fromkeys((*own, *RESIDUALS), np.nan)}
    reasons = []
    if each.mode == "repeated":
        entry |= {name: anova[name] for name in SPHERICITY}
        reasons += no_sphericity(entry, anova)
    else:
        spread = EqualSpread("rating", "condition")
        reasons += fill(
            entry, spread, each, {"levene_w": "levene_w", "p": "levene_p", "variance_ratio": "variance_ratio"}
        )
    if each.row.kind == "interaction":
        reasons.append("residuals: those of its factors' rows")
    else:
        shape = Residuals("rating", "condition", "participant" if each.mode == "repeated" else None)
        reasons += fill(entry, shape, each, dict(zip(RESIDUALS, RESIDUALS, strict=True)))
        if np.isnan(entry["shapiro_p"]) and not np.isnan(entry["skewness"]):
            reasons.append(f"Shapiro and Wilk's p is not accurate above {LARGEST:,} residuals")
    return {**entry, "reason": "; ".join(reasons)}


def no_sphericity(entry: Mapping[str, Any], anova: Mapping[str, Any]) -> list[str]:
    """Why Mauchly's test is missing."""
    if not np.isnan(entry["mauchly_p"]):
        return []
    if anova["df1"] == 1:
        return ["two levels have but one difference, so sphericity holds"]
    if entry["n"] > anova["df1"] + 1:
        return ["a difference between samples is the same in everyone, so Mauchly’s test has no value"]
    return [f"{entry['n']} participants for {entry['k']} levels: sphericity cannot be judged"]


def fill(entry: dict[str, Any], statistic: Statistic, each: Analysed, names: Mapping[str, str]) -> list[str]:
    """Puts a statistic's row into the entry (its name -> ours), or returns the sentence why there is none."""
    try:
        row = statistic(each.answers).iloc[0]
    except Undefined as reason:
        return [reader_words(reason, each.row.labels)]
    entry |= {ours: float(row[theirs]) for theirs, ours in names.items()}
    if np.isinf(entry.get("variance_ratio", np.nan)):
        entry["variance_ratio"] = np.nan
        return ["a sample does not scatter at all, so variances have no ratio"]
    return []


def ends_table(ratings: pd.DataFrame, study: StudyInfo) -> pd.DataFrame:
    """`question, stimulus, floor, ceiling` (shares of the answers at the scale's ends), `n`; where there is a scale."""
    parts = []
    for question in study.questions:
        mine = ratings[ratings["question"] == question.name]
        if question.scale is None or mine.empty:
            continue
        table = ScaleEnds("rating", "stimulus", 1, question.scale)(mine).rename(columns={"level": "stimulus"})
        table.insert(0, "question", question.name)
        parts.append(table)
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def crowded(ends: pd.DataFrame, study: StudyInfo) -> list[str]:
    """Questions that many answered with an end of the scale, over all pictures and for single ones."""
    said = []
    for question in study.questions if len(ends) else ():
        mine = ends[ends["question"] == question.name]
        for end, answer in (("floor", 1), ("ceiling", question.scale)):
            share = np.average(mine[end], weights=mine["n"]) if len(mine) else 0.0
            alone = [str(name) for name in mine.loc[mine[end] > CROWDED, "stimulus"]]
            if share > CROWDED:
                said.append(
                    f"{sentence_case(question.name)}: {share:.0%} of the answers are {answer}, the {LAST[end]} on the "
                    f"scale ({end}): differences between pictures there cannot show."
                )
            elif alone:
                which = joined(alone) if len(alone) <= MOST_NAMED else counted(len(alone), "picture")
                said.append(
                    f"{sentence_case(question.name)}: more than {CROWDED:.0%} of the answers to {which} are {answer} "
                    f"({end})."
                )
    return said


def cautions(table: pd.DataFrame, found: Sequence[Analysed], plan: AnalysisPlan) -> list[str]:
    """Tests that depend on a correction, and samples that scatter too differently for the test."""
    said = []
    for each in found:
        if each.anova is None or each.mode != "repeated":
            continue
        plain, corrected = float(each.anova["p"]), float(each.anova["p_gg"])
        if (plain < plan.alpha) is not (corrected < plan.alpha):
            said.append(
                f"{each.row.title}: {apa_p(plain)} without and {apa_p(corrected)} with the Greenhouse–Geisser "
                "correction; the corrected one counts."
            )
    said += [sentence for each in found if (sentence := without_spread(each))]
    for entry in table.to_dict("records") if "levene_p" in table else ():
        if entry["levene_p"] < plan.alpha and not entry["variance_ratio"] <= UNEVEN:
            said.append(
                f"{sentence_case(entry['question'])} vs {entry['factor']}: the samples scatter differently (Levene’s "
                f"test, {apa_p(entry['levene_p'])}); with unequal sizes, do not trust p of the analysis of variance."
            )
    return said


def without_spread(each: Analysed) -> str:
    """The pairs that everyone rates equally far apart: no t test, no p."""
    if each.contrasts is None or not each.contrasts["p"].isna().any():
        return ""
    labels = {level.code: level.label for level in each.row.levels}
    pairs = each.contrasts[each.contrasts["p"].isna()]
    named = [f"{labels[pair['a']]} and {labels[pair['b']]}" for pair in pairs.to_dict("records")]
    which = "; ".join(named) if len(named) <= MOST_NAMED else counted(len(named), "pair")
    return f"{each.row.title}: everyone rates {which} exactly the same distance apart, so there is no paired t test."


def table_of_assumptions(table: pd.DataFrame, found: Sequence[Analysed], mode: Mode) -> Table:
    """Each row of the tests with what it takes for granted."""
    repeated = mode == "repeated"
    own = (*SPHERICITY,) if repeated else (*SPREAD,)
    head = ("Mauchly W", "p", "ε GG", "ε HF") if repeated else ("Levene W", "p", "Variance ratio")
    titles = [each.row.title for each in found if each.anova is not None]
    entries = list(zip(titles, table.to_dict("records"), strict=True))
    why = [f"{title}: {entry['reason']}." for title, entry in entries if entry["reason"]]
    rows = tuple(
        (
            title,
            str(entry["n"]),
            str(entry["k"]),
            *(shown(name, entry[name]) for name in (*own, *RESIDUALS[:2], "shapiro_p")),
        )
        for title, entry in entries
    )
    return Table(
        "table-assumptions",
        f"What the tests take for granted, {METHODS[mode]}",
        ("Configuration", "n", "k", *head, "Skewness", "Kurtosis", "p Shapiro–Wilk"),
        rows,
        note="Skewness, excess kurtosis and Shapiro–Wilk’s p describe the residuals: with many people a small p says "
        "little, with few a large one says nothing. "
        + (
            "Greenhouse–Geisser’s correction is applied whatever Mauchly’s test says."
            if repeated
            else "Levene’s test about the medians."
        )
        + (" Without a value: " + " ".join(why) if why else ""),
    )


def shown(name: str, value: float) -> str:
    """A number of the table; a dash where there is none."""
    if np.isnan(value):
        return "–"
    return thesis_p(value) if name.endswith("_p") else signed(value, 3 if name.startswith("epsilon") else 2)
