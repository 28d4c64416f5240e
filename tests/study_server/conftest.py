import csv
import io
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))

from study_fixture import write_study

from study_server.app import admin_secret
from study_server.serve import served


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """A built study of three pictures and two questions."""
    return write_study(tmp_path / "study")


@pytest.fixture
def url(study: Path) -> Iterator[str]:
    """The study, served by uvicorn on a free port."""
    with served(study) as address:
        yield address


@pytest.fixture
def exported(study: Path, url: str) -> Callable[[str], list[dict[str, str]]]:
    """The rows of an exported table, downloaded from the server."""

    def rows(table: str = "ratings") -> list[dict[str, str]]:
        headers = {"Authorization": f"Bearer {admin_secret(study)}"}
        response = httpx.get(f"{url}/admin/export/{table}.csv", headers=headers)
        assert response.status_code == 200
        return list(csv.DictReader(io.StringIO(response.text)))

    return rows
