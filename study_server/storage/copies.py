"""Copies of the answers that our commands leave in the study's folder: who goes from the database goes there too.

`STUDY/report` can be written anew from what is kept, so it is mended or deleted here. `STUDY/export` and
`STUDY/psych-ds` were asked for by somebody, who may have gone on working with them: those are only named.
"""

import contextlib
import csv
import logging
import shutil
import threading
from pathlib import Path

from fakesss.problem import BadInput
from study_server.site import Site
from study_server.storage.staging import staged

log = logging.getLogger(__name__)

REPORT = "report"
EXPORTS = ("export", "psych-ds")


def strike_out(site: Site, session: str) -> None:
    """Take somebody who withdrew out of the tables that the report was made of, when no report is being written.

    The reply to them does not wait for that. What the report says is of then until it is written anew.
    """

    def strike() -> None:
        """Later, on a thread that nobody waits for."""
        with site.reporter.lock if site.reporter else contextlib.nullcontext():
            for folder in sorted((site.study.folder / REPORT).glob("**/data")):
                try:
                    strike_out_of(folder, session)
                except BadInput as problem:
                    log.error("the report still holds somebody who withdrew: %s", problem)

    threading.Thread(target=strike, name="strike out").start()


def strike_out_of(folder: Path, session: str) -> None:
    """Write the CSV files in `folder` anew without the rows of `session`; all of them or, after an error, none."""
    with staged(folder) as waiting:
        for file in sorted(folder.glob("*.csv")):
            with (
                file.open(encoding="utf-8", newline="") as old,
                (waiting / file.name).open("w", encoding="utf-8", newline="") as new,
            ):
                rows = csv.reader(old)
                columns = next(rows, [])
                at = columns.index("session") if "session" in columns else None
                writer = csv.writer(new, lineterminator="\n")
                writer.writerow(columns)
                writer.writerows(row for row in rows if at is None or row[at] != session)


def delete_report(study_folder: Path) -> Path | None:
    """Delete the report of every mode, which holds what people wrote; its folder, None if there was none."""
    folder = study_folder / REPORT
    if not folder.is_dir():
        return None
    try:
        shutil.rmtree(folder)
    except OSError as error:
        raise BadInput(f"{folder}: cannot be deleted ({error.strerror or error}); delete it by hand") from None
    return folder


def exports_in(study_folder: Path) -> list[Path]:
    """The exports that lie where `fakesss export` puts them."""
    return [folder for folder in (study_folder / name for name in EXPORTS) if folder.is_dir()]
