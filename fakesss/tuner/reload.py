"""Shaders that are edited while the tuner runs are read again."""

import asyncio
import contextlib
from pathlib import Path

from fakesss.tuner.state import Tuner

EVERY_S = 0.3  # a look at some sixty files takes less than a millisecond

SUFFIXES = (".vert", ".frag", ".glsl")
NAMED = 3  # so many files, and no more, by name

Stamp = tuple[int, int]  # time of change, ns, and size


def stamps(folder: Path) -> dict[str, Stamp]:
    """Every shader of the folder; one that vanishes meanwhile is left out, and so is a whole folder."""
    found = {}
    for path in (path for path in folder.glob("*") if path.suffix in SUFFIXES):  # editors leave other files there
        with contextlib.suppress(OSError):
            status = path.stat()
            found[path.name] = status.st_mtime_ns, status.st_size
    return found


async def watch_shaders(tuner: Tuner) -> None:
    """Until cancelled: after every change of a shader, each viewer asks again for its picture."""
    known = stamps(tuner.shaders)
    while True:
        await asyncio.sleep(EVERY_S)
        now = stamps(tuner.shaders)
        changed = sorted(name for name in now.keys() | known.keys() if now.get(name) != known.get(name))
        known = now
        if changed:
            await read_again(tuner, changed)


async def read_again(tuner: Tuner, changed: list[str]) -> None:
    """Forget the compiled shaders and say so."""
    sentence = f"Read again: {', '.join(changed)}." if len(changed) <= NAMED else f"Read again: {len(changed)} shaders."
    await tuner.studio.read_shaders_again()
    for viewer in tuple(tuner.viewers):
        viewer.say("info", sentence)
        viewer.tell("again", shaders=True)
