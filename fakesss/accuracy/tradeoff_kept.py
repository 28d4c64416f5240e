"""Measurements kept until a run has written its results: an interrupted one continues, a finished one starts anew."""

import hashlib
from collections.abc import Callable
from functools import cache as once
from pathlib import Path
from typing import Any

import fakesss
from fakesss import cache

VERSION = 3  # raised whenever entries mean something else
KIND = "tradeoff"


class Kept:
    """The measurements of one run, by what they depend on."""

    def __init__(self, run: dict[str, Any]) -> None:
        self.run = {"version": VERSION, "source": source_sha256(), **run}
        self.entries: list[Path] = []

    def __call__(
        self, what: dict[str, Any], shapes: cache.Shapes, make: Callable[[], cache.Arrays]
    ) -> tuple[cache.Arrays, bool]:
        """The arrays measured for `what`, and whether an interrupted run had measured them."""
        key = {**self.run, **what}
        self.entries.append(cache.entry(KIND, key))
        return cache.cached(KIND, key, shapes, make)

    def forget(self) -> None:
        """Called when all is written: the next run of the same kind shall measure, not repeat."""
        for path in self.entries:
            path.unlink(missing_ok=True)


@once
def source_sha256() -> str:
    """Hash of the package's source: what was measured of other code counts no more."""
    root = Path(fakesss.__file__).parent
    digest = hashlib.sha256()
    for path in sorted([*root.rglob("*.py"), *root.rglob("glsl/*")]):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()
