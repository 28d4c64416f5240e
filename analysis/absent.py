"""Pictures that a person was to rate and has no line for: answers missing from a file of answers alone."""

import pandas as pd

from analysis.plan import Mode
from analysis.ratings import MEASURED, is_first_showing

CELL = ["stimulus", "question"]
OF_A_PERSON = ("session", "started_at", "mode")


def with_absent(ratings: pd.DataFrame, mode: Mode) -> pd.DataFrame:
    """`ratings`, and a line with an empty rating for each picture and question that a person has no line for.

    The design must be known: within people, where more than half of them have a line for everything that anybody rated.
    In a design that gives each person a part of the pictures nobody lacks one.
    """
    first = ratings[is_first_showing(ratings)].drop_duplicates(["participant", *CELL])
    cells, lines = first[CELL].drop_duplicates(), first.groupby("participant").size()
    short = lines.index[lines < len(cells)]
    if mode != "repeated" or short.empty or 2 * len(short) >= len(lines):
        return ratings
    every = pd.DataFrame({"participant": short}).merge(cells, how="cross")
    there = pd.MultiIndex.from_frame(first[["participant", *CELL]])
    absent = every[~pd.MultiIndex.from_frame(every).isin(there)]
    facts = ratings.drop_duplicates("participant").set_index("participant")
    for name in (column for column in ratings.columns if column not in every):
        if name in OF_A_PERSON:
            absent = absent.assign(**{name: absent["participant"].map(facts[name])})
        else:
            absent = absent.assign(**{name: float("nan") if name in ("rating", *MEASURED) else ""})
    return pd.concat([ratings, absent[list(ratings.columns)]], ignore_index=True)
