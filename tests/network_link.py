"""One connection through the faulty network: the client's end, the server's end, and what passes between them."""

import asyncio
import socket
import struct
from collections import deque
from typing import Protocol

from http_messages import END_OF_HEAD, body, first_line, has_no_body

Ends = tuple[asyncio.StreamReader, asyncio.StreamWriter]
DISTURBANCES = (asyncio.IncompleteReadError, OSError)
"""How a connection ends when one of its ends goes away."""


class Faults(Protocol):
    """What the network tells its links."""

    def came(self, line: str) -> None:
        """The request `line` was read in full."""

    def delays(self, line: str) -> tuple[float, float]:
        """Seconds to hold back the request `line` and its response."""

    def take(self, line: str, kinds: tuple[str, ...]) -> tuple[str, int | None]:
        """The fault ("" for none) among `kinds` that is due at the request `line`, and after how many bytes."""


class Link:
    """Requests and responses run side by side, in order (RFC 9112, 9.3.2); either end's closing closes the other's."""

    def __init__(self, faults: Faults, client: Ends, server: Ends) -> None:
        self.faults = faults
        self.client_reader, self.client = client
        self.server_reader, self.server = server
        self.unanswered: deque[str] = deque()
        self.ways: list[asyncio.Task[None]] = []
        self.silent = False

    async def run(self) -> None:
        """Until one end closes, or a fault does it."""
        self.ways = [asyncio.create_task(self.requests()), asyncio.create_task(self.responses())]
        try:
            await asyncio.wait(self.ways, return_when=asyncio.FIRST_COMPLETED)
            self.end()
            ends = await asyncio.gather(*self.ways, return_exceptions=True)
            if self.silent:
                await asyncio.Event().wait()  # open, and nothing moves any more
        finally:
            self.end()
            self.client.close()
            self.server.close()
        expected = (*DISTURBANCES, asyncio.CancelledError, type(None))
        for mistake in (end for end in ends if not isinstance(end, expected)):
            raise mistake

    def end(self) -> None:
        """Nothing more is passed on."""
        for way in self.ways:
            way.cancel()

    def silence(self) -> None:
        """Nothing more is passed on, and neither end hears of it."""
        self.silent = True
        self.end()

    async def requests(self) -> None:
        """From the client to the server."""
        while True:
            head = await self.client_reader.readuntil(END_OF_HEAD)
            content = b"".join([piece async for piece in body(self.client_reader, head)])
            line = first_line(head)
            self.faults.came(line)
            await asyncio.sleep(self.faults.delays(line)[0])
            fault, after = self.faults.take(line, ("truncated request",))
            if fault:
                self.server.write(head + content[: len(content) // 2 if after is None else after])
                await self.server.drain()
                self.reset()
                return
            self.unanswered.append(line)
            self.server.write(head + content)
            await self.server.drain()

    async def responses(self) -> None:
        """From the server to the client."""
        while True:
            head = await self.server_reader.readuntil(END_OF_HEAD)
            status = int(first_line(head).split()[1])
            line = self.unanswered[0]
            if status >= 200:
                self.unanswered.popleft()
            if await self.response(line, status, head):
                return

    async def response(self, line: str, status: int, head: bytes) -> bool:
        """Pass one response on; whether the connection is of no more use."""
        await asyncio.sleep(self.faults.delays(line)[1])
        kinds = ("lost response", "truncated response", "stalled response") if status >= 200 else ()
        fault, after = self.faults.take(line, kinds)
        if fault == "lost response":
            self.reset()
            return True
        self.client.write(head)
        if not has_no_body(line.split()[0], status):
            left = after
            async for piece in body(self.server_reader, head, until_closed=True):
                self.client.write(piece if left is None else piece[:left])
                await self.client.drain()
                left = None if left is None else max(left - len(piece), 0)
                if left == 0:
                    break
        await self.client.drain()
        self.silent = fault == "stalled response"
        return bool(fault)

    def reset(self) -> None:
        """To the client a reset, to the server an end in the middle."""
        reset(self.client)
        self.server.close()


def reset(writer: asyncio.StreamWriter) -> None:
    """Close a connection so that its other end gets a reset."""
    open_socket: socket.socket = writer.get_extra_info("socket")
    open_socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))  # nothing is sent any more
    writer.transport.abort()
