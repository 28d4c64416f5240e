"""Pictures that arrive late, damaged, in part or not at all are asked for again; whole ones are asked for once."""

import time
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from faulty_network import faulty_network
from playwright.sync_api import Page, expect
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from steps import answerable, rate
from trial_pages import begun, short_study, shown_and_rendered

from study_server.app import create_app
from study_server.serve import running, served

pytestmark = pytest.mark.browser


def coming(url: str, path: str) -> list[dict[str, Any]]:
    """The pictures of the trial that is due and of those ahead, as the server names them."""
    page = httpx.get(f"{url}{path}", headers={"Accept": "application/json"}).json()
    return [trial["picture"] for trial in (page, *page["ahead"])]


def test_a_picture_that_stalls_beforehand_does_not_keep_its_trial_waiting(page: Page, tmp_path: Path) -> None:
    with served(short_study(tmp_path)) as url, faulty_network(url) as network:
        path = begun(url).removeprefix(url)
        second = coming(url, path)[1]["url"]
        network.stall_next_response(after_bytes=100, where=f"GET {second}")
        page.goto(network.url + path)
        answerable(page, "1 of 6")
        network.wait_for("stalled response")
        page.wait_for_timeout(1100)  # so long ago that nothing more is to be expected
        rate(page, "44")
        begun_at = time.monotonic()
        answerable(page, "2 of 6")
        assert time.monotonic() - begun_at < 3  # the stall alone would be noticed after 5 s
        assert network.requested(f"GET {second}") == 2


@pytest.mark.parametrize("fault", ["truncated", "stalled", "refused"])
def test_a_picture_that_arrives_badly_is_asked_for_again(page: Page, tmp_path: Path, fault: str) -> None:
    study = short_study(tmp_path)
    with served(study) as url, faulty_network(url) as network:
        path = begun(url).removeprefix(url)
        first = f"GET {coming(url, path)[0]['url']}"
        if fault == "truncated":
            network.truncate_next_response(after_bytes=100, n=2, where=first)
        elif fault == "stalled":
            network.stall_next_response(after_bytes=100, where=first)
        else:
            page.route("**/picture/*", lambda route: route.fulfill(status=503), times=2)
        page.goto(network.url + path)
        expect(page.locator(".question input").first).to_be_enabled(timeout=20_000)
        assert np.array_equal(*shown_and_rendered(page, study))


class Damaging:
    """An application whose pictures have one wrong bit when they are asked for the first time."""

    def __init__(self, app: ASGIApp) -> None:
        self.app, self.seen = app, set[str]()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request."""
        path = scope.get("path", "")
        damaged = path.startswith("/picture/") and path not in self.seen
        self.seen.add(path)

        async def send_damaged(message: Message) -> None:
            if message.get("body"):
                message["body"] = message["body"][:-20] + bytes([message["body"][-20] ^ 1]) + message["body"][-19:]
            await send(message)

        await self.app(scope, receive, send_damaged if damaged else send)


def test_a_damaged_picture_is_asked_for_past_the_cache_that_holds_it(page: Page, tmp_path: Path) -> None:
    study = short_study(tmp_path)
    app = create_app(study)
    app.add_middleware(Damaging)
    with running(app) as url:
        page.goto(begun(url))
        for trial in (1, 2, 3):
            answerable(page, f"{trial} of 6")
            assert np.array_equal(*shown_and_rendered(page, study))
            rate(page, "44")


def test_each_picture_is_asked_for_once(page: Page, tmp_path: Path) -> None:
    with served(short_study(tmp_path)) as url, faulty_network(url) as network:
        page.goto(begun(network.url))
        for trial in range(1, 7):
            answerable(page, f"{trial} of 6")
            rate(page, "44")
        page.wait_for_selector("body.comments")
        pictures = [line for line in network.lines if line.startswith("GET /picture/")]
        assert len(pictures) == len(set(pictures)) == 6
