"""A copy of the database that is whole, taken while people go on rating.

`VACUUM INTO` writes one file from one snapshot (https://sqlite.org/lang_vacuum.html#vacuuminto). In WAL mode that is a
reader, and "readers do not block writers and a writer does not block readers" (https://sqlite.org/wal.html): nobody
waits for it, and it need not wait for a quiet moment. The other way, the backup API copied in steps, starts again
whenever another process writes (https://sqlite.org/backup.html). What was deleted is not in the copy, not even as
traces, for pages are written anew; nor is a -wal file needed beside it.

The copy holds what the database holds: the admin secret and the participants' addresses too.
"""

import contextlib
import os
import sqlite3
import tempfile
import time
from pathlib import Path
from typing import Any, BinaryIO

from sqlalchemy import URL

from fakesss.problem import BadInput
from study_server.storage.database import chosen_url
from study_server.storage.engines import BUSY_TIMEOUT_S, parsed_url, shown_url, sqlite_file
from study_server.storage.staging import staged


def file_name(now: float) -> str:
    """What a backup is called, by the second it was asked for."""
    return time.strftime("ratings-%Y%m%d-%H%M%S.sqlite", time.gmtime(now))


def no_backup(url: URL) -> str:
    """What to do with PostgreSQL instead, in a sentence with the command: it asks for the password."""
    shown = shown_url(URL.create("postgresql", url.username, None, url.host, url.port, url.database, url.query))
    return f"{shown}: is PostgreSQL's to copy; run: pg_dump --format=custom --file=ratings.dump --dbname={shown}"


def snapshot(source: Path, target: Path) -> None:
    """Write the database at `source` to `target`, readable by nobody else, check it, and bring it to the disk.

    `target` must not exist. Raises `BadInput` if `source` is no database or damaged, `OSError` if `target` cannot be
    written.
    """
    os.close(os.open(target, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600))  # VACUUM INTO takes an empty file
    try:
        with contextlib.closing(sqlite3.connect(source, BUSY_TIMEOUT_S, isolation_level=None)) as connection:
            connection.execute("VACUUM INTO ?", (str(target),))
        with contextlib.closing(sqlite3.connect(target)) as copy:
            wrong = [str(row[0]) for row in copy.execute("PRAGMA integrity_check(3)") if row[0] != "ok"]
            wrong += [f"a row of {row[0]} belongs to nothing" for row in copy.execute("PRAGMA foreign_key_check")]
    except sqlite3.DatabaseError as error:
        raise BadInput(f"{source}: cannot be copied ({error}); check it, its rights and the space there") from None
    if wrong:
        raise BadInput(f"{source}: is damaged ({wrong[0]}); keep it as it is, and use an earlier backup")
    with target.open("rb+") as file:
        os.fsync(file.fileno())


def opened_backup(source: Path) -> tuple[BinaryIO, int]:
    """A checked copy of the database at `source`, open for reading, and its length in bytes.

    It is written beside the database, where there is room for one, and has no name any more: it goes when it is closed,
    however that comes about. Raises `BadInput`.
    """
    try:
        with tempfile.TemporaryDirectory(dir=source.parent, prefix=".backup-") as folder:
            path = Path(folder) / "copy.sqlite"
            snapshot(source, path)
            return path.open("rb"), path.stat().st_size
    except OSError as error:
        raise BadInput(f"{source.parent}: a backup cannot be written there ({error.strerror})") from None


def backup(study_folder: Path, out: Path | None = None, database_url: str | None = None) -> dict[str, Any]:
    """Write a backup of the study's database to `out` (default: beside the ratings, named by the time).

    Returns `file` and `bytes`. Raises `BadInput` if there is no database, it is PostgreSQL's, or `out` exists or cannot
    be written.
    """
    url = parsed_url(chosen_url(study_folder, database_url))
    if url.get_backend_name() != "sqlite":
        raise BadInput(no_backup(url))
    source = sqlite_file(url)
    if not source.is_file():
        raise BadInput(f"{source}: no such file; nobody has been served this study yet")
    out = out or study_folder / file_name(time.time())
    if out.exists():
        raise BadInput(f"{out}: is there already; a backup never replaces a file, give another name with -o")
    if not out.parent.is_dir():
        raise BadInput(f"{out}: the folder {out.parent} does not exist; make it first")
    with staged(out.parent) as folder:
        snapshot(source, folder / out.name)
    return {"file": str(out), "bytes": out.stat().st_size}
