"""Ratings turned into statements: the published tables, and what is right for the design.

Statistics are loaded when first asked for, so that checking a plan does not wait for the statistics libraries.
"""

from importlib import import_module
from typing import Any

STATISTICS = {
    "Adjusted": "analysis.statistics.multiplicity",
    "CueRegression": "analysis.statistics.cues",
    "CueSlopes": "analysis.statistics.cues",
    "Equivalence": "analysis.statistics.equivalence",
    "ExplainedMeans": "analysis.statistics.cues",
    "FactorialAnova": "analysis.statistics.factorial",
    "Friedman": "analysis.statistics.friedman",
    "IntraclassCorrelation": "analysis.statistics.agreement",
    "KrippendorffAlpha": "analysis.statistics.agreement",
    "MeanIntervals": "analysis.statistics.intervals",
    "MixedModel": "analysis.statistics.mixed",
    "OneWayAnova": "analysis.statistics.anova",
    "OrdinalRegression": "analysis.statistics.ordinal",
    "PairedContrasts": "analysis.statistics.contrasts",
    "PlannedContrast": "analysis.statistics.planned",
    "RepeatedMeasuresAnova": "analysis.statistics.anova",
    "SignedRanks": "analysis.statistics.wilcoxon",
    "SimpleEffects": "analysis.statistics.simple_effects",
    "TukeyHSD": "analysis.statistics.tukey",
    "VarianceComponents": "analysis.statistics.variance",
    "read_ratings": "analysis.ratings",
    "write_report": "analysis.report",
}
__all__ = sorted(STATISTICS)


def __getattr__(name: str) -> Any:
    """The public name, from the module that defines it."""
    if name not in STATISTICS:
        raise AttributeError(f"module 'analysis' has no attribute {name!r}")
    return getattr(import_module(STATISTICS[name]), name)
