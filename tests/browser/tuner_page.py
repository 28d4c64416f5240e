"""The tuner's page in a browser: what it asks the server for, and its controls by path."""

import json
from collections.abc import Callable
from typing import Any

from playwright.sync_api import Locator, Page, WebSocket
from waiting import until


class TunerPage:
    """A tab with the tuner. `wishes`: what it sent, the newest last."""

    def __init__(self, page: Page, url: str) -> None:
        self.page = page
        self.wishes: list[dict[str, Any]] = []
        page.on("websocket", self._listen)
        page.goto(url)
        page.locator("#picture:not([width='1'])").wait_for()

    def _listen(self, socket: WebSocket) -> None:
        socket.on("framesent", lambda text: self.wishes.append(json.loads(text)))

    def reset(self) -> None:
        """As it began, but for the history."""
        if self.page.locator("#reset-all").is_enabled():
            self.page.locator("#reset-all").click()
        self.wait_for_changes()
        self.wishes = self.wishes[-1:]

    def tab(self, name: str) -> None:
        """Choose a tab of the panel."""
        self.page.locator(f"#tab-{name}").click()

    def control(self, path: str) -> Locator:
        """The row of a field."""
        return self.page.locator(f".control[data-path='{path}']")

    def slider(self, path: str) -> Locator:
        """Of a number."""
        return self.control(path).locator("input[type=range]")

    def typed(self, path: str) -> Locator:
        """The number beside it."""
        return self.control(path).locator("input.typed")

    @property
    def settings(self) -> Any:
        """Those of the last wish that is not of something moving."""
        return next(wish for wish in reversed(self.wishes) if not wish["moving"])["settings"]

    @property
    def changes(self) -> Any:
        """What differs from the scene at the start."""
        return self.settings["changes"]

    def wait_for(self, holds: Callable[[], bool]) -> None:
        """Until something holds of what was sent."""

        def now() -> bool:
            self.page.title()  # lets events in
            return holds()

        until(now, 15)

    def wait_for_changes(self, **expected: Any) -> None:
        """Until exactly these changes are asked for; `__` stands for the dots of a path."""
        wanted = {path.replace("__", "."): value for path, value in expected.items()}
        self.wait_for(lambda: self.changes == wanted)
