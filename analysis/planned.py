"""The contrasts that a study planned: computed, adjusted, said."""

from collections.abc import Iterator

import pandas as pd

from analysis.plan import AnalysisPlan, PlannedContrast
from analysis.reasons import reader_words
from analysis.sample import Sample
from analysis.statistics import planned
from analysis.statistics.multiplicity import Adjusted
from analysis.statistics.undefined import Undefined
from analysis.wording import apa_df, apa_p, interval, joined, percent, signed
from fakesss.problem import nearest

T_TEST = ("estimate", "ci_low", "ci_high", "t", "df", "p", "p_holm", "d_z", "d_av", "n", "dropped")
COLUMNS = ("contrast", "question", "weights", *T_TEST)


def planned_table(sample: Sample, plan: AnalysisPlan) -> tuple[pd.DataFrame, list[str]]:
    """A row per declared contrast, Holm over those of a question, and sentences on those left out."""
    rows, notes = [], []
    for contrast in plan.contrast:
        mine = sample.ratings[sample.ratings["question"] == contrast.question]
        place = f'contrast "{contrast.name}" on {contrast.question} is left out'
        if mine.empty:
            asked = nearest(contrast.question, sample.ratings["question"].unique())
            notes.append(f"{place}: nobody answered that question; {asked}")
            continue
        try:
            row = statistic(contrast, plan)(mine).iloc[0].to_dict()
        except Undefined as reason:
            notes.append(f"{place}: {reader_words(reason)}")
            continue
        rows.append(
            {"contrast": contrast.name, "question": contrast.question, "weights": weights_text(contrast), **row}
        )
    if not rows:
        return pd.DataFrame(columns=COLUMNS), notes
    table = Adjusted("p", "holm", "question")(pd.DataFrame(rows))
    return table[list(COLUMNS)], notes


def statistic(contrast: PlannedContrast, plan: AnalysisPlan) -> planned.PlannedContrast:
    """The test of a declared contrast."""
    return planned.PlannedContrast("rating", "stimulus", "participant", contrast.weights, plan.confidence)


def weights_text(contrast: PlannedContrast) -> str:
    """−1 img01 + 1 img03."""
    parts = [f"{abs(weight):g} {name}" for name, weight in contrast.weights.items() if weight]
    signs = ["−" if weight < 0 else "+" for weight in contrast.weights.values() if weight]
    lead = "−" if signs[0] == "−" else ""
    return lead + parts[0] + "".join(f" {sign} {part}" for sign, part in zip(signs[1:], parts[1:], strict=True))


def deciding(row: "pd.Series[float]", plan: AnalysisPlan) -> float:
    """Plain p where nothing is adjusted, else Holm's: these are few and planned, and no false one is wanted."""
    return float(row["p" if plan.adjust == "none" else "p_holm"])


def planned_sentences(table: pd.DataFrame, plan: AnalysisPlan) -> Iterator[str]:
    """Each contrast in the APA's form."""
    for _, row in table.iterrows():
        p = deciding(row, plan)
        verdict = "was significant" if p < plan.alpha else "was not significant"
        holm = "" if plan.adjust == "none" else " (Holm-adjusted)"
        yield (
            f"The planned contrast “{row['contrast']}” ({row['weights']}) on ratings of “{row['question']}” {verdict}, "
            f"M = {signed(row['estimate'])}, {percent(plan.confidence)} CI "
            f"{interval(row['ci_low'], row['ci_high'])}, t({apa_df(row['df'])}) = {signed(row['t'])}, "
            f"{apa_p(p)}{holm}, d_z = {signed(row['d_z'])}."
        )


def planned_summary(table: pd.DataFrame, plan: AnalysisPlan) -> tuple[str, ...]:
    """For a reader in a hurry: which planned contrasts differ from 0, and which were not found to."""
    if table.empty:
        return ()
    found = [
        f"“{row['contrast']}” on {row['question']} ({signed(row['estimate'])}, {percent(plan.confidence)} CI "
        f"{signed(row['ci_low'])} to {signed(row['ci_high'])})"
        for _, row in table.iterrows()
        if deciding(row, plan) < plan.alpha
    ]
    rest = [f"“{r['contrast']}” on {r['question']}" for _, r in table.iterrows() if deciding(r, plan) >= plan.alpha]
    said = [f"Planned contrasts that differ from 0: {joined(found)}."] if found else []
    return (*said, *([f"Planned contrasts not found to differ from 0: {joined(rest)}."] if rest else []))
