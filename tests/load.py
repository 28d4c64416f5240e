"""Simulated raters who go on while a test does something to their server, and what became of their answers."""

import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from itertools import cycle
from pathlib import Path
from typing import Any

from server_process import ServerProcess
from sqlalchemy import func, select
from stored import sound

from study_server.app import admin_secret
from study_server.manifest import load_study
from study_server.simulation.simulate import simulate
from study_server.storage import schema
from study_server.storage.engines import connect

RATERS = 12
"""In one round, the last of whom leaves in the middle. Rounds follow each other until the last blow has fallen."""


def ratings_at(url: str) -> int:
    """How many first answers are stored. Looked up over a connection of its own, so that none is open at a kill."""
    engine = connect(url)
    with engine.connect() as connection:
        number = connection.scalar(select(func.count()).select_from(schema.ratings))
    engine.dispose()
    return number or 0


@contextmanager
def under_load(server: ServerProcess, study: Path, url: str) -> Iterator["Future[list[dict[str, Any]]]"]:
    """Simulated raters take part while the block runs, and what became of their answers is judged after it."""
    built, secret, enough = load_study(study), admin_secret(study, url), threading.Event()

    def rounds() -> list[dict[str, Any]]:
        results = []
        while not enough.is_set():
            results.append(simulate(server.url, built, secret, started=RATERS, completed=RATERS - 1, progress=False))
        return results

    with ThreadPoolExecutor(1) as pool:
        load = pool.submit(rounds)
        try:
            yield load
        finally:
            enough.set()
    results = load.result()
    for result in results:
        assert (result["started"], result["completed"]) == (RATERS, RATERS - 1)
        assert (result["lost"], result["duplicated"]) == (0, 0)
        assert result["stored"] >= result["acknowledged"] >= (RATERS - 1) * 2 * len(built.stimuli)
    stored = sound(url)
    finished = [session for session in stored.sessions.values() if session["completion_code"]]
    assert len(finished) == len(results) * (RATERS - 1)


def strike(load: "Future[Any]", url: str, blows: Sequence[Callable[[], None]], kills: int) -> None:
    """So many blows in turn, each after a few more ratings were stored and in the middle of others."""
    for number, blow in zip(range(kills), cycle(blows)):
        enough = ratings_at(url) + 1 + number % 7
        while ratings_at(url) < enough:
            assert not load.done(), load.result()
            time.sleep(0.001 * (number % 5))
        blow()
