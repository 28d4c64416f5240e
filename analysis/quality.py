"""How carefully each person answered: measures that a reader may judge by, never a silent removal."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from analysis.labels import natural_order
from analysis.ratings import is_check, is_first_showing, is_repeat
from analysis.spreadsheets import of_distinct
from analysis.study import StudyInfo

TOO_FAST_MS = 300.0  # choosing among seven answers takes longer than that even where the answer is known beforehand
FEWEST = 3  # ratings; fewer have no correlation worth the name
ROUNDING = 1e-9  # a deviation this small is what float64 leaves of none
NO = ("false", "0", "no")


def quality_table(ratings: pd.DataFrame, study: StudyInfo, too_fast_ms: float = TOO_FAST_MS) -> pd.DataFrame:
    """A row per participant in `ratings` (all that were read: repeats, checks and missing answers included).

    Columns: `participant, ratings` (answers to first showings), `missing` (first showings without an answer), `checks`
    and `failed_checks`, `same_answer_share` (of the answers, 0..1), `longest_run` (equal answers one after the other in
    the order of presentation), `median_rt_ms, shortest_rt_ms, too_fast_share` (of the answers, below `too_fast_ms`),
    `focus_lost_ms` (in all), `retest_difference` (mean distance, in steps, between showings of one picture),
    `person_rest_r` (correlation with the mean of the others, within questions). NaN: the file does not tell.
    """
    first = ratings[is_first_showing(ratings)]
    people = pd.Index([str(who) for who in natural_order(ratings["participant"])], name="participant")
    by_person = first.groupby("participant")["rating"]
    counted = by_person.count().reindex(people, fill_value=0)
    table = pd.DataFrame({"ratings": counted, "missing": by_person.size().reindex(people, fill_value=0) - counted})
    given = answers(ratings)
    measures = {
        "checks": checks(ratings),
        "failed_checks": failed_checks(ratings),
        "same_answer_share": same_answer_share(given),
        "longest_run": longest_run(given, [q.name for q in study.questions]),
        **answer_times(given, too_fast_ms),
        "focus_lost_ms": focus_lost(ratings),
        "retest_difference": retest_difference(ratings, study),
        "person_rest_r": person_rest(first.dropna(subset="rating")),
    }
    return table.assign(**{name: column.reindex(people) for name, column in measures.items()}).reset_index()


def answers(ratings: pd.DataFrame) -> pd.DataFrame:
    """What was answered: repeats included, attention checks and missing answers not."""
    return ratings[~is_check(ratings)].dropna(subset="rating")


def nothing() -> "pd.Series[float]":
    """A measure that the file does not tell."""
    return pd.Series(dtype=float)


def checks(ratings: pd.DataFrame) -> "pd.Series[float]":
    """Attention checks shown to each person; nothing where the study has none."""
    shown = is_check(ratings)
    return shown.groupby(ratings["participant"]).sum().astype(float) if shown.any() else nothing()


def failed_checks(ratings: pd.DataFrame) -> "pd.Series[float]":
    """Attention checks that each person failed; nothing where the study has none."""
    shown = is_check(ratings)
    if "check_passed" not in ratings or not shown.any():
        return nothing()
    failed = ratings["check_passed"].str.lower().isin(NO) & shown
    return failed.groupby(ratings["participant"]).sum().astype(float)


def same_answer_share(given: pd.DataFrame) -> "pd.Series[float]":
    """Share of each person's commonest answer among all their answers, 0..1."""
    counts = given.groupby(["participant", "rating"]).size().groupby(level="participant")
    return counts.max() / counts.sum()


def longest_run(given: pd.DataFrame, questions: Sequence[str]) -> "pd.Series[float]":
    """Most equal answers one after the other, by trial and within a trial by question; nothing without trials."""
    if "trial" not in given or not len(given):
        return nothing()
    places = {name: place for place, name in enumerate(questions)}
    who, people = pd.factorize(given["participant"], sort=True)
    session = pd.factorize(given["session"])[0] if "session" in given else np.zeros(len(given))
    trial = of_distinct(given["trial"], lambda texts: pd.to_numeric(texts, errors="coerce"))
    # numbers sort ten times as fast as names; the last key weighs most
    order = np.lexsort((given["question"].map(places), trial, session, who))
    who, rating = who[order], given["rating"].to_numpy()[order]
    begins = np.flatnonzero(np.r_[True, (who[1:] != who[:-1]) | (rating[1:] != rating[:-1])])
    lengths = np.diff(np.r_[begins, len(who)])
    return pd.Series(lengths).groupby(who[begins]).max().set_axis(people).astype(float)


def answer_times(given: pd.DataFrame, too_fast_ms: float) -> "dict[str, pd.Series[float]]":
    """Median and shortest answer time in milliseconds, and the share of answers below `too_fast_ms`."""
    if "rt_ms" not in given:
        return dict.fromkeys(("median_rt_ms", "shortest_rt_ms", "too_fast_share"), nothing())
    timed = given.dropna(subset="rt_ms")
    each = timed.groupby("participant")["rt_ms"]
    fast = (timed["rt_ms"] < too_fast_ms).groupby(timed["participant"]).mean()
    return {"median_rt_ms": each.median(), "shortest_rt_ms": each.min(), "too_fast_share": fast}


def focus_lost(ratings: pd.DataFrame) -> "pd.Series[float]":
    """Milliseconds the page was hidden or not in front; a trial's questions share one figure."""
    if "focus_lost_ms" not in ratings:
        return nothing()
    trial = [name for name in ("participant", "session", "trial", "stimulus", "presentation") if name in ratings]
    return ratings.groupby(trial)["focus_lost_ms"].max().groupby(level="participant").sum(min_count=1)


def showings(everything: pd.DataFrame, study: StudyInfo) -> pd.DataFrame:
    """Answers with `picture` (showings of one picture share it) and `showing` (which of them), checks left out."""
    root = {p.id: p.same_picture_as or p.id for p in study.pictures}
    frame = everything[~is_check(everything)].dropna(subset="rating")
    first = frame["stimulus"]
    if "repeat_of" in frame:
        first = first.where(~is_repeat(frame), frame["repeat_of"])
    # another program may show a picture again under its own name
    again = np.where(is_repeat(frame) & (first == frame["stimulus"]), " again", "")
    frame = frame.assign(picture=first.map(root).fillna(first), showing=frame["stimulus"] + again)
    several = frame.groupby("picture")["showing"].nunique()
    return frame[frame["picture"].isin(several.index[several > 1])]


def retest_difference(ratings: pd.DataFrame, study: StudyInfo) -> "pd.Series[float]":
    """Highest less lowest answer to the showings of one picture on one question, in the mean."""
    shown = showings(ratings, study)
    if shown.empty:
        return nothing()
    cells = shown.groupby(["participant", "picture", "question"])["rating"]
    spread = (cells.max() - cells.min())[cells.count() > 1]
    return spread.groupby(level="participant").mean()


def person_rest(answered: pd.DataFrame) -> "pd.Series[float]":
    """Pearson's correlation of each person's ratings with the means of all others, question means taken out.

    NaN below `FEWEST` ratings that somebody else gave too, and where all of a person's ratings of a question are equal.
    """
    wide = answered.pivot_table(index="participant", columns=["question", "stimulus"], values="rating", observed=True)
    others = wide.notna().sum() - wide.notna()
    rest = (wide.sum() - wide.fillna(0.0)) / others.where(others > 0)
    own, rest = within_questions(wide.where(rest.notna())), within_questions(rest.where(wide.notna()))
    varies = (np.abs(own).max(axis=1) > ROUNDING) & (np.abs(rest).max(axis=1) > ROUNDING)
    enough = varies & (own.notna().sum(axis=1) >= FEWEST)
    return pd.Series(own[enough].corrwith(rest[enough], axis=1), dtype=float)


def within_questions(wide: pd.DataFrame) -> pd.DataFrame:
    """People x (question, picture) with each person's mean of each question taken out."""
    return wide - wide.T.groupby(level="question").transform("mean").T
