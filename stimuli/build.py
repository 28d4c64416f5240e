"""`fakesss build`: draws what is missing or stale, then writes the manifest. Resumable at every picture.

Each picture has a build key: the hash of everything its bytes depend on (scene, mesh file, renderer's source, OpenGL
renderer). Drawn pictures wait in `stimuli/.build/<key>.png` until all are there; then they get their names, and the
manifest is written last. Encoding and writing go on while the next picture is drawn.
"""

import functools
import logging
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from tqdm import tqdm

from fakesss.problem import BadInput
from stimuli.background import Background
from stimuli.design import Stimulus, stimuli_of
from stimuli.drawn import Drawn
from stimuli.manifest import FORMAT, manifest_path, read_manifest, sha256, stimulus_entry, study_entry, write_manifest
from stimuli.offline import at_hand, look_ahead
from stimuli.picture import build_key, draw, software
from stimuli.sources import check_sources
from stimuli.store import Store, one_build_at_a_time, up_to_date
from stimuli.study import Study

log = logging.getLogger(__name__)

Task = tuple[str, Stimulus]  # build key, what to draw


def build(folder: Path, *, jobs: int = 1, force: bool = False, quiet: bool | None = None) -> dict[str, Any]:
    """Every picture of the study in `folder` on disk, and its manifest, which is also returned.

    `jobs`: processes that draw. `force`: draw even what is up to date. `quiet`: no progress bar (None: where standard
    error is no terminal). Raises `BadInput` for anything the user can mend.
    """
    study = Study.load(folder)
    stimuli = stimuli_of(study)
    check_sources(study, stimuli, folder)
    made_by = software()
    keys = {stimulus.id: build_key(stimulus, study.scene.size, folder, made_by) for stimulus in stimuli}
    store = Store(folder)
    with one_build_at_a_time(store.waiting):
        store.remove_unfinished()
        if not force:
            store.take_over(up_to_date(folder), set(keys.values()))
        tasks = {keys[s.id]: s for s in reversed(stimuli) if force or not store.has(keys[s.id])}
        look_ahead((s for s in tasks.values() if s.path_tracing is not None), folder)
        with tqdm(total=len(tasks), desc="pictures", unit="picture", disable=quiet) as bar:
            draw_all(sorted(tasks.items(), key=lambda task: task[1].id), study, folder, jobs, bar.update)
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


def draw_all(tasks: list[Task], study: Study, folder: Path, jobs: int, told: Callable[[], object]) -> None:
    """Every picture of `tasks` into the waiting room, drawn in this process or in `jobs` others; `told` of each.

    Path-traced ones come last and here: each takes minutes on all cores and has a bar of its own.
    """
    traced = [task for task in tasks if task[1].path_tracing is not None]
    drawn = [task for task in tasks if task[1].path_tracing is None]
    if jobs <= 1 or len(drawn) <= 1:
        draw_here(drawn + traced, study.scene.size, folder, told)
        return
    draw_elsewhere(drawn, study, folder, jobs, told)
    draw_here(traced, study.scene.size, folder, told)


def draw_elsewhere(tasks: list[Task], study: Study, folder: Path, jobs: int, told: Callable[[], object]) -> None:
    """Every picture of `tasks` into the waiting room, drawn in `jobs` other processes."""
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        try:
            for _ in pool.map(functools.partial(draw_one, size=study.scene.size, folder=folder), tasks):
                told()
        except BrokenProcessPool:
            raise BadInput(f"{folder}: a drawing process died; build with fewer --jobs, memory may be short") from None


def draw_here(tasks: Iterable[Task], size: tuple[int, int], folder: Path, told: Callable[[], object]) -> None:
    """Draws on this thread and has the pictures encoded and written on others meanwhile."""
    store = Store(folder)
    with Background(size) as background:
        for key, stimulus in tasks:
            finish = draw(stimulus, size=size, folder=folder)
            background.submit(functools.partial(keep, store, key, finish))
            told()


def draw_one(task: Task, *, size: tuple[int, int], folder: Path) -> None:
    """Draws, encodes and writes a picture: among several processes one draws while another writes."""
    key, stimulus = task
    keep(Store(folder), key, draw(stimulus, size=size, folder=folder))


def keep(store: Store, key: str, finish: Callable[[], Drawn]) -> None:
    """The finished picture in the waiting room."""
    store.put(key, finish())


def verify(folder: Path, *, offline: bool = False, quiet: bool | None = None) -> list[str]:
    """Rebuilds every picture in memory; one sentence for each whose bytes are not the manifest's (none: all equal).

    Of a path-traced picture whose light is not in the cache only the file is compared, and that is said; `offline`
    traces it again, for minutes.
    """
    study = Study.load(folder)
    listed = {entry["id"]: entry for entry in read_manifest(folder)["stimuli"]}
    problems = []
    stimuli = stimuli_of(study)
    check_sources(study, stimuli, folder)
    for stimulus in tqdm(stimuli, desc="verifying", unit="picture", disable=quiet):
        entry = listed.pop(stimulus.id, None)
        if entry is None:
            problems.append(f"{stimulus.id}: the design has it, the manifest does not; run `fakesss build`")
            continue
        path = manifest_path(folder).parent / entry["file"]
        if not path.is_file() or sha256(path.read_bytes()) != entry["sha256"]:
            problems.append(f"{stimulus.id}: {entry['file']} is not the picture of the manifest; run `fakesss build`")
        if offline or stimulus.path_tracing is None or at_hand(stimulus, folder):
            problems += differences(stimulus, entry, draw(stimulus, size=study.scene.size, folder=folder)())
        else:
            log.warning("%s: its file is compared, its light not traced again; --offline does that", stimulus.id)
    problems += [f"{identity}: the manifest has it, the design does not; run `fakesss build`" for identity in listed]
    return problems


def differences(stimulus: Stimulus, entry: Mapping[str, Any], again: Drawn) -> list[str]:
    """What of a picture made again is not as the manifest's entry says."""
    if sha256(again.png) != entry["sha256"]:
        return [f"{stimulus.id}: drawing it again gives other bytes than the manifest's"]
    if again.cues.values != entry.get("cues", again.cues.values):
        return [f"{stimulus.id}: its image cues are not the manifest's; run `fakesss build --force`"]
    return []
