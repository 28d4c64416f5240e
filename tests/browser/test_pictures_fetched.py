"""Pictures that arrive late, damaged, in part or not at all are asked for again; whole ones are asked for once."""

import time
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from faulty_network import faulty_network
from playwright.sync_api import Page, Route, expect
from steps import answerable, rate
from trial_pages import begun, short_study, shown_and_rendered

from study_server.serve import served

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


@pytest.mark.parametrize("fault", ["truncated", "stalled", "damaged", "refused"])
def test_a_picture_that_arrives_badly_is_asked_for_again(page: Page, tmp_path: Path, fault: str) -> None:
    study = short_study(tmp_path)
    with served(study) as url, faulty_network(url) as network:
        path = begun(url).removeprefix(url)
        first = coming(url, path)[0]
        bad = [{"status": 503}, {"status": 503}] if fault == "refused" else []
        if fault == "truncated":
            network.truncate_next_response(after_bytes=100, n=2, where=f"GET {first['url']}")
        elif fault == "stalled":
            network.stall_next_response(after_bytes=100, where=f"GET {first['url']}")
        elif fault == "damaged":
            data = bytearray(httpx.get(url + first["url"]).content)
            data[-20] ^= 1
            bad = [{"body": bytes(data), "headers": {"Cache-Control": "max-age=9999"}}] * 2
        replies, past_the_cache = iter(bad), []

        def badly(route: Route) -> None:
            past_the_cache.append(route.request.headers.get("cache-control") == "no-cache")
            reply = next(replies, None)
            route.fulfill(**reply) if reply else route.continue_()

        if bad:
            page.route(f"**{first['url']}", badly)
        page.goto(network.url + path)
        expect(page.locator(".question input").first).to_be_enabled(timeout=20_000)
        assert np.array_equal(*shown_and_rendered(page, study))
        assert next(replies, None) is None
        assert past_the_cache == ([False, True, False] if bad else [])  # what is damaged may lie in the browser's cache


def test_each_picture_is_asked_for_once(page: Page, tmp_path: Path) -> None:
    with served(short_study(tmp_path)) as url, faulty_network(url) as network:
        page.goto(begun(network.url))
        for trial in range(1, 7):
            answerable(page, f"{trial} of 6")
            rate(page, "44")
        page.wait_for_selector("body.comments")
        pictures = [line for line in network.lines if line.startswith("GET /picture/")]
        assert len(pictures) == len(set(pictures)) == 6
