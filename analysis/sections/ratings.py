"""The ratings in figures: means as in the thesis's figures 4.5 and 4.6, all answers, and person by person."""

import pandas as pd

from analysis.evidence import Evidence
from analysis.figures.means import comparison_figures, factor_figures
from analysis.figures.profiles import profile_figures, trend_table
from analysis.figures.ranked import ranked_figures
from analysis.figures.stacked import DRAWN, stacked_figures
from analysis.records import means_table
from analysis.section import Section, rendered
from analysis.statistics.shares import AnswerShares

MEANS = (factor_figures, comparison_figures, ranked_figures)


def ratings(evidence: Evidence) -> Section | None:
    """Means by factor and of the pictures compared, the answers to every picture, and each person's line."""
    study, confidence = evidence.study, evidence.plan.confidence
    shares = share_table(evidence)
    means = [figure for make in MEANS for figure in make(study, evidence.main, confidence)]
    answers = stacked_figures(study, shares)
    people = profile_figures(study, evidence.main)
    if not (means or answers):
        return None
    body = rendered(
        "ratings", means=means, answers=answers, people=people, pictures=shares["stimulus"].nunique(), drawn=DRAWN
    )
    tables = {"means": means_table([*evidence.main, *evidence.other]), "answers": shares}
    trends = trend_table(evidence.main)
    if not trends.empty:
        tables["trends"] = trends
    return Section("figures", "Figures", body, tables, (*means, *answers, *people))


def share_table(evidence: Evidence) -> pd.DataFrame:
    """`question, stimulus, answer, n, share` of every listed picture and question that has a scale."""
    parts = []
    frame = evidence.sample.ratings
    for question in evidence.study.questions:
        mine = frame[frame["question"] == question.name]
        if question.scale is not None and not mine.empty:
            table = AnswerShares("rating", "stimulus", question.scale)(mine).rename(columns={"group": "stimulus"})
            table.insert(0, "question", question.name)
            parts.append(table)
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=["question", "stimulus", "answer"])
