"""Running the survey: a socket of our own, uvicorn on it, and words about where it is."""

import contextlib
import ipaddress
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import uvicorn
from fastapi import FastAPI

from fakesss.listening import address_of, bound_to, listening
from fakesss.problem import BadInput
from study_server.announcement import announcement
from study_server.app import create_app
from study_server.prompt import PromptProtocol
from study_server.site import Mode
from study_server.workers import run_workers

FINISH_S = 20
"""How long requests that are under way are waited for at the end: a body that never comes must not keep the server."""

MOST_FILES = 65_536

START_S = 20
"""How long a worker may take to start before it is given up and replaced."""


def serve(
    study_folder: Path,
    host: str = "127.0.0.1",
    port: int = 8000,
    *,
    database_url: str | None = None,
    mode: Mode = "live",
    make_report: Callable[[], Path] | None = None,
    report_script: str = "'none'",
    workers: int = 1,
    proxies: Sequence[str] = (),
) -> None:
    """Serve the built study until interrupted; prints its addresses on standard error. Port 0: any free one.

    `workers`: processes that share the work, with PostgreSQL only. `proxies`: addresses or networks of the reverse
    proxies whose X-Forwarded-For and -Proto are believed. Raises `BadInput` if the study or its database cannot be
    used, or the port is taken.
    """
    arguments: dict[str, Any] = {
        "study_folder": study_folder,
        "database_url": database_url,
        "mode": mode,
        "make_report": make_report,
        "report_script": report_script,
    }
    settings = uvicorn_settings(checked_proxies(proxies))
    app = create_app(**arguments)
    database = app.state.site.database
    if workers > 1 and database.is_sqlite:
        raise BadInput(f"--workers {workers}: SQLite has one writer; give a PostgreSQL database with --database")
    allow_many_files()
    with listening(host, port) as listener:
        announce(app, bound_to(listener), address_of(listener), proxies=proxies, workers=workers)
        if workers > 1:
            database.close()
            run_workers(listener, workers, settings, **arguments)
        else:
            try:
                uvicorn.Server(uvicorn.Config(app, **settings)).run(sockets=[listener])
            finally:  # who presses Ctrl-C twice does not wait for requests
                database.close()


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
        server = uvicorn.Server(uvicorn.Config(app, **uvicorn_settings()))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        try:
            while not server.started and thread.is_alive():
                time.sleep(0.01)
            yield address_of(listener)
        finally:
            server.should_exit = True
            thread.join()
            app.state.site.database.close()


def uvicorn_settings(proxies: Sequence[str] = ()) -> dict[str, Any]:
    """No access log: addresses hold the participants' tokens. Forwarded headers only from `proxies`."""
    return {
        "http": PromptProtocol,
        "access_log": False,
        "log_level": "warning",
        "proxy_headers": bool(proxies),
        "forwarded_allow_ips": list(proxies),
        "server_header": False,
        "lifespan": "on",
        "timeout_graceful_shutdown": FINISH_S,
        "timeout_worker_healthcheck": START_S,
    }


def allow_many_files() -> None:
    """Every connection is an open file, and systems usually allow 1,024 until a program asks for more."""
    if sys.platform == "win32":
        return
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    most = MOST_FILES if hard == resource.RLIM_INFINITY else min(MOST_FILES, hard)
    if soft != resource.RLIM_INFINITY and soft < most:
        with contextlib.suppress(ValueError, OSError):  # macOS has a lower limit still
            resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))


def checked_proxies(proxies: Sequence[str]) -> Sequence[str]:
    """`BadInput` unless each is an address or a network: of everybody's word one must not believe any."""
    for proxy in proxies:
        try:
            network = ipaddress.ip_network(proxy)
        except ValueError as error:
            raise BadInput(f"--proxy {proxy}: {error}; give addresses such as 127.0.0.1 or 10.0.0.0/24") from None
        if network.prefixlen == 0:
            raise BadInput(f"--proxy {proxy}: is everybody; give the proxy's own address, such as 127.0.0.1")
    return proxies


def announce(app: FastAPI, address: str, url: str, *, proxies: Sequence[str] = (), workers: int = 1) -> None:
    """Where everything is and what is trusted, on standard error."""
    print(announcement(app.state.site, url, address, proxies, workers), file=sys.stderr, flush=True)
