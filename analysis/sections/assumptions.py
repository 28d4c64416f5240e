"""What the tests take for granted: sphericity or equal spread, residuals, room at the scale's ends, people enough."""

from analysis.assumptions import assumption_table, cautions, crowded, ends_table, table_of_assumptions
from analysis.evidence import Evidence
from analysis.section import Section, rendered


def assumptions(evidence: Evidence) -> Section | None:
    """The assumption box, and warnings where it matters."""
    sample, study = evidence.sample, evidence.study
    table, ends = assumption_table(evidence.main), ends_table(sample.ratings, study)
    if table.empty and ends.empty:
        return None
    at_ends = crowded(ends, study)
    said = [*cautions(table, evidence.main, evidence.plan), *at_ends] if len(table) else at_ends
    shown = table_of_assumptions(table, evidence.main, sample.mode) if len(table) else None
    body = rendered("assumptions", table=shown, ends=at_ends, judged=len(ends) > 0)
    tables = {"assumptions": table, "scale_ends": ends}
    return Section("assumptions", "Assumptions", body, tables, warnings=tuple(said))
