"""How long a movement of the hand takes to be seen in the tuner: `python benchmarks/tuner_latency.py -o tuner`.

`fakesss tune` as a process of its own and a headless Chromium on the same machine, driven like a hand: a drag around
the picture, the wheel, a slider's thumb, movements 16 ms apart. Measured in the page by tuner_probe.js, which the
page's scripts do not know of: from the time stamp of the *first* input that a picture answers (what the operating
system would give it; Chromium gathers movements until its next frame) until the picture has been drawn on the canvas.
Nothing is left out: time spent waiting for the frame before counts, which is mostly its drawing. *Newest* is from the
last input that the picture answers, so how old the picture is that one sees.

*Outside* is the share of the total in which nothing was being drawn, this picture or the one before, by the server's
own times of drawing, the way to the page taken as long as the way back; *of answer* is 1 - draw over the time from the
wish's leaving the page, so without what the input waited for the picture before it. *Still* is from letting go until
the full picture, a PNG with all its samples, is on the canvas.
"""

import json
import os
import re
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from itertools import pairwise
from math import cos, pi, sin
from pathlib import Path
from typing import Any

import click
import numpy as np
from playwright.sync_api import Browser, Page, sync_playwright

from fakesss.bench import machine
from fakesss.browser import find_browser

HERE = Path(__file__).parent
PAUSE_S = 0.016  # between movements
WARM_UP = 25  # movements before those that count: programs compile, sizes settle
STILL = """() => { const last = window.probe.frames.at(-1);
  return last && !last.moving && !last.stand_in && last.shown && last.number === window.probe.sent.at(-1).number }"""
FORGET = "() => Object.values(window.probe).forEach((list) => { list.length = 0 })"
WINDOW = {"width": 1280, "height": 800}

Point = tuple[float, float]
Movement = Callable[[int], None]


@dataclass(frozen=True)
class Answered:
    """One picture while something moved: milliseconds."""

    total: float  # first input to canvas
    newest: float  # last input to canvas
    held: float  # first input to the wish's leaving
    wait: float  # at the server, for its turn
    draw: float
    encode: float
    travel: float  # both ways, and threads waking
    show: float  # decoding, drawing on the canvas
    outside: float  # of the total, while nothing was being drawn


@dataclass(frozen=True)
class Row:
    """What one gesture cost: medians over its pictures, in milliseconds unless named otherwise."""

    gesture: str
    faces: int
    viewers: int
    pictures: int
    per_second: float
    median: float
    p95: float
    newest: float
    draw: float
    outside: float  # median of the share, 0..1
    outside_of_answer: float
    held: float
    wait: float
    encode: float
    travel: float
    show: float
    width: int  # of the moving pictures, the most frequent
    still: float


@contextmanager
def tuner(scene: str) -> Iterator[str]:
    """`fakesss tune` of a scene on any free port: its address."""
    command = [sys.executable, "-m", "fakesss", "tune", scene, "--port", "0"]
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
    assert process.stdout is not None
    try:
        for line in process.stdout:
            if found := re.search(r"http://\S+", line):
                yield found.group()
                break
        else:
            raise SystemExit(f"{' '.join(command)} ended without an address")
    finally:
        process.terminate()
        process.wait()


def opened(browser: Browser, url: str) -> Page:
    """The tuner's page in a profile of its own, its first full picture there."""
    page = browser.new_context(viewport=WINDOW).new_page()
    page.add_init_script(path=HERE / "tuner_probe.js")
    page.goto(url)
    page.wait_for_function(STILL, timeout=60_000)
    return page


def middle(page: Page, what: str) -> Point:
    """Of an element, in CSS pixels of the window."""
    page.locator(what).scroll_into_view_if_needed()
    box = page.locator(what).bounding_box()
    assert box, what
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


@contextmanager
def drag(page: Page) -> Iterator[Movement]:
    """The left button held down over the picture: round and round."""
    x, y = middle(page, "canvas#picture")
    page.mouse.move(x, y)
    page.mouse.down()
    yield lambda step: page.mouse.move(x + 120 * sin(step * pi / 40), y + 60 * sin(step * pi / 25))
    page.mouse.up()


@contextmanager
def wheel(page: Page) -> Iterator[Movement]:
    """The wheel turned to and fro; it settles by itself."""
    page.mouse.move(*middle(page, "canvas#picture"))
    yield lambda step: page.mouse.wheel(0, 40 * (1 if step % 30 < 15 else -1))


@contextmanager
def slider(page: Page) -> Iterator[Movement]:
    """The thumb of the backlight's slider, drawn to and fro."""
    page.get_by_role("tab", name="Material").click()
    x, y = middle(page, '[data-path="material.backlight"] input[type=range]')
    page.mouse.move(x, y)
    page.mouse.down()
    yield lambda step: page.mouse.move(x + 40 * (1 - cos(step * pi / 30)), y)
    page.mouse.up()


GESTURES = {"drag": drag, "wheel": wheel, "slider": slider}


def measured(browser: Browser, gesture: str, faces: int, viewers: int, moves: int) -> Row:
    """A gesture at a tuner of its own, in all its viewers' pages at once."""
    with tuner(f"figure:{faces}") as url:
        pages = [opened(browser, url) for _ in range(viewers)]
        try:
            seconds = performed(pages, gesture, moves)
            notes = [page.evaluate("() => window.probe") for page in pages]
        finally:
            for page in pages:
                page.context.close()
    return summary((gesture, faces, viewers), notes, seconds)


def performed(pages: Sequence[Page], gesture: str, moves: int) -> float:
    """Moves all pages in turn; seconds that the movements took."""
    movements = [GESTURES[gesture](page) for page in pages]
    moved = [movement.__enter__() for movement in movements]
    start = 0.0
    for step in range(WARM_UP + moves):
        if step == WARM_UP:
            for page in pages:
                page.evaluate(FORGET)
            start = time.perf_counter()
        due = time.perf_counter() + PAUSE_S
        for move in moved:
            move(step)
        time.sleep(max(0.0, due - time.perf_counter()))
    seconds = time.perf_counter() - start
    for movement in movements:
        movement.__exit__(None, None, None)
    for page in pages:
        page.wait_for_function(STILL, timeout=60_000)
    return seconds


def answered(notes: dict[str, Any]) -> list[Answered]:
    """Every moving picture with the first input that it answers: one heard after the wish before it had left."""
    frames = {frame["number"]: frame for frame in notes["frames"] if frame["moving"] and frame["shown"]}
    sent = {wish["number"]: wish["at"] for wish in notes["sent"]}
    drawn = [drawing(frame, sent[frame["number"]]) for frame in notes["frames"] if frame["number"] in sent]
    found = []
    for before, wish in pairwise(notes["sent"]):
        inputs = [one["at"] for one in notes["inputs"] if before["at"] < one["heard"] <= wish["at"]]
        frame = frames.get(wish["number"])
        if not inputs or not frame:
            continue
        first, shown, way = min(inputs), frame["shown"], travel(frame, wish["at"])
        outside = shown - first - sum(max(0.0, min(shown, end) - max(first, start)) for start, end in drawn)
        times = {**frame["times"], "travel": way, "show": shown - frame["came"], "outside": outside}
        found.append(Answered(shown - first, shown - max(inputs), wish["at"] - first, **times))
    return found


def travel(frame: dict[str, Any], sent: float) -> float:
    """What passed between sending and coming that was not spent at the server."""
    return float(frame["came"] - sent - sum(frame["times"].values()))


def drawing(frame: dict[str, Any], sent: float) -> tuple[float, float]:
    """When it was begun and drawn, if the way back takes half of its travel."""
    end = frame["came"] - travel(frame, sent) / 2 - frame["times"]["encode"]
    return end - frame["times"]["draw"], end


def summary(what: tuple[str, int, int], notes: Sequence[dict[str, Any]], seconds: float) -> Row:
    """The row of one gesture; pictures of all viewers count alike."""
    pictures = [one for page in notes for one in answered(page)]
    if len(pictures) < 10:
        raise SystemExit(f"{what}: only {len(pictures)} pictures came; nothing can be said of them")

    def median(of: Callable[[Answered], float]) -> float:
        return float(statistics.median(map(of, pictures)))

    totals = [one.total for one in pictures]
    widths = [frame["width"] for page in notes for frame in page["frames"] if frame["moving"]]
    return Row(
        *what,
        pictures=len(pictures),
        per_second=len(pictures) / seconds / len(notes),
        median=statistics.median(totals),
        p95=float(np.percentile(totals, 95)),
        newest=median(lambda one: one.newest),
        draw=median(lambda one: one.draw),
        outside=median(lambda one: one.outside / one.total),
        outside_of_answer=median(lambda one: 1 - one.draw / (one.total - one.held)),
        held=median(lambda one: one.held),
        wait=median(lambda one: one.wait),
        encode=median(lambda one: one.encode),
        travel=median(lambda one: one.travel),
        show=median(lambda one: one.show),
        width=statistics.mode(widths),
        still=float(statistics.median(until_still(page) for page in notes)),
    )


def until_still(notes: dict[str, Any]) -> float:
    """From letting go (the wheel: from its last turn) until the full picture is shown."""
    end = notes["ends"][-1] if notes["ends"] else notes["inputs"][-1]["at"]
    return float(notes["frames"][-1]["shown"] - end)


def cases(faces: Sequence[int], usual: int) -> Iterator[tuple[str, int, int]]:
    """What is measured: a drag at every number of faces; at the usual one each gesture, and two people at once."""
    yield from (("drag", count, 1) for count in faces)
    yield from ((gesture, usual, 1) for gesture in GESTURES if gesture != "drag")
    yield ("drag", usual, 2)


def table(rows: Sequence[Row]) -> str:
    """What docs/tuner.md shows of them, in Markdown."""
    what = ("gesture", "faces", "viewers", "pictures/s")
    heads = (*what, "median", "95 %", "newest", "drawing", "outside", "of answer", "still")
    lines = [f"| {' | '.join(heads)} |", f"|---|{'--:|' * (len(heads) - 1)}"]
    for row in rows:
        times = (row.per_second, row.median, row.p95, row.newest, row.draw)
        told = [row.gesture, f"{row.faces:,}", row.viewers, *(f"{time:.0f}" for time in times)]
        told += [f"{row.outside:.0%}", f"{row.outside_of_answer:.0%}", f"{row.still:.0f}"]
        lines.append(f"| {' | '.join(map(str, told))} |")
    return "\n".join(lines)


@click.command()
@click.option("--faces", type=int, multiple=True, default=(4000, 60000, 240000), show_default=True)
@click.option("--usual", default=60000, show_default=True, help="Faces for the other gestures and two viewers.")
@click.option("--moves", default=200, show_default=True)
@click.option("-o", "--out", type=click.Path(path_type=Path), default=Path("tuner"), show_default=True)
def main(faces: tuple[int, ...], usual: int, moves: int, out: Path) -> None:
    """Print the latency of the tuner on this machine and write it to OUT/latency.json."""
    load = os.getloadavg()[0]
    with sync_playwright() as playwright:
        switches = ["--no-sandbox", "--disable-gpu"]
        browser = playwright.chromium.launch(executable_path=find_browser(), args=switches)
        rows = [measured(browser, *case, moves) for case in cases(faces, usual)]
        version = browser.version
    out.mkdir(parents=True, exist_ok=True)
    where = {**machine(), "chromium": version, "load_before": load}
    document = {"method": __doc__, "machine": where, "moves": moves, "rows": [asdict(row) for row in rows]}
    (out / "latency.json").write_text(json.dumps(document, indent=1), encoding="utf-8")
    click.echo(table(rows))


if __name__ == "__main__":
    main()
