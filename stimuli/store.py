"""Where a build's pictures stand: waiting under their build keys while it runs, then under their names."""

import contextlib
import json
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import portalocker

from fakesss.output import MEND, make_folder, reason, write_atomically
from fakesss.problem import BadInput
from stimuli.drawn import Drawn
from stimuli.manifest import manifest_path, read_manifest, sha256

LOCK = "lock"
FACTS = {"sha256", "width", "height", "passes", "warnings", "origin", "cues", "cues_missing", "build_key"}
UNFINISHED = re.compile(r"\.(img\d+r?\.png|manifest\.json|[0-9a-f]{64}\.(png|json))\.\w{8}")  # see output.replacing


def earlier_entries(folder: Path) -> list[dict[str, Any]]:
    """The manifest entries of an earlier build; none where there is no manifest that can be read."""
    try:
        return list(read_manifest(folder)["stimuli"])
    except BadInput:
        return []


def up_to_date(folder: Path) -> Iterator[tuple[str, Path, dict[str, Any]]]:
    """(build key, file, manifest entry) of pictures from an earlier build whose bytes are still the manifest's."""
    for entry in earlier_entries(folder):
        path = manifest_path(folder).parent / entry["file"]
        if path.is_file() and sha256(path.read_bytes()) == entry["sha256"]:
            yield entry["build_key"], path, entry


@contextlib.contextmanager
def one_build_at_a_time(folder: Path) -> Iterator[None]:
    """Holds `folder` for this process (two builds would take each other's pictures away); removes it when empty."""
    make_folder(folder)
    try:
        lock = (folder / LOCK).open("wb")
    except OSError as error:
        raise BadInput(f"{folder}: cannot be written ({reason(error)}); {MEND}") from None
    with lock:
        try:
            portalocker.lock(lock, portalocker.LockFlags.EXCLUSIVE | portalocker.LockFlags.NON_BLOCKING)
        except portalocker.LockException:
            raise BadInput(f"{folder.parent}: another build of this study is running; wait for it to end") from None
        try:
            yield
        finally:
            (folder / LOCK).unlink(missing_ok=True)
            with contextlib.suppress(OSError):  # not empty: an interrupted build left pictures for the next one
                folder.rmdir()


class Store:
    """Pictures by build key while a build runs: `stimuli/.build/<key>.png` and `<key>.json` beside it."""

    def __init__(self, folder: Path) -> None:
        self.final = manifest_path(folder).parent
        self.waiting = self.final / ".build"

    def remove_unfinished(self) -> None:
        """Delete what a build that was killed had begun to write; only for who holds the lock."""
        for folder in (self.waiting, self.final):
            for path in folder.iterdir():
                if UNFINISHED.fullmatch(path.name):
                    path.unlink(missing_ok=True)

    def has(self, key: str) -> bool:
        """Whether the picture is there and is the one its description tells of."""
        try:
            facts = json.loads((self.waiting / f"{key}.json").read_bytes())
            same = sha256((self.waiting / f"{key}.png").read_bytes()) == facts["sha256"]
            return bool(same and facts.keys() >= FACTS)
        except (OSError, ValueError, KeyError, TypeError):
            return False

    def put(self, key: str, drawn: Drawn) -> None:
        """Keep a picture."""
        make_folder(self.waiting)
        write_atomically(self.waiting / f"{key}.png", drawn.png)
        write_atomically(self.waiting / f"{key}.json", json.dumps({**drawn.facts(), "build_key": key}).encode())

    def take_over(self, earlier: Iterable[tuple[str, Path, dict[str, Any]]], wanted: set[str]) -> None:
        """Keep the pictures of an earlier build that this one wants too."""
        for key, path, entry in earlier:
            if key in wanted and entry.keys() >= FACTS and not self.has(key):
                write_atomically(self.waiting / f"{key}.png", path.read_bytes())
                facts = {name: entry[name] for name in FACTS}
                write_atomically(self.waiting / f"{key}.json", json.dumps(facts).encode())

    def publish(self, key: str, name: str) -> dict[str, Any]:
        """The picture under its final name; returns its description."""
        content = (self.waiting / f"{key}.png").read_bytes()
        path = self.final / name
        if not path.is_file() or path.read_bytes() != content:
            write_atomically(path, content)
        facts: dict[str, Any] = json.loads((self.waiting / f"{key}.json").read_bytes())
        return facts

    def remove_strays(self, names: set[str]) -> None:
        """Delete pictures that an earlier manifest listed and this build does not."""
        for entry in earlier_entries(self.final.parent):
            if entry["file"] not in names:
                (self.final / Path(entry["file"]).name).unlink(missing_ok=True)

    def clear(self) -> None:
        """Drop the waiting room's pictures; called when the manifest stands."""
        for path in [*self.waiting.glob("*.png"), *self.waiting.glob("*.json")]:
            path.unlink(missing_ok=True)
