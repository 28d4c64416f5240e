"""A network between browser and server that fails when a test says so: a proxy of real sockets in a thread."""

import contextlib
import re
import threading
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from network_road import Road


@dataclass
class Fault:
    """`kind` happens to the next `left` requests whose first line begins as the regular expression `where`."""

    kind: str
    where: str
    left: int
    after_bytes: int | None = None


class FaultyNetwork:
    """A way to the server at `target` ("http://host:port") that leads over `url`. Switches may be used at any time.

    `where` is a regular expression for the beginning of a request's first line, such as "POST /s/"; empty: all.
    `lines` are the first lines that came here, `happened` counts the faults by the names in quotes below.
    """

    def __init__(self, target: str) -> None:
        self.lines: list[str] = []
        self.happened: Counter[str] = Counter()
        self.changed = threading.Condition()
        self.faults: list[Fault] = []
        self.slow = (0.0, 0.0, "")
        self.road = Road(self, target)
        self.url = self.road.url

    def cut(self) -> None:
        """Every connection is reset ("reset connection"), and new ones are refused until `heal`."""
        self.road.cut()

    def swallow(self) -> None:
        """Every connection goes silent for good ("swallowed connection"), and so does every new one until `heal`.

        Nobody closes them: who waits for an answer waits, after `heal` too, as where a router forgot them.
        """
        self.road.swallow()

    def heal(self) -> None:
        """New connections work again, and no planned fault or latency is left."""
        self.faults, self.slow = [], (0.0, 0.0, "")
        self.road.heal()

    def latency(self, response: float = 0.0, request: float = 0.0, where: str = "") -> None:
        """Hold back each request and each response by so many seconds."""
        self.slow = (request, response, where)

    def lose_next_response(self, n: int = 1, where: str = "") -> None:
        """The server gets the request and answers; the client gets a reset ("lost response")."""
        self.faults.append(Fault("lost response", where, n))

    def truncate_next_request(self, after_bytes: int | None = None, n: int = 1, where: str = "POST ") -> None:
        """The server gets the head and so many bytes of the body (None: half), then an end ("truncated request")."""
        self.faults.append(Fault("truncated request", where, n, after_bytes))

    def truncate_next_response(self, after_bytes: int = 0, n: int = 1, where: str = "") -> None:
        """The client gets the head and so many bytes of the body, then an end ("truncated response")."""
        self.faults.append(Fault("truncated response", where, n, after_bytes))

    def stall_next_response(self, after_bytes: int = 0, n: int = 1, where: str = "") -> None:
        """The same, but the connection stays open and silent ("stalled response")."""
        self.faults.append(Fault("stalled response", where, n, after_bytes))

    def wait_for(self, what: str, count: int = 1, seconds: float = 30.0) -> None:
        """Return when `what` has happened `count` times since the beginning. Fails after `seconds`."""
        with self.changed:
            arrived = self.changed.wait_for(lambda: self.happened[what] >= count, seconds)
        assert arrived, f"{what}: waited for {count}, happened: {dict(self.happened)}"

    def wait_for_request(self, where: str, count: int = 1, seconds: float = 30.0) -> None:
        """Return when `count` requests that match `where` have come since the beginning. Fails after `seconds`."""
        with self.changed:
            arrived = self.changed.wait_for(lambda: self.requested(where) >= count, seconds)
        assert arrived, f"{where}: waited for {count}, came: {self.lines}"

    def requested(self, where: str) -> int:
        """How many requests that match `where` came here."""
        return sum(re.match(where, line) is not None for line in self.lines)

    # What the connections ask and tell.

    def came(self, line: str) -> None:
        """Remember a request, and wake who waits for it."""
        with self.changed:
            self.lines.append(line)
            self.changed.notify_all()

    def count(self, what: str) -> None:
        """Remember that `what` happened, and wake who waits for it."""
        with self.changed:
            self.happened[what] += 1
            self.changed.notify_all()

    def delays(self, line: str) -> tuple[float, float]:
        """Seconds to hold back the request `line` and its response."""
        request, response, where = self.slow
        return (request, response) if re.match(where, line) else (0.0, 0.0)

    def take(self, line: str, kinds: tuple[str, ...]) -> tuple[str, int | None]:
        """The fault ("" for none) among `kinds` that is due at the request `line`, and after how many bytes."""
        for fault in self.faults:
            if fault.left > 0 and fault.kind in kinds and re.match(fault.where, line):
                fault.left -= 1
                self.count(fault.kind)
                return fault.kind, fault.after_bytes
        return "", None


@contextlib.contextmanager
def faulty_network(target: str) -> Iterator[FaultyNetwork]:
    """A `FaultyNetwork` that works until it is told otherwise. Fails at the end if the proxy itself made a mistake."""
    network = FaultyNetwork(target)
    try:
        network.road.open()
        yield network
    finally:
        network.road.close()
    assert network.road.mistakes == []
