"""Shaders edited while the tuner runs: read again, faults named by file and line, the last picture not lost."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from tuner_server import tab, tuned

from fakesss.output import write_atomically
from fakesss.scene import Scene
from fakesss.shader_source import GLSL
from fakesss.tuner import reload

pytestmark = pytest.mark.gl
BASE = Scene(object="sphere:1000", size=(32, 32), occlusion={"enabled": False})  # type: ignore[arg-type]
SHADER = "shade.frag"


@pytest.fixture
def shaders(tmp_path: Path) -> Path:
    """A copy that may be edited."""
    return Path(shutil.copytree(GLSL, tmp_path / "glsl"))


@pytest.fixture
def url(shaders: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    monkeypatch.setattr(reload, "EVERY_S", 0.01)
    with tuned(BASE, tmp_path, shaders) as address:
        yield address


def edit(path: Path, content: str | bytes) -> None:
    """In one step: half a file would be read, and the whole one again."""
    write_atomically(path, content.encode() if isinstance(content, str) else content)


def broken(text: str) -> tuple[str, int]:
    """A shader with a line that is no GLSL before its last brace, and that line's number."""
    lines = text.splitlines()
    place = max(number for number, line in enumerate(lines) if line.startswith("}"))
    lines.insert(place, "    this_is_no_glsl;")
    return "\n".join(lines) + "\n", place + 1


def test_an_edit_a_fault_and_its_mend(url: str, shaders: Path) -> None:
    path = shaders / SHADER
    right = path.read_text(encoding="utf-8")
    wrong, line = broken(right)
    with tab(url) as viewer:
        before = viewer.finished()
        edit(path, wrong)
        viewer.message(level="info", text=f"Read again: {SHADER}.")
        viewer.message(type="again")
        number = viewer.wish()
        said = viewer.message(level="error")
        assert said["number"] == number and f"{SHADER}:{line}" in said["text"]
        edit(path, right.replace("void main", "// mended\nvoid main"))
        viewer.message(type="again")
        assert viewer.finished().image == before.image


def test_an_edit_shows(url: str, shaders: Path) -> None:
    """Also of a file that others include, and in every tab."""
    path = shaders / "common_brdf.glsl"
    text = path.read_text(encoding="utf-8")
    start = text.index("{", text.index("float backlight("))
    with tab(url) as one, tab(url) as other:
        before = one.finished()
        other.finished()
        edit(path, f"{text[:start]}{{ exponent *= 0.5;{text[start + 1 :]}")
        for viewer in (one, other):
            viewer.message(type="again")
            assert viewer.finished().image != before.image


def test_a_file_that_goes_and_comes(url: str, shaders: Path) -> None:
    path = shaders / SHADER
    text = path.read_text(encoding="utf-8")
    with tab(url) as viewer:
        before = viewer.finished()
        path.unlink()
        viewer.message(type="again")
        number = viewer.wish()
        assert f'no shader file "{SHADER}"' in viewer.message(number=number)["text"]
        edit(path, text)
        viewer.message(type="again")
        assert viewer.finished().image == before.image


def test_a_file_that_is_no_text(url: str, shaders: Path) -> None:
    path = shaders / SHADER
    content = path.read_bytes()
    with tab(url) as viewer:
        viewer.finished()
        edit(path, b"\xff\xfe\x00")
        viewer.message(type="again")
        number = viewer.wish()
        assert viewer.message(number=number)["level"] == "error"
        edit(path, content)
        viewer.message(type="again")
        viewer.finished()


def test_a_folder_that_is_gone_for_a_moment(url: str, shaders: Path) -> None:
    away = shaders.with_name("away")
    with tab(url) as viewer:
        before = viewer.finished()
        shaders.rename(away)
        viewer.message(type="again")
        number = viewer.wish()
        assert "no shader file" in viewer.message(number=number)["text"]
        away.rename(shaders)
        viewer.message(type="again")
        assert viewer.finished().image == before.image
