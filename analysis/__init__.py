"""Ratings turned into statements: the published tables, and what is right for the design.

Statistics are loaded when first asked for, so that checking a plan does not wait for the statistics libraries.
"""

from importlib import import_module
from typing import Any

STATISTICS = {
    "Equivalence": "analysis.equivalence",
    "Friedman": "analysis.friedman",
    "IntraclassCorrelation": "analysis.agreement",
    "KrippendorffAlpha": "analysis.agreement",
    "MeanIntervals": "analysis.intervals",
    "OneWayAnova": "analysis.anova",
    "PairedContrasts": "analysis.contrasts",
    "RepeatedMeasuresAnova": "analysis.anova",
    "SignedRanks": "analysis.wilcoxon",
    "TukeyHSD": "analysis.tukey",
    "read_ratings": "analysis.ratings",
    "write_report": "analysis.report",
}
__all__ = sorted(STATISTICS)


def __getattr__(name: str) -> Any:
    """The public name, from the module that defines it."""
    if name not in STATISTICS:
        raise AttributeError(f"module 'analysis' has no attribute {name!r}")
    return getattr(import_module(STATISTICS[name]), name)
