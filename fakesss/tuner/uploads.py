"""Mesh files that viewers bring: under their content's hash, so that a link to one means the same a week later."""

import hashlib
import re
import secrets
from collections.abc import AsyncIterable
from pathlib import Path

from fakesss import cache
from fakesss.mesh import EXTENSIONS
from fakesss.output import make_folder, reason
from fakesss.problem import BadInput

MOST_BYTES = 1 << 29
"""Of one file: ten million triangles in a binary STL."""

STORED = re.compile(r"[0-9a-f]{64}\.(" + "|".join(EXTENSIONS) + ")")


class Uploads:
    """A folder in the cache."""

    def __init__(self) -> None:
        self.folder = cache.folder().absolute() / "objects"
        self.names: dict[str, str] = {}  # by path, as they were called where they come from

    def has(self, name: str) -> bool:
        """Whether a scene's `object` is a file that was brought."""
        path = Path(name)
        return path.parent == self.folder and bool(STORED.fullmatch(path.name)) and path.is_file()

    async def receive(self, name: str, pieces: AsyncIterable[bytes]) -> Path:
        """The file called `name` as it comes in, stored whole or not at all; `BadInput` for what cannot be a mesh."""
        kind = Path(name).suffix.lower().removeprefix(".")
        if kind not in EXTENSIONS:
            raise BadInput(f'"{name}": is no mesh format that can be read; load one of {", ".join(EXTENSIONS).upper()}')
        make_folder(self.folder)
        waiting = self.folder / f".{secrets.token_hex(8)}"
        digest = hashlib.sha256()
        try:
            with waiting.open("wb") as file:
                async for piece in pieces:
                    digest.update(piece)
                    file.write(piece)
            stored = self.folder / f"{digest.hexdigest()}.{kind}"
            waiting.replace(stored)
        except OSError as error:
            raise BadInput(f'"{name}": cannot be stored in {self.folder} ({reason(error)}); make room there') from None
        finally:
            waiting.unlink(missing_ok=True)
        return stored
