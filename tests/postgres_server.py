"""A PostgreSQL server of the tests' own: a temporary folder, 127.0.0.1, a free port, and as durable as a real one."""

import contextlib
import os
import pwd
import shutil
import signal
import subprocess
import tempfile
import time
import uuid
from collections.abc import Iterator
from pathlib import Path

import psycopg
from server_process import free_port

PASSWORD = "only-for-tests"
SETTINGS = {  # fsync, synchronous_commit and full_page_writes stay on: what survives a crash is what we test
    "listen_addresses": "127.0.0.1",
    "unix_socket_directories": "",
    "max_connections": "100",
    "shared_buffers": "16MB",
    "max_wal_size": "128MB",
}
CLEAN_UP = """
read -r _
pid=$(head -n 1 "$1/data/postmaster.pid") && kill -QUIT "$pid" && while kill -0 "$pid"; do sleep 0.1; done
rm -rf "$1"
"""
"""Waits for the end of its standard input, which comes however our process ends, kill -9 included."""


class PostgresServer:
    """A server on the data in `folder`. Not running until `start`; `kill` is a crash, after which `start` recovers."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.data = folder / "data"
        self.port = free_port()
        self.log = folder / "server.log"
        self.process: subprocess.Popen[bytes] | None = None
        self.owner = unprivileged_user()
        if self.owner:
            os.chown(folder, self.owner.pw_uid, self.owner.pw_gid)
        secret = folder / "password"
        secret.write_text(PASSWORD)
        self.run("initdb", "-D", self.data, "-U", "survey", "--auth=scram-sha-256", f"--pwfile={secret}",
                 "--no-locale", "--encoding=UTF8", "--no-sync").wait()  # fmt: skip
        assert (self.data / "PG_VERSION").exists(), self.log.read_text()

    def run(self, program: str, *arguments: str | Path) -> "subprocess.Popen[bytes]":
        """Start one of PostgreSQL's programs as its user: it refuses root. What it says goes to the log."""
        who = {"user": self.owner.pw_uid, "group": self.owner.pw_gid, "extra_groups": []} if self.owner else {}
        with self.log.open("ab") as log:
            return subprocess.Popen(
                [binaries() / program, *arguments],
                **who, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True,
            )  # fmt: skip

    def url(self, database: str = "postgres") -> str:
        """The address of a database of this server, as SQLAlchemy writes it."""
        return f"postgresql+psycopg://survey:{PASSWORD}@127.0.0.1:{self.port}/{database}"

    def start(self) -> None:
        """Start, and return when queries are answered. A server that runs is left alone."""
        if self.process is not None and self.process.poll() is None:
            return
        settings = [word for name, value in SETTINGS.items() for word in ("-c", f"{name}={value}")]
        self.process = self.run("postgres", "-D", self.data, "-p", str(self.port), *settings)
        for _ in range(600):  # 30 s: recovery after a crash may take a while on a busy machine
            assert self.process.poll() is None, f"PostgreSQL did not start:\n{self.log.read_text()}"
            with contextlib.suppress(psycopg.OperationalError):  # starting up
                self.execute("SELECT 1")
                return
            time.sleep(0.05)
        raise AssertionError(f"PostgreSQL does not answer:\n{self.log.read_text()}")

    def kill(self) -> None:
        """SIGKILL to the server and every process of it, as when the power goes (what was synced is on disk)."""
        assert self.process is not None, "start the server before killing it"
        listed = Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children")  # elsewhere they end by themselves
        children = listed.read_text().split() if listed.exists() else []
        self.process.kill()  # first, or it would notice its children's deaths and start to recover
        for child in children:
            with contextlib.suppress(ProcessLookupError):
                os.kill(int(child), signal.SIGKILL)
        self.process.wait()

    def stop(self) -> None:
        """End at once but orderly: open connections are closed by the server."""
        if self.process is not None and self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(20)
            except subprocess.TimeoutExpired:
                self.kill()

    def execute(self, statement: str) -> None:
        """Run one statement outside of a transaction in the maintenance database."""
        with psycopg.connect(self.url().replace("+psycopg", ""), autocommit=True, connect_timeout=5) as connection:
            connection.execute(statement.encode())

    @contextlib.contextmanager
    def new_database(self) -> Iterator[str]:
        """The address of a new empty database, dropped afterwards with whatever is still connected to it."""
        self.start()  # a test may have left it killed
        name = f"test_{uuid.uuid4().hex}"
        self.execute(f"CREATE DATABASE {name}")
        try:
            yield self.url(name)
        finally:
            self.start()
            self.execute(f"DROP DATABASE {name} WITH (FORCE)")


@contextlib.contextmanager
def postgres_server() -> Iterator[PostgresServer]:
    """A running server on new data; both are gone afterwards."""
    folder = Path(tempfile.mkdtemp(prefix="fakesss-postgres-"))  # pytest's own folders are closed to other users
    watcher = subprocess.Popen(
        ["sh", "-c", CLEAN_UP, "sh", str(folder)],
        stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
    )  # fmt: skip
    try:
        server = PostgresServer(folder)
        try:
            server.start()
            yield server
        finally:
            server.stop()
    finally:
        shutil.rmtree(folder)
        watcher.communicate()


def binaries() -> Path:
    """Where the newest PostgreSQL's programs are: Debian keeps them out of the PATH."""
    found = [path.parent for path in Path("/usr/lib/postgresql").glob("*/bin/initdb")]
    if on_path := shutil.which("initdb"):
        found.append(Path(on_path).resolve().parent)
    assert found, "no PostgreSQL server found: run .ci/system postgres"
    return max(found, key=lambda folder: int(folder.parent.name) if folder.parent.name.isdigit() else 0)


def unprivileged_user() -> pwd.struct_passwd | None:
    """Who runs the server if we are root; None: ourselves."""
    if os.geteuid() != 0:
        return None
    with contextlib.suppress(KeyError):
        return pwd.getpwnam("postgres")
    return pwd.getpwnam("nobody")
