"""The tuner's stage: what hands, fingers, keys and the clock do to the picture, and what stands on the canvas."""

import base64
import io
import itertools
import json
import secrets
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, CDPSession, Page, WebSocketRoute, expect
from tuner_pages import Pixels, Talk, drag, middle, on_canvas, opened, wait
from tuner_server import tuned

from fakesss.camera import View
from fakesss.renderer import render_file
from fakesss.scene import Scene

pytestmark = [pytest.mark.browser, pytest.mark.gl]

SIZE = 128
BASE = Scene.from_dict(
    {"object": "torus:1000", "size": (SIZE, SIZE), "supersampling": 2, "occlusion": {"rays": 4}}, "test"
)
HALF_TURN = 180 / SIZE  # degrees by one CSS pixel


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


def by_hand(page: Page, url: str) -> Talk:
    """The page with its first picture, and a clock that stands still unless it is told to run."""
    page.clock.install(time=0)
    talk = opened(page, url)
    page.clock.pause_at(3600)
    return talk


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


def test_a_drag_turns_the_object_and_is_one_step_of_undo(page: Page, url: str) -> None:
    talk = opened(page, url)
    drag(page, 40, 16)
    header = talk.settled(after=2)
    assert talk.changes == {
        "camera.azimuth": pytest.approx(-40 * HALF_TURN, abs=0.1),
        "camera.elevation": pytest.approx(BASE.camera.elevation + 16 * HALF_TURN, abs=0.1),
    }
    moving = [frame for frame in talk.of("frame") if frame["moving"]]
    assert moving and {frame["type"] for frame in moving} == {"image/jpeg"}
    assert talk.most_under_way == 1
    page.locator("#undo").click()
    assert talk.settled(after=header["number"])["scene_sha256"] == talk.of("frame")[0]["scene_sha256"]
    assert talk.changes == {}
    expect(page.locator("#undo")).to_be_disabled()


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


@pytest.mark.parametrize(
    ("button", "moved"), [("right", {"light.azimuth", "light.elevation"}), ("middle", {"camera.field_of_view"})]
)
def test_other_buttons_move_the_light_and_the_lens(page: Page, url: str, button: str, moved: set[str]) -> None:
    talk = opened(page, url)
    drag(page, 12, -12, button)
    talk.settled(after=1)
    assert set(talk.changes) == moved
    if button == "right":
        assert talk.changes["light.azimuth"] == pytest.approx(BASE.light.azimuth + 12 * HALF_TURN, abs=0.1)
        assert talk.changes["light.elevation"] == pytest.approx(BASE.light.elevation + 12 * HALF_TURN, abs=0.1)
    else:
        assert talk.changes["camera.field_of_view"] < BASE.camera.field_of_view


def test_the_menu_is_kept_away_from_the_picture_only(page: Page, url: str) -> None:
    opened(page, url)
    asked = """element => !element.dispatchEvent(new MouseEvent("contextmenu", { bubbles: true, cancelable: true }))"""
    assert page.locator("#picture").evaluate(asked)
    assert not page.locator(".bar").evaluate(asked)


def test_elevation_ends_at_the_poles(page: Page, url: str) -> None:
    talk = opened(page, url)
    drag(page, 0, 200)
    talk.settled(after=1)
    assert talk.changes == {"camera.elevation": 90}


def test_the_wheel_zooms_from_the_fitted_distance_in_one_step(page: Page, url: str) -> None:
    talk = by_hand(page, url)
    page.mouse.move(*middle(page))
    fitted = 1 / np.sin(np.radians(BASE.camera.field_of_view / 2))
    for turn in range(1, 4):
        page.mouse.wheel(0, 100)
        there = pytest.approx(fitted * np.exp(0.1 * turn), rel=1e-3)
        wait(page, lambda there=there: talk.changes == {"camera.distance": there})
    assert talk.of("wish")[-1]["moving"]
    page.clock.run_for(1000)  # the hand is off the wheel
    assert not talk.settled()["moving"]
    page.locator("#undo").click()
    wait(page, lambda: talk.changes == {})


def test_a_double_click_puts_the_camera_back(page: Page, url: str) -> None:
    talk = opened(page, url)
    drag(page, 30, 10)
    talk.settled(after=1)
    page.locator("#place").dblclick()
    wait(page, lambda: talk.changes == {})


@pytest.mark.parametrize(
    ("keys", "changes"),
    [
        (["ArrowRight"] * 4, {"camera.azimuth": -20}),
        (["ArrowDown"] * 2, {"camera.elevation": 18}),
        (["Shift+ArrowLeft"] * 3, {"light.azimuth": -50}),
        (["-"] * 2, {"camera.distance": pytest.approx(3.8637 * 1.05**2, rel=1e-3)}),
    ],
)
def test_a_held_key_is_one_gesture(page: Page, url: str, keys: list[str], changes: dict[str, Any]) -> None:
    talk = opened(page, url)
    page.locator("#place").focus()
    *held, key = keys[0].split("+")
    for modifier in held:
        page.keyboard.down(modifier)
    for _ in keys:
        page.keyboard.down(key)  # again and again without an end: that is what holding it looks like
    assert page.locator("#spoken").text_content() == ""
    page.keyboard.up(key)
    talk.settled(after=1)
    assert talk.changes == changes
    expect(page.locator("#spoken")).to_contain_text("Camera")
    for modifier in held:
        page.keyboard.up(modifier)
    page.locator("#undo").click()
    wait(page, lambda: talk.changes == {})


class Fingers:
    """Touches by the browser's own protocol."""

    def __init__(self, page: Page) -> None:
        self.devtools: CDPSession = page.context.new_cdp_session(page)

    def touch(self, kind: str, *points: tuple[float, float]) -> None:
        places = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(points)]
        self.devtools.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": places})

    def drag(self, start: list[tuple[float, float]], end: list[tuple[float, float]], steps: int = 8) -> None:
        self.touch("touchStart", *start)
        for step in range(1, steps + 1):
            share = step / steps
            between = [(a + share * (c - a), b + share * (d - b)) for (a, b), (c, d) in zip(start, end, strict=True)]
            self.touch("touchMove", *between)
        self.touch("touchEnd")


@pytest.fixture
def tablet(browser: Browser) -> Iterator[Page]:
    """A page that is touched."""
    with browser.new_context(viewport={"width": 1024, "height": 768}, has_touch=True) as context:
        yield context.new_page()


def test_one_finger_turns_two_light_and_a_pinch_zooms(tablet: Page, url: str) -> None:
    talk = opened(tablet, url)
    x, y = middle(tablet)
    fingers = Fingers(tablet)
    fingers.drag([(x, y)], [(x + 40, y)])
    talk.settled(after=1)
    assert set(talk.changes) == {"camera.azimuth"}
    seen = len(talk.of("wish"))
    fingers.drag([(x - 30, y), (x + 30, y)], [(x + 10, y - 20), (x + 70, y - 20)])
    talk.settled(after=seen)
    assert set(talk.changes) == {"camera.azimuth", "light.azimuth", "light.elevation"}
    assert talk.changes["light.azimuth"] > BASE.light.azimuth
    assert talk.changes["light.elevation"] > BASE.light.elevation
    seen = len(talk.of("wish"))
    fingers.drag([(x - 20, y), (x + 20, y)], [(x - 60, y), (x + 60, y)])
    talk.settled(after=seen)
    assert talk.changes["camera.distance"] < 3.8637 * 0.5
    for left in ({"camera.azimuth", "light.azimuth", "light.elevation"}, {"camera.azimuth"}, set()):
        tablet.locator("#undo").click()
        wait(tablet, lambda left=left: set(talk.changes) == left)


def test_a_touch_that_is_taken_away_ends_the_gesture(tablet: Page, url: str) -> None:
    talk = opened(tablet, url)
    x, y = middle(tablet)
    fingers = Fingers(tablet)
    fingers.touch("touchStart", (x, y))
    fingers.touch("touchMove", (x + 30, y))
    fingers.touch("touchCancel")
    assert not talk.settled(after=1)["moving"]


def test_two_device_pixels_a_css_pixel(browser: Browser, url: str) -> None:
    with browser.new_context(viewport={"width": 1000, "height": 700}, device_scale_factor=2) as context:
        page = context.new_page()
        opened(page, url)
        box = page.locator("#picture").bounding_box()
        assert box
        assert (box["width"], box["height"]) == (SIZE / 2, SIZE / 2)
        assert on_canvas(page).shape == (SIZE, SIZE, 4)
        tab(page, "Shader")
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


def tab(page: Page, name: str) -> None:
    """Open one of the panel's tabs."""
    page.get_by_role("tab", name=name).click()


def test_auto_rotation_keeps_to_the_clock(page: Page, url: str) -> None:
    talk = by_hand(page, url)
    tab(page, "Camera")
    page.locator("#auto-rotation").check()
    page.clock.run_for(2000)
    page.locator("#auto-rotation").uncheck()
    talk.settled(after=1)
    assert talk.changes == {"camera.azimuth": pytest.approx(60, abs=1)}  # 30 degrees a second
    page.locator("#undo").click()
    wait(page, lambda: talk.changes == {})


def test_what_is_set_while_it_turns_is_a_step_of_its_own(page: Page, url: str) -> None:
    talk = by_hand(page, url)
    tab(page, "Camera")
    page.locator("#auto-rotation").check()
    page.clock.run_for(1000)
    page.locator("#place").focus()
    page.keyboard.press("Shift+ArrowUp")
    page.clock.run_for(1000)
    wait(page, lambda: talk.changes["camera.azimuth"] > 55)
    assert talk.of("wish")[-1]["moving"]
    page.locator("#undo").click()  # which also stops it
    wait(page, lambda: set(talk.changes) == {"camera.azimuth"} and talk.changes["camera.azimuth"] < 35)
    expect(page.locator("#auto-rotation")).not_to_be_checked()
    page.locator("#undo").click()
    wait(page, lambda: talk.changes == {})


def test_random_lighting_moves_the_light_alone_and_steadily(page: Page, url: str) -> None:
    talk = by_hand(page, url)
    tab(page, "Lights")
    page.locator("#random-lighting").check()
    page.clock.run_for(3000)
    page.locator("#random-lighting").uncheck()
    talk.settled(after=1)
    assert set(talk.changes) <= {"light.azimuth", "light.elevation"}

    def towards(azimuth: float, elevation: float) -> Any:
        a, e = np.radians((azimuth, elevation))
        return np.array([np.sin(a) * np.cos(e), np.sin(e), np.cos(a) * np.cos(e)])

    now = {"azimuth": BASE.light.azimuth, "elevation": BASE.light.elevation}
    now |= {path.removeprefix("light."): value for path, value in talk.changes.items()}
    cosine = towards(BASE.light.azimuth, BASE.light.elevation) @ towards(**now)
    assert 0 < np.degrees(np.arccos(np.clip(cosine, -1, 1))) < 61  # 20 degrees a second, on a way that may turn
    page.locator("#undo").click()
    wait(page, lambda: talk.changes == {})


def test_who_wants_less_motion_is_asked(browser: Browser, url: str) -> None:
    with browser.new_context(reduced_motion="reduce") as context:
        page = context.new_page()
        talk = opened(page, url)
        tab(page, "Camera")
        page.locator("#auto-rotation").click()
        page.get_by_role("button", name="Keep still").click()
        expect(page.locator("#auto-rotation")).not_to_be_checked()
        assert talk.changes == {}
        page.locator("#auto-rotation").click()
        page.get_by_role("button", name="Let it move").click()
        wait(page, lambda: talk.changes)
        expect(page.locator("#auto-rotation")).to_be_checked()


def test_box_and_axes_are_over_the_picture_and_not_in_it(page: Page, url: str) -> None:
    talk = opened(page, url)
    page.locator("#place").focus()
    for _ in range(10):
        page.keyboard.press("-")  # the whole box in the picture
    header = talk.settled(after=2)
    before = on_canvas(page)
    tab(page, "Shader")
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
