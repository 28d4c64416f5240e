"""The tuner's stage: what stands on the canvas, pixel by pixel, and what is said of it."""

import base64
import io
import itertools
import json
import secrets
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page, WebSocketRoute, expect
from tuner_pages import Pixels, drag, middle, on_canvas, opened, panel, rewrite, wait
from tuner_server import tuned

from fakesss.camera import View
from fakesss.renderer import render_file
from fakesss.scene import Scene

pytestmark = [pytest.mark.browser, pytest.mark.gl]

SIZE = 128
BASE = Scene.from_dict(
    {"object": "torus:1000", "size": (SIZE, SIZE), "supersampling": 2, "occlusion": {"rays": 4}}, "test"
)


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """One tuner for all of these."""
    with tuned(BASE, tmp_path_factory.mktemp("tuner")) as address:
        yield address


def rendered(changes: dict[str, Any], folder: Path) -> Pixels:
    """The file that `fakesss render` makes of the scene, (height, width, 3)."""
    path = folder / f"{secrets.token_hex(4)}.png"
    render_file(BASE.replace(changes, "test"), path, timed=False)
    return np.asarray(Image.open(path).convert("RGB"))


def test_the_canvas_holds_the_rendered_picture_pixel_by_pixel(page: Page, url: str, tmp_path: Path) -> None:
    talk = opened(page, url)
    assert np.array_equal(on_canvas(page)[..., :3], rendered({}, tmp_path))
    drag(page, 20, 5)
    header = talk.settled(after=1)
    assert (header["type"], header["width"], header["height"]) == ("image/png", SIZE, SIZE)
    assert np.array_equal(on_canvas(page)[..., :3], rendered(talk.changes, tmp_path))
    box = page.locator("#picture").bounding_box()
    assert box
    assert (box["width"], box["height"]) == (SIZE, SIZE)
    assert (box["x"] % 1, box["y"] % 1) == (0, 0)  # on whole pixels


def test_a_moving_picture_of_fewer_pixels_stands_in_the_place_of_the_still_one(page: Page, url: str) -> None:
    coarse = io.BytesIO()
    Image.new("RGB", (SIZE // 4, SIZE // 4), (10, 20, 30)).save(coarse, "PNG")

    def coarser(header: dict[str, Any], image: bytes) -> bytes:
        return coarse.getvalue() if header["moving"] else image

    rewrite(page, lambda header: {**header, "type": "image/png"} if header["moving"] else header, coarser)
    talk = opened(page, url)
    still, place = on_canvas(page), page.locator("#picture").bounding_box()
    x, y = middle(page)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 9, y, steps=3)
    wait(page, lambda: page.locator("#place").get_attribute("data-moving") == "true")
    assert page.locator("#picture").bounding_box() == place
    moving = on_canvas(page)
    assert moving.shape == still.shape
    assert np.all(moving == (10, 20, 30, 255))
    page.mouse.up()
    assert not talk.settled()["moving"]
    assert on_canvas(page)[..., :3].max() > 100


def test_two_device_pixels_a_css_pixel(browser: Browser, url: str) -> None:
    with browser.new_context(viewport={"width": 1000, "height": 700}, device_scale_factor=2) as context:
        page = context.new_page()
        opened(page, url)
        box = page.locator("#picture").bounding_box()
        assert box
        assert (box["width"], box["height"]) == (SIZE / 2, SIZE / 2)
        assert on_canvas(page).shape == (SIZE, SIZE, 4)
        panel(page, "Shader")
        page.locator("#show-box").check()
        assert on_canvas(page, "#overlay").shape == (SIZE, SIZE, 4)


@pytest.mark.parametrize("ratio", [1.25, *(pytest.param(ratio, marks=pytest.mark.long) for ratio in (1.5, 1.75, 2))])
def test_a_pixel_of_the_picture_is_one_of_the_screen(launch: Callable[..., Browser], url: str, ratio: float) -> None:
    browser = launch(f"--force-device-scale-factor={ratio}", "--window-size=1113,801")
    page = browser.new_context(no_viewport=True).new_page()  # an emulated ratio is drawn in another way
    opened(page, url)
    devtools = page.context.new_cdp_session(page)

    def is_the_canvas() -> bool:
        taken = devtools.send("Page.captureScreenshot", {"format": "png"})
        screen = np.asarray(Image.open(io.BytesIO(base64.b64decode(taken["data"]))).convert("RGB"))
        corner = page.locator("#picture").evaluate(
            "e => [e.getBoundingClientRect().left, e.getBoundingClientRect().top]"
        )
        left, top = (round(side * ratio) for side in corner)
        return np.array_equal(screen[top : top + SIZE, left : left + SIZE], on_canvas(page)[..., :3])

    wait(page, is_the_canvas)
    browser.close()


def test_a_picture_without_room_is_said_to_be_smaller(page: Page, url: str) -> None:
    opened(page, url)
    expect(page.locator("#scale")).to_have_text("128 × 128 pixels")
    page.set_viewport_size({"width": 1280, "height": 260})
    expect(page.locator("#scale")).to_contain_text("shown at")
    page.set_viewport_size({"width": 1280, "height": 800})
    expect(page.locator("#scale")).to_have_text("128 × 128 pixels")


def test_the_connection_is_made_again_and_the_picture_stays(page: Page, tmp_path: Path) -> None:
    with tuned(BASE, tmp_path) as address:
        talk = opened(page, address)
        drag(page, 20, 0)
        talk.settled(after=1)
        before = on_canvas(page)
    expect(page.locator("#notice")).to_contain_text("The connection is lost")
    assert np.array_equal(on_canvas(page), before)
    *_, port, token = address.replace("/", ":").strip(":").split(":")
    seen = len(talk.of("wish"))
    with tuned(BASE, tmp_path, port=int(port), token=token):
        talk.settled(after=seen)
        expect(page.locator("#notice")).to_be_hidden()
        assert np.array_equal(on_canvas(page), before)
        drag(page, -20, 0)
        wait(page, lambda: talk.changes == {})
        talk.settled()


def test_an_error_keeps_the_last_good_picture(page: Page, url: str) -> None:
    servers: list[WebSocketRoute] = []

    def between(route: WebSocketRoute) -> None:
        route.connect_to_server()
        servers.append(route)

    page.route_web_socket("**/socket", between)
    talk = opened(page, url)
    before = on_canvas(page)
    text = "shade.frag:12: syntax error"
    servers[0].send(json.dumps({"type": "message", "level": "error", "text": text}))
    expect(page.locator("#notice")).to_contain_text(text)
    expect(page.locator("#unread")).to_have_text("1")
    assert np.array_equal(on_canvas(page), before)
    servers[0].send(json.dumps({"type": "message", "level": "error", "text": text}))
    page.locator("#show-messages").click()
    expect(page.locator("#log li").last).to_contain_text(f"{text} × 2")
    expect(page.locator("#unread")).to_have_text("")
    seen = len(talk.of("wish"))
    servers[0].send(json.dumps({"type": "again"}))  # it was mended
    talk.settled(after=seen)
    expect(page.locator("#notice")).to_be_hidden()
    page.locator("#clear-messages").click()
    expect(page.locator("#log li")).to_have_count(0)


def test_box_and_axes_are_over_the_picture_and_not_in_it(page: Page, url: str) -> None:
    talk = opened(page, url)
    page.locator("#place").focus()
    for _ in range(10):
        page.keyboard.press("-")  # the whole box in the picture
    header = talk.settled(after=2)
    before = on_canvas(page)
    panel(page, "Shader")
    assert not on_canvas(page, "#overlay").any()
    page.locator("#show-box").check()
    box = on_canvas(page, "#overlay")
    assert np.array_equal(box[..., 0], box[..., 2])  # grey
    drawn = np.argwhere(box[..., 3])  # rows and columns
    ends = [places(talk.changes, corner) for corner in itertools.product(*zip(*header["box"], strict=True))]
    for row, column in ends:
        assert np.abs(drawn + 0.5 - (row, column)).max(axis=1).min() < 2
    assert np.all(drawn.min(axis=0) > np.min(ends, axis=0) - 4) and np.all(drawn.max(axis=0) < np.max(ends, axis=0) + 4)
    page.locator("#show-axes").check()
    assert on_canvas(page, "#overlay")[round(places(talk.changes, (0.5, 0, 0))[0]), :, 3].any()
    assert (on_canvas(page, "#overlay")[..., 3] > 0).sum() > (box[..., 3] > 0).sum()
    assert np.array_equal(on_canvas(page), before)
    page.locator("#previous").click()  # which has a camera of its own
    wait(page, lambda: not on_canvas(page, "#overlay").any())
    page.locator("#previous").click()
    wait(page, lambda: on_canvas(page, "#overlay").any())


def places(changes: dict[str, Any], point: tuple[float, ...]) -> tuple[float, float]:
    """Row and column of a point in the world, in pixels."""
    view = View.of(BASE.replace(changes, "test").camera, (SIZE, SIZE))
    x, y, depth = view.to_eye(np.array([point]))[0]
    right, up = (x, y) / (view.distance + depth) / view.tangent[0]
    return (1 - up) / 2 * SIZE, (1 + right) / 2 * SIZE


def test_a_view_is_looked_at_in_the_picture_s_place(page: Page, url: str) -> None:
    talk = opened(page, url)
    before = on_canvas(page)
    page.locator("#view").select_option("thickness")
    assert talk.settled(after=1)["view"] == "thickness"
    assert not np.array_equal(on_canvas(page), before)
    expect(page.locator("#caption")).to_contain_text("diameters")
    page.locator("#view").select_option("picture")
    talk.settled(after=2)
    assert np.array_equal(on_canvas(page), before)


def test_the_status_tells_what_it_costs(page: Page, url: str) -> None:
    talk = opened(page, url)
    expect(page.locator("#mesh")).to_contain_text(f"{talk.of('frame')[-1]['faces']:,} faces")
    expect(page.locator("#rate")).to_have_text("–")
    drag(page, 60, 0, steps=60)
    talk.settled(after=1)
    expect(page.locator("#rate")).to_contain_text(" · ")
    expect(page.locator("#latency")).to_contain_text("ms")
    low, mean, high = map(float, (page.locator("#rate").text_content() or "").split(" · "))
    assert 0 < low <= mean <= high
    page.locator("#show-passes").click()
    told = {one["name"].replace("_", " "): one for one in talk.of("frame")[-1]["passes"]}
    assert set(page.locator("#passes tbody th").all_text_contents()) == set(told)
    assert page.locator("#passes tbody tr.culled").count() == sum(not one["kept"] for one in told.values())


def test_a_warning_is_said_once_for_as_long_as_it_holds(page: Page, url: str) -> None:
    clips = iter((["0.1% clip."], ["0.2% clip."], [], ["0.3% clip."]))
    rewrite(
        page,
        lambda header: header if header["moving"] else {**header, "warnings": next(clips)},
        lambda header, image: image,
    )
    talk = opened(page, url)
    for wishes in range(1, 4):
        page.locator("#view").select_option("front" if wishes % 2 else "picture")
        talk.settled(after=wishes)
    expect(page.locator("#log li")).to_have_count(2)
    assert "0.1%" in (page.locator("#log li").first.text_content() or "")
    assert "0.3%" in (page.locator("#log li").last.text_content() or "")


def test_a_damaged_picture_is_said_and_the_next_one_comes(page: Page, url: str) -> None:
    rewrite(page, lambda header: header, lambda header, image: image[:-200] if header["moving"] else image)
    talk = opened(page, url)
    drag(page, 20, 0)
    talk.settled(after=1)
    tell = page.locator("#log li").filter(has_text="damaged")
    expect(tell.first).to_be_attached()
    assert talk.changes["camera.azimuth"] < -20
