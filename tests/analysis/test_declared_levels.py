"""What the plan declares reaches each statistic: confidence, alpha of equivalence; and the HSD has its own error."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats
from test_factorial_report import crossing, gathered, ratings, rows

from analysis import MeanIntervals, PairedContrasts, TukeyHSD
from analysis.evidence import Evidence
from analysis.margins import judge
from analysis.models import models_of
from analysis.planned import planned_table

CONTRAST = {"name": "ends", "question": "translucent", "weights": {"img06": 1, "img01": -1}}
PLAN: dict[str, Any] = {
    "confidence": 0.8,
    "contrast": [CONTRAST],
    "tests": ["ordinal"],
    "equivalence": {"margin": 1.0, "alpha": 0.01},
}


@pytest.fixture(scope="module")
def evidence(tmp_path_factory: pytest.TempPathFactory) -> Evidence:
    """A 2 x 3 factorial whose plan differs from every default."""
    folder: Path = tmp_path_factory.mktemp("declared")
    return gathered(folder, ratings(2, crossing), **PLAN)


def test_intervals_have_the_declared_confidence(evidence: Evidence) -> None:
    """Means, Tukey's, paired contrasts: the limits of 80%, not of 95%."""
    light = rows(evidence, "factor")[1]
    names = ("rating", "condition", "participant")
    for found, statistic in ((light.means, MeanIntervals), (light.tukey, TukeyHSD), (light.contrasts, PairedContrasts)):
        limits = ["ci_low", "ci_high"]
        assert found is not None
        declared, usual = (statistic(*names, confidence=level)(light.answers)[limits] for level in (0.8, 0.95))
        assert found[limits].to_numpy() == pytest.approx(declared.to_numpy())
        assert np.abs(usual.to_numpy() - found[limits].to_numpy()).min() > 0.01


def test_the_planned_contrast_has_the_declared_confidence(evidence: Evidence) -> None:
    """t of 15 degrees of freedom at .90."""
    table, _ = planned_table(evidence.sample, evidence.plan)
    (row,) = table.to_dict("records")
    reach = stats.t.ppf(0.9, 15) * row["estimate"] / row["t"]
    assert (row["ci_low"], row["ci_high"]) == pytest.approx((row["estimate"] - reach, row["estimate"] + reach))


def test_odds_ratios_have_the_declared_confidence(evidence: Evidence) -> None:
    """The model of the report, t of 15 degrees of freedom at .90."""
    fit = models_of(evidence)[0].ordinal
    assert fit is not None
    odds = fit.odds_ratios
    reach = stats.t.ppf(0.9, 15) * odds["se"]
    assert odds["ci_high"].to_numpy() == pytest.approx(np.exp((odds["log_odds"] + reach).to_numpy()))


def test_equivalence_has_the_declared_alpha(evidence: Evidence) -> None:
    """Intervals of 98%, and verdicts at .01."""
    assert evidence.plan.equivalence is not None
    (one, *_), _ = judge(evidence.main, evidence.plan.equivalence)
    wide = one.each.answers.pivot(index="participant", columns="condition", values="rating")
    pair = one.records[0]
    difference = wide[pair["a"]] - wide[pair["b"]]
    expected = stats.ttest_1samp(difference, 0).confidence_interval(0.98)
    assert (pair["ci_low"], pair["ci_high"]) == pytest.approx((expected.low, expected.high))
    assert one.alpha == 0.01
    for record in one.records:
        equivalent, different = record["p_equivalence"] < 0.01, record["p_difference"] < 0.01
        assert (record["verdict"] in ("equivalent", "both")) == equivalent
        assert (record["verdict"] in ("different", "both")) == different


def test_the_printed_error_goes_with_the_printed_hsd(evidence: Evidence) -> None:
    """HSD = q sqrt(MSE / n) of means over pictures; the factorial's own MSE, of single pictures, is larger."""
    for each, pictures in zip(rows(evidence, "factor"), (3, 2), strict=True):
        wide = each.answers.pivot(index="participant", columns="condition", values="rating").to_numpy()
        left = wide - wide.mean(axis=1, keepdims=True) - wide.mean(axis=0) + wide.mean()
        n, k = wide.shape
        df = (n - 1) * (k - 1)
        assert each.mse == pytest.approx((left**2).sum() / df)
        assert each.anova is not None and each.anova["ss_error"] / df == pytest.approx(pictures * each.mse)
        assert each.hsd is not None
        assert each.hsd[0] == pytest.approx(stats.studentized_range.ppf(0.95, k, df) * np.sqrt(each.mse / n), rel=1e-6)
