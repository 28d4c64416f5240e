"""The ratings in figures: means over every answer, as the thesis's figures 4.5 and 4.6."""

from analysis.evidence import Evidence
from analysis.figures.means import comparison_figure, factor_figure
from analysis.records import means_table
from analysis.section import Section, rendered


def ratings(evidence: Evidence) -> Section | None:
    """Means by factor and of the pictures compared."""
    study, confidence = evidence.study, evidence.plan.confidence
    figures = factor_figure(study, evidence.main, confidence), comparison_figure(study, evidence.main, confidence)
    drawings = tuple(figure for figure in figures if figure is not None)
    if not drawings:
        return None
    tables = {"means": means_table([*evidence.main, *evidence.other])}
    return Section("figures", "Figures", rendered("ratings", drawings=drawings), tables, drawings)
