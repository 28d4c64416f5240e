"""Where the faulty network listens, and all connections that lead over it, in an event loop of a thread of its own."""

import asyncio
import threading
from collections.abc import Callable
from typing import Protocol
from urllib.parse import urlsplit

from network_link import Faults, Link, reset
from server_process import free_port


class Witness(Faults, Protocol):
    """Who decides on faults and is told what happened."""

    def count(self, what: str) -> None:
        """`what` happened."""


class Road:
    """From `url` to the server at `target`. `mistakes` are errors of the proxy itself."""

    def __init__(self, witness: Witness, target: str) -> None:
        self.witness = witness
        self.server = (urlsplit(target).hostname, urlsplit(target).port)
        self.port = free_port()
        self.url = f"http://127.0.0.1:{self.port}"
        self.mistakes: list[BaseException] = []
        self.links: set[Link] = set()
        self.clients: set[asyncio.StreamWriter] = set()
        self.tasks: set[asyncio.Task[None]] = set()
        self.swallowing = False
        self.listener: asyncio.Server | None = None
        self.loop = asyncio.new_event_loop()
        self.thread = threading.Thread(target=self.loop.run_forever)

    def open(self) -> None:
        """Start the thread and listen."""
        self.thread.start()
        self.heal()

    def close(self) -> None:
        """End every connection and the thread."""
        asyncio.run_coroutine_threadsafe(self.end(), self.loop).result()
        self.loop.call_soon_threadsafe(self.loop.stop)
        self.thread.join()
        self.loop.close()

    def cut(self) -> None:
        """Reset all, refuse new ones."""
        self.at_once(self.refuse)

    def swallow(self) -> None:
        """Silence all, and new ones."""
        self.at_once(self.silence)

    def heal(self) -> None:
        """Listen, and serve new ones."""
        asyncio.run_coroutine_threadsafe(self.listen(), self.loop).result()

    def at_once(self, do: Callable[[], None]) -> None:
        """Call `do` in the loop's thread; return when it is done."""

        async def called() -> None:
            do()

        asyncio.run_coroutine_threadsafe(called(), self.loop).result()

    async def listen(self) -> None:
        """Until the next cut."""
        self.swallowing = False
        if self.listener is None:
            self.listener = await asyncio.start_server(self.came, "127.0.0.1", self.port, backlog=1000)

    def refuse(self) -> None:
        """The listening socket is closed."""
        if self.listener is not None:
            self.listener.close()
            self.listener = None
        for link in self.links:
            self.witness.count("reset connection")
            link.reset()

    def silence(self) -> None:
        """Links stay open, and stop."""
        self.swallowing = True
        for link in self.links:
            if not link.silent:
                self.witness.count("swallowed connection")
                link.silence()

    def came(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """A client connected. It is noted at once: a task that is cancelled before it begins would leave it open."""
        self.clients.add(writer)
        if self.swallowing:
            self.witness.count("swallowed connection")
            return
        task = self.loop.create_task(self.connected(reader, writer))
        self.tasks.add(task)
        task.add_done_callback(self.tasks.discard)

    async def connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Until the client or the server has left."""
        try:
            server = await asyncio.open_connection(*self.server)
        except OSError:  # the server is down
            reset(writer)
            return
        link = Link(self.witness, (reader, writer), server)
        self.links.add(link)
        if self.listener is None:  # cut in this moment
            link.reset()
        try:
            await link.run()
        except Exception as mistake:
            self.mistakes.append(mistake)
        finally:
            self.links.discard(link)
            self.clients.discard(writer)

    async def end(self) -> None:
        """Nobody listens, nothing is open."""
        if self.listener is not None:
            self.listener.close()
        for writer in self.clients:
            writer.close()
        tasks = asyncio.all_tasks() - {asyncio.current_task()}
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        await asyncio.sleep(0)  # closed transports are taken away in the loop's next turn
