"""Controls in the analysis: in no factor's row and never the best, compared with it where nothing else is declared."""

from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from thesis_study import thesis_stimuli, write_manifest

from analysis.plan import AnalysisPlan
from analysis.rows import rows_of
from analysis.study import read_manifest


def controlled(folder: Path, *, others: bool, analysis: dict[str, Any]) -> tuple[Any, pd.DataFrame]:
    """The thesis's nine pictures, one control that is rated highest, and two people's ratings of everything."""
    stimuli = thesis_stimuli()[: 15 if others else 9]
    number = len(stimuli) + 1
    control = {"id": f"img{number:02d}", "file": f"img{number:02d}.png", "role": "control", "label": "opaque"}
    study = read_manifest(write_manifest(folder, [*stimuli, control], analysis))
    ratings = [
        {
            "participant": who,
            "stimulus": p.id,
            "question": "translucent",
            "rating": 7 if p.role == "control" else place % 6,
        }
        for who in ("a", "b")
        for place, p in enumerate(study.pictures)
    ]
    return study, pd.DataFrame(ratings)


@pytest.mark.parametrize("others", [True, False])
def test_controls_beside_the_best_of_ours(tmp_path: Path, others: bool) -> None:
    study, ratings = controlled(tmp_path / "s", others=others, analysis={})
    rows, notes = rows_of(study, AnalysisPlan(), ratings)
    named = {row.name: [level.stimuli[0] for level in row.levels] for row in rows}
    assert notes == []
    assert named["translucent: controls vs ours"] == ["img06", "img16" if others else "img10"]
    assert ("translucent: others vs ours" in named) is others
    assert "img10" not in [
        name for row in rows if row.kind == "factor" for level in row.levels for name in level.stimuli
    ]


def test_a_declared_comparison_may_name_a_control_and_is_the_only_one(tmp_path: Path) -> None:
    declared = {"name": "opaque?", "question": "translucent", "stimuli": ["best", "img10"]}
    study, ratings = controlled(tmp_path / "s", others=False, analysis={"comparison": [declared]})
    rows, _ = rows_of(study, study.plan, ratings)
    assert [row.name for row in rows if row.kind == "comparison"] == ["opaque?"]
