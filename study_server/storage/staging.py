"""Files that appear all together and whole, or not at all."""

import contextlib
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from fakesss.problem import BadInput


@contextlib.contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """An empty folder to write to, whose files take their places in `folder` when the block ends well.

    It lies hidden in `folder`, which is made if it is not there. What stands there already is replaced file by file,
    each in one step; other files stay. An interruption leaves `folder` as it was. Raises `BadInput` for an `OSError`.
    """
    waiting = None
    try:
        folder.mkdir(parents=True, exist_ok=True)
        waiting = Path(tempfile.mkdtemp(prefix=".unfinished-", dir=folder))
        yield waiting
        for file in sorted(path for path in waiting.rglob("*") if path.is_file()):
            place = folder / file.relative_to(waiting)
            place.parent.mkdir(parents=True, exist_ok=True)
            file.replace(place)
    except OSError as error:
        said = error.strerror or str(error)
        raise BadInput(f"{folder}: cannot be written ({said}); choose another folder with -o, or make room") from None
    finally:
        if waiting is not None:
            shutil.rmtree(waiting, ignore_errors=True)
