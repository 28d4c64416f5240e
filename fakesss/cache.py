"""What was slow to make, kept by content: the key is a hash of everything the result depends on.

A folder of .npz files under the user's cache directory; the environment variable FAKESSS_CACHE names another one.
It may be deleted at any time. An entry that cannot be read is made again; a folder that cannot be written costs only
time.
"""

import hashlib
import json
import logging
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np
import platformdirs
from numpy.typing import NDArray

Arrays = dict[str, NDArray[Any]]

log = logging.getLogger(__name__)


def folder() -> Path:
    """Where entries lie: FAKESSS_CACHE if set, otherwise the platform's user cache directory."""
    return Path(os.environ.get("FAKESSS_CACHE") or platformdirs.user_cache_dir("fakesss"))


def entry(kind: str, key: dict[str, Any]) -> Path:
    """The file of an entry. `key` holds JSON values, among them the version of the algorithm."""
    digest = hashlib.sha256(json.dumps(key, sort_keys=True).encode()).hexdigest()
    return folder() / kind / f"{digest}.npz"


def cached(kind: str, key: dict[str, Any], make: Callable[[], Arrays]) -> tuple[Arrays, bool]:
    """The arrays kept under `kind` and `key`, or those of `make()`, then kept; and whether they were there already."""
    path = entry(kind, key)
    found = read(path)
    if found is not None:
        return found, True
    arrays = make()
    try:
        write(path, arrays)
    except OSError as error:
        log.warning("%s: cannot be written (%s); it will be made again next time", path, error.strerror)
    return arrays, False


def read(path: Path) -> Arrays | None:
    """The arrays of an entry, None where there is none or it is damaged."""
    try:
        # opened here: numpy leaves a damaged file open
        with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
            return {name: arrays[name] for name in arrays.files}
    except FileNotFoundError:
        return None
    except (OSError, ValueError, EOFError, KeyError, BadZipFile) as error:
        log.warning("%s: damaged cache entry (%s), made again", path, error)
        return None


def write(path: Path, arrays: Arrays) -> None:
    """Writes an entry whole or not at all: other processes never see half a file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(suffix=".part", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            np.savez(file, allow_pickle=False, **arrays)
        Path(name).replace(path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
