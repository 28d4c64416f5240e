"""The tests that fit the design: means, ranks, all pairs."""

from analysis.evidence import Evidence
from analysis.remarks import agreement_of_tests
from analysis.section import Section, rendered
from analysis.tables import table_of_pairs, table_of_tests, tables_of_ranks


def tests(evidence: Evidence) -> Section:
    """Corrected tests with effect sizes, tests of ranks, whether they agree, and every pair."""
    body = rendered(
        "tests",
        tests=table_of_tests(evidence.main),
        ranks=tables_of_ranks(evidence.main),
        agreement=agreement_of_tests(evidence.main, evidence.plan.alpha),
        pairs=table_of_pairs(evidence.main, evidence.plan.confidence),
    )
    return Section("tests", "Tests for this design", body)
