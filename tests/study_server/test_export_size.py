"""The export of much: memory stays flat, slow readers hold nothing up, and an interruption leaves no half file."""

import json
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import httpx
import pytest
from full_disk import small_disk
from many_ratings import fill
from sqlalchemy import create_engine, text
from study_fixture import write_study
from survey_client import Participant

from fakesss.problem import BadInput
from study_server.app import admin_secret
from study_server.exports.codebook import TABLES
from study_server.exports.export import export_ratings
from study_server.serve import served
from study_server.storage.database import default_url, open_database
from study_server.storage.engines import parsed_url

MOST_MB = 8
"""What the larger export may need beyond the smaller one: buffers of the database and the allocator's whims."""

MEASURE = """
import json, re, sys, tempfile
from pathlib import Path
import httpx
from study_server.app import admin_secret
from study_server.storage.database import default_url, open_database
from study_server.exports.export import export_ratings
from study_server.exports.psych_ds import export_psych_ds
from study_server.serve import served

def memory_mb(kind):
    return int(re.search(kind + r":\\s+(\\d+)", Path("/proc/self/status").read_text())[1]) / 1024

def csv(study):
    with tempfile.TemporaryDirectory() as out:
        export_ratings(study, out)

def psych_ds(study):
    with tempfile.TemporaryDirectory() as out:
        export_psych_ds(study, out)

def http(study):
    secret = {"Authorization": f"Bearer {admin_secret(study)}"}
    with served(study) as url:
        for name in ("ratings.csv", "psych-ds.zip"):
            with httpx.stream("GET", f"{url}/admin/export/{name}", headers=secret, timeout=600) as reply:
                assert reply.status_code == 200
                assert sum(map(len, reply.iter_raw())) == int(reply.headers["content-length"])

export = {"csv": csv, "psych-ds": psych_ds, "http": http}[sys.argv[1]]
grown = []
for study in map(Path, [sys.argv[2], *sys.argv[2:]]):  # the first time brings what is imported late
    before = memory_mb("VmRSS")
    Path("/proc/self/clear_refs").write_text("5")  # the peak is counted from here
    export(study)
    grown.append(memory_mb("VmHWM") - before)
print(json.dumps(grown))
"""


@pytest.fixture(scope="module", params=[1_000, pytest.param(20_000, marks=pytest.mark.long)])
def studies(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A study with a tenth of the sessions and one with all: 18 ratings each."""
    folder = tmp_path_factory.mktemp("size")
    small, large = (write_study(folder / name, 9) for name in ("small", "large"))
    fill(small, request.param // 10)
    fill(large, request.param)
    return small, large


@pytest.mark.parametrize("way", ["csv", "psych-ds", "http"])
def test_memory_does_not_grow_with_the_rows(studies: tuple[Path, Path], way: str) -> None:
    command = [sys.executable, "-c", MEASURE, way, *map(str, studies)]
    measured = subprocess.run(command, capture_output=True, text=True, check=True)
    _, small, large = json.loads(measured.stdout)
    assert large - small < MOST_MB, measured.stdout


def test_a_slow_reader_holds_no_snapshot_and_nobody_up(tmp_path: Path, database_url: str) -> None:
    study = write_study(tmp_path / "study", 9)
    ratings = fill(study, 300, database_url=database_url)
    secret = {"Authorization": f"Bearer {admin_secret(study, database_url)}"}
    with (
        served(study, database_url=database_url) as url,
        httpx.stream("GET", f"{url}/admin/export/ratings.csv", headers=secret, timeout=60) as reply,
    ):
        pieces = reply.iter_bytes(1000)
        got = next(pieces)
        Participant(url).to_trials().rate()
        assert snapshots_held(database_url) == 0
        got += b"".join(pieces)
    assert len(got) == int(reply.headers["content-length"])
    assert got.count(b"\n") == ratings + 1


def snapshots_held(database_url: str) -> int:
    """Readers in whose way of clearing up the database still is."""
    if database_url.startswith("sqlite"):
        with sqlite3.connect(str(parsed_url(database_url).database), timeout=5) as connection:
            busy, *_ = connection.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()
        connection.close()
        return int(busy)
    engine = create_engine(database_url.replace("postgresql://", "postgresql+psycopg://"))
    held = text(
        "SELECT count(*) FROM pg_stat_activity WHERE backend_xmin IS NOT NULL AND application_name = 'fakesss' "
        "AND state LIKE 'idle in transaction%'"
    )
    with engine.connect() as connection:
        found = int(connection.scalar(held) or 0)
    engine.dispose()
    return found


def test_no_room_for_the_download(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study = write_study(tmp_path / "study", 9)
    fill(study, 50)
    secret = {"Authorization": f"Bearer {admin_secret(study)}"}
    with served(study) as url, small_disk(tmp_path / "disk") as disk:
        whole = httpx.get(f"{url}/admin/export/ratings.csv", headers=secret)
        monkeypatch.setattr(tempfile, "tempdir", str(disk.seen))  # not before: its own room may be freed late
        disk.fill()
        for name in ("ratings.csv", "psych-ds.zip"):
            refused = httpx.get(f"{url}/admin/export/{name}", headers={**secret, "Accept": "application/json"})
            assert (refused.status_code, "make room" in refused.json()["error"]) == (503, True)
        disk.free()
        assert httpx.get(f"{url}/admin/export/ratings.csv", headers=secret).content == whole.content


def test_a_full_disk_leaves_the_earlier_export(tmp_path: Path) -> None:
    study = write_study(tmp_path / "study", 9)
    open_database(default_url(study)).close()
    with small_disk(tmp_path / "disk", size=1_000_000) as disk:
        export_ratings(study, disk.seen / "out")
        before = contents(disk.seen / "out")
        fill(study, 1_000)
        with pytest.raises(BadInput, match=r"out: cannot be written .No space left on device.*make room"):
            export_ratings(study, disk.seen / "out")
        assert contents(disk.seen / "out") == before


def test_a_killed_export_leaves_the_earlier_one(studies: tuple[Path, Path], tmp_path: Path) -> None:
    export_ratings(studies[0], tmp_path)
    before = contents(tmp_path)
    command = [sys.executable, "-m", "fakesss", "export", str(studies[1]), "-o", str(tmp_path)]
    export = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    until = time.monotonic() + 60
    while not (begun := [*tmp_path.glob(".unfinished-*/ratings.csv")]) or not begun[0].stat().st_size:
        assert time.monotonic() < until
    export.kill()
    assert export.wait() == -9
    assert {name: data for name, data in contents(tmp_path).items() if "unfinished" not in name} == before
    for left in tmp_path.glob(".unfinished-*"):
        shutil.rmtree(left)
    export_ratings(studies[1], tmp_path)
    assert set(contents(tmp_path)) == {f"{table}.csv" for table in TABLES}


def contents(folder: Path) -> dict[str, bytes]:
    """Every file in it, hidden ones too."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
