"""Running the survey: a socket of our own, uvicorn on it, and words about where it is."""

import contextlib
import ipaddress
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import uvicorn
from fastapi import FastAPI

from fakesss.problem import BadInput
from study_server.app import create_app
from study_server.site import Mode


def serve(
    study_folder: Path,
    host: str = "127.0.0.1",
    port: int = 8000,
    *,
    database_url: str | None = None,
    mode: Mode = "live",
    make_report: Callable[[], Path] | None = None,
    report_script: str = "'none'",
) -> None:
    """Serve the built study until interrupted; prints its addresses on standard error. Port 0: any free one.

    Raises `BadInput` if the study or its database cannot be used, or the port is taken.
    """
    app = create_app(
        study_folder, database_url=database_url, mode=mode, make_report=make_report, report_script=report_script
    )
    with listening(host, port) as listener:
        announce(app, host, address_of(listener))
        uvicorn.Server(configuration(app)).run(sockets=[listener])


@contextlib.contextmanager
def served(
    study_folder: Path,
    *,
    port: int = 0,
    database_url: str | None = None,
    mode: Mode = "live",
    make_report: Callable[[], Path] | None = None,
    report_script: str = "'none'",
) -> Iterator[str]:
    """The same, on this machine only, in a thread for as long as the block runs; gives its address."""
    app = create_app(
        study_folder, database_url=database_url, mode=mode, make_report=make_report, report_script=report_script
    )
    with running(app, port) as url:
        yield url


@contextlib.contextmanager
def running(app: FastAPI, port: int = 0) -> Iterator[str]:
    """`app` on a port of this machine, in a thread for as long as the block runs; gives its address."""
    with listening("127.0.0.1", port) as listener:
        server = uvicorn.Server(configuration(app))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        try:
            while not server.started and thread.is_alive():
                time.sleep(0.01)
            yield address_of(listener)
        finally:
            server.should_exit = True
            thread.join()
            app.state.site.database.engine.dispose()


def configuration(app: FastAPI) -> uvicorn.Config:
    """No access log: addresses hold the participants' tokens. No forwarded headers: no proxy is known to be ours."""
    return uvicorn.Config(
        app, access_log=False, log_level="warning", proxy_headers=False, server_header=False, lifespan="off"
    )


@contextlib.contextmanager
def listening(host: str, port: int) -> Iterator[socket.socket]:
    """A bound socket, or `BadInput` in one sentence."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # asyncio turns Nagle's algorithm off only where it sees the protocol's number; with it a reply takes 40 ms more
    with socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP) as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((host, port))
        except (OSError, OverflowError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise BadInput(f"{host}:{port}: cannot be listened on ({reason}); choose another with --port") from None
        listener.listen(2048)
        yield listener


def address_of(listener: socket.socket) -> str:
    """The URL under which the socket is reached from this machine."""
    host, port = listener.getsockname()[:2]
    host = {"0.0.0.0": "127.0.0.1", "::": "[::1]"}.get(host, f"[{host}]" if ":" in host else host)
    return f"http://{host}:{port}"


def announce(app: FastAPI, host: str, url: str) -> None:
    """Where everything is, and a warning if the answers will travel unencrypted."""
    site = app.state.site
    lines = [
        f"{site.study.title} ({site.mode})",
        f"  participants  {url}/",
        f"  admin         {url}/admin   secret: {site.admin_secret}",
        f"  report        {url}/admin/report/",
    ]
    if not is_loopback(host):
        lines.append("  Warning: plain HTTP on a network; put an HTTPS proxy before it for people outside this room.")
    print("\n".join(lines), file=sys.stderr, flush=True)


def is_loopback(host: str) -> bool:
    """Whether only this machine can connect."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
