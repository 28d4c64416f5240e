"""How far people agree with each other, and with themselves on pictures shown more than once."""

from itertools import combinations

import numpy as np
import pandas as pd

from analysis.labels import natural_order
from analysis.ratings import is_check, is_repeat
from analysis.sample import Sample
from analysis.statistics.agreement import IntraclassCorrelation, KrippendorffAlpha
from analysis.statistics.undefined import Undefined
from analysis.study import StudyInfo


def rater_table(sample: Sample, study: StudyInfo) -> tuple[pd.DataFrame, list[str]]:
    """A row per question: `icc_a1, icc_a1_low, icc_a1_high` (absolute agreement of one rater), `icc_ak...` (of all),
    `alpha, alpha_low, alpha_high` (Krippendorff, ordinal), `n_raters, n_targets`; and why a question has none."""
    entries: list[dict[str, object]] = []
    notes: list[str] = []
    for question in study.questions if sample.mode == "repeated" else ():
        mine = sample.ratings[sample.ratings["question"] == question.name]
        if mine.empty:  # the remarks say so
            continue
        try:
            icc = IntraclassCorrelation("rating", "stimulus", "participant")(mine)
            alpha = KrippendorffAlpha("rating", "stimulus", "participant")(mine).iloc[0]
        except Undefined as reason:
            notes.append(f"Agreement on {question.name}: {reason}")
            continue
        by_type = {row["type"]: row for row in icc.to_dict("records")}
        entry: dict[str, object] = {"question": question.name}
        for name, short in (("ICC(A,1)", "icc_a1"), ("ICC(A,k)", "icc_ak")):
            row = by_type[name]
            entry |= {short: row["icc"], f"{short}_low": row["ci_low"], f"{short}_high": row["ci_high"]}
        entry |= {"alpha": alpha["alpha"], "alpha_low": alpha["ci_low"], "alpha_high": alpha["ci_high"]}
        entries.append({**entry, "n_raters": row["n_raters"], "n_targets": row["n_targets"]})
    return pd.DataFrame(entries), notes


def retest_table(everything: pd.DataFrame, study: StudyInfo) -> pd.DataFrame:
    """A row per picture shown repeatedly and question.

    Columns: `question, showings` (ids), `n` (people with all showings), `means` (one for each showing), `within_sd`
    (root of the mean variance within a person), `mean_abs_difference` and `share_equal`, `share_within_1` over all
    pairs of showings.
    """
    root = {p.id: p.same_picture_as or p.id for p in study.pictures}
    frame = everything[~is_check(everything)].dropna(subset="rating")
    first = frame["stimulus"]
    if "repeat_of" in frame:
        first = first.where(~is_repeat(frame), frame["repeat_of"])
    # another program may show a picture again under its own name
    again = np.where(is_repeat(frame) & (first == frame["stimulus"]), " again", "")
    frame = frame.assign(picture=first.map(lambda name: root.get(name, name)), showing=frame["stimulus"] + again)
    shown = frame.groupby("picture")["showing"].nunique()
    entries: list[dict[str, object]] = []
    for picture in natural_order(shown.index[shown > 1]):
        for question, part in frame[frame["picture"] == picture].groupby("question", sort=False):
            wide = part.pivot_table(index="participant", columns="showing", values="rating").dropna()
            if len(wide) and wide.shape[1] > 1:
                entries.append({"question": question, **agreement(wide)})
    order = {q.name: place for place, q in enumerate(study.questions)}
    entries.sort(key=lambda entry: order.get(str(entry["question"]), len(order)))
    return pd.DataFrame(entries)


def agreement(wide: pd.DataFrame) -> dict[str, object]:
    """Self-agreement in a participants x showings table."""
    names = [str(name) for name in natural_order(wide.columns)]
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
