"""How far people agree with each other, and with themselves on pictures shown more than once."""

from collections.abc import Callable
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd

from analysis.labels import natural_key, natural_order
from analysis.reasons import reader_words
from analysis.sample import Sample
from analysis.statistics.agreement import IntraclassCorrelation, KrippendorffAlpha
from analysis.statistics.undefined import Undefined
from analysis.study import StudyInfo

Entry = dict[str, Any]


def rater_table(sample: Sample, study: StudyInfo) -> tuple[pd.DataFrame, list[str]]:
    """A row per question, and sentences on what has no value.

    Columns: `icc_a1, icc_a1_low, icc_a1_high` (absolute agreement of one rater), `icc_ak...` (of all), `n_raters`,
    `n_targets`, `icc_dropped` (people left out of the ICC for a missing answer); `alpha, alpha_low, alpha_high`
    (Krippendorff, ordinal), `alpha_n_raters`; `n_missing` (empty cells of people by pictures); `reason` for a NaN.
    """
    entries: list[Entry] = []
    notes: list[str] = []
    for question in study.questions if sample.mode == "repeated" else ():
        mine = sample.ratings[sample.ratings["question"] == question.name]
        if mine.empty:  # the remarks say so
            continue
        icc, said = valued(icc_entry, mine, f"Agreement on {question.name}")
        alpha, again = valued(alpha_entry, mine, f"Agreement on {question.name}")
        notes += dict.fromkeys([*said, *again])
        if icc or alpha:
            missing = mine["participant"].nunique() * mine["stimulus"].nunique() - len(mine)
            nothing = dict.fromkeys((*ICC_COLUMNS, *ALPHA_COLUMNS), np.nan) | {"n_raters": 0, "icc_dropped": 0}
            entry = {"question": question.name, **nothing, **icc, **alpha, "n_missing": missing}
            entries.append({**entry, "reason": "; ".join(dict.fromkeys([*said, *again, *no_interval(entry)]))})
    return pd.DataFrame(entries), notes


ICC_COLUMNS = ("icc_a1", "icc_a1_low", "icc_a1_high", "icc_ak", "icc_ak_low", "icc_ak_high")
ALPHA_COLUMNS = ("alpha", "alpha_low", "alpha_high")


def no_interval(entry: Entry) -> list[str]:
    """Why an ICC stands without its interval."""
    alone: bool = pd.notna(entry["icc_a1"]) and pd.isna(entry["icc_a1_low"])
    return ["raters agree without any residual, so the ICC has no interval"] if alone else []


def valued(make: Callable[[pd.DataFrame], Entry], frame: pd.DataFrame, what: str) -> tuple[Entry, list[str]]:
    """The entry of a frame, or the sentence why it has none."""
    try:
        return make(frame), []
    except Undefined as reason:
        return {}, [f"{what}: {reader_words(reason)}"]


def icc_entry(mine: pd.DataFrame) -> Entry:
    """Both ICCs of one question's ratings."""
    table = IntraclassCorrelation("rating", "stimulus", "participant")(mine)
    entry = icc_columns(table, {"ICC(A,1)": "icc_a1", "ICC(A,k)": "icc_ak"})
    first = table.iloc[0]
    dropped = len(str(first["dropped"]).split("; ")) if first["dropped"] else 0
    return {**entry, "n_raters": int(first["n_raters"]), "n_targets": int(first["n_targets"]), "icc_dropped": dropped}


def icc_columns(table: pd.DataFrame, names: dict[str, str]) -> Entry:
    """Value and interval of the types that `names` lists (type -> our name)."""
    entry: Entry = {}
    for row in table.to_dict("records"):
        if short := names.get(row["type"]):
            entry |= {short: row["icc"], f"{short}_low": row["ci_low"], f"{short}_high": row["ci_high"]}
    return entry


def alpha_entry(mine: pd.DataFrame) -> Entry:
    """Krippendorff's alpha of one question's ratings."""
    row = KrippendorffAlpha("rating", "stimulus", "participant")(mine).iloc[0]
    entry: Entry = {"alpha": row["alpha"], "alpha_low": row["ci_low"], "alpha_high": row["ci_high"]}
    return {**entry, "alpha_n_raters": int(row["n_raters"])}


def retest_table(shown: pd.DataFrame, study: StudyInfo) -> pd.DataFrame:
    """A row per picture shown repeatedly and question; `shown` as `analysis.quality.showings` returns it.

    Columns: `question, showings` (ids), `n` (people with all showings), `means` (one for each showing), `within_sd`
    (root of the mean variance within a person), `mean_abs_difference` and `share_equal`, `share_within_1` over all
    pairs of showings.
    """
    entries: list[Entry] = []
    for picture in natural_order(shown["picture"]):
        for question, part in shown[shown["picture"] == picture].groupby("question", sort=False):
            wide = part.pivot_table(index="participant", columns="showing", values="rating").dropna()
            if len(wide) and wide.shape[1] > 1:
                entries.append({"question": question, **agreement(wide[in_turn(wide, str(picture))])})
    order = {q.name: place for place, q in enumerate(study.questions)}
    entries.sort(key=lambda entry: order.get(str(entry["question"]), len(order)))
    return pd.DataFrame(entries)


def in_turn(wide: pd.DataFrame, picture: str) -> list[str]:
    """The showings as they are numbered: the picture itself, then its repeats in natural order."""
    return sorted(map(str, wide.columns), key=lambda name: (name != picture, natural_key(name)))


def agreement(wide: pd.DataFrame) -> Entry:
    """Self-agreement in a participants x showings table, the first showing first."""
    names = list(wide.columns)
    gaps = np.concatenate([(wide[a] - wide[b]).abs().to_numpy() for a, b in combinations(names, 2)])
    return {
        "showings": ", ".join(names),
        "n": len(wide),
        "means": ", ".join(f"{wide[name].mean():.2f}" for name in names),
        "within_sd": float(np.sqrt(wide.var(axis=1).mean())),
        "mean_abs_difference": float(gaps.mean()),
        "share_equal": float((gaps == 0).mean()),
        "share_within_1": float((gaps <= 1).mean()),
    }


def stability_table(shown: pd.DataFrame, study: StudyInfo) -> tuple[pd.DataFrame, list[str]]:
    """A row per question: ICC(A,1) of the first showing with the second, over all people and repeated pictures.

    Columns: `question, icc_a1, icc_a1_low, icc_a1_high, n_pairs, n_people, n_pictures`; and sentences on what has no
    value. `shown` as `analysis.quality.showings` returns it; showings count in natural order of their names.
    """
    entries: list[Entry] = []
    notes: list[str] = []
    for question in study.questions:
        pairs = first_two(shown[shown["question"] == question.name])
        if pairs.empty:
            continue
        made, said = valued(stability, pairs, f"Test-retest on {question.name}")
        entries += [{"question": question.name, **made}] if made else []
        notes += said
    return pd.DataFrame(entries), notes


def first_two(shown: pd.DataFrame) -> pd.DataFrame:
    """`participant, picture, place` (0, 1), `rating`: of everyone who answered both of the first two showings."""
    places = {
        showing: place
        for _, part in shown.groupby("picture")
        for place, showing in enumerate(natural_order(part["showing"]))
    }
    frame = shown.assign(place=shown["showing"].map(places))
    frame = frame[frame["place"] < 2]
    cells = frame.groupby(["participant", "picture", "place"], as_index=False)["rating"].mean()
    both = cells.groupby(["participant", "picture"])["place"].transform("size") == 2
    return pd.DataFrame(cells[both])


def stability(pairs: pd.DataFrame) -> Entry:
    """One question's pairs of answers: each pair is a target, the first and the second showing its raters."""
    code = pairs.groupby(["participant", "picture"]).ngroup()
    table = IntraclassCorrelation("rating", "pair", "place")(pairs.assign(pair=code))
    counts: Entry = {"n_pairs": len(pairs) // 2, "n_people": pairs["participant"].nunique()}
    return {**icc_columns(table, {"ICC(A,1)": "icc_a1"}), **counts, "n_pictures": pairs["picture"].nunique()}
