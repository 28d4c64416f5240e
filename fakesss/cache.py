"""What was slow to make, kept by content: the key is a hash of everything the result depends on.

A folder of .npz files under the user's cache directory; the environment variable FAKESSS_CACHE names another one.
It may be deleted at any time. An entry that cannot be read, or holds other arrays than expected, is made again; a
folder that cannot be written costs only time.
"""

import hashlib
import json
import logging
import os
import tempfile
from collections.abc import Callable, Mapping
from functools import cache as once
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np
import platformdirs
from numpy.typing import NDArray

Arrays = dict[str, NDArray[Any]]
Shapes = Mapping[str, tuple[int | str, ...]]  # by name; a word stands for a length, the same wherever it stands

log = logging.getLogger(__name__)


def folder() -> Path:
    """Where entries lie: FAKESSS_CACHE if set, otherwise the platform's user cache directory."""
    return Path(os.environ.get("FAKESSS_CACHE") or platformdirs.user_cache_dir("fakesss"))


def entry(kind: str, key: dict[str, Any]) -> Path:
    """The file of an entry. `key` holds JSON values, among them the version of the algorithm."""
    digest = hashlib.sha256(json.dumps(key, sort_keys=True).encode()).hexdigest()
    return folder() / kind / f"{digest}.npz"


def cached(kind: str, key: dict[str, Any], shapes: Shapes, make: Callable[[], Arrays]) -> tuple[Arrays, bool]:
    """The arrays kept under `kind` and `key`, or those of `make()`, then kept; and whether they were there already.

    Kept ones count only if they are numbers under the names and in the shapes of `shapes`.
    """
    path = entry(kind, key)
    found = read(path, shapes)
    if found is not None:
        return found, True
    arrays = make()
    try:
        write(path, arrays)
    except OSError as error:
        warn_of(folder(), str(error.strerror))
    return arrays, False


@once
def warn_of(place: Path, why: str) -> None:
    """Said once: a study of a hundred pictures asks for the folder a hundred times."""
    log.warning(
        "%s: the cache cannot be written (%s), so what is slow is made each time; "
        "set FAKESSS_CACHE to a folder of yours",
        place,
        why,
    )


def read(path: Path, shapes: Shapes) -> Arrays | None:
    """The arrays of an entry, None where there is none or it is damaged."""
    try:
        # opened here: numpy leaves a damaged file open
        with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
            found = {name: arrays[name] for name in arrays.files}
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, ValueError, EOFError, KeyError, TypeError, BadZipFile):  # whose words are about pickles and zips
        found = {}
    if fits(found, shapes):
        return found
    log.warning("%s: damaged cache entry, made again", path)
    return None


def fits(arrays: Arrays, shapes: Shapes) -> bool:
    """Whether `arrays` are numbers, and have the names and shapes of `shapes`."""
    if arrays.keys() != shapes.keys() or not all(np.issubdtype(array.dtype, np.number) for array in arrays.values()):
        return False
    if any(arrays[name].ndim != len(shape) for name, shape in shapes.items()):
        return False
    pairs = [pair for name, shape in shapes.items() for pair in zip(shape, arrays[name].shape, strict=True)]
    lengths = dict(pairs)
    return all(length == (lengths[word] if isinstance(word, str) else word) for word, length in pairs)


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
