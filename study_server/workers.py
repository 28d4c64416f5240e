"""Several processes on one listening socket: which of them takes a connection is left to the system.

They share nothing but the database. What is kept in memory is kept in each: the throttle of wrong admin secrets
(so that N workers allow N times the guesses) and which report was written last.
"""

import functools
import multiprocessing
import os
import signal
import socket
import sys
import threading
import time
from typing import Any

import uvicorn
from fastapi import FastAPI
from uvicorn.supervisors import Multiprocess

from fakesss.problem import BadInput
from study_server.app import create_app

WAIT_S = 1.0
"""Between a worker's tries to open its database."""


def run_workers(listener: socket.socket, workers: int, settings: dict[str, Any], **app: Any) -> None:
    """`workers` processes that each serve `create_app(**app)`, until SIGINT or SIGTERM; one that dies is replaced.

    `settings` are uvicorn's. All of it is pickled: the processes begin anew rather than as copies of this one, for a
    copy of a database connection is a broken one.
    """
    config = uvicorn.Config(functools.partial(worker_app, **app), factory=True, workers=workers, **settings)
    Multiprocess(config, sockets=[listener]).run()


def worker_app(**app: Any) -> FastAPI:
    """The application of one worker, which does not outlive the process that started it.

    One that finds the database gone says so and waits: were it to end, uvicorn would not notice for `START_S`.
    """
    threading.Thread(target=end_with_parent, daemon=True).start()
    stop = signal.signal(signal.SIGTERM, signal.SIG_DFL)  # uvicorn's way to stop begins with the application
    said = ""
    while True:
        try:
            created = create_app(**app)
        except BadInput as problem:
            if str(problem) != said:
                said = str(problem)
                print(f"fakesss: a worker waits: {said}", file=sys.stderr, flush=True)
            time.sleep(WAIT_S)
        else:
            signal.signal(signal.SIGTERM, stop)
            return created


def end_with_parent() -> None:
    """Without it a worker whose parent was killed (-9) would go on and keep the port."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os.kill(os.getpid(), signal.SIGTERM)
