"""The tests that fit the design: means, ranks, pairs, and the contrasts that were planned."""

from analysis.evidence import Evidence
from analysis.pair_tables import table_of_contrasts, table_of_pairs, table_of_planned
from analysis.planned import planned_sentences, planned_summary, planned_table
from analysis.records import contrasts_table, tests_table
from analysis.section import Section, rendered
from analysis.tables import table_of_tests, tables_of_ranks


def tests(evidence: Evidence) -> Section:
    """Corrected tests with effect sizes, tests of ranks, every pair, planned contrasts."""
    plan, main = evidence.plan, evidence.main
    planned, notes = planned_table(evidence.sample, plan)
    body = rendered(
        "tests",
        tests=table_of_tests(main, plan),
        ranks=tables_of_ranks(main),
        pairs=table_of_pairs(main, plan.confidence),
        contrasts=table_of_contrasts(main, plan),
        planned=table_of_planned(planned, plan),
    )
    tables = {"tests": tests_table(main), "contrasts": contrasts_table(main)}
    if plan.contrast:
        tables["planned"] = planned
    return Section(
        "tests",
        "Tests for this design",
        body,
        tables,
        summary=planned_summary(planned, plan),
        sentences=tuple(planned_sentences(planned, plan)),
        warnings=tuple(notes),
    )
