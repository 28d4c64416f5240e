"""No public statistic says p = 0, however sure: what float64 cannot hold stands as its smallest number."""

from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest

from analysis import STATISTICS
from analysis.statistics import (
    agreement,
    anova,
    contrasts,
    cues,
    equivalence,
    factorial,
    friedman,
    mixed,
    multiplicity,
    ordinal,
    planned,
    simple_effects,
    tukey,
    wilcoxon,
)
from analysis.statistics.diagnostics import EqualSpread, Residuals
from analysis.statistics.undefined import SMALLEST_P

WITHIN = ("rating", "condition", "participant")
WITHOUT_P = {"MeanIntervals", "KrippendorffAlpha", "VarianceComponents", "read_ratings", "write_report"}
CASES: dict[str, Callable[[pd.DataFrame], pd.DataFrame]] = {
    "Adjusted": lambda _: multiplicity.Adjusted("p", "holm")(pd.DataFrame({"p": [SMALLEST_P, 0.5]})),
    "OneWayAnova": lambda f: anova.OneWayAnova("rating", "condition")(f),
    "RepeatedMeasuresAnova": lambda f: anova.RepeatedMeasuresAnova(*WITHIN)(f),
    "TukeyHSD": lambda f: tukey.TukeyHSD(*WITHIN)(f),
    "Friedman": lambda f: friedman.Friedman(*WITHIN)(f),
    "SignedRanks": lambda f: wilcoxon.SignedRanks(*WITHIN)(two(f)),
    "PairedContrasts": lambda f: contrasts.PairedContrasts(*WITHIN)(f),
    "PlannedContrast": lambda f: planned.PlannedContrast(*WITHIN, {"a1": -1, "b1": 1})(f),
    "Equivalence": lambda f: equivalence.Equivalence(*WITHIN, 1.0)(f),
    "IntraclassCorrelation": lambda f: agreement.IntraclassCorrelation(*WITHIN)(f),
    "FactorialAnova": lambda f: factorial.FactorialAnova("rating", ("letter", "digit"), "participant")(f),
    "SimpleEffects": lambda f: simple_effects.SimpleEffects("rating", ("letter", "digit"), "participant")(f),
    "MixedModel": lambda f: mixed.MixedModel("rating", ("condition",), "participant", None)(f),
    "OrdinalRegression": lambda f: ordinal.OrdinalRegression("rating", ("condition",))(graded(f)),
    "CueSlopes": lambda f: cues.CueSlopes("rating", "participant", "condition", ("cue",))(f),
    "CueRegression": lambda f: cues.CueRegression("rating", "participant", "condition", ("cue", "other"))(f),
    "ExplainedMeans": lambda f: cues.ExplainedMeans("rating", "participant", "condition", ("cue",))(f),
    "EqualSpread": lambda f: EqualSpread("rating", "condition")(f),
    "Residuals": lambda f: Residuals("rating", "condition", "participant")(f),
}


@pytest.fixture(scope="module")
def sure() -> pd.DataFrame:
    """1,200 people's ratings of four pictures as unlike in place and in spread as can be."""
    random = np.random.default_rng(3)
    table = np.array([1, 30, 60, 95]) + random.normal(size=(1200, 4)) * [0.1, 1, 2, 9]
    return pd.DataFrame(
        {
            "participant": np.repeat(np.arange(1200), 4),
            "condition": ["a1", "a2", "b1", "b2"] * 1200,
            "letter": ["a", "a", "b", "b"] * 1200,
            "digit": ["1", "2"] * 2400,
            "cue": [1.0, 30.0, 60.0, 95.1] * 1200,
            "other": [1.0, -1.0, -1.0, 1.5] * 1200,
            "rating": table.ravel(),
        }
    )


def two(frame: pd.DataFrame) -> pd.DataFrame:
    """Two of the pictures."""
    return frame[frame["condition"].isin(["a1", "b2"])]


def graded(frame: pd.DataFrame) -> pd.DataFrame:
    """Six ordered answers that no picture has to itself."""
    return frame.assign(rating=frame["cue"].rank(method="dense") + (frame["rating"] * 1000).round() % 3)


@pytest.mark.parametrize("name", CASES)
def test_no_p_is_zero(sure: pd.DataFrame, name: str) -> None:
    """Every column of p values."""
    table = CASES[name](sure)
    columns = [str(name) for name in table if name == "p" or str(name).startswith("p_") or str(name).endswith("_p")]
    p = table[columns].astype(float).to_numpy()
    assert columns and p[~np.isnan(p)].min() >= SMALLEST_P


def test_every_public_statistic_is_asked() -> None:
    """A new one comes with its case here."""
    assert set(STATISTICS) - WITHOUT_P <= set(CASES)
