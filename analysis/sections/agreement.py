"""How far people agree with each other and with themselves."""

import pandas as pd

from analysis.agreement_tables import table_of_raters, table_of_retests, table_of_stability
from analysis.evidence import Evidence
from analysis.quality import showings
from analysis.reliability import rater_table, retest_table, stability_table
from analysis.section import Section, rendered
from analysis.wording import counted, no_zero, sentence_case

HARDLY = 0.1  # Krippendorff's alpha: far below the .667 that he asks of the most tentative conclusion


def agreement(evidence: Evidence) -> Section | None:
    """Intraclass correlations, Krippendorff's alpha, and test-retest on pictures shown more than once."""
    study = evidence.study
    raters, notes = rater_table(evidence.sample, study)
    shown = showings(evidence.sample.everything, study)
    retests = retest_table(shown, study)
    stability, said = stability_table(shown, study)
    notes = [*notes, *dropped_people(raters), *said, *hardly_agree(raters, evidence)]
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


def hardly_agree(raters: pd.DataFrame, evidence: Evidence) -> list[str]:
    """Questions with a significant test on which one person's ratings say next to nothing about another's."""
    said = []
    for entry in raters.to_dict("records") if len(raters) else ():
        mine = [each for each in evidence.main if each.row.question == entry["question"] and each.anova is not None]
        significant = [
            each for each in mine if (p := each.deciding_p(evidence.plan)) is not None and p < evidence.plan.alpha
        ]
        if significant and entry["alpha"] < HARDLY:
            tests = f"{counted(len(significant), 'test')} {'is' if len(significant) == 1 else 'are'}"
            said.append(
                f"{sentence_case(str(entry['question']))}: {tests} significant although raters hardly agree "
                f"(Krippendorff’s α = {no_zero(entry['alpha'], 2)}): means differ, but less than people do."
            )
    return said


def dropped_people(raters: pd.DataFrame) -> list[str]:
    """The ICC knows no missing answers: whom it leaves out is said."""
    if raters.empty:
        return []
    return [
        f"Agreement on {entry['question']}: the ICC leaves out {counted(int(entry['icc_dropped']), 'participant')} "
        "with a missing answer; Krippendorff’s alpha keeps them."
        for entry in raters[raters["icc_dropped"] > 0].to_dict("records")
    ]
