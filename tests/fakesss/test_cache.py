"""The content-addressed cache survives damage and full or closed disks."""

import logging
from pathlib import Path

import numpy as np
import pytest

from fakesss import cache


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def made(key: dict[str, int], value: float = 1.0) -> tuple[float, bool]:
    arrays, found = cache.cached("kind", key, lambda: {"value": np.full(1000, value)})
    return float(arrays["value"][-1]), found


def test_made_once_per_key() -> None:
    assert made({"a": 1}, 5) == (5, False)
    assert made({"a": 1}, 6) == (5, True)
    assert made({"a": 2}, 7) == (7, False)


@pytest.mark.parametrize("damage", [b"", b"PK\x03\x04 half", b"noise" * 500])
def test_damaged_entries_are_made_again(damage: bytes, caplog: pytest.LogCaptureFixture) -> None:
    made({"a": 1}, 5)
    path = cache.entry("kind", {"a": 1})
    path.write_bytes(damage)
    assert made({"a": 1}, 6) == (6, False) and "made again" in caplog.text
    assert made({"a": 1}, 7) == (6, True)


def test_a_cut_or_flipped_entry_is_made_again(caplog: pytest.LogCaptureFixture) -> None:
    for spoil in (lambda data: data[: len(data) // 2], lambda data: data[:2000] + b"\xff" * 8 + data[2008:]):
        made({"a": 1}, 5)
        path = cache.entry("kind", {"a": 1})
        path.write_bytes(spoil(path.read_bytes()))
        assert made({"a": 1}, 5) == (5, False)


def test_no_half_files_are_left(folder: Path) -> None:
    made({"a": 1})
    assert [path.suffix for path in folder.rglob("*") if path.is_file()] == [".npz"]


def test_a_folder_that_cannot_be_made_costs_only_time(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    folder.write_text("a file where the folder should be")
    with caplog.at_level(logging.WARNING):
        assert made({"a": 1}, 5) == (5, False)
    assert "cannot be written" in caplog.text
