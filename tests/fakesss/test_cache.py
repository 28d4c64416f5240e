"""The content-addressed cache survives damage and full or closed disks."""

import logging
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from fakesss import cache


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def made(key: dict[str, int], value: float = 1.0) -> tuple[float, bool]:
    arrays, found = cache.cached("kind", key, {"value": (1000,)}, lambda: {"value": np.full(1000, value)})
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
    assert "pickle" not in caplog.text
    assert made({"a": 1}, 7) == (6, True)


def test_a_cut_or_flipped_entry_is_made_again(caplog: pytest.LogCaptureFixture) -> None:
    spoils: list[Callable[[bytes], bytes]] = [
        lambda data: data[: len(data) // 2],
        lambda data: data[:2000] + b"\xff" * 8 + data[2008:],
    ]
    for spoil in spoils:
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
        assert made({"a": 1}, 5) == made({"a": 2}, 5) == (5, False)
    (said,) = caplog.messages
    assert said.startswith(f"{folder}: the cache cannot be written (") and "FAKESSS_CACHE" in said


@pytest.mark.parametrize(
    "other",
    [
        {"values": np.zeros(1000)},
        {"value": np.zeros(999)},
        {"value": np.zeros((1000, 1))},
        {"value": np.full(1000, "x")},
        {"value": np.zeros(1000), "more": np.zeros(1)},
    ],
    ids=["name", "length", "dimensions", "text", "one more"],
)
def test_an_entry_with_other_arrays_is_made_again(other: cache.Arrays, caplog: pytest.LogCaptureFixture) -> None:
    cache.write(cache.entry("kind", {"a": 1}), other)
    assert made({"a": 1}, 5) == (5, False) and "made again" in caplog.text
    assert made({"a": 1}, 6) == (5, True)


def test_a_word_is_one_length_wherever_it_stands() -> None:
    shapes = {"positions": ("vertices", 3), "normals": ("vertices", 3)}
    assert cache.fits({"positions": np.zeros((4, 3)), "normals": np.zeros((4, 3))}, shapes)
    assert not cache.fits({"positions": np.zeros((4, 3)), "normals": np.zeros((5, 3))}, shapes)
