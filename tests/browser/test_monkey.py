"""Random keys, clicks, reloads, tabs, resizes and cuts of the network over a whole session: nothing breaks, nothing is
lost, doubled or out of order, and the session can still be finished."""

import contextlib
import random
import sqlite3
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import BrowserContext, Error, Page, Request, Response
from steps import ratings_by_trial
from study_fixture import write_study

from study_server.serve import served

pytestmark = pytest.mark.browser

KEYS = (
    "1",
    "2",
    "3",
    "4",
    "5",
    "6",
    "7",
    "8",
    "0",
    "Enter",
    "Enter",
    "Tab",
    "Shift+Tab",
    "Space",
    "ArrowRight",
    "Escape",
)
SEEDS = [1, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(2, 41))]
SURVEY = {"about": [], "screen_check": [], "checks": 1, "unsaved_ahead": 2}


class Monkey:
    """Somebody who means nothing by it. `page` is the tab in front."""

    def __init__(self, context: BrowserContext, url: str, seed: int) -> None:
        self.context, self.url, self.random = context, url, random.Random(seed)
        self.page = context.new_page()
        self.page.goto(url)
        self.address = self.page.url
        self.acts: list[tuple[Callable[[], Any], int]] = [
            (self.press, 40),
            (self.rate, 20),
            (self.click_anywhere, 20),
            (self.click_something, 25),
            (self.reload, 4),
            (self.go_back, 3),
            (self.go_forward, 3),
            (self.resize, 5),
            (self.other_tab, 3),
            (self.cut_or_heal, 4),
            (self.rest, 15),
        ]

    def act(self) -> None:
        """One thing; a page that is just leaving may not take it."""
        acts, weights = zip(*self.acts, strict=True)
        with contextlib.suppress(Error):
            self.random.choices(acts, weights)[0]()
        if not self.page.url.startswith(self.address):
            self.open_again()

    def open_again(self) -> None:
        """Back from wherever the way back or forward led, with a network."""
        self.context.set_offline(False)
        self.page.goto(self.address)

    def press(self) -> None:
        self.page.keyboard.press(self.random.choice(KEYS))

    def rate(self) -> None:
        for _ in range(3):
            self.page.keyboard.press(str(self.random.randint(1, 7)))
        self.page.keyboard.press("Enter")

    def click_anywhere(self) -> None:
        self.page.mouse.click(self.random.uniform(0, 900), self.random.uniform(0, 600))

    def click_something(self) -> None:
        things = self.page.locator("main button:visible, main label:visible").all()
        self.random.choice(things or [self.page.locator("body")]).click(
            timeout=500, click_count=self.random.choice((1, 1, 2))
        )

    def reload(self) -> None:
        self.page.reload(timeout=5000)

    def go_back(self) -> None:
        self.page.go_back(timeout=5000)

    def go_forward(self) -> None:
        self.page.go_forward(timeout=5000)

    def resize(self) -> None:
        self.page.set_viewport_size({"width": self.random.randint(320, 1400), "height": self.random.randint(400, 900)})

    def other_tab(self) -> None:
        if len(self.context.pages) < 3:
            self.context.new_page().goto(self.address)
        self.page = self.random.choice(self.context.pages)
        self.page.bring_to_front()

    def cut_or_heal(self) -> None:
        self.context.set_offline(self.random.random() < 0.6)

    def rest(self) -> None:
        self.page.wait_for_timeout(self.random.choice((20, 100, 400)))


@pytest.mark.parametrize("seed", SEEDS)
def test_a_monkey_breaks_nothing(context: BrowserContext, tmp_path: Path, seed: int) -> None:
    study = write_study(tmp_path / "study", pictures=9, survey=SURVEY)
    errors: list[str] = []
    sent: dict[str, dict[str, Any]] = {}
    acknowledged: set[str] = set()

    def note_sent(request: Request) -> None:
        if request.url.endswith("/ratings"):
            sent[request.post_data_json["submission"]] = request.post_data_json

    def note_acknowledged(response: Response) -> None:
        if response.url.endswith("/ratings") and response.status == 200:
            acknowledged.add(response.request.post_data_json["submission"])

    context.route("**/withdraw", lambda route: route.fulfill(status=204))  # nothing would be left to look at
    context.on("weberror", lambda error: errors.append(str(error.error)))
    context.on("request", note_sent)
    context.on("response", note_acknowledged)
    with served(study) as url:
        monkey = Monkey(context, url, seed)
        for _ in range(150):
            monkey.act()
        finish(monkey)
    assert errors == []
    judge(study, sent, acknowledged)


def finish(monkey: Monkey) -> None:
    """Somebody sensible takes over and gets to the code. The other tabs stay open."""
    monkey.open_again()
    page = monkey.page
    deadline = time.monotonic() + 60
    while (step := page.locator("body").get_attribute("class")) != "done":
        assert time.monotonic() < deadline, step
        with contextlib.suppress(Error):
            take_the_step(page)
        page.wait_for_timeout(20)
    assert len(page.locator("#code").inner_text()) == 8


def take_the_step(page: Page) -> None:
    """Answer what is open on this page, and go on."""
    page.evaluate(
        """() => {
            for (const group of document.querySelectorAll("fieldset:not(:disabled)"))
                if (!group.querySelector("input:checked")) group.querySelectorAll("input[type=radio]")[1]?.click();
            document.querySelector("main form button:not(.quiet)")?.click();
        }"""
    )


def judge(study: Path, sent: dict[str, dict[str, Any]], acknowledged: set[str]) -> None:
    """What is stored was sent by the page; what the server acknowledged is stored; first answers came in order."""
    database = sqlite3.connect(study / "ratings.sqlite")
    columns = "place, question, rating, submission, stored_at"
    firsts = database.execute(f"select {columns} from ratings order by place").fetchall()
    history = firsts + database.execute(f"select {columns} from revisions").fetchall()
    refused = database.execute("select detail from events where kind = 'refused'").fetchall()
    database.close()
    for place, question, rating, submission, _ in history:
        assert (place, question, rating) in given(sent[submission])
    assert {row for name in acknowledged for row in given(sent[name])} <= {row[:3] for row in history}
    times = [row[4] for row in firsts]
    assert times == sorted(times)
    assert refused == []
    assert all(all(ratings) for ratings in ratings_by_trial(study).values())


def given(answer: dict[str, Any]) -> set[tuple[int, str, int]]:
    """(place, question, rating) of one submission."""
    return {(answer["place"], each["question"], each["rating"]) for each in answer["answers"]}
