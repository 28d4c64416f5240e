"""Who took part, who is analysed, and who was left out by which rule."""

from analysis.evidence import Evidence
from analysis.plan import Exclusions
from analysis.section import Section, rendered


def people(evidence: Evidence) -> Section:
    """Counts, the rules written before the data, and everyone they left out."""
    body = rendered("people", sample=evidence.sample, plan=evidence.plan, rules=declared_rules(evidence.plan.exclude))
    return Section("people", "People", body)


def declared_rules(rules: Exclusions) -> list[str]:
    """The exclusion rules in words."""
    said = []
    if rules.failed_checks is not None:
        said.append(f"{rules.failed_checks} or more failed attention checks")
    if rules.median_rt_ms_below is not None:
        said.append(f"median answer time below {rules.median_rt_ms_below:g} ms")
    if rules.same_answer_share is not None:
        said.append(f"one answer in {rules.same_answer_share:.0%} or more of the ratings")
    return said
