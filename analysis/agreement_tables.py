"""Tables of agreement for the page."""

from collections.abc import Hashable, Mapping
from typing import Any

import pandas as pd

from analysis.tables import Table
from analysis.wording import no_zero, share_interval

Entry = Mapping[Hashable, Any]


def table_of_raters(raters: pd.DataFrame) -> Table | None:
    """Agreement between people, question by question."""
    if raters.empty:
        return None
    rows = tuple(
        (
            entry["question"],
            with_interval(entry, "icc_a1"),
            with_interval(entry, "icc_ak"),
            str(entry["n_raters"]),
            with_interval(entry, "alpha"),
            str(entry["alpha_n_raters"]),
            str(entry["n_missing"]),
        )
        for entry in raters.to_dict("records")
    )
    head = ("Question", "ICC(A,1), one rater", "ICC(A,k), all raters", "k", "Krippendorff’s α, ordinal", "n", "Missing")
    return Table(
        "table-raters",
        "Agreement between people",
        head,
        rows,
        note="95% intervals in brackets; that of α is a bootstrap over pictures. The ICC needs people who rated every "
        "picture (k of them); α keeps everybody (n) and leaves missing answers out.",
    )


def with_interval(entry: Entry, name: str) -> str:
    """.290 [.019, .761]; without the bracket where there is no interval, a dash where there is no value."""
    if pd.isna(entry[name]):
        return "–"
    if pd.isna(entry[f"{name}_low"]):
        return f"{no_zero(entry[name], 3)} (no interval)"
    return f"{no_zero(entry[name], 3)} {share_interval(entry[f'{name}_low'], entry[f'{name}_high'])}"


def table_of_retests(retests: pd.DataFrame) -> Table | None:
    """Self-agreement on pictures shown more than once."""
    if retests.empty:
        return None
    rows = [
        (
            entry["question"],
            entry["showings"],
            str(entry["n"]),
            entry["means"],
            f"{entry['within_sd']:.2f}",
            f"{entry['mean_abs_difference']:.2f}",
            f"{entry['share_equal']:.0%}",
            f"{entry['share_within_1']:.0%}",
        )
        for entry in retests.to_dict("records")
    ]
    head = ("Question", "Showings", "n", "Means", "Within-person SD", "Mean |difference|", "Same answer", "Within 1")
    return Table("table-retest", "One picture, shown more than once", head, tuple(rows), text_columns=2)


def table_of_stability(stability: pd.DataFrame) -> Table | None:
    """The first showing against the second, over all repeated pictures."""
    if stability.empty:
        return None
    rows = tuple(
        (
            entry["question"],
            str(entry["n_pictures"]),
            str(entry["n_people"]),
            str(entry["n_pairs"]),
            with_interval(entry, "icc_a1"),
        )
        for entry in stability.to_dict("records")
    )
    head = ("Question", "Pictures", "People", "Pairs of answers", "ICC(A,1)")
    several = bool((stability["n_pairs"] > stability["n_people"]).any())
    together = " Pairs of one person are not independent, so the 95% interval is too narrow." if several else ""
    return Table(
        "table-stability",
        "Test-retest: first against second showing",
        head,
        rows,
        note=f"How far a person's two answers to one picture agree: 1 is the same answer every time.{together}",
    )
