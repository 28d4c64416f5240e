"""Files that are there whole or not at all, and places that are refused before the work."""

import resource
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from fakesss.image_io import write_image
from fakesss.output import check_writable, make_folder, replacing, write_atomically
from fakesss.problem import BadInput


@contextmanager
def no_space_after(size: int) -> Iterator[None]:
    """No file may grow beyond so many bytes: what a full disk is to who writes."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)


@pytest.mark.parametrize("suffix", [".png", ".exr"])
def test_a_full_disk_leaves_the_picture_that_stood_there(tmp_path: Path, suffix: str) -> None:
    path = write_image(tmp_path / f"a{suffix}", np.zeros((4, 4, 3)))
    before = path.read_bytes()
    noise = np.random.default_rng(1).uniform(0, 1, (64, 64, 3))
    with no_space_after(2000), pytest.raises(BadInput, match=r"cannot be written \(.+\); check the folder's"):
        write_image(path, noise)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]
    assert len(write_image(path, noise).read_bytes()) > 2000


def test_an_interruption_leaves_what_stood_there(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("old")
    with pytest.raises(KeyboardInterrupt), replacing(path) as waiting:
        waiting.write_text("half")
        raise KeyboardInterrupt
    assert path.read_text() == "old" and list(tmp_path.iterdir()) == [path]


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "link.txt").symlink_to(tmp_path / "elsewhere" / "a.txt")
    write_atomically(tmp_path / "link.txt", b"new")
    assert (tmp_path / "link.txt").is_symlink()
    assert (tmp_path / "elsewhere" / "a.txt").read_bytes() == b"new"


def test_places_that_cannot_be_written_are_told_before_the_work(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    for place in (tmp_path, tmp_path / "file" / "a.json", tmp_path / "missing" / "a.json"):
        with pytest.raises(BadInput, match="cannot be written"):
            check_writable(place)
    with pytest.raises(BadInput, match=r"cannot be made \((File exists|Not a directory)\); name a folder"):
        make_folder(tmp_path / "file")
    check_writable(tmp_path / "file")
    assert (tmp_path / "file").read_text() == "x" and list(tmp_path.iterdir()) == [tmp_path / "file"]
