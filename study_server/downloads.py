"""What the researcher takes away: tables of the export, the report, a backup."""

import time
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from fastapi import APIRouter, Request, Response
from fastapi.responses import FileResponse, StreamingResponse

from fakesss.problem import BadInput
from study_server import counts
from study_server.admin_door import Unlocked
from study_server.backup import file_name, no_backup, opened_backup
from study_server.export import ROWS, table_text
from study_server.export_rows import Source
from study_server.sessions import release_s
from study_server.site import Mode, sorry

router = APIRouter()

PIECE_BYTES = 1 << 18


@router.get("/export/{table}.csv")
def download(request: Request, site: Unlocked, table: str, mode: Mode | None = None) -> Response:
    """One table of the export, sent as it is read: of `mode`, or else of the mode that is served."""
    if table not in ROWS:
        return sorry(request, 404, "There is no such table.")

    chosen = mode or site.mode

    def pieces() -> Iterator[str]:
        with site.database.reading() as connection:
            yield from table_text(table, Source(connection, site.study, chosen, site.salt))

    disposition = f'attachment; filename="{table}{"" if chosen == "live" else f"-{chosen}"}.csv"'
    return StreamingResponse(pieces(), media_type="text/csv", headers={"Content-Disposition": disposition})


@router.get("/backup")
def backup(request: Request, site: Unlocked) -> Response:
    """The whole database as one file, checked, while people go on; 409 where PostgreSQL's own program does that."""
    if not site.database.is_sqlite:
        return sorry(request, 409, no_backup(site.database.engine.url))
    try:
        file, size = opened_backup(Path(str(site.database.engine.url.database)))
    except BadInput as problem:
        return sorry(request, 503, str(problem))
    headers = {"Content-Disposition": f'attachment; filename="{file_name(time.time())}"', "Content-Length": str(size)}
    return StreamingResponse(pieces_of(file), media_type="application/vnd.sqlite3", headers=headers)


def pieces_of(file: BinaryIO) -> Iterator[bytes]:
    """The file's bytes, a few at a time; closed at the end."""
    with file:
        while piece := file.read(PIECE_BYTES):
            yield piece


@router.get("/report/{path:path}")
def report(request: Request, site: Unlocked, path: str) -> Response:
    """The report, written anew when its first page is asked for."""
    if site.reporter is None:
        return sorry(request, 404, "This server was started without a report; run `fakesss report` on the study.")
    with site.database.reading() as connection:
        figures = counts.overview(connection, site.study.identity, site.mode, time.time(), release_s(site.study))
    if not figures["ratings"]:
        return sorry(request, 409, "There are no ratings yet, so there is nothing to report.")
    try:
        folder = site.reporter.folder(anew=path in ("", "index.html"))
    except BadInput as problem:
        return sorry(request, 409, str(problem))
    wanted = file_inside(folder, path or "index.html")
    return FileResponse(wanted) if wanted else sorry(request, 404, "The report has no such file.")


def file_inside(folder: Path, name: str) -> Path | None:
    """The file of that name in or under `folder`, or None."""
    try:
        path = (folder / name).resolve()
        return path if path.is_relative_to(folder.resolve()) and path.is_file() else None
    except (OSError, ValueError):  # a name that no file can have: too long, or with a NUL
        return None
