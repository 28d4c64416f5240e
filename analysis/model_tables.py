"""Tables for the page of what the models say."""

from collections.abc import Hashable, Mapping, Sequence
from typing import Any

import pandas as pd

from analysis.models import Modelled
from analysis.tables import SHOWN_LEVELS, Table, told_once
from analysis.verdicts import NAMES, finders, tested_rows
from analysis.wording import joined, percent, thesis_p, true_minus

PARTS = {"participant": "People", "picture": "Pictures", "residual": "Residual"}


def table_of_verdicts(fitted: Sequence[Modelled], alpha: float) -> Table | None:
    """Every row's tests side by side."""
    tested = list(tested_rows(fitted))
    kind = "F (df)" if any(each.mode == "repeated" for each, _ in tested) else "χ² (df)"
    names = [name for name in NAMES if any(name in p for _, p in tested)]
    models = {id(each): model for model in fitted for each in model.found}
    rows = []
    for each, p in tested:
        model, cells = models[id(each)], []
        for name in names:
            if name in ("ordinal", "mixed"):
                test = model.test(model.ordinal if name == "ordinal" else model.mixed, each)
                cells.append("" if test is None else statistic(test))
            cells.append(thesis_p(p[name]) if name in p else "")
        rows.append((each.row.title, finders(p, alpha), *cells))
    head = [
        text
        for name in names
        for text in (
            (f"{NAMES[name].capitalize()}, {kind}", "p") if name in ("ordinal", "mixed") else (f"{heading(name)}, p",)
        )
    ]
    if len(names) < 2:
        return None
    return Table(
        "table-models",
        f"The same question put to {len(names)} tests",
        ("Configuration", f"Effect at {percent(alpha)} by", *head),
        tuple(rows),
        text_columns=2,
        note="p without adjustment for the number of tests. Models: Wald's joint test of all coefficients"
        + (", which takes the number of answers as large." if kind == "χ² (df)" else "."),
    )


def statistic(test: Mapping[str, Any]) -> str:
    """F (df, df2), or of independent answers chi-squared (df)."""
    if pd.isna(test["F"]):
        return f"{test['chi2']:.2f} ({test['df']})"
    return f"{test['F']:.2f} ({test['df']}, {test['df2']:.0f})"


def heading(name: str) -> str:
    """ANOVA, Ranks."""
    return NAMES[name] if NAMES[name].isupper() else NAMES[name].capitalize()


def table_of_odds(odds: pd.DataFrame, fitted: Sequence[Modelled], confidence: float) -> Table | None:
    """Odds ratios of every level against the first of its factor."""
    titles = {(each.row.question, each.row.name): each.row.title for model in fitted for each in model.found}
    fits = {(each.row.question, each.row.name): model.ordinal for model in fitted for each in model.found}
    rows, long = [], []
    groups = odds.groupby(["question", "factor"], sort=False) if len(odds) else ()
    for (question, factor), part in groups:
        title, fit = titles[(str(question), str(factor))], fits[(str(question), str(factor))]
        assert fit is not None
        counts = (str(fit.n), str(fit.clusters or "–"))
        if len(part) >= SHOWN_LEVELS:
            long.append(title)
            continue
        for place, row in enumerate(part.to_dict("records")):
            shown = (ratio(row["odds_ratio"]), f"[{ratio(row['ci_low'])}, {ratio(row['ci_high'])}]")
            rows.append(
                (title if place == 0 else "", true_minus(f"{row['level']} against {row['against']}"), *counts, *shown)
            )
    if not rows:
        return None
    note = "Odds of a higher answer at the level, divided by those at the factor's first level; 1 is no difference."
    if long:
        note += f" Many levels: those of {joined(long)} stand in tables/odds_ratios.csv."
    table = Table(
        "table-odds",
        "Odds ratios of the proportional odds model",
        ("Configuration", "Level", "ratings", "participants", "Odds ratio", f"{percent(confidence)} CI"),
        tuple(rows),
        text_columns=2,
        note=note,
    )
    return told_once(table, "ratings", "participants")


def ratio(value: float) -> str:
    """Two places, and no 0.00."""
    if value < 0.01:
        return "< 0.01"
    return f"{value:.2f}" if value < 1000 else f"{value:.3g}"


def table_of_variances(fitted: Sequence[Modelled]) -> Table | None:
    """The mixed models' random terms."""
    rows: list[tuple[str, ...]] = []
    lacks: dict[str, list[str]] = {}
    for model in fitted:
        if model.mixed is None:
            continue
        title = model.found[-1].row.title
        by_term = {str(row["term"]).rstrip("'"): row for row in model.mixed.variances.to_dict("records")}
        cells = [part_text(by_term.get(name)) for name in PARTS]
        rows.append((title, *cells, str(model.mixed.n)))
        for why in model.mixed.left_out:
            lacks.setdefault(why, []).append(title)
    if not rows:
        return None
    used = [0, *(place for place in range(1, 5) if any(row[place] for row in rows))]
    everywhere = [why for why, titles in lacks.items() if len(titles) == len(rows)]
    notes = [f"In every row {why}." for why in everywhere]
    notes += [f"{joined(titles)}: {why}." for why, titles in lacks.items() if why not in everywhere]
    return Table(
        "table-mixed",
        "Variances of the mixed models, beside the factors' effects (share of their sum)",
        tuple(("Configuration", *PARTS.values(), "Ratings")[place] for place in used),
        tuple(tuple(row[place] for place in used) for row in rows),
        note=" ".join(notes),
    )


def part_text(part: dict[Hashable, Any] | None) -> str:
    """Variance and share; empty for a term that the model lacks."""
    return "" if part is None else f"{part['variance']:.3f} ({part['share']:.0%})"


def table_of_shares(shares: pd.DataFrame) -> Table | None:
    """Where the variance of all ratings of a question lies."""
    if shares.empty:
        return None
    at_zero = " 0.000: the likelihood is highest without that variance." if (shares["variance"] == 0).any() else ""
    rows = []
    for question, part in shares.groupby("question", sort=False):
        cells = {row["term"]: part_text(row) for row in part.to_dict("records")}
        rows.append((str(question), cells["picture"], cells["participant"], cells["residual"], str(part["n"].iloc[0])))
    return Table(
        "table-variance",
        "How much of the variance of all ratings lies in the picture (share)",
        ("Question", "Between pictures", "Between people", "In neither", "Ratings"),
        tuple(rows),
        note="No intervals are given: the pictures were chosen, not drawn at random. Where everyone rated every "
        "picture once, the pictures' share is ICC(A,1), and its interval stands under Agreement."
        f"{at_zero}",
    )
