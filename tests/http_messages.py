"""Just enough of HTTP/1.1 (RFC 9112) to pass messages on byte by byte and know where each one ends."""

import asyncio
from collections.abc import AsyncIterator

END_OF_HEAD = b"\r\n\r\n"
PIECE = 65_536


def field(head: bytes, name: str) -> str:
    """The value of a header field in lower case, "" where there is none."""
    for line in head.decode("latin-1").split("\r\n")[1:]:
        key, _, value = line.partition(":")
        if key.strip().lower() == name:
            return value.strip().lower()
    return ""


def first_line(head: bytes) -> str:
    """The request line or the status line."""
    return head.split(b"\r\n", 1)[0].decode("latin-1")


async def body(reader: asyncio.StreamReader, head: bytes, *, until_closed: bool = False) -> AsyncIterator[bytes]:
    """The bytes after `head`, chunk framing included. `until_closed`: what a response without a length means.

    Raises `asyncio.IncompleteReadError` where the sender stops in the middle.
    """
    if field(head, "transfer-encoding") == "chunked":
        async for piece in chunks(reader):
            yield piece
    elif length := field(head, "content-length"):
        left = int(length)
        while left:
            piece = await some(reader, left)
            left -= len(piece)
            yield piece
    elif until_closed:
        while piece := await reader.read(PIECE):
            yield piece


async def chunks(reader: asyncio.StreamReader) -> AsyncIterator[bytes]:
    """A chunked body up to its last chunk and trailers (RFC 9112, 7.1)."""
    size = -1
    while size:
        line = await reader.readuntil(b"\r\n")
        size = int(line.split(b";")[0], 16)
        yield line + (await reader.readexactly(size + 2) if size else b"")
    while (line := await reader.readuntil(b"\r\n")) != b"\r\n":
        yield line
    yield line


async def some(reader: asyncio.StreamReader, most: int) -> bytes:
    """What is there, at least one byte and at most `most`."""
    piece = await reader.read(min(most, PIECE))
    if not piece:
        raise asyncio.IncompleteReadError(b"", most)
    return piece


def has_no_body(method: str, status: int) -> bool:
    """Whether a response ends with its head whatever its fields say (RFC 9112, 6.3)."""
    return method == "HEAD" or status // 100 == 1 or status in (204, 304)
