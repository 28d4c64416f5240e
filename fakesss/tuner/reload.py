"""Shaders that are edited while the tuner runs are read again."""

import asyncio
import logging
from pathlib import Path

from fakesss.tuner.state import Tuner

log = logging.getLogger(__name__)

EVERY_S = 0.3  # a look at some sixty files takes less than a millisecond

Stamp = tuple[int, int]  # time of change, ns, and size


def stamps(folder: Path) -> dict[str, Stamp]:
    """Every file of the folder; one that vanishes meanwhile is left out."""
    found = {}
    for path in folder.iterdir():
        try:
            status = path.stat()
        except OSError:
            continue
        found[path.name] = status.st_mtime_ns, status.st_size
    return found


async def watch_shaders(tuner: Tuner) -> None:
    """Until cancelled: after every change of a shader, each viewer asks again for its picture."""
    known = stamps(tuner.shaders)
    while True:
        await asyncio.sleep(EVERY_S)
        try:
            now = stamps(tuner.shaders)
        except OSError as error:
            log.warning("%s: cannot be read (%s)", tuner.shaders, error)
            continue
        changed = sorted(name for name in now.keys() | known.keys() if now.get(name) != known.get(name))
        known = now
        if changed:
            await read_again(tuner, f"Read again: {', '.join(changed)}.")


async def read_again(tuner: Tuner, sentence: str) -> None:
    """Forget the compiled shaders and say so."""
    await tuner.studio.read_shaders_again()
    for viewer in tuple(tuner.viewers):
        viewer.say("info", sentence)
        viewer.tell("again")
