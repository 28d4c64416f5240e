"""The survey server as a process of its own, to be killed and started again on the same port."""

import contextlib
import json
import os
import random
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import httpx

PROGRAM = """
import json, os, signal, sys, threading
from pathlib import Path
from study_server.serve import serve

def end_with_the_tests():
    os.read(0, 1)  # returns when their process is gone, be it by kill -9
    os.killpg(0, signal.SIGKILL)

threading.Thread(target=end_with_the_tests, daemon=True).start()
serve(Path(sys.argv[1]), port=int(sys.argv[2]), **json.loads(sys.argv[3]))
"""
ROOT = Path(__file__).parents[1]


class NotStarted(Exception):
    """The server ended before it answered; the message is what it wrote on standard error."""


class ServerProcess:
    """A server of the built study in `study`, whose standard error is appended to the file `log`.

    `prefix`: a command that runs it, such as nsenter. `options`: what `study_server.serve.serve` takes by name.
    """

    def __init__(self, study: Path, log: Path, *, prefix: Sequence[str] = (), **options: Any) -> None:
        self.port = free_port()
        self.url = f"http://127.0.0.1:{self.port}"
        self.log = log
        self.command = [*prefix, sys.executable, "-c", PROGRAM, str(study), str(self.port), json.dumps(options)]
        self.process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Start, and return when it answers, be it that it is unwell. Raises `NotStarted`."""
        assert self.process is None, "it runs already"
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}  # nsenter changes the working directory
        with self.log.open("ab") as log:
            self.process = subprocess.Popen(
                self.command, stdin=subprocess.PIPE, stderr=log, env=environment, start_new_session=True
            )
        for _ in range(1200):
            with contextlib.suppress(httpx.TransportError):  # not listening yet
                httpx.get(f"{self.url}/health")
                return
            if self.process.poll() is not None:
                self.process.communicate()
                self.process = None
                raise NotStarted(self.said())
            time.sleep(0.05)
        self.kill()
        raise NotStarted(f"no answer in 60 s; {self.said()}")

    def end(self, number: int) -> None:
        """Send a signal to it and the workers that it started, and wait for its end."""
        if self.process is not None:
            with contextlib.suppress(ProcessLookupError):  # it ended by itself
                os.killpg(self.process.pid, number)
            self.process.wait()
            self.process.communicate()
            self.process = None

    def kill(self) -> None:
        """SIGKILL, as when the machine fails."""
        self.end(signal.SIGKILL)

    def stop(self) -> None:
        """SIGTERM, as when it is restarted on purpose."""
        self.end(signal.SIGTERM)

    def workers(self) -> list[int]:
        """Process ids of its workers: the children that answer for it, without Python's resource tracker."""
        assert self.process is not None
        children = Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children").read_text().split()
        found = []
        for pid in children:
            with contextlib.suppress(FileNotFoundError):  # it has just ended
                if b"spawn_main" in Path(f"/proc/{pid}/cmdline").read_bytes():
                    found.append(int(pid))
        return found

    def said(self) -> str:
        """Everything that it wrote on standard error so far."""
        return self.log.read_text(encoding="utf-8")

    def unforeseen(self) -> list[str]:
        """Lines of what it wrote that tell of errors nobody foresaw."""
        return [line for line in self.said().splitlines() if re.search("Traceback|^unexpected:|Exception in", line)]


@contextlib.contextmanager
def server_process(study: Path, log: Path, *, prefix: Sequence[str] = (), **options: Any) -> Iterator[ServerProcess]:
    """A `ServerProcess` that answers; killed afterwards."""
    server = ServerProcess(study, log, prefix=prefix, **options)
    try:
        server.start()
        yield server
    finally:
        server.kill()


def free_port() -> int:
    """A port of this machine that nobody listens on, and none that the system gives to outgoing connections.

    So it is still free when its server is started again.
    """
    while True:
        port = random.SystemRandom().randrange(20_000, 32_000)
        with socket.socket() as probe, contextlib.suppress(OSError):  # taken
            probe.bind(("127.0.0.1", port))
            return port
