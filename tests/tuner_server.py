"""The tuner on a real socket, for tests in Python and in browsers, and a tab of it without a browser."""

import json
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from websockets.sync.client import ClientConnection, connect

from fakesss.tuner.serve import running, tuned

__all__ = ["Frame", "Tab", "running", "tab", "tuned"]

PATIENCE_S = 60.0


class Frame(NamedTuple):
    """A frame's header and image."""

    header: dict[str, Any]
    image: bytes


class Tab:
    """A connection as a browser's tab has it. What is not a frame is kept in `messages`."""

    def __init__(self, socket: ClientConnection) -> None:
        self.socket = socket
        self.messages: list[dict[str, Any]] = []
        self.number = 0

    def wish(self, changes: dict[str, Any] | None = None, **wish: Any) -> int:
        """Ask for a picture; gives the wish's number. `effects`, `view`, `moving` as the wish has them."""
        self.number += 1
        settings = {"changes": changes or {}, "effects": wish.pop("effects", {})}
        self.socket.send(json.dumps({"number": self.number, "settings": settings, **wish}))
        return self.number

    def frame(self) -> Frame:
        """The next frame."""
        while not isinstance(answer := self.next(), Frame):
            pass
        return answer

    def message(self, **facts: Any) -> dict[str, Any]:
        """The next message, or one kept, that has these facts; frames before it are passed over."""

        def fits(message: dict[str, Any]) -> bool:
            return facts.items() <= message.items()

        while not any(map(fits, self.messages)):
            self.next()
        found = next(filter(fits, self.messages))
        self.messages.remove(found)
        return found

    def next(self) -> Frame | dict[str, Any]:
        """What comes next."""
        data = self.socket.recv(PATIENCE_S)
        if isinstance(data, str):
            self.messages.append(json.loads(data))
            return self.messages[-1]
        (length,) = struct.unpack("<I", data[:4])
        return Frame(json.loads(data[4 : 4 + length]), data[4 + length :])

    def finished(self, changes: dict[str, Any] | None = None, **wish: Any) -> Frame:
        """The picture with nothing standing in, asked for again as often as the tuner says so."""
        while True:
            self.wish(changes, **wish)
            answer = self.next()
            while not isinstance(answer, Frame) and "number" not in answer:
                answer = self.next()
            if isinstance(answer, Frame) and not answer.header["stand_in"]:
                return answer
            assert isinstance(answer, Frame) or answer["level"] == "info", answer
            self.message(type="again")


@contextmanager
def tab(url: str, **options: Any) -> Iterator[Tab]:
    """A tab of the tuner at `url`."""
    with connect(f"ws{url.removeprefix('http')}socket", max_size=None, proxy=None, **options) as socket:
        yield Tab(socket)
