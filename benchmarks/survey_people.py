"""Simulated participants for `survey_load.py`, in a process of their own: standard input and output are JSON.

A lean HTTP client on asyncio, so that the people are cheaper than the server; what they cost is told. Like a browser
they keep a connection and open another when the server has closed it, and send the same submission again until it is
acknowledged.
"""

import asyncio
import json
import math
import random
import sys
import time
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import urlsplit

TRIES = 200
"""How often a request is repeated, a tenth of a second apart."""


@dataclass
class Crowd:
    """What all people share."""

    url: str
    median_s: float = 0.0
    """Think time per picture, 0: none."""
    sigma: float = 0.0
    fetches: bool = False
    """Whether every picture is fetched once."""
    measuring: bool = False
    waits: list[float] = field(default_factory=list)
    """Seconds from a save's first byte out to its reply's last byte in, of those begun while measuring."""
    acknowledged: list[tuple[str, str, str, int]] = field(default_factory=list)
    repeated: int = 0

    def think_s(self) -> float:
        """Seconds over one picture."""
        return random.lognormvariate(math.log(self.median_s), self.sigma) if self.median_s else 0.0


class Client:
    """One browser's connection."""

    def __init__(self, crowd: Crowd) -> None:
        self.crowd = crowd
        address = urlsplit(crowd.url)
        self.host, self.port = str(address.hostname), address.port
        self.streams: tuple[asyncio.StreamReader, asyncio.StreamWriter] | None = None

    async def request(self, method: str, path: str, body: Any = None) -> tuple[int, bytes]:
        """Status and body; redirects are followed, failures repeated."""
        data = b"" if body is None else json.dumps(body).encode()
        head = (
            f"{method} {path} HTTP/1.1\r\nHost: {self.host}:{self.port}\r\nAccept: application/json\r\n"
            f"Content-Type: application/json\r\nContent-Length: {len(data)}\r\n\r\n"
        )
        for _ in range(TRIES):
            try:
                status, location, reply = await self.exchange(head.encode() + data)
            except (OSError, asyncio.IncompleteReadError):
                self.hang_up()
                continue
            if status == 303:
                return await self.request("GET", location)
            if status < 500 and status != 429:
                return status, reply
            self.crowd.repeated += 1
            await asyncio.sleep(0.1)
        raise SystemExit(f"{method} {path.split('/')[-1]}: no answer after {TRIES} tries")

    async def exchange(self, request: bytes) -> tuple[int, str, bytes]:
        """Status, Location and body of one request."""
        if self.streams is None:
            self.streams = await asyncio.open_connection(self.host, self.port)
        reader, writer = self.streams
        writer.write(request)
        head = (await reader.readuntil(b"\r\n\r\n")).decode("latin1")
        headers = dict(line.lower().split(": ", 1) for line in head.split("\r\n")[1:] if line)
        body = await reader.readexactly(int(headers.get("content-length", 0)))
        if headers.get("connection") == "close":
            self.hang_up()
        location = next((line[10:] for line in head.split("\r\n") if line.lower().startswith("location: ")), "")
        return int(head[9:12]), location, body

    def hang_up(self) -> None:
        """The next request opens another connection."""
        if self.streams is not None:
            self.streams[1].close()
        self.streams = None


async def person(client: Client, state: dict[str, Any], go: asyncio.Event) -> None:
    """Somebody who has begun takes part, and after them somebody else, for ever."""
    while True:
        await go.wait()
        while state["step"] == "trials":
            state = await look_and_rate(client, state)
        state = await begin(client)


async def begin(client: Client) -> dict[str, Any]:
    """From the link to the first picture."""
    state = json.loads((await client.request("GET", "/"))[1])
    while state["step"] != "trials":
        if state["step"] == "practice":
            state = await save(client, state)
        else:
            form = {"simulated": "yes"} if state["step"] == "consent" else {}
            state = json.loads((await client.request("POST", f"{state['here']}/{state['step']}", form))[1])
    return dict(state)


async def look_and_rate(client: Client, state: dict[str, Any]) -> dict[str, Any]:
    """One picture."""
    if client.crowd.fetches:
        await client.request("GET", state["picture"]["url"])
    if client.crowd.median_s:
        await asyncio.sleep(client.crowd.think_s())
    return await save(client, state)


async def save(client: Client, state: dict[str, Any]) -> dict[str, Any]:
    """Send the answers until they are acknowledged; the next state."""
    crowd = client.crowd
    body = {
        "place": state["place"],
        "submission": f"load-{state['session']}-{state['place']}",
        "stimulus_sha256": state["picture"]["sha256"],
        "since_shown_ms": 4000.0,
        "answers": [
            {"question": question["name"], "rating": random.randint(1, question["scale"]), "rt_ms": 1500.0 + number}
            for number, question in enumerate(state["questions"])
        ],
        "display": {"device_pixel_ratio": 1, "zoom": 1, "drawn_width_px": 512, "window_width_px": 1280,
                    "window_height_px": 800, "focus_lost_ms": 0},
    }  # fmt: skip
    measured, begun = crowd.measuring, time.perf_counter()
    status, reply = await client.request("POST", f"{state['here']}/ratings", body)
    if measured and crowd.measuring:
        crowd.waits.append(time.perf_counter() - begun)
    if status != 200:
        raise SystemExit(f"a save was refused: {reply.decode()}")
    answer = json.loads(reply)
    if not state["practice"]:
        key = (state["session"], str(state["trial"]))
        crowd.acknowledged += [(*key, row["question"], row["rating"]) for row in answer["saved"]]
    return dict(answer["next"])


async def measure(crowd: Crowd, seconds: float) -> dict[str, float]:
    """What happens within so many seconds."""
    crowd.waits, crowd.measuring = [], True
    began, busy = time.monotonic(), time.process_time()
    await asyncio.sleep(seconds)
    crowd.measuring = False
    passed = time.monotonic() - began
    waits = sorted(crowd.waits)
    return {
        "saves_per_s": len(waits) / passed,
        "p50_ms": quantile(waits, 0.5) * 1000,
        "p99_ms": quantile(waits, 0.99) * 1000,
        "max_ms": quantile(waits, 1.0) * 1000,
        "people_cpu": (time.process_time() - busy) / passed,
    }


def quantile(ordered: list[float], share: float) -> float:
    """The smallest value that at least this share does not exceed."""
    return ordered[max(math.ceil(share * len(ordered)) - 1, 0)] if ordered else math.nan


async def run(order: dict[str, Any]) -> None:
    """Grow the crowd to each of `order["people"]` in turn; a line of JSON for each, then what was acknowledged."""
    crowd = Crowd(order["url"], order["median_s"], order["sigma"], order["fetches"])
    go = asyncio.Event()
    everybody: list[asyncio.Task[None]] = []
    for people in order["people"]:
        while len(everybody) < people:  # a few at a time: those under way are not to wait behind a crowd at the door
            clients = [Client(crowd) for _ in range(min(order["at_the_door"], people - len(everybody)))]
            states = await asyncio.gather(*map(begin, clients))
            everybody += [asyncio.create_task(person(*each, go)) for each in zip(clients, states, strict=True)]
        go.set()
        await asyncio.sleep(order["settle_s"])
        result = {"people": people, **await measure(crowd, order["seconds"])}
        print(json.dumps(result), flush=True)
        if result["p99_ms"] > order["until_p99_ms"]:
            break
    for task in everybody:
        task.cancel()
    await asyncio.gather(*everybody, return_exceptions=True)
    print(json.dumps({"acknowledged": crowd.acknowledged, "repeated": crowd.repeated}), flush=True)


if __name__ == "__main__":
    asyncio.run(run(json.loads(sys.stdin.readline())))
