"""The controls of the tuner's panel, by path."""

from collections.abc import Callable
from typing import Any

from playwright.sync_api import Locator, Page
from tuner_pages import opened, wait

from fakesss.scene import Scene

BASE = Scene.from_dict(
    {"object": "sphere:1000", "size": [64, 64], "supersampling": 1, "occlusion": {"rays": 4}}, "test"
)
"""The scene of the tuner that the tests of the panel share."""


class Panel:
    """A tab with the tuner."""

    def __init__(self, page: Page, url: str) -> None:
        self.page = page
        self.errors: list[str] = []
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.talk = opened(page, url)

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

    def type(self, path: str, text: str) -> None:
        """Write a number and be done."""
        self.typed(path).fill(text)
        self.typed(path).press("Enter")

    @property
    def moved(self) -> Any:
        """The settings of the last wish."""
        return self.talk.of("wish")[-1]["settings"]

    @property
    def settings(self) -> Any:
        """Those of the last wish that is not of something moving."""
        return next(wish for wish in reversed(self.talk.of("wish")) if not wish["moving"])["settings"]

    @property
    def changes(self) -> Any:
        """What differs from the scene at the start."""
        return self.settings["changes"]

    def wait_for(self, holds: Callable[[], object]) -> None:
        """Until something holds of what was sent."""
        wait(self.page, holds)

    def wait_for_changes(self, changes: dict[str, Any]) -> None:
        """Until exactly these changes are asked for."""
        self.wait_for(lambda: self.changes == changes)

    def reset(self) -> None:
        """As it began, but for the history."""
        if self.page.locator("#reset-all").is_enabled():
            self.page.locator("#reset-all").click()
        self.wait_for(lambda: self.settings == {"changes": {}, "effects": {}})
        self.talk.settled()
        self.talk.said = [("wish", self.talk.of("wish")[-1]), ("frame", self.talk.of("frame")[-1])]
