"""What is given up halfway leaves nothing on the terminal."""

import asyncio
import gc
import threading
from pathlib import Path
from typing import Any

import pytest
from waiting import until

from fakesss import occlusion
from fakesss.patience import Unwanted, is_wanted, while_wanted
from fakesss.shapes import load_object
from fakesss.tuner.preparing import Preparing
from fakesss.tuner.studio import Unprepared


def test_what_is_given_up_halfway_is_not_complained_of() -> None:
    began, ended = threading.Event(), threading.Event()
    complaints: list[dict[str, Any]] = []

    def make() -> None:
        began.set()
        until(lambda: not is_wanted())
        ended.set()
        raise Unwanted

    async def given_up() -> None:
        asyncio.get_running_loop().set_exception_handler(lambda loop, context: complaints.append(context))
        preparing = Preparing()
        waiting = asyncio.create_task(preparing(Unprepared(("occlusion", 1), make)))
        await asyncio.to_thread(began.wait)
        waiting.cancel()
        await asyncio.to_thread(ended.wait)
        assert await asyncio.to_thread(preparing.close)
        await asyncio.gather(waiting, return_exceptions=True)
        gc.collect()  # a future complains when it is forgotten
        await asyncio.sleep(0)

    asyncio.run(given_up())
    assert complaints == []


def test_rays_nobody_waits_for_are_not_cast(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path))
    mesh = load_object("sphere:1000")
    with while_wanted(lambda: False), pytest.raises(Unwanted):
        occlusion.bake_occlusion(mesh, 64)
    assert not occlusion.bake_occlusion(mesh, 64).cached
    assert is_wanted()
