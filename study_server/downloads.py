"""What the researcher takes away: tables of the export, the report, a backup."""

import time
from pathlib import Path
from typing import IO

from fastapi import APIRouter, Request, Response
from fastapi.responses import FileResponse, StreamingResponse

from fakesss.problem import BadInput
from study_server import counts
from study_server.exports.export import ROWS, table_text
from study_server.exports.export_rows import Source
from study_server.exports.psych_ds import write_zip
from study_server.exports.spool import pieces_of, spooled
from study_server.guards.admin_door import Unlocked
from study_server.sessions import release_s
from study_server.site import Mode, sorry
from study_server.storage.backup import file_name, no_backup, opened_backup

router = APIRouter()


@router.get("/export/psych-ds.zip")
def download_dataset(request: Request, _: Unlocked, mode: Mode | None = None) -> Response:
    """The export as a Psych-DS dataset: of `mode`, or else of the mode that is served."""
    return spooled(request, "psych-ds.zip", "application/zip", mode, write_zip)


@router.get("/export/{table}.csv")
def download(request: Request, _: Unlocked, table: str, mode: Mode | None = None) -> Response:
    """One table of the export: of `mode`, or else of the mode that is served."""
    if table not in ROWS:
        return sorry(request, 404, "There is no such table.")

    def write(file: IO[bytes], source: Source) -> None:
        file.writelines(piece.encode() for piece in table_text(table, source))

    return spooled(request, f"{table}.csv", "text/csv", mode, write)


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
