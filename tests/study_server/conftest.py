import contextlib
import csv
import io
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))

from running_survey import KINDS, Running, running_survey
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


@pytest.fixture(scope="module", params=KINDS)
def running(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A study like `study`, served in each of the ways there are to all tests of a file; judged afterwards."""
    folder = tmp_path_factory.mktemp("running")
    with contextlib.ExitStack() as stack:
        is_file = request.param == "sqlite"
        address = "" if is_file else stack.enter_context(request.getfixturevalue("postgres").new_database())
        survey = running_survey(request.param, write_study(folder / "study"), folder / "server.log", address)
        yield stack.enter_context(survey)


def downloaded(study: Path, url: str, table: str, mode: str = "") -> list[dict[str, str]]:
    """The rows of an exported table, downloaded from the server at `url`: of its own mode, or of `mode`."""
    headers = {"Authorization": f"Bearer {admin_secret(study)}"}
    chosen = {"mode": mode} if mode else {}
    response = httpx.get(f"{url}/admin/export/{table}.csv", headers=headers, params=chosen)
    assert response.status_code == 200
    return list(csv.DictReader(io.StringIO(response.text)))


@pytest.fixture
def csv_rows() -> Callable[..., list[dict[str, str]]]:
    """`downloaded`, for tests that serve a study of their own."""
    return downloaded


@pytest.fixture
def exported(study: Path, url: str) -> Callable[..., list[dict[str, str]]]:
    """The rows of an exported table of the study at `url`."""
    return lambda table="ratings", mode="": downloaded(study, url, table, mode)
