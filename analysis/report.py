"""The report: one page to read, tables and figures to reuse, numbers for machines."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.evidence import Progress, gather
from analysis.figures.style import letters_missing
from analysis.files import plain, save
from analysis.levels import from_ratings, read_levels
from analysis.one_core import on_one_core
from analysis.page import render_page, sections_of
from analysis.plan import AnalysisPlan, margins_not_asked, refuse_margins
from analysis.provenance import provenance
from analysis.ratings import DEFAULT_SCALE, is_check, read_ratings
from analysis.remarks import remarks
from analysis.sample import Sample, draw_sample
from analysis.study import StudyInfo, read_manifest
from fakesss.problem import BadInput

FINE, COARSE = 0.2, 1e13  # span below which two decimals hide differences; size beyond which float64 has no decimals


@on_one_core
def write_report(
    ratings: Path,
    out: Path,
    *,
    manifest: Path | None = None,
    plan: AnalysisPlan | None = None,
    participants: Path | None = None,
    columns: Mapping[str, str] | None = None,
    wide: str | None = None,
    factors: Mapping[str, str] | None = None,
    scale: int | None = DEFAULT_SCALE,
    command: str | None = None,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Writes index.html, results.json, tables/*.csv and figures/*.svg, *.png into `out`; returns what is in
    results.json.

    `ratings`: long CSV (contract.md's columns, or others named by `columns` or their aliases), or a wide one (`wide`:
    the form of its pictures' columns, "img*"). `manifest`: the study's manifest.json, for factors, labels, scales and
    pictures; without it `factors` names columns that hold levels (factor -> column; without any every picture is
    compared with every other) and answers are 1..`scale`, or any number where it is None. `plan`: overrides the
    manifest's `[analysis]`. `participants`: CSV of all who started. `command`: stands in the session block.
    `progress(done, total, what)` is called before each analysis and at the end. Raises `BadInput` for what a user can
    mend. Equal input gives equal bytes, on any number of cores: linear algebra runs on one, as sums of several threads
    differ in their last digits.
    """
    study, frame = study_and_answers(ratings, manifest, columns, wide, factors, scale)
    plan = plan or study.plan
    refuse_margins(plan, {q.name: q.scale for q in study.questions}, "plan")
    asked_of = frame["question"].isin([q.name for q in study.questions])
    sample = draw_sample(frame[asked_of | is_check(frame)], plan, participants)
    evidence = gather(study, plan, sample, frame, progress)
    sections = sections_of(evidence)
    drawings = [drawing for section in sections for drawing in section.drawings]
    slips = [*margins_not_asked(plan, [q.name for q in study.questions]), *decimals_lost(study, sample.ratings)]
    notes = [*slips, *evidence.notes, *(sentence for section in sections for sentence in section.warnings)]
    said = [*remarks(study, plan, sample, frame, evidence.main, notes), *letters_missing(drawings)]
    tables = {name: table for section in sections for name, table in section.tables.items()}
    origin = provenance(ratings, frame, study, command or f"write_report({ratings.name})")
    results = results_json(study, plan, sample, tables, said, origin)
    save(out, render_page(evidence, sections, said, origin), results, tables, drawings)
    return results


def study_and_answers(
    ratings: Path,
    manifest: Path | None,
    columns: Mapping[str, str] | None,
    wide: str | None,
    factors: Mapping[str, str] | None,
    scale: int | None,
) -> tuple[StudyInfo, pd.DataFrame]:
    """What was asked, by the manifest or by the answers alone, and the answers: see `write_report`."""
    known = read_manifest(manifest) if manifest is not None else None
    refuse_contradictions(known is not None, wide, factors)
    scales = {q.name: q.scale for q in known.questions} if known is not None else scale
    asked = known.questions[0].name if known is not None and len(known.questions) == 1 else None
    frame = read_ratings(ratings, columns, scales, wide=wide, question=asked)
    study = known or from_ratings(
        frame, f"Ratings in {ratings.name}", scale, list(factors or {}),
        read_levels(ratings, columns or {}, factors) if factors else None,
    )  # fmt: skip
    frame = with_repeats(frame, study)
    refuse_strangers(study, frame, ratings)
    return study, frame


def results_json(
    study: StudyInfo,
    plan: AnalysisPlan,
    sample: Sample,
    tables: Mapping[str, pd.DataFrame],
    said: list[str],
    origin: dict[str, str],
) -> dict[str, Any]:
    """contract.md's shape, and beside it who was left out, means, agreement and the session."""
    return {
        "title": study.title,
        "n_started": sample.n_started,
        "n_completed": sample.n_completed,
        "n_analysed": sample.n_analysed,
        "mode": sample.mode,
        "alpha": plan.alpha,
        "took_part_twice": [{"participant": who, "session_left_out": name} for who, name in sample.set_aside],
        **{name: plain(table) for name, table in tables.items()},
        "warnings": said,
        "session": origin,
    }


def with_repeats(frame: pd.DataFrame, study: StudyInfo) -> pd.DataFrame:
    """`frame` with `repeat_of` by the study, where the file has no such column, as a wide one."""
    again = {picture.id: picture.same_picture_as or "" for picture in study.pictures if picture.role == "repeat"}
    if "repeat_of" in frame or not again:
        return frame
    return frame.assign(repeat_of=[again.get(picture, "") for picture in frame["stimulus"]])


def decimals_lost(study: StudyInfo, ratings: pd.DataFrame) -> list[str]:
    """A sentence for each question on a free scale whose numbers the page's two decimals do not show."""
    said = []
    for question in study.questions:
        given = ratings.loc[ratings["question"] == question.name, "rating"]
        far, spread = given.abs().max(), given.max() - given.min()
        if question.scale is None and (0 < spread < FINE or far > COARSE):
            said.append(
                f"Ratings of {question.name} lie from {given.min():.4g} to {given.max():.4g}, and the page prints two "
                "decimals; multiply them by a power of ten, or read the numbers in the tables' files."
            )
    return said


def refuse_contradictions(has_study: bool, wide: str | None, factors: Mapping[str, str] | None) -> None:
    """Levels come from the study, or from a column of a file with a row per rating."""
    if factors and has_study:
        raise BadInput("factors: the study says which picture has which level; leave --factor out, or the study")
    if factors and wide is not None:
        raise BadInput(
            "factors: a file with a column for each picture has none for their levels; write one row per rating "
            "(pandas: frame.melt), then name the column of each factor"
        )


def refuse_strangers(study: StudyInfo, frame: pd.DataFrame, ratings: Path) -> None:
    """Ratings of none of the study's pictures or questions belong to another study."""
    known = {"stimulus": [p.id for p in study.pictures], "question": [q.name for q in study.questions]}
    for column, names in known.items():
        if not set(names) & set(frame[column].unique()):
            raise BadInput(
                f'{ratings}: no {column} of it is in the study (it has "{frame[column].iloc[0]}", the study has '
                f'"{next(iter(names), "none")}"); are these ratings of another study?'
            )
