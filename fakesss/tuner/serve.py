"""Running the tuner: a socket of our own, uvicorn on it, and its address, which holds the secret."""

import contextlib
import os
import secrets
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import uvicorn
from starlette.types import ASGIApp

from fakesss.listening import address_of, bound_to, listening
from fakesss.mesh import Mesh
from fakesss.scene import Scene
from fakesss.shader_source import GLSL
from fakesss.shapes import is_mesh_file, load_object, shape_and_faces
from fakesss.tuner.app import create_app
from fakesss.tuner.guards import Guards
from fakesss.tuner.state import Tuner, WriteStudy

TOKEN_BYTES = 16
FINISH_S = 0.3  # how long requests under way are waited for at the end, and then their threads
MESSAGE_LIMIT = 1 << 20  # bytes of one wish; 32 lights are 16 KB
INTERRUPTED = 130  # the shell's exit status for Ctrl-C


def serve(
    scene: Scene,
    host: str,
    port: int,
    write_study: WriteStudy,
    announce: Callable[[str, str], None],
) -> None:
    """Tune `scene` until interrupted, which ends the program. `announce` is told the URL, with its secret, as soon as
    it answers, and the IP address that is listened on.

    Raises `BadInput` if the port is taken, there is no OpenGL, or no such object.
    """
    with listening(host, port) as listener:
        tuner = Tuner(scene, Path.cwd(), GLSL, write_study, read_object(scene.object))
        token = secrets.token_urlsafe(TOKEN_BYTES)
        server = PromptServer(configured(Guards(create_app(tuner), token, host, bound_to(listener))))
        announce(f"{address_of(listener)}/{token}/", bound_to(listener))
        try:
            server.run(sockets=[listener])
        except KeyboardInterrupt:
            print("The tuner is stopped.", file=sys.stderr)
            raise SystemExit(INTERRUPTED) from None
        finally:
            tuner.close()
            if somebody_works():
                sys.stdout.flush()
                sys.stderr.flush()
                os._exit(INTERRUPTED)  # a picture or a post that takes minutes would keep the process for as long


def somebody_works() -> bool:
    """Whether a thread, of those that draw, make things or answer posts, has not come to its end after `FINISH_S`."""
    end = time.monotonic() + FINISH_S
    others = [thread for thread in threading.enumerate() if not thread.daemon and thread is not threading.main_thread()]
    for thread in others:
        thread.join(max(end - time.monotonic(), 0))
    return any(thread.is_alive() for thread in others)


def read_object(name: str) -> Mesh | None:
    """The mesh in a file; of a built-in object, which may take long to make, only whether there is such a one."""
    if is_mesh_file(name):
        return load_object(name)
    shape_and_faces(name)
    return None


@contextlib.contextmanager
def tuned(
    scene: Scene,
    folder: Path,
    shaders: Path = GLSL,
    write_study: WriteStudy | None = None,
    port: int = 0,
    token: str = "",
) -> Iterator[str]:
    """The same on this machine only, in a thread for as long as the block runs; gives its address."""
    with running(Tuner(scene, folder, shaders, write_study), port, token) as url:
        yield url


@contextlib.contextmanager
def running(tuner: Tuner, port: int = 0, token: str = "", host: str = "127.0.0.1") -> Iterator[str]:
    """The same for a tuner that was made already."""
    token = token or secrets.token_urlsafe(TOKEN_BYTES)
    with listening(host, port) as listener:
        server = PromptServer(configured(Guards(create_app(tuner), token, host, bound_to(listener))))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        try:
            while not server.started and thread.is_alive():
                time.sleep(0.01)
            yield f"{address_of(listener)}/{token}/"
        finally:
            server.should_exit = True
            thread.join()
            tuner.close()


class PromptServer(uvicorn.Server):
    """Waits for nobody at the end: a picture may take longer than somebody who pressed Ctrl-C."""

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Ends every request and WebSocket."""
        for task in tuple(self.server_state.tasks):
            task.cancel()
        await super().shutdown(sockets)


def configured(app: ASGIApp) -> uvicorn.Config:
    """No access log: addresses hold the secret. Frames are compressed already."""
    settings: dict[str, Any] = {
        "ws": "websockets-sansio",
        "ws_max_size": MESSAGE_LIMIT,
        "ws_per_message_deflate": False,
        "access_log": False,
        "log_level": "warning",
        "proxy_headers": False,
        "server_header": False,
        "lifespan": "on",
        "timeout_graceful_shutdown": FINISH_S,
    }
    return uvicorn.Config(app, **settings)
