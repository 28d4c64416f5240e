"""The `[analysis]` table: defaults, and a sentence for each slip."""

from typing import Any

import pytest

from analysis.plan import AnalysisPlan, check_analysis
from fakesss.problem import BadInput

QUESTIONS = [{"name": "translucent"}, {"name": "realistic"}]


def study(**analysis: Any) -> dict[str, Any]:
    """A study table with that analysis."""
    return {"title": "T", "question": QUESTIONS, "analysis": analysis}


def comparison(**changes: Any) -> dict[str, Any]:
    """A valid comparison with changes."""
    return {"name": "ours vs theirs", "question": "translucent", "stimuli": ["best", "img10"], **changes}


def test_defaults() -> None:
    """No table at all is a plan."""
    plan = check_analysis({"title": "T"}, "study.toml")
    assert plan == AnalysisPlan()
    assert (plan.alpha, plan.mode, plan.completers_only) == (0.05, "auto", True)


def test_a_full_plan() -> None:
    """Everything a study may declare."""
    table = study(
        alpha=0.10,
        mode="repeated",
        exclude={"failed_checks": 2, "median_rt_ms_below": 300, "same_answer_share": 1.0},
        comparison=[comparison()],
    )
    plan = check_analysis(table, "study.toml")
    assert plan.comparison[0].stimuli == ("best", "img10") and plan.exclude.failed_checks == 2


@pytest.mark.parametrize(
    ("analysis", "sentence"),
    [
        ({"alfa": 0.1}, 'study.toml: [analysis]: alfa: unknown key; did you mean "alpha"?'),
        ({"alpha": 0}, "alpha: 0: must be > 0"),
        ({"alpha": 1.5}, "alpha: 1.5: must be < 1"),
        ({"mode": "paired"}, "mode: 'paired': must be 'auto', 'repeated' or 'independent'"),
        ({"exclude": {"failed_check": 2}}, 'exclude.failed_check: unknown key; did you mean "failed_checks"?'),
        ({"comparison": [comparison(stimuli=["best"])]}, "comparison[1].stimuli"),
        ({"comparison": [comparison(stimuli=["a", "a"])]}, 'stimulus "a" stands twice in comparison "ours vs theirs"'),
        (
            {"comparison": [comparison(), comparison()]},
            'comparison "ours vs theirs" of question "translucent" stands twice',
        ),
        (
            {"comparison": [comparison(question="transluscent")]},
            'question "transluscent" is not asked; did you mean "translucent"?',
        ),
    ],
)
def test_sentences(analysis: dict[str, Any], sentence: str) -> None:
    """File, key, mend."""
    with pytest.raises(BadInput) as error:
        check_analysis(study(**analysis), "study.toml")
    assert sentence in str(error.value)


def test_not_a_table() -> None:
    """analysis = "t-test" at top level."""
    with pytest.raises(BadInput, match=r"must be a table; write \[analysis\]"):
        check_analysis({"analysis": "t-test"}, "study.toml")
