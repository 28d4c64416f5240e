"""How far people agree with each other and with themselves."""

import pandas as pd

from analysis.agreement_tables import table_of_raters, table_of_retests, table_of_stability
from analysis.evidence import Evidence
from analysis.quality import showings
from analysis.reliability import rater_table, retest_table, stability_table
from analysis.section import Section, rendered
from analysis.wording import counted


def agreement(evidence: Evidence) -> Section | None:
    """Intraclass correlations, Krippendorff's alpha, and test-retest on pictures shown more than once."""
    study = evidence.study
    raters, notes = rater_table(evidence.sample, study)
    shown = showings(evidence.sample.everything, study)
    retests = retest_table(shown, study)
    stability, said = stability_table(shown, study)
    notes = [*notes, *dropped_people(raters), *said]
    tables = {"agreement": raters, "retest": retests, "test_retest": stability}
    body = rendered(
        "agreement",
        raters=table_of_raters(raters),
        retests=table_of_retests(retests),
        stability=table_of_stability(stability),
    )
    if raters.empty and retests.empty and not notes:
        return None
    return Section("agreement", "Agreement", body, tables, warnings=tuple(notes))


def dropped_people(raters: pd.DataFrame) -> list[str]:
    """The ICC knows no missing answers: whom it leaves out is said."""
    if raters.empty:
        return []
    return [
        f"Agreement on {entry['question']}: the ICC leaves out {counted(int(entry['icc_dropped']), 'participant')} "
        "with a missing answer; Krippendorff’s alpha keeps them."
        for entry in raters[raters["icc_dropped"] > 0].to_dict("records")
    ]
