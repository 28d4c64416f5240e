"""What stands before every endpoint: body limit, same-origin check for posts, response headers. Plain ASGI."""

from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

BODY_LIMIT = 65_536
"""Bytes. A trial of 100 questions is 12 KB; the longest comment is 20 KB."""

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
    "form-action 'self'; base-uri 'none'; frame-ancestors 'none'"
)
REPORT_POLICY = (
    "default-src 'none'; script-src {script}; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "form-action 'none'; base-uri 'none'; frame-ancestors 'none'"
)
"""The report is one file with its own style sheet inside; `script` is the one script it may run, named by its hash."""

HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "same-origin",  # addresses hold the participant's token; `no-referrer` would blank Origin
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=()",
}


class TooLarge(HTTPException):
    """The body has more bytes than `BODY_LIMIT`. The framework lets this kind through where it reads JSON itself."""

    def __init__(self) -> None:
        super().__init__(413, f"More than {BODY_LIMIT} bytes were sent.")


class WebSafety:
    """The three checks around an ASGI application. `report_script`: the source that pages of the report may run."""

    def __init__(self, app: ASGIApp, report_script: str = "'none'") -> None:
        self.app = app
        self.report_policy = REPORT_POLICY.format(script=report_script)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request, or refuse it with 403; while its body is read, with 413."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        send = with_headers(send, self.report_policy if scope["path"].startswith("/admin/report/") else POLICY)
        if scope["method"] not in ("GET", "HEAD", "OPTIONS") and not is_same_origin(Headers(scope=scope)):
            refusal = JSONResponse({"error": "This request came from another site and was refused."}, 403)
            await refusal(scope, receive, send)
            return
        await self.app(scope, limited(receive), send)


def is_same_origin(headers: Headers) -> bool:
    """Whether a post comes from our own pages, or from a program, which sends neither of the two headers.

    Browsers send Sec-Fetch-Site on HTTPS and localhost, and Origin always.
    """
    fetch_site = headers.get("sec-fetch-site")
    if fetch_site is not None:
        return fetch_site in ("same-origin", "none")
    origin = headers.get("origin")
    return origin is None or urlsplit(origin).netloc == headers.get("host")


def limited(receive: Receive) -> Callable[[], Awaitable[MutableMapping[str, Any]]]:
    """`receive` that raises `TooLarge` once too much has come, whatever Content-Length said."""
    total = 0

    async def receive_limited() -> Message:
        nonlocal total
        message = await receive()
        total += len(message.get("body", b""))
        if total > BODY_LIMIT:
            raise TooLarge
        return message

    return receive_limited


def with_headers(send: Send, policy: str) -> Send:
    """`send` that adds our headers to the response, `policy` among them."""

    async def send_with_headers(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            headers["Content-Security-Policy"] = policy
            headers.setdefault("Cache-Control", "no-store")
            headers.setdefault("Vary", "Accept")
            for name, value in HEADERS.items():
                headers[name] = value
        await send(message)

    return send_with_headers
