"""The faulty network itself: what it lets through, and that each fault is what it says."""

import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import httpx
import pytest
from faulty_network import FaultyNetwork, faulty_network
from waiting import until

LONG = bytes(range(256)) * 1000


class Handler(BaseHTTPRequestHandler):
    """Says back what it got; remembers bodies and connections."""

    protocol_version = "HTTP/1.1"
    bodies: list[bytes]
    peers: set[tuple[str, int]]
    hosts: set[str]

    def do_GET(self) -> None:
        self.peers.add(self.client_address)
        self.hosts.add(self.headers["Host"])
        status = 204 if self.path == "/nothing" else 200
        self.send_response(status)
        if self.path == "/chunked":
            self.send_header("Transfer-Encoding", "chunked")
            self.end_headers()
            for piece in (b"5\r\nabcde\r\n", b"A;why=not\r\n0123456789\r\n", b"0\r\nX-Trailer: 1\r\n\r\n"):
                self.wfile.write(piece)
        elif self.path == "/until-closed":
            self.close_connection = True
            self.end_headers()
            self.wfile.write(LONG)
        elif status == 204:
            self.end_headers()
        else:
            self.send_header("Content-Length", str(len(LONG)))
            self.end_headers()
            self.wfile.write(LONG if self.command == "GET" else b"")

    do_HEAD = do_GET

    def do_POST(self) -> None:
        body = self.rfile.read(int(self.headers["Content-Length"]))
        self.bodies.append(body)
        self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_: object) -> None:
        """Quiet."""


@pytest.fixture
def server() -> Iterator[type[Handler]]:
    """A real HTTP server; what it saw."""

    class Mine(Handler):
        bodies, peers, hosts = [], set(), set()

    with ThreadingHTTPServer(("127.0.0.1", 0), Mine) as listening:
        Mine.url = f"http://127.0.0.1:{listening.server_port}"  # type: ignore[attr-defined]
        thread = threading.Thread(target=listening.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        yield Mine
        listening.shutdown()
        thread.join()


@pytest.fixture
def network(server: type[Handler]) -> Iterator[FaultyNetwork]:
    with faulty_network(server.url) as between:  # type: ignore[attr-defined]
        yield between


@pytest.fixture
def client(network: FaultyNetwork) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=network.url, timeout=30) as fresh:
        yield fresh


def test_everything_passes_on_one_connection_as_it_is(
    network: FaultyNetwork, client: httpx.Client, server: type[Handler]
) -> None:
    assert client.get("/long").content == LONG
    assert client.get("/chunked").content == b"abcde0123456789"
    assert client.get("/nothing").status_code == 204
    assert client.head("/long").headers["content-length"] == str(len(LONG))
    assert client.post("/s/x", content=LONG).content == LONG
    assert client.get("/until-closed").content == LONG
    assert len(server.peers) == 1
    assert server.hosts == {network.url.removeprefix("http://")}
    assert network.requested("GET /long") == 1 and len(network.lines) == 6


def test_a_lost_response_reached_the_server_once(
    network: FaultyNetwork, client: httpx.Client, server: type[Handler]
) -> None:
    network.lose_next_response(2, where="POST /s/")
    assert client.get("/long").content == LONG
    for _ in range(2):
        with pytest.raises(httpx.ReadError):
            client.post("/s/x", content=b"once")
    assert client.post("/s/x", content=b"through").content == b"through"
    assert server.bodies == [b"once", b"once", b"through"]
    assert network.happened["lost response"] == 2


def test_half_of_a_request_reaches_the_server(
    network: FaultyNetwork, client: httpx.Client, server: type[Handler]
) -> None:
    network.truncate_next_request()
    network.truncate_next_request(3)
    for _ in range(2):
        with pytest.raises(httpx.ReadError):
            client.post("/s/x", content=b"12345678")
    network.wait_for("truncated request", 2)
    assert client.post("/s/x", content=b"12345678").content == b"12345678"
    until(lambda: sorted(server.bodies) == [b"123", b"1234", b"12345678"])


@pytest.mark.parametrize("path", ["/long", "/chunked"])
def test_a_truncated_response_ends_early(network: FaultyNetwork, client: httpx.Client, path: str) -> None:
    network.truncate_next_response(12, where="GET ")
    with pytest.raises(httpx.RemoteProtocolError, match="closed"):
        client.get(path)
    assert client.get(path).status_code == 200
    assert network.happened["truncated response"] == 1


def test_a_stalled_response_stays_open(network: FaultyNetwork, client: httpx.Client) -> None:
    network.stall_next_response(100, where="GET ")
    with client.stream("GET", "/long", timeout=0.2) as response:
        got = bytearray()
        with pytest.raises(httpx.ReadTimeout):
            for piece in response.iter_bytes():
                got += piece
    assert bytes(got) == LONG[:100]
    assert client.get("/long").content == LONG
    assert network.happened["stalled response"] == 1


def test_a_cut_resets_what_is_open_and_refuses_what_is_new(network: FaultyNetwork, client: httpx.Client) -> None:
    network.latency(response=60)
    with ThreadPoolExecutor(1) as other:
        waiting = other.submit(client.get, "/long")
        network.wait_for_request("GET /long")
        network.cut()
        assert isinstance(waiting.exception(), httpx.ReadError)
    for _ in range(3):
        with pytest.raises(httpx.ConnectError):
            client.get("/long")
    network.heal()
    assert client.get("/long").content == LONG
    assert network.happened["reset connection"] == 1


def test_what_is_swallowed_is_never_answered(network: FaultyNetwork, client: httpx.Client) -> None:
    assert client.get("/long").content == LONG
    network.swallow()
    for connections in (1, 2):  # the open one, and a new one
        with pytest.raises(httpx.ReadTimeout):
            client.get("/nothing", timeout=0.1)
        assert network.happened["swallowed connection"] == connections
    with ThreadPoolExecutor(1) as other:
        waiting = other.submit(client.get, "/nothing", timeout=0.5)
        network.wait_for("swallowed connection", 3)
        network.heal()
        assert isinstance(waiting.exception(), httpx.ReadTimeout)
    assert network.requested("GET /nothing") == 0
    assert client.get("/nothing").status_code == 204


def test_a_late_response_was_an_early_request(
    network: FaultyNetwork, client: httpx.Client, server: type[Handler]
) -> None:
    network.latency(response=0.3, where="POST ")
    begin = time.monotonic()
    client.get("/nothing")
    with pytest.raises(httpx.ReadTimeout):
        client.post("/s/x", content=b"late", timeout=0.1)
    until(lambda: server.bodies == [b"late"])
    assert client.post("/s/x", content=b"late").content == b"late"
    assert time.monotonic() - begin >= 0.4
    network.latency(request=0.3)
    with pytest.raises(httpx.ReadTimeout):
        client.post("/s/x", content=b"later", timeout=0.1)
    assert server.bodies == [b"late", b"late"]
    until(lambda: server.bodies == [b"late", b"late", b"later"])  # it was on its way


def test_a_server_that_is_down(client: httpx.Client, network: FaultyNetwork) -> None:
    network.road.server = ("127.0.0.1", 1)
    with pytest.raises(httpx.NetworkError):  # the reset comes while connecting or after it
        client.get("/long")
