"""The tuner's page as tests see it: what it says to the server, and what stands on its canvas."""

import base64
import json
import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any
from urllib.parse import quote

import numpy as np
import numpy.typing as npt
from playwright.sync_api import Browser, Page, WebSocket, WebSocketRoute

Pixels = npt.NDArray[np.uint8]
Told = dict[str, Any]

SECONDS = 20.0  # for what a busy machine does


class Talk:
    """What a page and the tuner say to each other, in order: `("wish" | "frame" | "message", its JSON)`."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.said: list[tuple[str, Told]] = []
        page.on("websocket", self._opened)

    def _opened(self, socket: WebSocket) -> None:
        socket.on("framesent", lambda payload: self.said.append(("wish", json.loads(payload))))
        socket.on("framereceived", self._received)

    def _received(self, payload: str | bytes) -> None:
        if isinstance(payload, str):
            self.said.append(("message", json.loads(payload)))
            return
        (length,) = struct.unpack_from("<I", payload)
        self.said.append(("frame", json.loads(payload[4 : 4 + length])))

    def of(self, kind: str) -> list[Told]:
        """Everything of one kind."""
        return [told for each, told in self.said if each == kind]

    @property
    def changes(self) -> Told:
        """What differs from the scene at the start, as the page last asked."""
        changes: Told = self.of("wish")[-1]["settings"]["changes"]
        return changes

    @property
    def most_under_way(self) -> int:
        """The most wishes that were sent and not yet answered."""
        most, open_wishes = 0, set[int]()
        for kind, told in self.said:
            if kind == "wish":
                open_wishes.add(told["number"])
            else:
                open_wishes.discard(told.get("number", -1))
            most = max(most, len(open_wishes))
        return most

    def settled(self, *, after: int = 0) -> Told:
        """The header of the still picture on the canvas, once it is that of the last wish; of more than `after`."""
        # twice: a wish that waited for this picture is sent as soon as it is there
        wait(self.page, lambda: len(self.of("wish")) > after and self._is_settled() and self._is_settled())
        return self.of("frame")[-1]

    def _is_settled(self) -> bool:
        wish = self.of("wish")[-1]
        place = self.page.locator("#place")
        shown = place.get_attribute("data-wish"), place.get_attribute("data-moving")
        frames = self.of("frame")
        is_last = shown == (str(wish["number"]), "false") and frames[-1]["number"] == wish["number"]
        return is_last and not frames[-1]["stand_in"]


class Stills:
    """The PNG of every still frame that a page was sent, by its wish's number."""

    def __init__(self, page: Page) -> None:
        self.by_number: dict[int, bytes] = {}
        page.on("websocket", self._listen)

    def _listen(self, socket: WebSocket) -> None:
        socket.on("framereceived", self._keep)

    def _keep(self, payload: str | bytes) -> None:
        if isinstance(payload, bytes):
            (length,) = struct.unpack_from("<I", payload)
            header = json.loads(payload[4 : 4 + length])
            if not header["moving"]:
                self.by_number[header["number"]] = payload[4 + length :]


def wait(page: Page, condition: Callable[[], object]) -> None:
    """Return once `condition()` holds, while the page's events go on; an assertion fails after `SECONDS`."""
    for _ in range(int(SECONDS * 100)):
        if condition():
            return
        page.wait_for_timeout(10)
    raise AssertionError("it did not happen")


@contextmanager
def one_page(browser: Browser, url: str, **context: Any) -> Iterator[Talk]:
    """A page for several tests, 1280 x 800; a script error in it fails the last of them."""
    with browser.new_context(viewport={"width": 1280, "height": 800}, **context) as profile:
        page = profile.new_page()
        errors: list[str] = []
        page.on("pageerror", lambda error: errors.append(str(error)))
        yield opened(page, url)
        assert errors == []


def opened(page: Page, url: str) -> Talk:
    """The tuner's page with its first picture."""
    talk = Talk(page)
    page.goto(url)
    talk.settled()
    return talk


def on_canvas(page: Page, canvas: str = "#picture") -> Pixels:
    """What a canvas holds, (height, width, 4)."""
    width, height, data = page.locator(canvas).evaluate(
        """canvas => {
          const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          let text = "";
          for (let i = 0; i < data.length; i += 32768) text += String.fromCharCode(...data.subarray(i, i + 32768));
          return [canvas.width, canvas.height, btoa(text)];
        }"""
    )
    return np.frombuffer(base64.b64decode(data), np.uint8).reshape(height, width, 4)


def middle(page: Page) -> tuple[float, float]:
    """Of the picture, in CSS pixels of the window."""
    box = page.locator("#picture").bounding_box()
    assert box
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def drag(page: Page, right: float, down: float, button: Any = "left", steps: int = 12) -> None:
    """From the picture's middle, with a button of the mouse."""
    x, y = middle(page)
    page.mouse.move(x, y)
    page.mouse.down(button=button)
    page.mouse.move(x + right, y + down, steps=steps)
    page.mouse.up(button=button)


def by_hand(page: Page, url: str) -> Talk:
    """The page with its first picture, and a clock that stands still unless it is told to run."""
    page.clock.install(time=0)
    talk = opened(page, url)
    page.clock.pause_at(3600)
    return talk


def rewrite(
    page: Page, header: Callable[[dict[str, Any]], dict[str, Any]], image: Callable[[dict[str, Any], bytes], bytes]
) -> None:
    """Frames come to the page with another header and image."""

    def between(route: WebSocketRoute) -> None:
        server = route.connect_to_server()

        def passed_on(message: str | bytes) -> None:
            if isinstance(message, bytes):
                (length,) = struct.unpack_from("<I", message)
                told = json.loads(message[4 : 4 + length])
                text = json.dumps(header(told)).encode()
                message = struct.pack("<I", len(text)) + text + image(told, message[4 + length :])
            route.send(message)

        server.on_message(passed_on)

    page.route_web_socket("**/socket", between)


def panel(page: Page, name: str) -> None:
    """Open one of the panel's tabs."""
    page.get_by_role("tab", name=name).click()


def link(url: str, settings: dict[str, Any]) -> str:
    """The address that restores `settings`."""
    return f"{url}#s={quote(json.dumps(settings))}"


def press(talk: Talk, *keys: str) -> Pixels:
    """Keys on the picture; the still picture they lead to."""
    seen = len(talk.of("wish"))
    talk.page.locator("#place").focus()
    for key in keys:
        talk.page.keyboard.press(key)
    talk.settled(after=seen)
    return on_canvas(talk.page)


def shows(page: Page, picture: Pixels) -> None:
    """Wait until this is on the canvas."""
    wait(page, lambda: np.array_equal(on_canvas(page), picture))


def pinned(page: Page, count: int) -> None:
    """Pin what there is, as the pin of this number."""
    page.locator("#pin").click()
    image = page.locator("#pins img").nth(count - 1)
    wait(page, lambda: image.evaluate("img => img.complete && img.naturalWidth") > 0)
