"""Interactions of a full factorial: lines that are parallel or not, and the simple effects behind them."""

from analysis.evidence import Evidence
from analysis.figures.interaction import interaction_figures
from analysis.interaction_sentences import simple_effects_sentence
from analysis.pair_tables import table_of_simple_effects
from analysis.records import simple_table
from analysis.section import Section, rendered


def interactions(evidence: Evidence) -> Section | None:
    """Plot and simple effects; None where the design is no factorial, or an incomplete one."""
    found = [each for each in evidence.main if each.row.kind == "interaction"]
    if not found:
        return None
    drawings = interaction_figures(evidence.study, evidence.main, evidence.plan.confidence)
    simple = table_of_simple_effects(found)
    body = rendered("interactions", drawings=drawings, simple=simple)
    sentences = (simple_effects_sentence(each, evidence.plan) for each in found)
    return Section(
        "interactions",
        "Interactions",
        body,
        {"simple_effects": simple_table(found)},
        tuple(drawings),
        sentences=tuple(sentence for sentence in sentences if sentence),
    )
