"""Who took part, who is analysed for which picture, who was left out by which rule, and how carefully they answered."""

import pandas as pd

from analysis.cells import cell_table, in_every_cell, table_of_cells
from analysis.evidence import Evidence
from analysis.labels import natural_key
from analysis.plan import AnalysisPlan
from analysis.quality import TOO_FAST_MS, quality_table
from analysis.results import METHODS
from analysis.sample import Sample
from analysis.section import Section, rendered
from analysis.standing_out import summary_of, table_of_those, with_reasons
from analysis.tables import Table
from analysis.wording import counted, joined, percent

LEFT_OUT = ("participant", "rule", "reason")


def people(evidence: Evidence) -> Section:
    """Counts, the rules written before the data and whom they left out, counts per cell, answer quality."""
    sample, plan = evidence.sample, evidence.plan
    cells = cell_table(sample, evidence.study)
    bound = plan.exclude.median_rt_ms_below or TOO_FAST_MS
    quality = with_reasons(quality_table(sample.of_everyone, evidence.study, bound), evidence.study)
    quality.insert(1, "analysed", quality["participant"].isin(sample.ratings["participant"].unique()))
    left_out = pd.DataFrame(
        [(each.participant, each.rule, each.reason) for each in sample.left_out], columns=list(LEFT_OUT)
    )
    everywhere = in_every_cell(cells)
    said = summary_of(quality)
    said_first = [*not_independent(evidence), *look_alikes(evidence.ratings)]
    body = rendered(
        "people",
        sample=sample,
        method=METHODS[sample.mode],
        chosen="as declared" if plan.mode != "auto" else why_mode(sample),
        declared=bool(plan.model_fields_set),
        rules=table_of_rules(plan, sample),
        everywhere=everywhere,
        cells=None if everywhere else table_of_cells(cells),
        quality=said,
        odd=table_of_those(quality, bound),
    )
    tables = {"cells": cells, "participants": told(quality), "excluded": left_out}
    return Section("people", "People", body, tables, summary=(said,), warnings=tuple(said_first))


def told(quality: pd.DataFrame) -> pd.DataFrame:
    """The table without the measures that the file does not tell; `reason`: why a correlation is missing."""
    why = "no correlation: fewer than 3 ratings that others gave too, or all equal within their question"
    missing = quality["person_rest_r"].isna()
    return quality.dropna(axis=1, how="all").assign(reason=[why if none else "" for none in missing])


def why_mode(sample: Sample) -> str:
    """What the design showed."""
    if sample.mode == "repeated":
        return "people rated more than one picture on a question"
    return "nobody rated two pictures on one question"


def table_of_rules(plan: AnalysisPlan, sample: Sample) -> Table:
    """Every rule, whether declared, and how many it left out (a person may break several)."""
    count = {rule: sum(each.rule == rule for each in sample.left_out) for rule in declared_rules(plan)}
    rows = tuple((words, str(count[rule])) for rule, words in declared_rules(plan).items())
    return Table("table-rules", "Rules for leaving participants out", ("Rule", "Left out"), rows)


def declared_rules(plan: AnalysisPlan) -> dict[str, str]:
    """The rules in force, in words."""
    rules = plan.exclude
    said = {"withdrew": "withdrew their data"}
    if plan.completers_only:
        said["completers_only"] = "did not complete"
    if rules.failed_checks is not None:
        said["failed_checks"] = f"{rules.failed_checks} or more failed attention checks"
    if rules.median_rt_ms_below is not None:
        said["median_rt_ms_below"] = f"median answer time below {rules.median_rt_ms_below:g} ms"
    if rules.same_answer_share is not None:
        said["same_answer_share"] = f"one answer in {percent(rules.same_answer_share)} or more of the ratings"
    return said


def not_independent(evidence: Evidence) -> list[str]:
    """Samples declared independent that are of the same people."""
    if evidence.plan.mode != "independent":
        return []
    shared = [each for each in evidence.main if each.answers["participant"].duplicated().any()]
    if not shared:
        return []
    return [
        'mode = "independent" is declared, but people rated several of the pictures that are compared with each other '
        f"({len(shared)} of {counted(len(evidence.main), 'row')}): samples of the same people are not independent, and "
        'their p values are wrong; mode = "repeated" fits.'
    ]


def look_alikes(ratings: pd.DataFrame) -> list[str]:
    """Labels that differ in case or spaces alone: most often one label written in two ways."""
    said = []
    for column, several in (("participant", "Participants"), ("stimulus", "Pictures"), ("question", "Questions")):
        alike: dict[str, list[str]] = {}
        for label in ratings[column].unique():
            alike.setdefault("".join(str(label).casefold().split()), []).append(str(label))
        for labels in (sorted(names, key=natural_key) for names in alike.values() if len(names) > 1):
            quoted = joined([f'"{label}"' for label in labels])
            said.append(f"{several} {quoted} differ in case or spaces alone and count as {len(labels)}.")
    return said
