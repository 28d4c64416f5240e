"""Wishes in, frames out: the newest wish wins, viewers take turns, and nobody's trouble is another's."""

import asyncio
import io
import json
import socket
import threading
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from PIL import Image
from tuner_server import Frame, running, tab
from waiting import until

from fakesss.renderer import Renderer
from fakesss.scene import Scene
from fakesss.shader_source import GLSL
from fakesss.tuner import viewer as viewers
from fakesss.tuner.frames import Asked
from fakesss.tuner.preparing import Attempt, attempt
from fakesss.tuner.state import Tuner

pytestmark = pytest.mark.gl
BASE = Scene(object="sphere:1000", size=(64, 48))


@pytest.fixture(scope="module")
def tuner(tmp_path_factory: pytest.TempPathFactory) -> Tuner:
    return Tuner(BASE, tmp_path_factory.mktemp("tuner"), GLSL)


@pytest.fixture(scope="module")
def url(tuner: Tuner) -> Iterator[str]:
    with running(tuner) as address:
        with tab(address) as first:
            first.finished()
        yield address


class Studio:
    """Stands before the drawing: notes what is drawn, and holds it until `go` is set."""

    def __init__(self) -> None:
        self.azimuths: list[float] = []
        self.started, self.go = threading.Event(), threading.Event()

    def __call__(self, renderer: Renderer, asked: Asked, last: Scene | None) -> Attempt:
        self.azimuths.append(asked.scene.camera.azimuth)
        self.started.set()
        assert self.go.wait(60)
        return attempt(renderer, asked, last)


@pytest.fixture
def held(monkeypatch: pytest.MonkeyPatch) -> Iterator[Studio]:
    studio = Studio()
    monkeypatch.setattr(viewers, "attempt", studio)
    yield studio
    studio.go.set()


def turned(degrees: float) -> dict[str, Any]:
    return {"camera.azimuth": degrees}


def test_a_frame(url: str) -> None:
    with tab(url) as viewer:
        viewer.wish(turned(10), moving=True)
        moving = viewer.frame()
        still = viewer.finished(turned(10))
    assert moving.header["type"] == "image/jpeg" and moving.image.startswith(b"\xff\xd8")
    assert still.header["type"] == "image/png" and still.image.startswith(b"\x89PNG")
    for frame in (moving, still):
        assert (frame.header["width"], frame.header["height"]) == BASE.size
        assert frame.header["times"].keys() == {"wait", "draw", "encode"}
        kept = {entry["name"] for entry in frame.header["passes"] if entry["kept"]}
        assert {"front", "shade"} <= kept and all(entry["because"] for entry in frame.header["passes"])
        assert frame.header["reasons"]["backlight"] == ""
        assert frame.header["reasons"]["shadows"] == "no light has shadows = true"
        assert frame.header["faces"] == pytest.approx(1000, rel=0.1)
    assert all(entry["gpu_ms"] is not None for entry in still.header["passes"] if entry["name"] == "shade")


def test_a_moving_frame_is_nearly_the_still_one(url: str) -> None:
    """One sample a pixel and a JPEG, of the same picture."""
    with tab(url) as viewer:
        viewer.wish(turned(10), moving=True)
        moving, still = viewer.frame(), viewer.finished(turned(10))
    one, other = (np.asarray(Image.open(io.BytesIO(frame.image)).convert("RGB"), float) for frame in (moving, still))
    assert np.abs(one - other).mean() < 6


def test_the_first_picture_does_not_slow_the_first_drag(tuner: Tuner, url: str) -> None:
    """It compiled shaders, which takes as long as ten pictures."""
    asyncio.run(tuner.studio.read_shaders_again())
    with tab(url) as viewer:
        viewer.finished()
        (one,) = tuner.viewers
        assert one.pace.still is None
        viewer.finished()
        assert one.pace.still is not None


def test_others_go_on_while_a_pass_is_waited_for(tuner: Tuner, url: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each pass is waited for by a call that leaves Python's lock to the other threads."""
    waits: list[None] = []
    monkeypatch.setattr(tuner.studio.renderer.gpu, "after_pass", lambda: waits.append(None))
    with tab(url) as viewer:
        header = viewer.finished().header
    drawn = [entry for entry in header["passes"] if entry["gpu_ms"] is not None]
    assert len(waits) >= len(drawn) > 2


def test_a_view_has_a_note(url: str) -> None:
    with tab(url) as viewer:
        frame = viewer.finished({}, view="thickness")
    assert "sphere diameters" in frame.header["note"] and frame.header["legend"]["scale"]
    assert frame.header["view"] == "thickness"


def test_the_newest_wish_wins(tuner: Tuner, url: str, held: Studio) -> None:
    with tab(url) as viewer:
        viewer.wish(turned(1))
        assert held.started.wait(60)
        for number in (2, 3, 4):
            viewer.wish(turned(number))
        (one,) = tuner.viewers
        until(lambda: one.newest is not None and one.newest[0].number == 4)
        held.go.set()
        assert [viewer.frame().header["number"], viewer.frame().header["number"]] == [1, 4]
        viewer.wish(turned(5))
        assert viewer.frame().header["number"] == 5
    assert held.azimuths == [1, 4, 5]


def has_asked(tuner: Tuner, azimuth: float) -> bool:
    """Whether a wish for this camera has come in."""
    wishes = [one.newest[0] for one in tuner.viewers if one.newest]
    return any(wish.settings.changes == turned(azimuth) for wish in wishes)


def test_every_viewer_has_its_own_camera_and_its_turn(tuner: Tuner, url: str, held: Studio) -> None:
    """Two that ask while a third is drawn come before its next picture, with what they want by then."""
    with tab(url) as first, tab(url) as second, tab(url) as third:
        first.wish(turned(1))
        assert held.started.wait(60)
        for viewer, azimuth in ((second, 10), (third, 30), (second, 20), (first, 2)):
            viewer.wish(turned(azimuth))
            until(lambda azimuth=azimuth: has_asked(tuner, azimuth))  # type: ignore[misc]
        held.go.set()
        frames = [viewer.frame().header["scene_sha256"] for viewer in (first, second, third, first)]
    assert frames == [BASE.replace(turned(azimuth)).sha256() for azimuth in (1, 20, 30, 2)]
    assert held.azimuths == [1, 20, 30, 2]


def test_who_leaves_takes_its_work_with_it(tuner: Tuner, url: str, held: Studio) -> None:
    """A browser is killed while its wish waits for another's picture."""
    with tab(url) as first, tab(url) as second:
        with tab(url) as killed:
            first.wish(turned(1))
            assert held.started.wait(60)
            killed.wish(turned(2))
            until(lambda: has_asked(tuner, 2))
            killed.socket.socket.shutdown(socket.SHUT_RDWR)
            until(lambda: len(tuner.viewers) == 2)
        second.wish(turned(3))
        held.go.set()
        assert first.frame().header["number"] == second.frame().header["number"] == 1
    assert held.azimuths == [1, 3]


def test_who_leaves_while_its_picture_is_drawn_hurts_nobody(tuner: Tuner, url: str, held: Studio) -> None:
    with tab(url) as second:
        with tab(url) as first:
            first.wish(turned(1))
            assert held.started.wait(60)
        until(lambda: len(tuner.viewers) == 1)
        held.go.set()
        second.wish(turned(2))
        assert second.frame().header["number"] == 1


def test_who_reads_slowly_hurts_nobody(tuner: Tuner, url: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A line that takes nothing more: its frame waits, that of others does not."""
    with tab(url) as slow, tab(url) as quick:
        slow.wish(turned(1))
        slow.frame()
        stuck, blocked = next(one for one in tuner.viewers if one.newest), threading.Event()

        async def never(data: bytes) -> None:
            blocked.set()
            await asyncio.Event().wait()

        monkeypatch.setattr(stuck.socket, "send_bytes", never)
        slow.wish(turned(2))
        assert blocked.wait(60)
        for number in range(3):
            quick.wish(turned(number))
            assert quick.frame().header["number"] == number + 1


NO_WISHES: list[tuple[str | bytes, str]] = [
    ("{", "is no JSON"),
    ("", "is no JSON"),
    ("[" * 100_000, "is no JSON"),
    ("[]", "must be a table"),
    ("null", "must be a table"),
    (b"\xff\x00", "is no JSON"),
    ('{"number": -1}', "number: -1: must be >= 0"),
    ('{"number": 1.5}', "number"),
    ('{"settings": {}}', "number: is missing"),
    ('{"number": 1, "int": 2}', "int: unknown key"),  # also pydantic's name of a type
]


@pytest.mark.parametrize(("message", "words"), NO_WISHES, ids=lambda value: repr(value)[:20])
def test_what_is_no_wish_is_said_and_the_connection_stays(url: str, message: str | bytes, words: str) -> None:
    with tab(url) as viewer:
        viewer.socket.send(message)
        answer = viewer.next()
        assert not isinstance(answer, Frame)
        assert (answer["type"], answer["level"]) == ("message", "error") and words in answer["text"]
        viewer.wish()
        viewer.frame()


@pytest.mark.parametrize(
    ("wish", "words"),
    [
        ({"settings": {"changes": {"material.backlight": "much"}}}, "material.backlight"),
        ({"settings": {"changes": {"camera.elevation": 91}}}, "camera.elevation: 91"),
        ({"settings": {"changes": {"camera.near": 5, "camera.far": 4}}}, "near 5.0 must be < far 4.0"),
        ({"settings": {"changes": {"lights.0.azimuth": 4}}}, "lights.0"),
        ({"settings": {"effects": {"bloom": "on"}}}, "bloom"),
        ({"settings": {"changes": {"object": "sphere:12"}}}, "must be a whole number of faces"),
        ({"view": "inside"}, 'view "inside": there is none'),
        ({"wiev": "picture"}, 'did you mean "view"?'),
    ],
)
def test_a_wish_that_cannot_be_is_answered_under_its_number(url: str, wish: dict[str, Any], words: str) -> None:
    with tab(url) as viewer:
        viewer.socket.send(json.dumps({"number": 7, **wish}))
        said = viewer.message(type="message", level="error")
        assert said["number"] == 7 and words in said["text"] and "\n" not in said["text"]
        viewer.wish()
        viewer.frame()


def test_a_fault_of_the_program_is_said_too(
    url: str, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def broken(*arguments: Any, **named: Any) -> Attempt:
        raise ZeroDivisionError

    with tab(url) as viewer:
        with monkeypatch.context() as patch:
            patch.setattr(viewers, "attempt", broken)
            number = viewer.wish()
            assert "a fault of the program" in viewer.message(number=number)["text"]
        viewer.wish()
        viewer.frame()
    assert "ZeroDivisionError" in caplog.text


def test_memory_is_given_back_when_nobody_looks(tuner: Tuner, url: str) -> None:
    with tab(url) as viewer:
        viewer.finished()
        assert held_bytes(tuner) > 0
    until(lambda: held_bytes(tuner) == 0)
    with tab(url) as viewer:
        viewer.finished()


def held_bytes(tuner: Tuner) -> int:
    return tuner.studio.renderer.gpu.pool.held
