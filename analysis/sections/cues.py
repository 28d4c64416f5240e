"""What in the pictures goes along with the ratings: image cues, one at a time and together."""

from collections.abc import Hashable, Sequence
from typing import Any

import pandas as pd

from analysis.cue_findings import BY_CUES, BY_FACTORS, CueFindings, cue_name, cue_table, find_cues
from analysis.evidence import Evidence
from analysis.figures.cues import cue_figure
from analysis.section import Section, rendered
from analysis.tables import Table, told_once
from analysis.wording import apa_df, apa_p, counted, interval, no_zero, percent, sentence_case, signed, thesis_p

ELSEWHERE = (
    "Pictures of other origin have cues of their whole area, background included, and no thickness: they are listed in "
    "tables/cues.csv and not analysed here."
)
FEW = "“{}” is not analysed here: fewer than two different pictures of the study’s own were rated."


def cues(evidence: Evidence) -> Section | None:
    """Slopes, figures and shares explained. None where the manifest has no cues, or no question two own pictures."""
    listed = cue_table(evidence.study)
    if listed.empty:
        return None
    questions = [q.name for q in evidence.study.questions if q.name in set(evidence.sample.ratings["question"])]
    tried = {question: find_cues(evidence, question) for question in questions}
    found = [one for one in tried.values() if one is not None]
    if not found:
        return None
    figures = [cue_figure(evidence.study, one, number) for number, one in enumerate(found, 1)]
    drawings = tuple(figure for figure in figures if figure is not None)
    said = list(dict.fromkeys(sentence for one in found for sentence in one.said))
    said += [FEW.format(question) for question, one in tried.items() if one is None]
    if "compare" in set(listed["role"]):
        said.append(ELSEWHERE)
    level = f"{percent(evidence.plan.confidence)} CI"
    body = rendered(
        "cues",
        drawings=drawings,
        slopes=table_of_slopes(found, level),
        joint=table_of_regression(found, level),
        explained=table_of_explained(found),
        said=said,
    )
    tables = {"cues": listed, **machine_tables(found)}
    summary = tuple(sentence for one in found if (sentence := strongest(one, evidence.plan.alpha)))
    sentences = tuple(sentence for one in found if (sentence := apa_cue(one, evidence.plan.alpha, level)))
    return Section("cues", "Cues", body, tables, drawings, summary, sentences)


def machine_tables(found: Sequence[CueFindings]) -> dict[str, pd.DataFrame]:
    """Every number of the section, question by question."""
    parts = {"cue_slopes": "slopes", "cue_regression": "joint", "cue_explained": "explained"}
    tables = {}
    for name, attribute in parts.items():
        made = [(one.question, getattr(one, attribute)) for one in found]
        frames = [t.assign(question=question) for question, t in made if t is not None and len(t)]
        if frames:
            table = pd.concat(frames, ignore_index=True)
            tables[name] = table[["question", *(column for column in table.columns if column != "question")]]
    return tables


def steepest(slopes: pd.DataFrame) -> dict[Hashable, Any] | None:
    """The row of the steepest slope; None of an empty table."""
    return max(slopes.to_dict("records"), key=lambda cue: abs(float(cue["slope"])), default=None)


def beyond_chance(slopes: pd.DataFrame, alpha: float) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Cues that other people would go by on these pictures, and those that other pictures would show in these people.

    Equal slopes of everybody and means on a line have no test and need none.
    """
    everyone = slopes["p"].isna() & (slopes["slope"] != 0)
    line = slopes["p_pictures"].isna() & slopes["r"].notna() & (slopes["pictures"] > 2)
    return slopes[(slopes["p_holm"] < alpha) | everyone], slopes[(slopes["p_pictures_holm"] < alpha) | line]


def strongest(one: CueFindings, alpha: float) -> str:
    """For the paragraph that stands first: which cue goes along most with the question, and of whom that is true.

    That one does is claimed where neither other people nor other pictures would change it.
    """
    if one.slopes is None or not one.slopes[["p", "p_pictures"]].notna().any(axis=None):
        return ""
    what = sentence_case(one.question)
    people, pictures = beyond_chance(one.slopes, alpha)
    both = people[people["cue"].isin(pictures["cue"])]
    if (cue := steepest(both)) is not None:
        return (
            f"{what} goes along most with {name_of(cue)}: rated {by_how_much(cue)} ({of_people(one, cue)}); "
            f"{of_pictures(one, cue)}; an association, not a cause."
        )
    if (cue := steepest(people)) is not None:
        return (
            f"{what}: on these pictures it goes along most with {name_of(cue)}, rated {by_how_much(cue)} "
            f"({of_people(one, cue)}), but other pictures may not show it: {of_pictures(one, cue)}."
        )
    if (cue := steepest(pictures)) is not None:
        return (
            f"{what}: these participants’ means go along most with {name_of(cue)} ({of_pictures(one, cue)}), but other "
            f"participants may not show it: rated {by_how_much(cue)}, {of_people(one, cue)}."
        )
    return f"{what}: no image cue goes along with it beyond chance ({counted_in(one, 'p')})."


def name_of(cue: dict[Hashable, Any]) -> str:
    """As a reader calls it."""
    return cue_name(str(cue["cue"]))


def by_how_much(cue: dict[Hashable, Any]) -> str:
    """The slope in words."""
    more = "more" if cue["slope"] > 0 else "less"
    return f"{abs(cue['slope']):.2f} {more} for each standard deviation more of it between pictures"


def counted_in(one: CueFindings, p: str) -> str:
    """Over how many tests Holm's adjustment goes: those that have a p."""
    assert one.slopes is not None
    return f"Holm over {counted(int(one.slopes[p].notna().sum()), 'cue')}"


def of_people(one: CueFindings, cue: dict[Hashable, Any]) -> str:
    """The test of the slopes."""
    if pd.isna(cue["p"]):
        return "the same slope in everybody, so no test"
    return f"{apa_p(cue['p_holm'])}, {counted_in(one, 'p')}"


def of_pictures(one: CueFindings, cue: dict[Hashable, Any]) -> str:
    """The test of the correlation with the pictures' means."""
    if pd.isna(cue["r"]):
        return "the pictures’ means are all equal"
    if pd.isna(cue["p_pictures"]):
        few = cue["pictures"] <= 2
        return "two pictures allow no test of that" if few else "the pictures’ means are on a line, so no test"
    r = f"r = {no_zero(cue['r'], 2)} with the means of {cue['pictures']:.0f} pictures"
    return f"{r}, {apa_p(cue['p_pictures_holm'])}, {counted_in(one, 'p_pictures')}"


def apa_cue(one: CueFindings, alpha: float, level: str) -> str:
    """A sentence to paste about the steepest slope of those beyond chance, else of all that were tested."""
    if one.slopes is None:
        return ""
    tested = one.slopes[one.slopes["p"].notna()]
    people, pictures = beyond_chance(tested, alpha)
    both = people[people["cue"].isin(pictures["cue"])]
    chosen = next((found for found in (both, people) if len(found)), tested)
    cue = steepest(chosen)
    if cue is None:
        return ""
    which = "the steepest mean slope" if chosen is tested else "of the significant mean slopes the steepest"
    return (
        f"Within participants, ratings of “{one.question}” were regressed on each standardised image cue over "
        f"{cue['pictures']:.0f} different pictures; {which} was that on {name_of(cue)}, b = {signed(cue['slope'])}, "
        f"{level} {interval(cue['ci_low'], cue['ci_high'])}, t({apa_df(cue['df'])}) = {signed(cue['t'])}, "
        f"{of_people(one, cue)}, a test that takes these pictures as given; over pictures, {of_pictures(one, cue)}."
    )


def table_of_slopes(found: Sequence[CueFindings], level: str) -> Table | None:
    """Each cue by itself."""
    rows = tuple(
        (one.question if place == 0 else "", cue_name(str(cue["cue"])), *slope_cells(cue))
        for one in found
        if one.slopes is not None
        for place, cue in enumerate(one.slopes.to_dict("records"))
    )
    head = ("Question", "Cue", "r of means", "p of r, Holm", "Slope", level, "t", "df", "p", "p, Holm")
    note = (
        "r: correlation of the pictures’ mean ratings with the cue; its p tells whether other pictures would show it. "
        "Slope: steps of the scale for one standard deviation of the cue between the pictures, the mean of every "
        "person’s own slope, tested against 0; that p is of these pictures only and tells whether other people would "
        "show it. Holm: adjusted over the cues of a question."
    )
    caption = "One cue at a time: the slope of each person’s ratings on the cue"
    table = Table("table-cue-slopes", caption, head, rows, text_columns=2, note=note)
    return told_once(table, "df") if rows else None


def slope_cells(cue: dict[Hashable, Any]) -> tuple[str, ...]:
    """The numbers of one cue; dashes where all people have the same slope."""
    r = "–" if pd.isna(cue["r"]) else no_zero(cue["r"], 2)
    of_r = "–" if pd.isna(cue["p_pictures_holm"]) else thesis_p(cue["p_pictures_holm"])
    if pd.isna(cue["p"]):
        return (r, of_r, signed(cue["slope"]), "–", "–", f"{cue['df']:.0f}", "–", "–")
    test = (signed(cue["t"]), f"{cue['df']:.0f}", thesis_p(cue["p"]), thesis_p(cue["p_holm"]))
    return (r, of_r, signed(cue["slope"]), interval(cue["ci_low"], cue["ci_high"]), *test)


def table_of_regression(found: Sequence[CueFindings], level: str) -> Table | None:
    """All cues that fit at once; None where no question has enough pictures."""
    rows = tuple(
        (
            one.question if place == 0 else "",
            cue_name(str(cue["cue"])),
            signed(cue["slope"]),
            interval(cue["ci_low"], cue["ci_high"]),
            signed(cue["t"]),
            f"{cue['df']:.0f}",
            thesis_p(cue["p"]),
            f"{cue['vif']:.1f}",
        )
        for one in found
        if one.joint is not None
        for place, cue in enumerate(one.joint.to_dict("records"))
    )
    head = ("Question", "Cue", "Slope", level, "t", "df", "p", "VIF")
    note = (
        "Least squares of all ratings on all these cues, standard errors clustered by participant. A slope is what one "
        "standard deviation of the cue adds while the others stay. VIF: how much larger its variance is than if the "
        "cue went along with no other. p unadjusted, and of these pictures only."
    )
    table = Table("table-cue-regression", "Cues at once", head, rows, text_columns=2, note=note)
    return told_once(table, "df") if rows else None


def in_short(explained: pd.DataFrame) -> list[dict[Hashable, Any]]:
    """Without the cues one by one, of which the page has r already."""
    rows = explained.to_dict("records")
    return [row for row in rows if row["explained_by"] in (BY_FACTORS, BY_CUES)]


def table_of_explained(found: Sequence[CueFindings]) -> Table | None:
    """How much of the differences between pictures the factors and the cues explain."""
    rows = tuple(
        (
            one.question if place == 0 else "",
            str(row["explained_by"]),
            f"{row['predictors']:.0f}",
            f"{row['pictures']:.0f}",
            no_zero(row["r2"], 2),
            no_zero(row["r2_adjusted"], 2),
        )
        for one in found
        for place, row in enumerate(in_short(one.explained))
    )
    head = ("Question", "By", "Predictors", "Pictures", "R²", "R² adjusted")
    note = (
        "Linear regression of the mean ratings of the pictures that the factors made; factors of numbers count as "
        "numbers. With few pictures R² is large by itself: the adjusted one allows for the number of predictors."
    )
    caption = "Share of the variance between the pictures’ means that is explained"
    return Table("table-cue-explained", caption, head, rows, text_columns=2, note=note) if rows else None
