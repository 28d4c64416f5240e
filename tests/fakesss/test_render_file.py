"""What is said of a picture, and the files that `render_file` writes."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from picture_scenes import sheet_file

from fakesss import cli_picture
from fakesss.image_io import encode_png, read_picture
from fakesss.inspect import explain
from fakesss.problem import BadInput
from fakesss.renderer import Renderer, Rendering, render_file
from fakesss.scene import Scene

pytestmark = pytest.mark.gl


def test_a_picture_too_large_for_opengl_is_one_sentence(renderer: Renderer) -> None:
    with pytest.raises(BadInput, match=r"scene: size 16384x1 with supersampling 8 needs 131072 samples in a row"):
        renderer.render(Scene(object="sphere:4000", size=(16384, 1), supersampling=8))


def test_warnings_tell_what_clips_and_what_is_missing(renderer: Renderer) -> None:
    scene = Scene(object="torus:4000", size=(32, 32))
    (clipped,) = renderer.render(scene.replace({"exposure": 100.0})).warnings
    assert clipped.endswith("of the object's pixels are brighter than the display's white and clip.")
    (empty,) = renderer.render(scene.replace({"camera.near": 50.0, "camera.far": 60.0})).warnings
    assert empty.startswith("No pixel shows the object")


def test_repairs_are_among_the_warnings(renderer: Renderer, tmp_path: Path) -> None:
    drawn = renderer.render(Scene(object=sheet_file(tmp_path), size=(16, 16)))
    assert any("open" in warning for warning in drawn.warnings)


@pytest.mark.parametrize("name", ["picture.png", "picture.exr"])
def test_render_file_writes_and_tells(renderer: Renderer, tmp_path: Path, name: str) -> None:
    scene = Scene(object="torus:4000", size=(31, 21))
    told = render_file(scene, tmp_path / name)
    assert set(told) == {
        *("image", "width", "height", "gl_renderer", "passes"),
        *("non_finite", "warnings", "scene_sha256"),
    }
    assert (told["width"], told["height"], told["non_finite"]) == (31, 21, 0)
    drawn = {entry["name"]: entry["gpu_ms"] for entry in told["passes"]}
    assert drawn.pop("blur") is None  # computed by the shading, in its time
    assert all(ms >= 0 for ms in drawn.values())
    if name.endswith(".png"):
        assert (tmp_path / name).read_bytes() == encode_png(renderer.render(scene).image)
        assert read_picture(tmp_path / name)[1] == ()


@pytest.fixture
def faulty(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    """A renderer whose pictures are not finite in two pixels, as no scene that we know of makes them."""
    render = Renderer.render

    def spoilt(self: Renderer, *args: Any, **kwargs: Any) -> Any:
        drawn = render(self, *args, **kwargs)
        drawn.image[3, 4, :2] = np.nan, np.inf
        drawn.image[5, 6, 2] = -np.inf
        return drawn

    monkeypatch.setattr(Renderer, "render", spoilt)


@pytest.mark.usefixtures("faulty")
@pytest.mark.parametrize("name", ["picture.png", "picture.exr"])
def test_pixels_that_are_not_finite_are_said_and_are_a_failure(tmp_path: Path, name: str) -> None:
    run = CliRunner().invoke(
        cli_picture.render, ["torus:4000", "--size", "31x21", "-o", str(tmp_path / name), "--json"]
    )
    assert run.exit_code == 1
    assert run.stderr.splitlines()[0].startswith("2 pixels hold a value that is not finite")
    assert json.loads(run.stdout)["non_finite"] == 2
    pixels = read_picture(tmp_path / name)[0] if name.endswith(".png") else None
    assert pixels is None or (pixels[3, 4, 0] == 0 and pixels[3, 4, 1] == 255 and pixels[5, 6, 2] == 0)


def test_render_file_writes_the_contact_sheet(renderer: Renderer, tmp_path: Path) -> None:
    told = render_file(Scene(object="torus:4000", size=(31, 21)), tmp_path / "views.png", views=True)
    assert told["width"] > 1000 and (tmp_path / "views.png").is_file()


def test_times_are_of_a_second_drawing(monkeypatch: pytest.MonkeyPatch, renderer: Renderer, tmp_path: Path) -> None:
    """The first compiles and uploads; what it baked is still what is told."""
    draws: list[bool] = []
    render = Renderer.render

    def noting(self: Renderer, scene: Scene, timed: bool = False) -> Rendering:
        draws.append(timed)
        return render(self, scene, timed)

    monkeypatch.setattr(Renderer, "render", noting)
    scene = Scene(object="torus:2344", size=(31, 21))
    baked = {entry["name"]: entry["cached"] for entry in explain(scene, timed=True)["baked"] if entry["kept"]}
    assert draws == [False, True] and baked["mesh"] is False
    render_file(scene, tmp_path / "a.png")
    assert draws == [False, True] * 2
    told = render_file(scene, tmp_path / "a.png", timed=False)
    assert draws[4:] == [False] and {entry["gpu_ms"] for entry in told["passes"]} == {None}
