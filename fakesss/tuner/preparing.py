"""What takes long to make (meshes, occlusion) is made on a thread of its own; meanwhile something like it is drawn."""

import asyncio
from collections import Counter
from collections.abc import Hashable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, replace
from typing import Any

from fakesss.patience import Unwanted, while_wanted
from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.tuner.frames import Asked, Drawn, draw
from fakesss.tuner.studio import LEAVE_S, Unprepared

Changes = Mapping[str, Any]


@dataclass(frozen=True)
class Attempt:
    """What came of a wish: a picture or none, what it lacks, and a sentence if something stands in for that."""

    drawn: Drawn | None
    missing: Unprepared | None = None
    stand_in: str = ""


def attempt(renderer: Renderer, asked: Asked, last: Scene | None) -> Attempt:
    """The picture that is asked for; while something of it is not made yet, one with a stand-in.

    `last` is the last scene of which everything was at hand.
    """
    scene, missing = asked.scene, None
    said: dict[str, str] = {}  # what stands in for each kind of thing; a later way of one replaces the earlier
    ways: dict[str, Iterator[tuple[Changes, str]]] = {}
    while True:
        try:
            drawn = draw(renderer, replace(asked, scene=scene))
            return Attempt(drawn, missing, " ".join(dict.fromkeys(said.values())))
        except Unprepared as lack:
            missing, kind = missing or lack, lack.kind
        changes, words = next(ways.setdefault(kind, stand_ins(kind, asked.scene, last)), ({}, ""))
        if not changes:
            return Attempt(None, missing)
        scene = scene.replace(changes, "tuner")
        said[kind] = f"{in_words(kind, asked.scene)} is not made yet; {words}."


def in_words(kind: str, scene: Scene) -> str:
    """What is being made."""
    return {
        "mesh": f'The object "{scene.object}"',
        "solid": f'The object "{scene.object}"',
        "occlusion": f"Occlusion with {scene.occlusion.rays} rays a vertex",
        "local_thickness": f"Local thickness with {scene.layers.rays} rays a vertex",
        "coarse_mesh": f"A second layer of {scene.layers.faces} faces",
    }.get(kind, kind)


def stand_ins(kind: str, scene: Scene, last: Scene | None) -> Iterator[tuple[Changes, str]]:
    """Changes of `scene` by which it may do without what is missing, the nearest to it first, each in words."""
    if kind == "occlusion":
        if last:
            rays, sampling = last.occlusion.rays, last.occlusion.sampling
            words = f"{rays}" if rays != scene.occlusion.rays else f"{sampling} sampling"
            if (rays, sampling) != (scene.occlusion.rays, scene.occlusion.sampling):
                yield {"occlusion.rays": rays, "occlusion.sampling": sampling}, f"drawn with {words}"
        yield {"occlusion.enabled": False}, "drawn without"
    elif kind == "local_thickness":
        if last and last.material.thickness == "local" and last.layers != scene.layers:
            yield {"layers.rays": last.layers.rays, "layers.reach": last.layers.reach}, "drawn with the last one"
        yield {"material.thickness": "first-interval"}, "drawn with the thickness along the line of sight"
    elif kind == "coarse_mesh":
        yield {"layers.faces": None}, "drawn with all faces"
    elif last and last.object != scene.object:
        yield {"object": last.object}, f'"{last.object}" is drawn meanwhile'


class Preparing:
    """Makes one thing after the other; who asks for the same shares it, what nobody waits for any more is dropped."""

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(1, "preparing")
        self._under_way: dict[Hashable, Future[Any]] = {}
        self._waiting: Counter[Hashable] = Counter()

    async def __call__(self, missing: Unprepared) -> Any:
        """What `missing` lacks."""
        key = missing.key
        self._waiting[key] += 1
        if key not in self._under_way:
            self._under_way[key] = self._thread.submit(self._make, missing)
        made = asyncio.wrap_future(self._under_way[key])
        made.add_done_callback(forgotten)
        try:
            return await asyncio.shield(made)
        finally:
            self._waiting[key] -= 1
            if not self._waiting[key]:
                del self._waiting[key]
                self._under_way.pop(key).cancel()

    def _make(self, missing: Unprepared) -> Any:
        if missing.key not in self._waiting:
            raise Unwanted
        with while_wanted(lambda: missing.key in self._waiting):
            return missing.make()

    def close(self) -> bool:
        """Give up what is under way; False if that has not come to its end after `LEAVE_S`."""
        self._waiting.clear()
        last = self._thread.submit(int)
        self._thread.shutdown(wait=False)
        return not wait([last], LEAVE_S).not_done


def forgotten(made: "asyncio.Future[Any]") -> None:
    """Ask what became of it, though nobody may wait for it any more: asyncio would complain on the terminal."""
    if not made.cancelled():
        made.exception()
