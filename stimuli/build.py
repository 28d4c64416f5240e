"""`fakesss build`: draws what is missing or stale, then writes the manifest. Resumable at every picture.

Each picture has a build key: the hash of everything its bytes depend on (scene, mesh file, renderer's source, OpenGL
renderer). Drawn pictures wait in `stimuli/.build/<key>.png` until all are there; then they get their names, and the
manifest is written last.
"""

import contextlib
import functools
import json
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import portalocker
from tqdm import tqdm

from fakesss.problem import BadInput
from stimuli.design import Stimulus, stimuli_of
from stimuli.manifest import (
    FORMAT,
    manifest_path,
    read_manifest,
    sha256,
    stimulus_entry,
    study_entry,
    write_atomically,
    write_manifest,
)
from stimuli.picture import Drawn, build_key, draw, software
from stimuli.study import Study

LOCK = "lock"


def build(folder: Path, *, jobs: int = 1, force: bool = False, quiet: bool | None = None) -> dict[str, Any]:
    """Every picture of the study in `folder` on disk, and its manifest, which is also returned.

    `jobs`: processes that draw. `force`: draw even what is up to date. `quiet`: no progress bar (None: where standard
    error is no terminal). Raises `BadInput` for anything the user can mend.
    """
    study = Study.load(folder)
    stimuli = stimuli_of(study)
    made_by = software()
    keys = {stimulus.id: build_key(stimulus, study.scene.size, folder, made_by) for stimulus in stimuli}
    store = Store(folder)
    with one_build_at_a_time(store.waiting):
        if not force:
            store.take_over(up_to_date(folder), set(keys.values()))
        tasks = {keys[s.id]: s for s in reversed(stimuli) if force or not store.has(keys[s.id])}
        with tqdm(total=len(tasks), desc="pictures", unit="picture", disable=quiet) as bar:
            for key, drawn in draw_all(tasks, study, folder, jobs):
                store.put(key, drawn)
                bar.update()
        entries = identified([stimulus_entry(s, store.publish(keys[s.id], f"{s.id}.png")) for s in stimuli])
        manifest = {"format": FORMAT, "study": study_entry(study, folder), "software": made_by, "stimuli": entries}
        store.remove_strays({entry["file"] for entry in entries})
        write_manifest(folder, manifest)
        store.clear()
        return manifest


def identified(entries: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The entries with `same_picture_as` set for every picture whose bytes came before."""
    first: dict[str, str] = {}
    for entry in entries:
        earlier = first.setdefault(entry["sha256"], entry["id"])
        if earlier != entry["id"] and entry["same_picture_as"] is None:
            entry["same_picture_as"] = earlier
    return entries


def levels_without_effect(manifest: dict[str, Any]) -> list[str]:
    """A sentence for each picture that equals an earlier one although its scene differs: nobody can tell them apart."""
    scenes = {entry["id"]: entry["scene"] for entry in manifest["stimuli"]}
    return [
        f"{entry['id']}: is the same picture as {entry['same_picture_as']}, though made differently"
        for entry in manifest["stimuli"]
        if entry["same_picture_as"] and entry["scene"] != scenes[entry["same_picture_as"]]
    ]


def draw_all(tasks: dict[str, Stimulus], study: Study, folder: Path, jobs: int) -> Iterator[tuple[str, Drawn]]:
    """(build key, picture) for each task, in one process or in `jobs` of them."""
    work: Callable[[Stimulus], Drawn] = functools.partial(draw, size=study.scene.size, folder=folder)
    ordered = sorted(tasks.items(), key=lambda item: item[1].id)
    if jobs <= 1 or len(ordered) <= 1:
        yield from ((key, work(stimulus)) for key, stimulus in ordered)
        return
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        yield from zip((key for key, _ in ordered), pool.map(work, (s for _, s in ordered)), strict=True)


def verify(folder: Path, *, quiet: bool | None = None) -> list[str]:
    """Rebuilds every picture in memory; one sentence for each whose bytes are not the manifest's (none: all equal)."""
    study = Study.load(folder)
    listed = {entry["id"]: entry for entry in read_manifest(folder)["stimuli"]}
    problems = []
    for stimulus in tqdm(stimuli_of(study), desc="verifying", unit="picture", disable=quiet):
        entry = listed.pop(stimulus.id, None)
        if entry is None:
            problems.append(f"{stimulus.id}: the design has it, the manifest does not; run `fakesss build`")
            continue
        path = manifest_path(folder).parent / entry["file"]
        if not path.is_file() or sha256(path.read_bytes()) != entry["sha256"]:
            problems.append(f"{stimulus.id}: {entry['file']} is not the picture of the manifest; run `fakesss build`")
        if sha256(draw(stimulus, size=study.scene.size, folder=folder).png) != entry["sha256"]:
            problems.append(f"{stimulus.id}: drawing it again gives other bytes than the manifest's")
    problems += [f"{identity}: the manifest has it, the design does not; run `fakesss build`" for identity in listed]
    return problems


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
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock = (folder / LOCK).open("wb")
    except OSError as error:
        reason = error.strerror or error
        raise BadInput(f"{folder}: cannot be written ({reason}); check the folder's permissions and space") from None
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

    def has(self, key: str) -> bool:
        """Whether the picture is there and is the one its description tells of."""
        try:
            facts = json.loads((self.waiting / f"{key}.json").read_bytes())
            return bool(sha256((self.waiting / f"{key}.png").read_bytes()) == facts["sha256"])
        except (OSError, ValueError, KeyError, TypeError):
            return False

    def put(self, key: str, drawn: Drawn) -> None:
        """Keep a picture."""
        write_atomically(self.waiting / f"{key}.png", drawn.png)
        write_atomically(self.waiting / f"{key}.json", json.dumps({**drawn.facts(), "build_key": key}).encode())

    def take_over(self, earlier: Iterable[tuple[str, Path, dict[str, Any]]], wanted: set[str]) -> None:
        """Keep the pictures of an earlier build that this one wants too."""
        for key, path, entry in earlier:
            if key in wanted and not self.has(key):
                write_atomically(self.waiting / f"{key}.png", path.read_bytes())
                facts = {name: entry[name] for name in ("sha256", "width", "height", "passes", "warnings", "build_key")}
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
