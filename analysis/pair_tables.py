"""Tables of what stands behind an overall test: pairs, declared contrasts, simple effects."""

from collections.abc import Hashable, Iterable, Iterator
from typing import Any

import pandas as pd

from analysis.plan import AnalysisPlan
from analysis.results import Analysed
from analysis.tables import SHOWN_LEVELS, Table, sizes_text, told_once
from analysis.wording import (
    apa_df,
    interval,
    no_zero,
    percent,
    sentence_case,
    share_interval,
    signed,
    thesis_p,
    true_minus,
)

SHOWN_EFFECTS = 24  # simple effects of an interaction; more stand in tables/simple_effects.csv
CHOSEN = {"all": "all pairs", "reference": "each level with the first", "neighbours": "levels that follow each other"}


def pairs_shown(each: Analysed, pairs: pd.DataFrame | None) -> Iterator[tuple[tuple[str, ...], dict[Hashable, Any]]]:
    """Title (once a row), names, difference and interval of each pair, and its record; none of more samples than a page
    can hold."""
    if pairs is None or len(each.row.levels) > SHOWN_LEVELS:
        return
    labels = each.row.labels
    for place, pair in enumerate(pairs.to_dict("records")):
        name = f"{labels[pair['a']]} minus {labels[pair['b']]}"
        bounds = interval(pair["ci_low"], pair["ci_high"])
        yield ("" if place else each.row.title, name, signed(pair["difference"]), bounds), pair


def table_of_pairs(found: Iterable[Analysed], confidence: float) -> Table | None:
    """Every pair of every row with Tukey's simultaneous intervals; None where no row has few enough samples."""
    rows = [
        (*cells, f"{pair['q']:.2f}", f"{pair['df']:.0f}", sizes_text(each.n), thesis_p(pair["p"]))
        for each in found
        for cells, pair in pairs_shown(each, each.tukey)
    ]
    head = ("Configuration", "Pair", "Difference", f"{percent(confidence)} CI", "q", "df", "n", "p Tukey")
    note = "Intervals and p hold together for all pairs of a row."
    table = Table("table-pairs", "All pairs, Tukey", head, tuple(rows), text_columns=2, note=note)
    return told_once(table, "df", "n") if rows else None


def table_of_contrasts(found: Iterable[Analysed], plan: AnalysisPlan) -> Table | None:
    """Paired t tests of the declared pairs with Holm's adjustment; None where nobody rated two samples."""
    rows = [(*cells, *t_test_cells(pair)) for each in found for cells, pair in pairs_shown(each, each.contrasts)]
    head = ("Configuration", "Pair", "Difference", f"{percent(plan.confidence)} CI", "t", "df", "p Holm", "d_z")
    note = (
        "p Holm: adjusted within each row. The interval is that of the pair alone. d_z: mean difference over the "
        "standard deviation of differences. A pair that everyone rates the same distance apart has no t."
    )
    caption = f"Paired contrasts, Holm: {CHOSEN[plan.contrasts]}"
    return Table("table-contrasts", caption, head, tuple(rows), text_columns=2, note=note) if rows else None


def t_test_cells(pair: "dict[Hashable, Any] | pd.Series[float]") -> tuple[str, ...]:
    """t, df, p Holm, d_z; dashes where the differences have no spread."""
    if pd.isna(pair["p_holm"]):
        return ("–", f"{pair['df']:.0f}", "–", "–")
    return (signed(pair["t"]), f"{pair['df']:.0f}", thesis_p(pair["p_holm"]), signed(pair["d_z"]))


def table_of_simple_effects(found: Iterable[Analysed]) -> Table | None:
    """What each interaction consists of; None where none is small enough for the page."""
    rows = []
    for each in found:
        if each.simple is None or len(each.simple) > SHOWN_EFFECTS:
            continue
        for place, part in enumerate(each.simple.to_dict("records")):
            title = "" if place else sentence_case(each.row.question)
            name = f"{part['factor']} at {true_minus(part['at'])}"
            rows.append((title, name, str(each.n[0]), *simple_cells(part)))
    head = ("Question", "Effect of", "n", "F", "df", "p", "p Holm", "η²p", "90% CI")
    note = (
        "The effect of one factor with the others held, Greenhouse–Geisser corrected, each with its own error. p Holm: "
        "adjusted over the effects of an interaction. η²p: partial eta squared. A dash: no spread to test against. "
        "They follow up an interaction: without a significant one they only repeat the main effects."
    )
    table = Table("table-simple", "Simple effects", head, tuple(rows), text_columns=2, note=note)
    return told_once(table, "n") if rows else None


def simple_cells(part: "dict[object, float]") -> tuple[str, ...]:
    """The numbers of one simple effect; dashes where it has none."""
    if pd.isna(part["F"]):
        return ("–",) * 6
    df1, df2 = (apa_df(part[name] * part["epsilon_gg"]) for name in ("df1", "df2"))
    return (
        f"{part['F']:.2f}",
        f"{df1}, {df2}",
        thesis_p(part["p_gg"]),
        thesis_p(part["p_holm"]),
        no_zero(part["partial_eta_squared"], 3),
        share_interval(part["partial_ci_low"], part["partial_ci_high"]),
    )


def table_of_planned(planned: pd.DataFrame, plan: AnalysisPlan) -> Table | None:
    """The contrasts that were declared picture by picture; None where there are none."""
    rows = tuple(
        (
            f"{sentence_case(str(row['question']))}: {row['contrast']}",
            str(row["weights"]),
            signed(row["estimate"]),
            interval(row["ci_low"], row["ci_high"]),
            *t_test_cells(row),
            "–" if pd.isna(row["d_av"]) else signed(row["d_av"]),
        )
        for _, row in planned.iterrows()
    )
    head = (
        "Contrast",
        "Weights",
        "Estimate",
        f"{percent(plan.confidence)} CI",
        "t",
        "df",
        "p Holm",
        "d_z",
        "d_av",
    )
    note = (
        "The weighted sum of each person’s ratings, tested against 0. p Holm: adjusted over the contrasts declared for "
        "a question. d_z: estimate over the standard deviation of the sums. d_av: the difference of the two sides, "
        "each a weighted mean, over their average standard deviation."
    )
    return Table("table-planned", "Planned contrasts", head, rows, text_columns=2, note=note) if rows else None
