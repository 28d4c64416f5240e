"""uvicorn's HTTP protocol, that also gives up on who opens a connection and does not come out with a request.

uvicorn limits how long a connection may be silent between requests (5 s), not how long the head of one may take, so
that a thousand connections that send a byte now and then would hold a thousand file descriptors for ever.
"""

import asyncio
from typing import Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

HEAD_S = 30.0
"""How long the head of a request may take, from the opening of the connection or its first byte."""


class PromptProtocol(H11Protocol):
    """Closes the connection if a head is not whole after `HEAD_S`. Bodies have a limit of their own (`web_safety`)."""

    head_timer: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """The first head is due."""
        super().connection_made(transport)
        self.head_timer = self.loop.call_later(HEAD_S, transport.close)

    def data_received(self, data: bytes) -> None:
        """Part of a head, or something after it."""
        super().data_received(data)
        if self.conn.their_state is not h11.IDLE:
            self.head_is_here()
        elif self.head_timer is None:
            self.head_timer = self.loop.call_later(HEAD_S, self.transport.close)

    def connection_lost(self, exc: Exception | None) -> None:
        """Nothing is waited for any more."""
        self.head_is_here()
        super().connection_lost(exc)

    def head_is_here(self) -> None:
        """Stop the clock."""
        if self.head_timer is not None:
            self.head_timer.cancel()
            self.head_timer = None
