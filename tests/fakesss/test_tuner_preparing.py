"""What takes long is made beside the drawing: something stands in, and what nobody waits for is given up."""

import contextlib
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from tuner_server import Frame, Tab, tab, tuned
from waiting import until

from fakesss import occlusion
from fakesss.patience import Unwanted, is_wanted
from fakesss.problem import BadInput
from fakesss.renderer import render_file
from fakesss.scene import Scene
from fakesss.shapes import load_object
from fakesss.tuner import state
from fakesss.tuner.preparing import stand_ins

BASE = Scene(object="sphere:1000", size=(32, 32), occlusion={"rays": 16})  # type: ignore[arg-type]


@pytest.fixture
def url(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """With nothing in the cache."""
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path / "cache"))
    with tuned(BASE, tmp_path) as address:
        yield address


class Bake:
    """Stands before the casting of rays: notes how many are asked for, and holds it until `go` is set."""

    def __init__(self) -> None:
        self.asked: list[int] = []
        self.given_up: list[int] = []
        self.go = threading.Event()
        self.bake = occlusion.bake_occlusion

    def __call__(self, mesh: Any, rays: int, sampling: Any) -> Any:
        self.asked.append(rays)
        while not self.go.wait(0.01):
            if not is_wanted():
                self.given_up.append(rays)
                raise Unwanted
        return self.bake(mesh, rays, sampling)


@pytest.fixture
def held(monkeypatch: pytest.MonkeyPatch) -> Iterator[Bake]:
    bake = Bake()
    monkeypatch.setattr(occlusion, "bake_occlusion", bake)
    yield bake
    bake.go.set()


def bytes_of(scene: Scene, folder: Path) -> bytes:
    render_file(scene, folder / "picture.png", timed=False)
    return (folder / "picture.png").read_bytes()


def stand_in(viewer: Tab, changes: dict[str, Any], **wish: Any) -> Frame:
    """The first frame of a wish."""
    viewer.wish(changes, **wish)
    return viewer.frame()


@pytest.mark.gl
def test_the_first_picture_has_no_occlusion_until_it_is_baked(url: str, held: Bake, tmp_path: Path) -> None:
    with tab(url) as viewer:
        viewer.wish()
        while not isinstance(answer := viewer.next(), Frame):
            assert answer.get("level") != "error", answer
            if answer["type"] == "again":
                viewer.wish()
        assert answer.header["stand_in"] == "Occlusion with 16 rays a vertex is not made yet; drawn without."
        assert answer.image == bytes_of(BASE.replace({"occlusion.enabled": False}), tmp_path)
        what = "Occlusion with 16 rays a vertex"
        assert viewer.message(type="working", what=what)["done"] is False
        held.go.set()
        viewer.message(type="again")
        assert viewer.message(type="working", what=what)["done"] is True
        final = stand_in(viewer, {})
    assert final.header["stand_in"] == "" and final.image == bytes_of(BASE, tmp_path)


@pytest.mark.gl
def test_the_last_rays_stand_in_for_the_next(url: str, held: Bake, tmp_path: Path) -> None:
    with tab(url) as viewer:
        held.go.set()
        viewer.finished()
        held.go.clear()
        changes = {"occlusion.rays": 24, "camera.azimuth": 20.0}
        frame = stand_in(viewer, changes)
        assert frame.header["stand_in"] == "Occlusion with 24 rays a vertex is not made yet; drawn with 16."
        assert frame.image == bytes_of(BASE.replace({**changes, "occlusion.rays": 16}), tmp_path)
        held.go.set()
        viewer.message(type="again")
        assert stand_in(viewer, changes).image == bytes_of(BASE.replace(changes), tmp_path)


@pytest.mark.gl
def test_the_sentence_is_of_what_is_drawn_at_last(url: str, held: Bake) -> None:
    """A way that is tried first, and lacks something too, is not the one that was taken."""
    held.go.set()
    with tab(url) as viewer:
        viewer.finished({"occlusion.enabled": False, "occlusion.rays": 40})
        held.go.clear()
        for changes in ({"occlusion.rays": 40}, {"occlusion.rays": 48}):
            header = stand_in(viewer, changes).header
            words = f"Occlusion with {changes['occlusion.rays']} rays a vertex is not made yet; drawn without."
            assert (header["stand_in"], header["reasons"]["occlusion"]) == (words, "occlusion.enabled is false")


@pytest.mark.gl
def test_everything_that_stands_in_is_named(url: str, monkeypatch: pytest.MonkeyPatch) -> None:
    go = threading.Event()
    with tab(url) as viewer:
        viewer.finished({"occlusion.enabled": False})
        monkeypatch.setattr("fakesss.passes.mesh.load_object", lambda name: go.wait(60) and load_object(name))
        said = stand_in(viewer, {"object": "torus:1000"}).header["stand_in"]
        go.set()
    assert said == (
        'The object "torus:1000" is not made yet; "sphere:1000" is drawn meanwhile. '
        "Occlusion with 16 rays a vertex is not made yet; drawn without."
    )


@pytest.mark.gl
def test_a_slider_on_its_way_bakes_nothing(url: str, held: Bake) -> None:
    held.go.set()
    with tab(url) as viewer:
        viewer.finished()
        for rays in range(20, 30):
            frame = stand_in(viewer, {"occlusion.rays": rays}, moving=True)
            assert f"with {rays} rays" in frame.header["stand_in"]
        viewer.finished({"occlusion.rays": 30})
    assert held.asked == [16, 30]


@pytest.mark.gl
def test_what_nobody_waits_for_is_given_up(url: str, held: Bake) -> None:
    """Another number of rays is asked for before those of the last are cast; then the tab is closed."""
    held.go.set()
    with tab(url) as viewer:
        viewer.finished()
        held.go.clear()
        for rays in (24, 32):
            stand_in(viewer, {"occlusion.rays": rays})
            until(lambda rays=rays: held.asked[-1] == rays)  # type: ignore[misc]
        assert held.given_up == [24]
    until(lambda: held.given_up == [24, 32])


@pytest.mark.gl
def test_what_was_taken_back_is_given_up(url: str, held: Bake) -> None:
    """A drag does not; the next picture that can be drawn does."""
    held.go.set()
    with tab(url) as viewer:
        viewer.finished()
        held.go.clear()
        stand_in(viewer, {"occlusion.rays": 24})
        until(lambda: held.asked[-1] == 24)
        stand_in(viewer, {}, moving=True)
        assert held.given_up == []
        assert stand_in(viewer, {}).header["stand_in"] == ""
        until(lambda: held.given_up == [24])
        viewer.message(type="working", done=True, what="Occlusion with 24 rays a vertex")


@pytest.mark.gl
def test_whoever_leaves_while_an_object_is_examined(url: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """It has been read; whether it is a solid is being found out."""
    begun, given_up = threading.Event(), threading.Event()

    def examined(mesh: Any) -> bool:
        begun.set()
        until(lambda: not is_wanted())
        given_up.set()
        raise Unwanted

    with tab(url) as viewer:
        viewer.finished()
        monkeypatch.setattr("fakesss.renderer.is_solid", examined)
        stand_in(viewer, {"object": "torus:1000"})
        assert begun.wait(60)
    assert given_up.wait(60)


@pytest.mark.gl
def test_a_picture_that_nobody_fetches_any_more(url: str, held: Bake, monkeypatch: pytest.MonkeyPatch) -> None:
    """The browser leaves the page of a grid whose pictures are being prepared."""
    monkeypatch.setattr(state, "LOOK_S", 0.01)
    held.go.set()
    with tab(url) as viewer:
        viewer.finished()
        held.go.clear()
        with contextlib.suppress(httpx.TimeoutException):
            settings = {"changes": {"occlusion.rays": 24}}
            httpx.post(url + "picture", json={"settings": settings}, timeout=httpx.Timeout(60, read=0.2))
        until(lambda: held.given_up == [24])
        assert stand_in(viewer, {}).header["stand_in"] == ""


@pytest.mark.gl
def test_two_who_wait_for_the_same_share_it(url: str, held: Bake) -> None:
    held.go.set()
    with tab(url) as first, tab(url) as third:
        first.finished()
        held.go.clear()
        with tab(url) as second:
            for viewer in (first, second, third):
                stand_in(viewer, {"occlusion.rays": 24})
                viewer.message(type="working", what="Occlusion with 24 rays a vertex")
            until(lambda: held.asked[-1] == 24)
        held.go.set()  # the second has left, the others still wait
        for viewer in (first, third):
            viewer.message(type="again")
            assert stand_in(viewer, {"occlusion.rays": 24}).header["stand_in"] == ""
    assert held.asked == [16, 24] and held.given_up == []


@pytest.mark.gl
def test_the_last_object_stays_while_the_next_is_made(
    url: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    go, changes = threading.Event(), {"object": "torus:1000"}

    def slowly(name: str) -> Any:
        assert go.wait(60)
        return load_object(name)

    with tab(url) as viewer:
        viewer.finished()
        monkeypatch.setattr("fakesss.passes.mesh.load_object", slowly)
        frame = stand_in(viewer, changes)
        assert frame.header["stand_in"] == 'The object "torus:1000" is not made yet; "sphere:1000" is drawn meanwhile.'
        go.set()
        assert viewer.finished({"object": "torus:1000"}).image == bytes_of(
            BASE.replace({"object": "torus:1000"}), tmp_path
        )


@pytest.mark.gl
def test_an_object_that_cannot_be_read_is_said(url: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def unreadable(name: str) -> Any:
        raise BadInput(f"{name}: its disk is gone")

    with tab(url) as viewer:
        viewer.finished()
        monkeypatch.setattr("fakesss.passes.mesh.load_object", unreadable)
        stand_in(viewer, {"object": "torus:1000"})
        assert viewer.message(level="error")["text"] == "torus:1000: its disk is gone"
        assert viewer.message(type="working", done=True)
        viewer.finished()


@pytest.mark.gl
@pytest.mark.parametrize(
    "changes",
    [
        {"material.thickness": "local", "layers.rays": 24},
        {"layers.faces": 200},
        {"object": "torus:1000", "material.thickness": "local", "layers.faces": 300},
        {"occlusion.sampling": "uniform"},
    ],
)
def test_everything_that_is_made_is_waited_for(url: str, tmp_path: Path, changes: dict[str, Any]) -> None:
    with tab(url) as viewer:
        viewer.finished()
        assert stand_in(viewer, changes).header["stand_in"]
        assert viewer.finished(changes).image == bytes_of(BASE.replace(changes), tmp_path)


@pytest.mark.gl
@pytest.mark.parametrize("view", ["occlusion", "ambient", "second"])
def test_views_wait_too(url: str, held: Bake, view: str) -> None:
    with tab(url) as viewer:
        held.go.set()
        assert viewer.finished({"occlusion.enabled": False}, view=view).header["view"] == view


def kinds(kind: str, scene: Scene, last: Scene | None) -> list[Any]:
    return [dict(changes) for changes, _ in stand_ins(kind, scene, last)]


def test_the_nearest_stand_in_comes_first() -> None:
    last = BASE.replace({"occlusion.rays": 64, "object": "torus:1000"})
    assert kinds("occlusion", BASE, None) == [{"occlusion.enabled": False}]
    assert kinds("occlusion", BASE, last)[0]["occlusion.rays"] == 64
    assert kinds("occlusion", BASE, BASE.replace({"occlusion.enabled": False})) == [{"occlusion.enabled": False}]
    assert kinds("mesh", BASE, last) == [{"object": "torus:1000"}] and kinds("mesh", BASE, None) == []
    assert kinds("coarse_mesh", BASE.replace({"layers.faces": 100}), last) == [{"layers.faces": None}]
