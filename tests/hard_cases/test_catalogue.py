"""The catalogue, its page and its sheet of pictures hold the same cases."""

import re
from pathlib import Path

from catalogue import CASES, DRAWN, GROUPS
from draw import SHEET

from fakesss.scene import scene_paths

PAGE = (Path(__file__).parents[2] / "docs" / "hard-cases.md").read_text(encoding="utf-8")


def test_the_page_lists_every_case_and_what_happens() -> None:
    rows = re.findall(r"^\| `([a-z0-9.-]+)` \| (.+) \| (.+) \|$", PAGE, re.MULTILINE)
    assert [row[0] for row in rows] == list(CASES)
    for name, why, outcome in rows:
        assert (why, outcome) == (CASES[name].why, CASES[name].outcome), name


def test_the_page_has_the_groups_and_the_picture() -> None:
    assert re.findall(r"^## (.+)$", PAGE, re.MULTILINE)[: len(GROUPS)] == list(GROUPS)
    assert f"](images/{SHEET.name})" in PAGE and SHEET.stat().st_size < 500_000


def test_every_case_changes_something() -> None:
    scenes = {(case.content is not None, case.name if case.content else str(case.changes)) for case in CASES.values()}
    assert len(scenes) == len(CASES)
    known = set(scene_paths())
    assert {path for case in CASES.values() for path in case.changes} <= known
    assert len(DRAWN) >= 60
