"""Nobody uses a tuner who was not given its address: other hosts' names, other sites' pages, guessed secrets."""

import socket
from collections.abc import Iterator
from urllib.parse import urlsplit

import httpx
import pytest
from starlette.datastructures import Headers
from tuner_server import tab, tuned
from websockets.exceptions import InvalidStatus

from fakesss.scene import Scene
from fakesss.tuner.guards import is_same_origin, known_names

BASE = Scene(object="sphere:1000", size=(32, 32))


@pytest.fixture(scope="module")
def http() -> Iterator[httpx.Client]:
    """One for all: each takes long to make."""
    with httpx.Client() as client:
        yield client


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with tuned(BASE, tmp_path_factory.mktemp("tuner")) as address:
        yield address


def place(url: str) -> str:
    """Host and port."""
    return urlsplit(url).netloc


PATHS = ("", "start.json", "static/settings.js")


@pytest.mark.gl
@pytest.mark.parametrize("path", PATHS)
def test_without_the_secret_there_is_nothing(http: httpx.Client, url: str, path: str) -> None:
    root, token = url[:-1].rsplit("/", 1)
    assert len(token) >= 22  # 128 bits
    for guess in ("", "x", token[:-1], token + "x", token.swapcase(), "ü" * 22, "%00", "..", "static"):
        answer = http.get(f"{root}/{guess}/{path}")
        assert answer.status_code == 404 and token not in answer.text
    assert http.get(root).status_code == 404
    assert http.get(url + path).status_code == 200


@pytest.mark.gl
def test_without_a_slash_one_is_led_to_it(http: httpx.Client, url: str) -> None:
    """Addresses in the page are relative to it."""
    answer = http.get(url.removesuffix("/"))
    assert answer.status_code == 307 and httpx.URL(url).join(answer.headers["location"]) == httpx.URL(url)


@pytest.mark.gl
def test_a_slash_too_many_does_not_lead_out_of_the_secret(http: httpx.Client, url: str) -> None:
    assert http.get(url + "start.json/").status_code == 404


@pytest.mark.gl
@pytest.mark.parametrize(
    ("method", "body", "status", "words"),
    [
        ("POST", b'{"view": "\xff"}', 400, "could not be read"),
        ("POST", b'{"view": ' + b"[" * 100_000 + b"]" * 100_000 + b"}", 400, "could not be read"),
        ("POST", b'{"view": ' + b"1" * 5000 + b"}", 400, "could not be read"),
        ("POST", rb'{"view": "\ud800"}', 422, 'view "\ud800"'),
        ("POST", rb'{"settings": {"changes": {"\ud800": 1}}}', 422, "\ud800"),
        ("DELETE", b"", 405, "This address does not take DELETE."),
    ],
)
def test_a_refusal_says_what_is_wrong(
    http: httpx.Client, url: str, method: str, body: bytes, status: int, words: str
) -> None:
    answer = http.request(method, url + "picture", content=body, headers={"Content-Type": "application/json"})
    assert answer.status_code == status and words in answer.json()["error"]


@pytest.mark.gl
@pytest.mark.parametrize(
    "host",
    ["evil.example", "evil.example:{port}", "127.0.0.1.evil.example", "localhost.evil.example:{port}", "", "a b"],
)
def test_a_name_that_was_pointed_here_is_refused(http: httpx.Client, url: str, host: str) -> None:
    """DNS rebinding: a page at evil.example has its name resolve to 127.0.0.1, and is of our origin then."""
    headers = {"Host": host.format(port=urlsplit(url).port)}
    answer = http.get(url, headers=headers)
    assert answer.status_code == 421 and "--host" in answer.json()["error"]
    with pytest.raises(InvalidStatus) as refused, tab(url, additional_headers=headers):
        pass
    assert refused.value.response.status_code in (400, 421)


@pytest.mark.gl
def test_two_hosts_are_none(url: str) -> None:
    with socket.create_connection(("127.0.0.1", urlsplit(url).port or 0)) as line:
        path = urlsplit(url).path
        line.sendall(
            f"GET {path} HTTP/1.1\r\nHost: localhost\r\nHost: evil.example\r\nConnection: close\r\n\r\n".encode()
        )
        answer = b"".join(iter(lambda: line.recv(4096), b""))
    assert answer.split()[1] in (b"400", b"421")


@pytest.mark.gl
@pytest.mark.parametrize("name", ["localhost", "127.0.0.1", "[::1]", "LOCALHOST"])
def test_names_of_this_machine_at_any_port(http: httpx.Client, url: str, name: str) -> None:
    """An SSH tunnel may end at another port."""
    for host in (name, f"{name}:9999"):
        assert http.get(url, headers={"Host": host}).status_code == 200


@pytest.mark.gl
@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "http://[", "https://localhost:1", "http://127.0.0.1"]
)
def test_another_sites_page_can_neither_post_nor_listen(http: httpx.Client, url: str, origin: str) -> None:
    for path in ("picture", "save", "study", "medium", "object?name=x.ply"):
        assert http.post(url + path, json={}, headers={"Origin": origin}).status_code == 403
    assert http.delete(url, headers={"Origin": origin}).status_code == 403
    with pytest.raises(InvalidStatus) as refused, tab(url, origin=origin):
        pass
    assert refused.value.response.status_code == 403


@pytest.mark.gl
def test_our_own_page_can(http: httpx.Client, url: str) -> None:
    origin = f"http://{place(url)}"
    assert http.post(url + "picture", json={}, headers={"Origin": origin}).status_code == 200
    with tab(url, origin=origin) as viewer:
        viewer.finished()


@pytest.mark.gl
@pytest.mark.parametrize("path", [*PATHS, "nothing"])
def test_what_every_answer_carries(http: httpx.Client, url: str, path: str) -> None:
    headers = http.get(url + path).headers
    policy = headers["content-security-policy"]
    assert "default-src 'none'" in policy and "script-src 'self';" in policy and "style-src 'self';" in policy
    assert f"connect-src 'self' ws://{place(url)};" in policy and "frame-ancestors 'none'" in policy
    assert headers["x-content-type-options"] == "nosniff" and headers["referrer-policy"] == "same-origin"
    assert headers["cache-control"] == ("no-cache" if path.startswith("static/") else "no-store")
    assert "access-control-allow-origin" not in headers and "server" not in headers


@pytest.mark.parametrize(
    ("host", "name", "is_ours"),
    [
        ("127.0.0.1", "192.0.2.7", False),
        ("192.0.2.7", "192.0.2.7", True),
        ("192.0.2.7", "192.0.2.8", False),
        ("::1", "[::1]", True),
        ("2001:db8::1", "[2001:0DB8:0::1]", True),
        ("::ffff:192.0.2.7", "[::ffff:c000:207]", True),
        ("0.0.0.0", "192.0.2.7", True),
        ("0.0.0.0", "[2001:db8::1]", True),
        ("0.0.0.0", "evil.example", False),
        ("::", "192.0.2.7", True),
    ],
)
def test_which_names_are_ours(host: str, name: str, is_ours: bool) -> None:
    assert known_names(host, host)(name.lower()) is is_ours
    assert known_names(host, host)("localhost")


def test_a_name_that_was_given_and_its_address_are_ours() -> None:
    is_ours = known_names("Lab.example", "192.0.2.7")
    assert [is_ours(name) for name in ("lab.example", "192.0.2.7", "192.0.2.8", "evil.example")] == [
        True,
        True,
        False,
        False,
    ]


@pytest.mark.parametrize(
    ("origin", "is_same"),
    [("http://localhost:80", True), ("https://localhost:80", True), ("http://localhost", False), ("null", False)],
)
def test_origins(origin: str, is_same: bool) -> None:
    assert is_same_origin(Headers({"host": "localhost:80", "origin": origin})) is is_same
