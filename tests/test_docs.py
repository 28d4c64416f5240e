"""A pass, a scene field, a study key, a recorded column or a command that the docs do not name fails here.

The survey's own keys are checked in tests/study_server/test_export_tables.py.
"""

import re
from pathlib import Path

import pytest

import fakesss.cli_analysis
import fakesss.cli_fit
import fakesss.cli_measure
import fakesss.cli_picture
import fakesss.cli_power
import fakesss.cli_study
import fakesss.cli_survey
import fakesss.cli_tune  # noqa: F401  (all add their commands)
from analysis.plan import AnalysisPlan, Comparison, EquivalencePlan, Exclusions, PlannedContrast
from fakesss.cli import commands
from fakesss.pipeline import build
from fakesss.scene import Scene, scene_paths
from fakesss.shapes import names
from stimuli.study import Compare, Control, Design, Factor, Study
from study_server.exports.columns import RATINGS

ROOT = Path(__file__).parent.parent


def page(name: str) -> str:
    return (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")


DOCUMENTED = [
    ("scene", list(scene_paths())),
    ("study", [*Study.model_fields, *Factor.model_fields, *Design.model_fields]),
    ("study", [*Compare.model_fields, *Control.model_fields]),
    ("survey", list(RATINGS)),
    ("statistics", [*AnalysisPlan.model_fields, *Comparison.model_fields, *Exclusions.model_fields]),
    ("statistics", [*EquivalencePlan.model_fields, *PlannedContrast.model_fields]),
    ("objects", list(names())),
    ("technique", [node.name for node in build(Scene()).nodes]),
]


@pytest.mark.parametrize(("name", "things"), DOCUMENTED, ids=lambda value: value if isinstance(value, str) else "")
def test_everything_is_documented(name: str, things: list[str]) -> None:
    text = page(name)
    assert [thing for thing in things if f"`{thing}`" not in text and f"[{thing}]" not in text] == []


def test_every_command_has_an_example_and_stands_in_the_changelog() -> None:
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    for name, command in commands.commands.items():
        assert f"Example: fakesss {name}" in (command.help or ""), name
        assert f"`{name}`" in changelog, name


def test_every_page_is_in_the_contents() -> None:
    pages = {path.stem for path in (ROOT / "docs").glob("*.md")} - {"index"}
    assert pages == set(page("index").split(":maxdepth: 1")[1].replace("```", "").split())


@pytest.mark.parametrize("folder", ["", "docs", "stimuli", "fakesss", "analysis", "study_server", "benchmarks"])
def test_no_figure_is_left_to_be_filled_in(folder: str) -> None:
    found = [
        path
        for kind in ("md", "py", "toml")
        for path in (ROOT / folder).glob(f"**/*.{kind}" if folder else f"*.{kind}")
    ]
    assert found
    assert [path for path in found if re.search("@[A-Z]+@", path.read_text(encoding="utf-8"))] == []
