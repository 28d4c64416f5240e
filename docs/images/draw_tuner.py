"""Takes the tuner's picture for the documentation: `python docs/images/draw_tuner.py`."""

import io
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright

from analysis.pdf import sandbox
from fakesss.browser import find_browser
from fakesss.scene import Scene
from fakesss.tuner.serve import tuned

HERE = Path(__file__).parent
PROBE = HERE.parents[1] / "benchmarks" / "tuner_probe.js"
WINDOW = {"width": 1440, "height": 940}
CHANGES = {"thickness_exponent": "12", "backlight": "0.8", "diffuse_weight": "0"}  # each pinned with those before it
AT_REST = """() => { const last = window.probe.frames.at(-1);
  return last && !last.moving && !last.stand_in && last.shown && last.number === window.probe.sent.at(-1).number }"""


def screenshot(page: Page) -> Image.Image:
    """The page with four settings pinned, turned a little, the Material panel open."""
    page.wait_for_function(AT_REST)
    drag(page, 90, -20)
    page.wait_for_function(AT_REST)
    page.get_by_role("tab", name="Material").click()
    page.locator("#pin").click()
    for field, value in CHANGES.items():
        number = page.locator(f'[data-path="material.{field}"] .typed')
        number.fill(value)
        number.press("Enter")
        page.wait_for_function(AT_REST)
        page.locator("#pin").click()
    page.wait_for_function(
        "count => document.querySelectorAll('#pins img[src]').length === count", arg=1 + len(CHANGES)
    )
    return Image.open(io.BytesIO(page.screenshot()))


def drag(page: Page, right: float, down: float) -> None:
    """Turn the object by hand, so that the status bar has something to say."""
    box = page.locator("canvas#picture").bounding_box()
    assert box
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + right, y + down, steps=60)
    page.mouse.up()


if __name__ == "__main__":
    scene = Scene(object="figure:60000")
    with (
        tempfile.TemporaryDirectory() as folder,
        tuned(scene, Path(folder)) as url,
        sync_playwright() as playwright,
    ):
        browser = playwright.chromium.launch(executable_path=find_browser(), args=sandbox())
        page = browser.new_page(viewport=WINDOW)
        page.add_init_script(path=PROBE)
        page.goto(url)
        screenshot(page).convert("RGB").quantize(256).save(HERE / "tuner.png", optimize=True)
        browser.close()
