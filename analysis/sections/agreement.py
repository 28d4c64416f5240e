"""How far people agree with each other and with themselves."""

from analysis.evidence import Evidence
from analysis.reliability import rater_table, retest_table
from analysis.section import Section, rendered
from analysis.tables import table_of_raters, table_of_retests


def agreement(evidence: Evidence) -> Section | None:
    """Intraclass correlations, Krippendorff's alpha, and test-retest on pictures shown more than once."""
    raters, notes = rater_table(evidence.sample, evidence.study)
    retests = retest_table(evidence.sample.everything, evidence.study)
    tables = {"agreement": raters, "retest": retests}
    body = rendered("agreement", raters=table_of_raters(raters), retests=table_of_retests(retests))
    if raters.empty and retests.empty and not notes:
        return None
    return Section("agreement", "Agreement", body, tables, warnings=tuple(notes))
