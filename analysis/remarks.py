"""What a reader must know before believing a table: plain sentences."""

from collections.abc import Sequence
from difflib import get_close_matches

import pandas as pd

from analysis.labels import natural_key
from analysis.plan import AnalysisPlan
from analysis.ratings import is_check
from analysis.reasons import reader_words
from analysis.results import Analysed
from analysis.sample import Sample
from analysis.study import StudyInfo
from analysis.wording import counted, joined, percent, sentence_case, true_minus

NOT_LIVE = {
    "simulated": "These answers are simulated: programs gave them, not people.",
    "pilot": "These answers are from a pilot of the study.",
}


def remarks(
    study: StudyInfo,
    plan: AnalysisPlan,
    sample: Sample,
    ratings: pd.DataFrame,
    found: Sequence[Analysed],
    notes: Sequence[str],
) -> list[str]:
    """Warnings in the order of their weight: not people's answers, answers lost, tests without a value, cautions.

    `ratings`: all that were read; `found`: the default mode's analyses; `notes`: what else had to be left out.
    """
    said = [not_live(ratings)] if not_live(ratings) else []
    said += question_remarks(study, sample, ratings)
    said += design_remarks(study, sample, ratings)
    said += [sentence for each in found for sentence in each.trouble]
    said += notes
    said += dict.fromkeys(sentence for each in found for sentence in row_remarks(each))
    own = sum(picture.role == "factor" for picture in study.pictures)
    if own > 1 and any(each.row.picked_best for each in found):
        said.append(
            f'The "best" of {own} own pictures was picked by the same ratings: the choice flatters its mean, '
            f"and comparisons with it find a difference by chance alone in more than {percent(plan.alpha)} of studies "
            "(before any adjustment)."
        )
    tested = [each.p for each in found if each.p is not None]
    if plan.adjust == "none" and len(tested) > 1 and min(tested) < plan.alpha:
        chance = len(tested) * plan.alpha
        said.append(
            f"{len(tested)} tests at the {percent(plan.alpha)} level: if no picture differed, about {chance:.1f} would "
            "be significant by chance. The Holm column allows for that."
        )
    if any(each.row.kind == "comparison" for each in found):
        said.append('"Non significant" between two pictures is not evidence that they are rated alike.')
    return said


def not_live(ratings: pd.DataFrame) -> str:
    """A sentence on answers that no study may be published with; empty for live ones."""
    mode = ratings["mode"].iloc[0] if "mode" in ratings and len(ratings) else "live"
    return NOT_LIVE.get(mode, "")


def row_remarks(each: Analysed) -> list[str]:
    """Too few people for the levels, and who was left out of this row alone."""
    if each.anova is None or each.mode != "repeated":
        return []
    said = []
    contrasts = int(each.anova["df1"])
    if contrasts > 1 and each.n[0] <= contrasts + 1:  # of one contrast sphericity holds
        levels = f"{contrasts} contrasts" if each.row.kind == "interaction" else f"{contrasts + 1} levels"
        said.append(f"{each.row.title}: {counted(each.n[0], 'participant')} for {levels}; sphericity cannot be judged.")
    who = sorted((name for name in str(each.anova["dropped"]).split("; ") if name), key=natural_key)
    if who:
        people = counted(len(who), "participant")
        where = sentence_case(each.row.question) if "effect" in each.anova else each.row.title
        said.append(f"{where}: {people} with a missing cell left out: {joined(who)}.")
    said += [f"{each.row.title}: {reason}." for reason in reasons(each)]
    return said


def reasons(each: Analysed) -> list[str]:
    """Why simple effects of an interaction have no value."""
    return (
        []
        if each.simple is None
        else [f"{true_minus(at)}: {reader_words(why)}" for at, why in each.simple[["at", "reason"]].to_numpy() if why]
    )


def question_remarks(study: StudyInfo, sample: Sample, ratings: pd.DataFrame) -> list[str]:
    """Questions that the study does not ask, and those of it that have no answer."""
    asked = [q.name for q in study.questions]
    said = []
    ratings = ratings[~is_check(ratings)]
    for name in (str(found) for found in ratings["question"].unique() if found not in asked):
        meant = get_close_matches(name, asked, n=1, cutoff=0.5)
        hint = f' (did you mean "{meant[0]}"?)' if meant else ""
        said.append(f'Rated but not a question of the study: "{name}"{hint}; not analysed.')
    answered, used = (set(frame["question"].unique()) for frame in (ratings.dropna(subset="rating"), sample.ratings))
    if never := [name for name in asked if name not in answered]:
        said.append(f"Never answered: {joined(never)}.")
    if left_out := [name for name in asked if name in answered - used]:
        said.append(f"Answered only by people who were left out: {joined(left_out)}.")
    return said


def design_remarks(study: StudyInfo, sample: Sample, ratings: pd.DataFrame) -> list[str]:
    """Pictures that were never rated or are not listed, and answers that are missing."""
    said = []
    rated = set(ratings["stimulus"].unique())
    unseen = [p.id for p in study.pictures if p.id not in rated]
    unlisted = sorted(rated - {p.id for p in study.pictures})
    if unseen:
        said.append(f"Never rated: {joined(unseen)}.")
    if unlisted:
        said.append(f"Rated but not in the manifest: {joined(unlisted)}; used only where a comparison names them.")
    if sample.n_missing:
        said.append(f"{counted(sample.n_missing, 'answer')} missing.")
    return said
