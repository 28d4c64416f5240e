"""Downloads of the export: written to a temporary file first, then sent at the reader's pace.

The snapshot of the database is held for as long as this machine needs to read it, never while somebody downloads: a
snapshot held open keeps SQLite's log from being taken over (it grows with every write) and PostgreSQL's dead rows from
being cleared. What goes wrong goes wrong before the first byte is sent, and a download that is cut short does not look
whole, for its length was announced.
"""

import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import IO

from fastapi import Request, Response
from fastapi.responses import StreamingResponse

from study_server.exports.export_rows import Source
from study_server.site import Mode, site_of, sorry

PIECE_BYTES = 1 << 18

Write = Callable[[IO[bytes], Source], None]


NO_ROOM = "The export could not be written to a temporary file on the server; make room there and try again."


def spooled(request: Request, name: str, media_type: str, mode: Mode | None, write: Write) -> Response:
    """A download called `name` of what `write` writes, about `mode` or else the mode that is served; 503 without room.

    Memory does not grow with the rows. Where temporary files go: TMPDIR.
    """
    site = site_of(request)
    chosen = mode or site.mode
    try:
        with ExitStack() as unless_done:
            file = unless_done.enter_context(tempfile.TemporaryFile())
            with site.database.reading() as connection:
                write(file, Source(connection, site.study, chosen, site.salt))
            size = file.tell()
            file.seek(0)
            unless_done.pop_all()
    except OSError:
        return sorry(request, 503, NO_ROOM)
    stem, _, suffix = name.rpartition(".")
    shown = name if chosen == "live" else f"{stem}-{chosen}.{suffix}"
    headers = {"Content-Disposition": f'attachment; filename="{shown}"', "Content-Length": str(size)}
    return StreamingResponse(pieces_of(file), media_type=media_type, headers=headers)


def pieces_of(file: IO[bytes]) -> Iterator[bytes]:
    """The file's bytes, a few at a time; closed at the end."""
    with file:
        while piece := file.read(PIECE_BYTES):
            yield piece
