"""What in the pictures goes along with the ratings: image cues, one at a time and together."""

from collections.abc import Hashable, Sequence
from typing import Any

import pandas as pd

from analysis.cue_findings import BY_CUES, BY_FACTORS, CueFindings, cue_name, cue_table, find_cues
from analysis.evidence import Evidence
from analysis.figures.cues import cue_figure
from analysis.section import Section, rendered
from analysis.tables import Table
from analysis.wording import apa_df, apa_p, no_zero, sentence_case, signed, thesis_p

ELSEWHERE = (
    "Pictures made elsewhere have cues of their whole area, background included, and no thickness: they are listed in "
    "tables/cues.csv and not analysed here."
)


def cues(evidence: Evidence) -> Section | None:
    """Slopes, figures and shares explained. None where the manifest has no cues, or no question two own pictures."""
    listed = cue_table(evidence.study)
    if listed.empty:
        return None
    questions = [q.name for q in evidence.study.questions if q.name in set(evidence.sample.ratings["question"])]
    found = [one for question in questions if (one := find_cues(evidence, question)) is not None]
    if not found:
        return None
    figures = [cue_figure(evidence.study, one, number) for number, one in enumerate(found, 1)]
    drawings = tuple(figure for figure in figures if figure is not None)
    said = list(dict.fromkeys(sentence for one in found for sentence in one.said))
    if "compare" in set(listed["role"]):
        said.append(ELSEWHERE)
    level = f"{evidence.plan.confidence:.0%} CI"
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
    sentences = tuple(sentence for one in found if (sentence := apa_cue(one, level)))
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


def best(one: CueFindings) -> dict[Hashable, Any] | None:
    """The tested cue whose slope is steepest; None without any."""
    if one.slopes is None or not one.slopes["p"].notna().any():
        return None
    tested = one.slopes[one.slopes["p"].notna()].to_dict("records")
    return max(tested, key=lambda cue: abs(float(cue["slope"])))


def strongest(one: CueFindings, alpha: float) -> str:
    """For the paragraph that stands first: which cue goes along most with the question."""
    found = best(one)
    if found is None:
        return ""
    what = sentence_case(one.question)
    if found["p_holm"] >= alpha:
        return f"{what}: no image cue goes along with it beyond chance (Holm over {len(one.used)} cues)."
    more = "more" if found["slope"] > 0 else "less"
    return (
        f"{what} goes along most with {cue_name(str(found['cue']))}: rated {abs(found['slope']):.2f} {more} for each "
        f"standard deviation more of it between pictures, {apa_p(found['p_holm'])} (Holm); an association, not a cause."
    )


def apa_cue(one: CueFindings, level: str) -> str:
    """A sentence to paste about the steepest slope."""
    found = best(one)
    if found is None:
        return ""
    return (
        f"Within participants, ratings of “{one.question}” were regressed on each standardised image cue over "
        f"{found['pictures']:.0f} different pictures; the steepest mean slope was that on "
        f"{cue_name(str(found['cue']))}, b = {signed(found['slope'])}, {level} "
        f"[{signed(found['ci_low'])}, {signed(found['ci_high'])}], "
        f"t({apa_df(found['df'])}) = {signed(found['t'])}, {apa_p(found['p_holm'])} (Holm over {len(one.used)} cues)."
    )


def table_of_slopes(found: Sequence[CueFindings], level: str) -> Table | None:
    """Each cue by itself."""
    rows = tuple(
        (one.question if place == 0 else "", cue_name(str(cue["cue"])), *slope_cells(cue))
        for one in found
        if one.slopes is not None
        for place, cue in enumerate(one.slopes.to_dict("records"))
    )
    head = ("Question", "Cue", "r of means", "Slope", level, "t", "df", "p", "Holm")
    note = (
        "Slope: steps of the scale for one standard deviation of the cue between the pictures, the mean of every "
        "person’s own slope, tested against 0. Holm: p adjusted over the cues of a question. r: correlation of the "
        "pictures’ mean ratings with the cue."
    )
    caption = "One cue at a time: the slope of each person’s ratings on the cue"
    return Table("table-cue-slopes", caption, head, rows, text_columns=2, note=note) if rows else None


def slope_cells(cue: dict[Hashable, Any]) -> tuple[str, ...]:
    """The numbers of one cue; dashes where all people have the same slope."""
    r = "–" if pd.isna(cue["r"]) else no_zero(cue["r"], 2)
    if pd.isna(cue["p"]):
        return (r, signed(cue["slope"]), "–", "–", f"{cue['df']:.0f}", "–", "–")
    interval = f"[{signed(cue['ci_low'])}, {signed(cue['ci_high'])}]"
    test = (signed(cue["t"]), f"{cue['df']:.0f}", thesis_p(cue["p"]), thesis_p(cue["p_holm"]))
    return (r, signed(cue["slope"]), interval, *test)


def table_of_regression(found: Sequence[CueFindings], level: str) -> Table | None:
    """All cues that fit at once; None where no question has enough pictures."""
    rows = tuple(
        (
            one.question if place == 0 else "",
            cue_name(str(cue["cue"])),
            signed(cue["slope"]),
            f"[{signed(cue['ci_low'])}, {signed(cue['ci_high'])}]",
            signed(cue["t"]),
            thesis_p(cue["p"]),
            f"{cue['vif']:.1f}",
        )
        for one in found
        if one.joint is not None
        for place, cue in enumerate(one.joint.to_dict("records"))
    )
    head = ("Question", "Cue", "Slope", level, "t", "p", "VIF")
    note = (
        "Least squares of all ratings on all these cues, standard errors clustered by participant. A slope is what one "
        "standard deviation of the cue adds while the others stay. VIF: how much larger its variance is than if the "
        "cue went along with no other. p unadjusted."
    )
    return Table("table-cue-regression", "Cues at once", head, rows, text_columns=2, note=note) if rows else None


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
