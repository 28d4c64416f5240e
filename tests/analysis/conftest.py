"""Files that most tests of the analysis start from."""

from collections.abc import Callable
from pathlib import Path

import pytest
from thesis_study import COMPARISON, thesis_stimuli, write_manifest


@pytest.fixture
def thesis_manifest(tmp_path: Path) -> Path:
    """The thesis's study with its comparison declared."""
    return write_manifest(tmp_path / "study", thesis_stimuli(), {"alpha": 0.10, "comparison": [COMPARISON]})


@pytest.fixture
def csv_of(tmp_path: Path) -> Callable[[str], Path]:
    """A CSV file of the given text."""

    def write(text: str) -> Path:
        path = tmp_path / "ratings.csv"
        path.write_text(text, encoding="utf-8")
        return path

    return write
