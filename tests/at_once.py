"""Requests that arrive together: all of each but its last byte is sent beforehand, then the last bytes in one go."""

import contextlib
import http.client
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlsplit


@dataclass(frozen=True)
class Reply:
    """Status and JSON of a response; `location` of a redirect."""

    status: int
    data: Any
    location: str


Sent = tuple[str, Mapping[str, Any]]
"""A path and the JSON object that is posted there."""


def at_once(url: str, posts: Sequence[Sent]) -> list[Reply]:
    """The replies to `posts`, each sent over a connection of its own."""
    with contextlib.ExitStack() as stack:
        waiting = [stack.enter_context(held_back(url, path, json.dumps(body).encode())) for path, body in posts]
        for connection, last_byte in waiting:
            connection.send(last_byte)
        return [reply_of(connection) for connection, _ in waiting]


@contextlib.contextmanager
def held_back(url: str, path: str, body: bytes) -> Iterator[tuple[http.client.HTTPConnection, bytes]]:
    """A connection over which all of a post has gone but the last byte, and that byte."""
    with contextlib.closing(http.client.HTTPConnection(urlsplit(url).netloc, timeout=60)) as connection:
        connection.putrequest("POST", path)
        connection.putheader("Accept", "application/json")
        connection.putheader("Content-Type", "application/json")
        connection.putheader("Content-Length", str(len(body)))
        connection.endheaders(body[:-1])
        yield connection, body[-1:]


def reply_of(connection: http.client.HTTPConnection) -> Reply:
    """What the server says; a redirect has no JSON."""
    response = connection.getresponse()
    text = response.read()
    return Reply(response.status, json.loads(text) if text else None, response.headers.get("Location", ""))
