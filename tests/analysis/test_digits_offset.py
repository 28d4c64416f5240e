"""Ratings on a scale that starts at 1e12 keep their digits through reading and through every statistic."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import analysis
from analysis import (
    Equivalence,
    FactorialAnova,
    Friedman,
    IntraclassCorrelation,
    KrippendorffAlpha,
    MeanIntervals,
    OneWayAnova,
    PairedContrasts,
    PlannedContrast,
    RepeatedMeasuresAnova,
    SignedRanks,
    SimpleEffects,
    TukeyHSD,
    read_ratings,
)

OFFSET = 10**12
WITHIN = ("rating", "picture", "person")
CROSSED = ("rating", ("light", "weight"), "person")
STATISTICS = {
    "OneWayAnova": OneWayAnova("rating", "picture"),
    "RepeatedMeasuresAnova": RepeatedMeasuresAnova(*WITHIN),
    "FactorialAnova": FactorialAnova(*CROSSED),
    "SimpleEffects": SimpleEffects(*CROSSED),
    "TukeyHSD": TukeyHSD("rating", "picture"),
    "TukeyHSD within": TukeyHSD(*WITHIN),
    "Friedman": Friedman(*WITHIN),
    "SignedRanks": SignedRanks(*WITHIN),
    "PairedContrasts": PairedContrasts(*WITHIN),
    "PlannedContrast": PlannedContrast(*WITHIN, {"c0": 2.0, "c1": -1.0, "c2": -1.0}),
    "Equivalence": Equivalence(*WITHIN, margin=3.0),
    "MeanIntervals": MeanIntervals("rating", "picture"),
    "MeanIntervals within": MeanIntervals(*WITHIN),
    "IntraclassCorrelation": IntraclassCorrelation("rating", "picture", "person"),
    "KrippendorffAlpha": KrippendorffAlpha("rating", "picture", "person", resamples=50),
}
OF_STEPS = {
    "OrdinalRegression",
    "MixedModel",
    "VarianceComponents",
    "CueRegression",
    "CueSlopes",
    "ExplainedMeans",
    "Adjusted",
}
"""The first takes answers as categories; models have tests of their own; p values have no scale."""
ELSEWHERE = {"read_ratings", "write_report"}


def ratings(offset: int) -> pd.DataFrame:
    """Fourteen people, four pictures (two lights by two weights), whole numbers."""
    random = np.random.default_rng(5)
    table = random.integers(1, 30, (14, 4)) + 2 * np.arange(4)
    return pd.DataFrame(
        [
            (f"p{who}", f"c{picture}", "ab"[picture // 2], "xy"[picture % 2], float(offset + table[who, picture]))
            for who in range(14)
            for picture in range(4)
        ],
        columns=["person", "picture", "light", "weight", "rating"],
    )


def test_every_public_statistic_is_here() -> None:
    """A new one has to say what an offset does to it."""
    mine = {name.split()[0] for name in STATISTICS}
    assert mine | OF_STEPS | ELSEWHERE == set(analysis.STATISTICS)


@pytest.mark.parametrize("name", STATISTICS)
def test_an_offset_changes_no_digit(name: str) -> None:
    """Every number of every table to 1e-9; a mean itself has the digits that float64 leaves it (1e-4 of 1e12)."""
    statistic: Callable[[pd.DataFrame], pd.DataFrame] = STATISTICS[name]
    frames = [ratings(offset) for offset in (0, OFFSET)]
    if name == "SignedRanks":
        frames = [frame[frame["picture"].isin(["c0", "c1"])] for frame in frames]
    plain, shifted = (statistic(frame) for frame in frames)
    assert list(plain.columns) == list(shifted.columns) and len(plain) == len(shifted) > 0
    for column in plain.select_dtypes("number"):
        moved = column in ("mean", "ci_low", "ci_high") and name.startswith("MeanIntervals")
        got = shifted[column] - OFFSET if moved else shifted[column]
        expected = pytest.approx(plain[column].to_numpy(), rel=1e-9, abs=3e-4 if moved else 1e-11, nan_ok=True)
        assert got.to_numpy() == expected, column
    for column in plain.select_dtypes(exclude="number"):
        assert list(plain[column]) == list(shifted[column])


def test_reading_keeps_them(tmp_path: Path) -> None:
    """As written in the file, to the last digit."""
    frame = ratings(OFFSET)
    text = frame.rename(columns={"person": "participant", "picture": "stimulus"}).assign(question="q")
    text["rating"] = text["rating"].map("{:.0f}".format)
    path = tmp_path / "vas.csv"
    text.to_csv(path, index=False)
    found = read_ratings(path, scale=None).set_index(["participant", "stimulus"])["rating"]
    assert (found == frame.set_index(["person", "picture"])["rating"].reindex(found.index)).all()
