"""People who took part more than once: one session of each person is analysed."""

import pandas as pd

from analysis.ratings import is_first_showing


def one_session_each(ratings: pd.DataFrame) -> tuple[pd.DataFrame, tuple[tuple[str, str], ...]]:
    """The ratings of one session a person, and (participant, session) of those set aside.

    `ratings` as `read_ratings` returns them: a person's sessions in the order of their start. Of sessions that show
    one person the same pictures, the one with the most answers is kept, of equals the earliest: the first complete one
    where there is one. Sessions of one person that share no picture belong together and are all kept.
    """
    if "session" not in ratings:
        return ratings, ()
    shown = ratings[is_first_showing(ratings)]
    twice = shown.duplicated(["participant", "stimulus", "question"])
    set_aside: list[tuple[str, str]] = []
    for who in shown.loc[twice, "participant"].unique():
        answers = shown[shown["participant"] == who].groupby("session", sort=False)["rating"].count()
        set_aside += [(str(who), str(name)) for name in answers.index if name != answers.idxmax()]
    keys = pd.MultiIndex.from_frame(ratings[["participant", "session"]])
    return ratings[~keys.isin(set_aside)] if set_aside else ratings, tuple(set_aside)
