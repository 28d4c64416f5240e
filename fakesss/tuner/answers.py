"""Answers that are JSON, and how a refusal reads."""

import json
from collections.abc import Mapping
from typing import Any

from starlette.responses import JSONResponse


class Answer(JSONResponse):
    """JSON in ASCII: half a surrogate pair, in what was sent or in a folder's name, has no UTF-8."""

    def render(self, content: Any) -> bytes:
        """The body."""
        return json.dumps(content, allow_nan=False, separators=(",", ":")).encode("ascii")


def refused(status: int, sentence: str, headers: Mapping[str, str] | None = None) -> Answer:
    """An answer that a program can read as well."""
    return Answer({"error": sentence}, status, headers)
