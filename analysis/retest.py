"""Pictures shown more than once: how far the same people agree with themselves."""

from itertools import combinations

import numpy as np
import pandas as pd

from analysis.labels import natural_order
from analysis.ratings import is_check, is_repeat
from analysis.study import StudyInfo


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
