"""Ratings beside image cues, question by question: what is computed for the section on cues."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd

from analysis.evidence import Evidence
from analysis.statistics.cues import (
    CueRegression,
    CueSlopes,
    ExplainedMeans,
    correlation_with,
    is_flat,
    standardised,
)
from analysis.statistics.undefined import Undefined
from analysis.study import Picture, StudyInfo
from analysis.wording import counted, joined, signed

OWN = ("factor", "control")
BY_FACTORS, BY_CUES = "the factors", "the cues at once"
ALIKE = 0.95  # correlation from which on two cues cannot be told apart
NAMES = {
    "mean_luminance": "mean luminance",
    "rms_contrast": "contrast",
    "contrast_beside_highlights": "contrast beside highlights",
    "luminance_skew": "skew of luminance",
    "saturation_intensity_correlation": "saturation with intensity",
    "gradient_energy": "sharpness (gradient energy)",
    "highlight_share": "share of highlights",
    "mean_thickness": "mean thickness",
}


def cue_name(cue: str) -> str:
    """As a reader calls it."""
    return NAMES.get(cue, cue.replace("_", " "))


@dataclass(frozen=True)
class CueFindings:
    """One question. `frame`: a row per person and distinct picture with its cues; `slopes`, `joint`: None where they
    have no value; `explained`: a row per set of predictors; `said`: what was left out, and why."""

    question: str
    frame: pd.DataFrame
    used: tuple[str, ...]
    slopes: pd.DataFrame | None
    joint: pd.DataFrame | None
    explained: pd.DataFrame
    said: tuple[str, ...]


def cue_table(study: StudyInfo) -> pd.DataFrame:
    """`stimulus, label, role`, then a column per cue, of every listed picture that has cues."""
    rows = [{"stimulus": p.id, "label": p.label, "role": p.role, **dict(p.cues)} for p in study.pictures if p.cues]
    return pd.DataFrame(rows)


def first_of(study: StudyInfo, picture: Picture) -> Picture:
    """The first listed own picture of the same bytes: one picture counts once, however often it was shown."""
    earlier = next((p for p in study.pictures if p.id == picture.same_picture_as and p.role in OWN), None)
    return picture if earlier is None else first_of(study, earlier)


def ratings_with_cues(evidence: Evidence, question: str) -> tuple[pd.DataFrame, tuple[str, ...]]:
    """`participant, picture, rating` of own pictures (twins averaged) with a column per cue; and the cues' names."""
    own = [p for p in evidence.study.pictures if p.role in OWN and p.cues]
    first = {p.id: first_of(evidence.study, p).id for p in own}
    asked = evidence.sample.ratings
    mine = asked[(asked["question"] == question) & asked["stimulus"].isin(list(first))]
    picture = mine["stimulus"].astype(object).map(first).rename("picture")
    rating = mine[["participant", "rating"]].assign(picture=picture)
    if len(set(first.values())) < len(first):
        rating = rating.groupby(["participant", "picture"])["rating"].mean().reset_index()
    cues = pd.DataFrame([{"picture": p.id, **dict(p.cues)} for p in own], dtype=object)
    names = tuple(str(name) for name in cues.columns if name != "picture")
    return rating.merge(cues.astype(dict.fromkeys(names, float)), on="picture"), names


def find_cues(evidence: Evidence, question: str) -> CueFindings | None:
    """All of one question; None where fewer than two different own pictures were rated."""
    frame, names = ratings_with_cues(evidence, question)
    pictures = frame.drop_duplicates("picture").set_index("picture")
    if len(pictures) < 2:
        return None
    used, said = usable(pictures[list(names)])
    if not used:
        return CueFindings(question, frame, (), None, None, pd.DataFrame(), tuple(said))

    def attempt(statistic: Callable[[pd.DataFrame], pd.DataFrame]) -> pd.DataFrame | None:
        try:
            return statistic(frame)
        except Undefined as reason:
            said.append(f"Cues and “{question}”: {reason}.")
            return None

    columns = ("rating", "participant", "picture")
    slopes = attempt(CueSlopes(*columns, tuple(used), evidence.plan.confidence))
    together, why = fitted_together(pictures[used])
    said += why
    joint = attempt(CueRegression(*columns, tuple(together), evidence.plan.confidence)) if len(together) > 1 else None
    if slopes is not None:
        said += equal_slopes(question, slopes)
    explained, why = explained_means(evidence.study, frame, used, together)
    said += [f"Share explained of “{question}”: {reason}." for reason in why]
    return CueFindings(question, frame, tuple(used), slopes, joint, explained, tuple(said))


def equal_slopes(question: str, slopes: pd.DataFrame) -> list[str]:
    """A sentence on each cue with a slope but no test of it."""
    same = slopes[slopes["p"].isna() & (slopes["slope"] != 0)]
    return [
        f"Every participant’s slope of “{question}” on {cue_name(str(row['cue']))} is {signed(row['slope'])}; without "
        "spread there is no test of it, and Holm’s adjustment does not count it."
        for row in same.to_dict("records")
    ]


def usable(pictures: pd.DataFrame) -> tuple[list[str], list[str]]:
    """The cues that all pictures have and that differ between them; a sentence on the others."""
    used: list[str] = []
    missing: list[str] = []
    flat: list[str] = []
    for cue in map(str, pictures.columns):
        values = pictures[cue].to_numpy(dtype=np.float64)
        (missing if np.isnan(values).any() else flat if is_flat(values) else used).append(cue)
    said = []
    if missing:
        said.append(f"Left out, as not every picture has it: {joined([cue_name(cue) for cue in missing])}.")
    if flat:
        said.append(f"Left out, as the same in all pictures: {joined([cue_name(cue) for cue in flat])}.")
    return used, said


def fitted_together(pictures: pd.DataFrame) -> tuple[list[str], list[str]]:
    """The cues that one regression can hold, in their order, and a sentence on what it cannot.

    Fewer pictures than cues + 2 explain anything: then none.
    """
    z = pd.DataFrame({cue: standardised(pictures[cue]) for cue in pictures}, index=pictures.index)
    pairwise, said = told_apart(z, together=False)
    if len(z) < len(pairwise) + 2:
        here = counted(len(z), "different picture")
        return [], [*said, f"{here} cannot hold a regression on {len(pairwise)} cues at once: one cue at a time."]
    return told_apart(z, together=True)


def told_apart(z: pd.DataFrame, together: bool) -> tuple[list[str], list[str]]:
    """The standardised cues whose correlation with each one kept before is at most `ALIKE`, with `together` also that
    with all of them; and a sentence on each of the others."""
    kept: list[str] = []
    said = []
    for cue in map(str, z.columns):
        twin = next((other for other in kept if abs(float(z[cue].corr(z[other]))) > ALIKE), None)
        most = correlation_with(z[cue].to_numpy(), z[kept].to_numpy()) if together else 0.0
        if twin is not None:
            r = signed(float(z[cue].corr(z[twin])), 3)
            said.append(f"On these pictures {cue_name(cue)} cannot be told from {cue_name(twin)} (r = {r}).")
        elif most > ALIKE:
            said.append(f"On these pictures {cue_name(cue)} follows from other cues (multiple R = {most:.3f}).")
        else:
            kept.append(cue)
    if said and together:
        said.append(f"Fitted at once are therefore {joined([cue_name(cue) for cue in kept])}.")
    return kept, said


def explained_means(
    study: StudyInfo, frame: pd.DataFrame, used: list[str], together: list[str]
) -> tuple[pd.DataFrame, list[str]]:
    """R squared of the means of the pictures that the factors made: by the factors, by each cue, by all cues; and why
    there is none by others."""
    levels, said = factor_columns(study)
    means = frame.assign(rating=frame["rating"] - frame["rating"].iloc[0]).groupby("picture")["rating"].mean()
    one_each = frame.drop_duplicates("picture").assign(participant="mean of all")
    known = one_each.assign(rating=one_each["picture"].map(means))
    known = known.merge(levels, on="picture") if len(levels) else known
    factors = [str(name) for name in levels.columns if name != "picture"]
    varied = [name for name in factors if not is_flat(known[name].to_numpy(dtype=float))]
    if factors and not varied:
        said.append("the pictures that were rated do not differ in the factors, so these explain nothing")
    sets = {BY_FACTORS: varied, **{cue_name(cue): [cue] for cue in used}, BY_CUES: together}
    rows = []
    without: dict[str, list[str]] = {}
    for name, predictors in sets.items():
        if not predictors:
            continue  # said above, or with the regression
        try:
            found = ExplainedMeans("rating", "participant", "picture", tuple(predictors))(known)
        except Undefined as reason:
            without.setdefault(str(reason), []).append(name)
        else:
            rows.append({"explained_by": name, **found.to_dict("records")[0]})
    said += [f"none by {joined(names)} ({reason})" for reason, names in without.items()]
    return pd.DataFrame(rows), said


def factor_columns(study: StudyInfo) -> tuple[pd.DataFrame, list[str]]:
    """`picture` and what its levels are as numbers: a column per numeric factor, else one per level but the first; and
    which factors have none."""
    made = [p for p in study.pictures if p.role == "factor" and p.levels]
    columns: dict[str, list[float]] = {}
    said = []
    for factor in study.factors:
        given = [dict(p.levels).get(factor.name) for p in made]
        numbers = [float(level) for level in given if isinstance(level, int | float) and not isinstance(level, bool)]
        if None in given:  # a picture without a level has no place on the factor's axis
            if any(level is not None for level in given):
                said.append(f"the factor {factor.name} is left out, as not every picture has a level of it")
        elif len(numbers) == len(given):
            columns[factor.name] = numbers
        else:
            for level in factor.levels[1:]:
                columns[f"{factor.name} {level}"] = [float(other == level) for other in given]
    return (pd.DataFrame({"picture": [p.id for p in made], **columns}) if columns else pd.DataFrame()), said
