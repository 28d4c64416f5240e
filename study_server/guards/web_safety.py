"""What stands before every endpoint: body limit, same-origin check for posts, response headers, the last resort.

Plain ASGI. docs/threat-model.md says against whom.
"""

import asyncio
import logging
import traceback
from collections.abc import Awaitable, Callable, Mapping, MutableMapping, Sequence
from typing import Any
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

BODY_LIMIT = 131_072
"""Bytes. A trial of 100 questions is 12 KB; the longest comment, 10,000 characters, is 90 KB in a form, where one of
Chinese is nine bytes long (%E6%BC%A2)."""

BODY_S = 60.0
"""How long a body may be on its way: 128 KiB by a bad telephone line (18 kbit/s)."""

HTTPS_ONLY_S = 365 * 24 * 3600
"""For how long a browser that came by HTTPS refuses to come without."""

log = logging.getLogger(__name__)

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
    "form-action 'self'; base-uri 'none'; frame-ancestors {frames}"
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
    "X-Robots-Tag": "noindex, nofollow",
}


class TooLarge(HTTPException):
    """The body has more bytes than `BODY_LIMIT`. The framework lets this kind through where it reads JSON itself."""

    def __init__(self) -> None:
        super().__init__(413, f"More than {BODY_LIMIT} bytes were sent.")


class TooSlow(HTTPException):
    """The body was not there after `BODY_S`."""

    def __init__(self) -> None:
        super().__init__(408, f"The request took more than {BODY_S:.0f} s to arrive.", {"Connection": "close"})


class WebSafety:
    """What is checked around an ASGI application, and the headers of its answers.

    `report_script`: the source that pages of the report may run. `frame_ancestors`: sites that may show participants'
    pages in a frame; /admin is never shown in one.
    """

    def __init__(self, app: ASGIApp, report_script: str = "'none'", frame_ancestors: Sequence[str] = ()) -> None:
        self.app = app
        self.report_policy = REPORT_POLICY.format(script=report_script)
        self.admin_policy = POLICY.format(frames="'none'")
        self.policy = POLICY.format(frames=" ".join(frame_ancestors) or "'none'")

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request, or refuse it with 403; while its body is read, with 413 or 408; 500 if all else fails."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        send = with_headers(send, self.headers_of(scope))
        if scope["method"] not in ("GET", "HEAD", "OPTIONS") and not is_same_origin(Headers(scope=scope)):
            refusal = JSONResponse({"error": "This request came from another site and was refused."}, 403)
            await refusal(scope, receive, send)
            return
        started = False

        async def send_noting(message: Message) -> None:
            nonlocal started
            started = True
            await send(message)

        try:
            await self.app(scope, limited(receive), send_noting)
        except ClientDisconnect:  # in the middle of a body; nothing was done with it
            return
        except Exception as error:
            log.error("unexpected: %s", without_values(error))
            if started:
                raise Unfinished from None
            await JSONResponse({"error": "Something went wrong here; please try again."}, 500)(scope, receive, send)

    def headers_of(self, scope: Scope) -> dict[str, str]:
        """What an answer to this request carries besides its own headers."""
        path = scope["path"]
        policy = self.admin_policy if path.startswith("/admin") else self.policy
        policy = self.report_policy if path.startswith("/admin/report/") else policy
        stored = "no-cache" if path.startswith("/static/") else "no-store"  # no-cache: kept, and asked for anew
        headers = {"Cache-Control": stored, "Vary": "Accept", **HEADERS, "Content-Security-Policy": policy}
        if scope["scheme"] == "https":
            headers["Strict-Transport-Security"] = f"max-age={HTTPS_ONLY_S}"
        return headers


class Unfinished(Exception):
    """An answer broke off; uvicorn closes the connection, so that it does not look whole."""


def without_values(error: BaseException) -> str:
    """Where an error came from, line by line, and of what kind it is, without its message.

    Messages quote what was being worked on: tokens, answers, names at the recruiting service.
    """
    causes = [error]
    while (before := causes[-1].__cause__ or causes[-1].__context__) is not None and before not in causes:
        causes.append(before)
    lines = []
    for each in reversed(causes):
        lines += [*traceback.format_tb(each.__traceback__), f"{type(each).__module__}.{type(each).__qualname__}\n"]
    return "\n" + "".join(lines)


def is_same_origin(headers: Headers) -> bool:
    """Whether a post comes from our own pages, or from a program, which sends neither of the two headers.

    Browsers send Sec-Fetch-Site on HTTPS and localhost, and Origin always.
    """
    fetch_site = headers.get("sec-fetch-site")
    if fetch_site is not None:
        return fetch_site in ("same-origin", "none")
    origin = headers.get("origin")
    try:
        return origin is None or urlsplit(origin).netloc == headers.get("host")
    except ValueError:  # no address at all, such as http://[
        return False


def limited(receive: Receive) -> Callable[[], Awaitable[MutableMapping[str, Any]]]:
    """`receive` that raises `TooLarge` once too much has come, whatever Content-Length said, and `TooSlow`."""
    total = 0
    is_whole = False
    until = asyncio.get_running_loop().time() + BODY_S

    async def receive_limited() -> Message:
        """The next piece of the body, counted and in time."""
        nonlocal total, is_whole
        if is_whole:  # what comes now is that the browser has left
            return await receive()
        try:
            async with asyncio.timeout_at(until):
                message = await receive()
        except TimeoutError:
            raise TooSlow from None
        total += len(message.get("body", b""))
        is_whole = not message.get("more_body", False)
        if total > BODY_LIMIT:
            raise TooLarge
        return message

    return receive_limited


def with_headers(send: Send, ours: Mapping[str, str]) -> Send:
    """`send` that adds those of `ours` that the response does not have."""

    async def send_with_headers(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in ours.items():
                headers.setdefault(name, value)
        await send(message)

    return send_with_headers
