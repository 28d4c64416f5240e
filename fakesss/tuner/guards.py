"""Who is let in: the address of a tuner holds a secret, and no other site's page may use it (docs/threat-model.md).

Plain ASGI, around everything. A page of another site cannot read the secret; if it learned it, it could still neither
post nor open a WebSocket (Origin), nor reach the tuner under a name of its own that points here (Host).
"""

import asyncio
import contextlib
import hmac
import ipaddress
import re
import socket
from collections.abc import Callable
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from fakesss.tuner.answers import refused
from fakesss.tuner.uploads import MOST_BYTES

OWN_NAMES = ("localhost", "127.0.0.1", "[::1]")
HOST = re.compile(r"(?P<name>[A-Za-z0-9.-]+|\[[0-9A-Fa-f:.]+\])(:[0-9]{1,5})?")

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self' ws://{host}; "
    "form-action 'none'; base-uri 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "same-origin",  # the address holds the secret; `no-referrer` would blank the Origin of our posts
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=()",
    "X-Robots-Tag": "noindex, nofollow",
}
BODY_LIMIT = 1 << 20  # bytes of a post; 32 lights are 16 KB
LIMITS = {"object": MOST_BYTES}  # of the others


class Guards:
    """Refuses who does not know `token` or comes from elsewhere; what is inside sees paths without the token.

    `host`: what it was told to listen on; `address`: the IP address that this is.
    """

    def __init__(self, app: ASGIApp, token: str, host: str, address: str) -> None:
        self.app, self.token, self.is_ours = app, token.encode(), known_names(host, address)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request or WebSocket, or refuse it with one sentence."""
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        first, slash, path = scope["path"].removeprefix("/").partition("/")
        send = with_headers(send, headers.get("host", ""), is_kept=path.startswith("static/"))
        if refusal := self.refusal(scope, headers, first, LIMITS.get(path, BODY_LIMIT)):
            await refusal(scope, receive, send)
        elif not slash:
            await RedirectResponse(f"/{first}/")(scope, receive, send)  # addresses in the page are relative to it
        else:
            inside = {**scope, "path": f"/{path}", "raw_path": f"/{path}".encode()}
            try:
                await self.app(inside, receive, send)
            except asyncio.CancelledError:
                if scope["type"] == "http":
                    with contextlib.suppress(RuntimeError):  # part of an answer was sent already
                        await refused(503, "The tuner was stopped.")(scope, receive, send)

    def refusal(self, scope: Scope, headers: Headers, first: str, limit: int) -> Response | None:
        """What is said to who may not come in. `limit`: bytes of a body; who lies about it is stopped inside."""
        hosts = headers.getlist("host")
        name = HOST.fullmatch(hosts[0]) if len(hosts) == 1 else None
        if not name or not self.is_ours(name["name"].lower()):
            return refused(421, "The tuner is not served under this name; start it with --host NAME to allow it.")
        if not hmac.compare_digest(first.encode("utf-8", "surrogatepass"), self.token):
            return refused(404, "There is no such page; use the address that `fakesss tune` printed.")
        posts = scope["type"] == "websocket" or scope["method"] not in ("GET", "HEAD")
        if posts and not is_same_origin(headers):
            return refused(403, "This request came from another site and was refused.")
        length = headers.get("content-length", "0")
        if length.isdecimal() and int(length) > limit:
            return refused(413, f"This is more than the {limit >> 20} MB that can be taken here.")
        return None


def known_names(host: str, address: str) -> Callable[[str], bool]:
    """Whether a name in lower case, as it stands in a Host header, is one of ours when listening on `host`, which is
    `address`.

    An address is no name that somebody else could point here: where we listen on it, it is ours however it is spelt.
    """
    bound = ipaddress.ip_address(address)
    ours = {*OWN_NAMES, host.lower()}
    if bound.is_unspecified:  # everywhere
        ours |= {socket.gethostname().lower(), socket.getfqdn().lower()}

    def is_ours(name: str) -> bool:
        meant = address_in(name)
        return name in ours or (meant is not None and (bound.is_unspecified or meant == bound))

    return is_ours


def address_in(name: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    """The IP address that a name is, version 6 in brackets; None of another name."""
    try:
        return ipaddress.ip_address(name.removeprefix("[").removesuffix("]"))
    except ValueError:
        return None


def is_same_origin(headers: Headers) -> bool:
    """Whether a post or a WebSocket comes from our own page, or from a program, which sends no Origin."""
    origin = headers.get("origin")
    try:
        return origin is None or urlsplit(origin).netloc == headers.get("host")
    except ValueError:  # no address at all, such as http://[
        return False


def with_headers(send: Send, host: str, is_kept: bool) -> Send:
    """`send` that adds our headers. `is_kept`: a browser may keep the answer, but must ask whether it is the same."""
    policy = POLICY.format(host=host if HOST.fullmatch(host) else "localhost")
    ours = {**HEADERS, "Cache-Control": "no-cache" if is_kept else "no-store", "Content-Security-Policy": policy}

    async def send_with_headers(message: Message) -> None:
        if message["type"] in ("http.response.start", "websocket.http.response.start"):
            headers = MutableHeaders(scope=message)
            for name, value in ours.items():
                headers.setdefault(name, value)
        await send(message)

    return send_with_headers
