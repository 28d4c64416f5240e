"""`fakesss doctor`: what this machine has of what a study needs, and the line that mends what is missing."""

import sqlite3
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from fakesss import browser as browsers
from fakesss.gpu import MEND, shared
from fakesss.problem import BadInput

OPTIONAL = ("path-traced pictures", "report --pdf, the tests")


@dataclass(frozen=True)
class Finding:
    """One thing looked for. `needed_for` names the work that cannot be done without it."""

    name: str
    found: bool
    version: str
    needed_for: str
    mend: str


def look() -> list[Finding]:
    """Every finding, in the order a study needs them."""
    return [
        finding("Python", python, "everything", "install Python 3.11 or newer"),
        finding("OpenGL", opengl, "building pictures", MEND),
        finding("Embree", embree, "ambient occlusion", "pip install embreex"),
        finding("database", database, "the survey", "use a Python built with SQLite 3.35 or newer"),
        finding("cache folder", cache_folder, "keeping baked occlusion", "set FAKESSS_CACHE to a writable folder"),
        finding("path tracer", path_tracer, OPTIONAL[0], "pip install 'fakesss[offline]'"),
        finding("browser", browser, OPTIONAL[1], browsers.MEND),
    ]


def report(findings: list[Finding]) -> dict[str, Any]:
    """The findings as one JSON document; `ok` means that a study can be built and served."""
    ok = all(f.found for f in findings if f.needed_for not in OPTIONAL)
    return {"ok": ok, "findings": [asdict(f) for f in findings]}


def lines(findings: list[Finding]) -> Iterator[str]:
    """The findings as a person reads them."""
    for f in findings:
        if f.found:
            yield f"  found    {f.name:13} {f.version}"
        else:
            yield f"  MISSING  {f.name:13} {f.version}; needed for {f.needed_for}; mend: {f.mend}"


def finding(name: str, probe: Callable[[], str], needed_for: str, mend: str) -> Finding:
    """What `probe` says of the thing, or why it is not there."""
    try:
        return Finding(name, True, probe(), needed_for, mend)
    except (BadInput, ImportError, OSError, sqlite3.Error) as error:
        return Finding(name, False, str(error), needed_for, mend)


def python() -> str:
    """The interpreter's version."""
    return sys.version.split()[0]


def opengl() -> str:
    """Renderer and version of the context that pictures are drawn with."""
    try:
        return f"{shared().version}, {shared().renderer}"
    except BadInput as error:
        raise BadInput(str(error).removesuffix(f"; {MEND}").removeprefix("OpenGL: ")) from None


def embree() -> str:
    """The version of the ray-casting library, loaded."""
    from embreex import rtcore_scene  # noqa: F401

    return f"embreex {version('embreex')}"


def database() -> str:
    """SQLite's version, after a write-ahead-log commit on disk."""
    with tempfile.TemporaryDirectory() as folder:
        connection = sqlite3.connect(Path(folder) / "probe.sqlite")
        mode = connection.execute("PRAGMA journal_mode = WAL").fetchone()[0]
        connection.close()
    if mode != "wal" or sqlite3.sqlite_version_info < (3, 35):
        raise BadInput(f"SQLite {sqlite3.sqlite_version}, journal mode {mode}")
    return f"SQLite {sqlite3.sqlite_version}"


def cache_folder() -> str:
    """The folder baked data is kept in, after a write into it."""
    from fakesss.cache import folder

    folder().mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryFile(dir=folder()):
        return str(folder())


def path_tracer() -> str:
    """Mitsuba's version, loaded."""
    import mitsuba

    return f"Mitsuba {mitsuba.__version__}"


def browser() -> str:
    """A Chromium that prints reports and that the browser tests can drive."""
    try:
        return browsers.find_browser()
    except BadInput as error:
        raise BadInput(str(error).removesuffix(f"; {browsers.MEND}").removeprefix("browser: ")) from None
