"""Files written whole or not at all, and asked for before the work: whether a file can be put there."""

import contextlib
import os
import secrets
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from fakesss.problem import BadInput

MEND = "check the folder's permissions and space"


def check_output(path: str | Path, suffixes: Sequence[str], kind: str) -> Path:
    """`path` if a file of `kind` (a plural) can be written there in one of the formats `suffixes`, else `BadInput`."""
    path = Path(path)
    if path.suffix.lower() not in suffixes:
        formats = ", ".join(suffixes[:-1]) + " or " + suffixes[-1]
        raise BadInput(f'{path}: "{path.suffix}" is no format of {kind}; name it {formats}')
    if not path.parent.is_dir():
        raise BadInput(f"{path}: the folder {path.parent} does not exist; make it first")
    check_writable(path)
    return path


def make_folder(folder: Path) -> None:
    """`folder` and those above it, where they are not there yet, or `BadInput`."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BadInput(f"{folder}: cannot be made ({reason(error)}); name a folder that can be written") from None


def check_writable(path: Path) -> None:
    """`BadInput` if no file can be put at `path`; what stands there is left alone."""
    if path.is_dir():
        raise BadInput(f"{path}: cannot be written (is a folder); name a file")
    try:
        tempfile.TemporaryFile(dir=path.parent).close()
    except OSError as error:
        raise BadInput(f"{path}: cannot be written ({reason(error)}); {MEND}") from None


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A name beside `path` to write to, which takes its place when the block ends well.

    An interruption or a full disk leaves what stood at `path`. Raises `BadInput` for an `OSError`.
    """
    target = Path(os.path.realpath(path))  # a link stays a link
    waiting = target.with_name(f".{target.name}.{secrets.token_hex(4)}")
    try:
        yield waiting
        waiting.replace(target)
    except OSError as error:
        raise BadInput(f"{path}: cannot be written ({reason(error)}); {MEND}") from None
    finally:
        with contextlib.suppress(OSError):
            waiting.unlink()


def write_atomically(path: Path, content: bytes) -> None:
    """`content` at `path` in one step."""
    with replacing(path) as waiting:
        waiting.write_bytes(content)


def reason(error: OSError) -> str:
    """The operating system's own words where there are any."""
    return error.strerror or str(error).splitlines()[0]


def write_new(path: Path, content: bytes) -> None:
    """`content` at `path` in one step; `BadInput` if anything stands there already, which is left alone."""
    try:
        path.open("xb").close()  # the name is taken before anything is written: of two at once one is refused
    except FileExistsError:
        raise BadInput(f"{path}: exists already; choose another name") from None
    except OSError as error:
        raise BadInput(f"{path}: cannot be written ({reason(error)}); {MEND}") from None
    try:
        write_atomically(path, content)
    except BaseException:
        path.unlink(missing_ok=True)
        raise
