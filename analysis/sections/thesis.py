"""The thesis's tables 4.4 and 4.5, in the design's mode and in the other."""

from collections.abc import Sequence

from analysis.evidence import Evidence
from analysis.plan import AnalysisPlan
from analysis.records import anova_table, hsd_table, tukey_table
from analysis.results import METHODS, Analysed
from analysis.section import Section, rendered
from analysis.tables import SHOWN_LEVELS, Table, table_4_4, table_4_5


def thesis(evidence: Evidence) -> Section:
    """Both tables under both assumptions."""
    found = [*evidence.main, *evidence.other]
    shown = thesis_tables(evidence.main, evidence.other, evidence.plan)
    body = rendered("thesis", tables=shown, method=METHODS[evidence.sample.mode])
    tables = {"anova": anova_table(found), "tukey": tukey_table(found), "hsd": hsd_table(found)}
    return Section("thesis", "Tables 4.4 and 4.5", body, tables)


def thesis_tables(main: Sequence[Analysed], other: Sequence[Analysed], plan: AnalysisPlan) -> list[Table]:
    """Tables 4.4 and 4.5 in the design's mode, then in the other."""
    tables = []
    for found in (main, other):
        part = [each for each in found if each.row.kind != "interaction"]
        if part:
            tables.append(table_4_4(part, plan))
            tables += [table_4_5(each) for each in part if in_full(each)]
    return tables


def in_full(each: Analysed) -> bool:
    """Whether the comparison's pairs are few enough for a table on the page."""
    return each.row.kind != "factor" and each.tukey is not None and len(each.row.levels) <= SHOWN_LEVELS
