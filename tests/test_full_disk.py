"""The small disk: really full, really read-only, and a server on it that hears of both from the file system."""

import errno
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from full_disk import SmallDisk, small_disk
from server_process import NotStarted, server_process
from study_fixture import write_study
from survey_client import Participant
from waiting import until

from study_server.health import REMEMBERED_S

INSERT = """
import sqlite3, sys
try:
    with sqlite3.connect(sys.argv[1]) as connection:
        connection.execute("CREATE TABLE IF NOT EXISTS seen (bytes BLOB)")
        connection.execute("INSERT INTO seen VALUES (zeroblob(100000))")
except sqlite3.Error as error:
    print(error.sqlite_errorname)
else:
    print("stored")
"""


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[SmallDisk]:
    """With a built study on it."""
    study = write_study(tmp_path / "study")
    with small_disk(tmp_path / "disk", copy_of=study) as mounted:
        yield mounted


def inserted(disk: SmallDisk) -> str:
    """What SQLite says of a write on the disk."""
    command = [*disk.prefix, sys.executable, "-c", INSERT, str(disk.path / "some.sqlite")]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def test_a_full_disk_is_full_and_can_be_freed(disk: SmallDisk) -> None:
    assert inserted(disk) == "stored"
    disk.fill()
    with pytest.raises(OSError) as refused:
        (disk.seen / "other").write_bytes(bytes(5000))
    assert refused.value.errno == errno.ENOSPC
    assert inserted(disk) == "SQLITE_FULL"
    disk.free()
    assert inserted(disk) == "stored"


def test_a_read_only_disk_is_read_only_and_can_be_mended(disk: SmallDisk) -> None:
    disk.read_only()
    with pytest.raises(OSError) as refused:
        (disk.seen / "other").write_bytes(b"x")
    assert refused.value.errno == errno.EROFS
    assert inserted(disk) == "SQLITE_CANTOPEN"
    disk.writable()
    assert inserted(disk) == "stored"


def test_nobody_else_sees_the_disk_and_it_goes(tmp_path: Path) -> None:
    with small_disk(tmp_path / "disk", size=1_000_000) as disk:
        (disk.seen / "here").touch()
        assert list((tmp_path / "disk").iterdir()) == []
        assert os.statvfs(disk.seen).f_blocks * os.statvfs(disk.seen).f_frsize < 1_010_000
        assert str(disk.path) not in Path("/proc/mounts").read_text()
    assert not disk.seen.exists()


def test_a_server_is_unwell_while_its_disk_is_full_and_does_not_start_on_one_that_is_read_only(
    disk: SmallDisk, tmp_path: Path
) -> None:
    with server_process(disk.path, tmp_path / "server.log", prefix=disk.prefix) as server:
        person = Participant(server.url).to_trials()
        person.rate()
        disk.fill()
        until(lambda: httpx.get(f"{server.url}/health").status_code == 503, 10 * REMEMBERED_S)
        disk.free()
        assert httpx.get(f"{server.url}/health").status_code == 200
        person.to_end()
        with pytest.raises(AssertionError, match="open for writing"):
            disk.read_only()
        server.kill()
        disk.read_only()
        with pytest.raises(NotStarted, match="attempt to write a readonly database"):
            server.start()
        disk.writable()
        server.start()
        assert httpx.get(f"{server.url}/health").status_code == 200


def test_where_no_disk_can_be_mounted_the_test_says_what_to_allow(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(AssertionError, match=r"a small disk cannot be mounted here .*user namespaces"):
        SmallDisk(tmp_path / "file", 1_000_000)
