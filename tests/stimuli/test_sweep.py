"""Long sweeps: nothing is sent to the graphics memory twice, and memory stays flat."""

from collections import Counter
from pathlib import Path
from typing import Any

import moderngl
import pytest
from test_build import STUDY

from benchmarks.memory import Course, lit_tasks, measure, tasks
from fakesss import texture_pool
from fakesss.gpu import shared
from stimuli import build as building
from stimuli.build import build
from stimuli.picture import thicknesses

NEW_THINGS = {
    moderngl.Context: ("buffer", "texture", "renderbuffer", "depth_renderbuffer", "framebuffer", "program"),
    moderngl.Buffer: ("write", "orphan"),
    moderngl.Texture: ("write",),
}
SETTLING = {"Context.framebuffer"}  # pooled textures are combined anew until every combination has been met
PATHS = {
    "material.thickness_exponent": [25, 18, 30, 5],
    "material.backlight": [1.2, 0.8, 1.6, 0.1],
    "material.diffuse": [[1, 0.5, 0.2], [0.2, 0.5, 1], [0, 0.1, 0]],
    "light.azimuth": [0, 90, 180],
    "background": [[0, 0, 0], [1, 1, 1]],
}


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[Counter[str]]:
    """What each picture of a build made or wrote in graphics memory.

    What earlier tests left is forgotten: a first picture whose thickness is known would leave the texture that
    thickness needs to the second.
    """
    thicknesses.clear()
    shared().uploads.clear()
    shared().drawn.clear()
    shared().pool.release()
    pictures: list[Counter[str]] = []
    for kind, names in NEW_THINGS.items():
        for name in names:
            monkeypatch.setattr(kind, name, counting(getattr(kind, name), f"{kind.__name__}.{name}", pictures))
    draw = building.draw

    def on_a_new_page(*args: Any, **kwargs: Any) -> Any:
        pictures.append(Counter())
        return draw(*args, **kwargs)

    monkeypatch.setattr(building, "draw", on_a_new_page)
    return pictures


def counting(method: Any, name: str, pictures: list[Counter[str]]) -> Any:
    def counted(*args: Any, **kwargs: Any) -> Any:
        if pictures:
            pictures[-1][name] += 1
        return method(*args, **kwargs)

    return counted


def study(folder: Path, path: str, levels: list[Any]) -> Path:
    head = STUDY.split("[[factor]]")[0]
    factor = f'[[factor]]\nname = "x"\npath = "{path}"\nlevels = {levels}\n'
    (folder / "study.toml").write_text(head + factor, encoding="utf-8")
    return folder


@pytest.mark.gl
@pytest.mark.parametrize("path", PATHS)
def test_a_sweep_of_what_leaves_the_mesh_alone_uploads_nothing_after_its_first_picture(
    tmp_path: Path, made: list[Counter[str]], path: str
) -> None:
    build(study(tmp_path, path, PATHS[path]), quiet=True)
    assert len(made) == len(PATHS[path])
    assert made[0]["Context.buffer"] > 0
    assert {name for picture in made[1:] for name in picture} <= SETTLING


@pytest.mark.gl
def test_a_turning_camera_writes_over_the_same_buffers(tmp_path: Path, made: list[Counter[str]]) -> None:
    build(study(tmp_path, "camera.azimuth", [0.0, 30.0, 60.0, 90.0]), quiet=True)
    assert {name for picture in made[1:] for name in picture} <= SETTLING | {"Buffer.write"}


GROWTH = 24  # MiB in the last 90 % of a sweep; single measurements scatter by 13, one object left behind a pass was 78


@pytest.mark.gl
@pytest.mark.parametrize(
    "pictures",
    [400, pytest.param(10_000, marks=[pytest.mark.long, pytest.mark.timeout(3600)])],
)
def test_memory_stays_flat(pictures: int) -> None:
    measure(tasks(100), 100)  # what is loaded once
    course = measure(tasks(pictures), pictures // 100)
    assert course.growth < GROWTH, list(zip(course.pictures, course.mib, strict=True))


@pytest.mark.gl
@pytest.mark.parametrize(
    "pictures",
    [200, pytest.param(5000, marks=[pytest.mark.long, pytest.mark.timeout(3600)])],
)
def test_memory_stays_flat_while_lights_and_shadow_maps_change(monkeypatch: pytest.MonkeyPatch, pictures: int) -> None:
    """Limits that are soon reached; without them 200 pictures took 560 MiB."""
    monkeypatch.setattr(texture_pool, "KEPT", 8 << 20)
    monkeypatch.setattr(shared().programs.compiled, "limit", 8)
    measure(lit_tasks(50), 50)
    course = measure(lit_tasks(pictures), pictures // 100)
    assert course.growth < GROWTH, list(zip(course.pictures, course.mib, strict=True))


def test_a_leak_would_be_seen() -> None:
    drawn = list(range(100, 10_001, 100))
    leaking = Course(drawn, [250 + number * 0.004 for number in drawn])  # one kilobyte of 4 a picture
    settling = Course(drawn, [250 + 50 * min(1, number / 900) for number in drawn])
    assert leaking.growth == pytest.approx(0.004 * 8200, rel=0.05) and leaking.growth > GROWTH
    assert leaking.slope == pytest.approx(0.004 * 2**20)
    assert abs(settling.growth) < 1
