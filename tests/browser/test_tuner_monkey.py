"""Whatever is done to the tuner, in whatever order: one wish is under way, and undo leads back to the first picture."""

import random
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from playwright.sync_api import Page
from tuner_pages import Talk, drag, middle, on_canvas, opened, wait
from tuner_server import tuned

from fakesss.scene import Scene

pytestmark = [pytest.mark.browser, pytest.mark.gl]

BASE = Scene.from_dict(
    {"object": "sphere:1000", "size": (64, 64), "supersampling": 1, "occlusion": {"rays": 4}}, "test"
)
KEYS = [
    "ArrowLeft",
    "ArrowUp",
    "Shift+ArrowRight",
    "Shift+ArrowDown",
    "+",
    "-",
    "0",
    "b",
    "1",
    "2",
    "Control+z",
    "Control+y",
]


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """One tuner for all of these."""
    with tuned(BASE, tmp_path_factory.mktemp("tuner")) as address:
        yield address


class Monkey:
    """Does anything that a hand can do on the stage and to its pins; each `act` one thing."""

    def __init__(self, page: Page, seed: int) -> None:
        self.page, self.random = page, random.Random(seed)
        self.acts: list[Callable[[], None]] = [
            self.drags,
            self.drags,
            self.key,
            self.key,
            self.key,
            self.wheel,
            self.button,
            self.view,
            self.animation,
        ]

    def act(self) -> None:
        self.random.choice(self.acts)()

    def drags(self) -> None:
        button = self.random.choice(["left", "right", "middle"])
        right, down = self.random.randint(-60, 60), self.random.randint(-60, 60)
        drag(self.page, right, down, button, steps=self.random.randint(1, 6))

    def key(self) -> None:
        self.page.locator("#place").focus()
        self.page.keyboard.press(self.random.choice(KEYS))

    def wheel(self) -> None:
        self.page.mouse.move(*middle(self.page))
        self.page.mouse.wheel(0, self.random.randint(-300, 300))

    def button(self) -> None:
        places = "#undo, #redo, #previous, #pin, #pins button, #show-difference, #reset-camera"
        buttons = self.page.locator(places).locator("visible=true").all()
        chosen = self.random.choice([each for each in buttons if each.is_enabled()] or [None])
        if chosen:
            chosen.click()

    def view(self) -> None:
        self.page.locator("#view").select_option(self.random.choice(["picture", "thickness", "front"]))

    def animation(self) -> None:
        name, box = self.random.choice([("Camera", "#auto-rotation"), ("Lights", "#random-lighting")])
        self.page.get_by_role("tab", name=name).click()
        self.page.locator(box).click()


@pytest.mark.parametrize(
    ("seed", "acts"), [(7, 15), *(pytest.param(seed, 60, marks=pytest.mark.long) for seed in range(8, 20))]
)
def test_undo_leads_back_from_anywhere(page: Page, url: str, seed: int, acts: int) -> None:
    talk: Talk = opened(page, url)
    first = on_canvas(page)
    monkey = Monkey(page, seed)
    for _ in range(acts):
        monkey.act()
    for box, name in (("#auto-rotation", "Camera"), ("#random-lighting", "Lights")):
        page.get_by_role("tab", name=name).click()
        page.locator(box).uncheck()
    undo = page.locator("#undo")
    while undo.is_enabled():
        undo.click()
    page.locator("#view").select_option("picture")
    talk.settled()
    if page.locator("#show-difference").get_attribute("aria-pressed") == "true" and page.locator("#pins li").count():
        page.locator("#show-difference").click()
    assert talk.changes == {}
    wait(page, lambda: np.array_equal(on_canvas(page), first))
    assert talk.most_under_way == 1
