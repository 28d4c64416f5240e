from pathlib import Path
from typing import Any

import pytest

from fakesss.gpu import Gpu
from fakesss.shader_source import GLSL, Programs, ShaderError, assemble, declared_defaults, feed

VERTEX = "void main() { gl_Position = vec4(0.0); }\n"


def folder(path: Path, **files: str) -> Path:
    for name, text in files.items():
        (path / name.replace("_dot_", ".")).write_text(text)
    return path


def test_includes_are_flattened_once_each(tmp_path: Path) -> None:
    root = folder(
        tmp_path,
        a_dot_glsl="float one() { return 1.0; }\n",
        b_dot_glsl='#include "a.glsl"\nfloat two() { return one() + one(); }\n',
        main_dot_frag='#include "a.glsl"\n#include "b.glsl"\nvoid main() {}\n',
    )
    source = assemble("main.frag", root=root)
    assert source.text.count("float one()") == 1
    assert source.origin[1:] == (("a.glsl", 1), ("b.glsl", 2), ("main.frag", 3))


def test_a_default_is_replaced_and_a_private_define_is_not(tmp_path: Path) -> None:
    root = folder(tmp_path, f_dot_frag="#define TAPS 5  // a side\n#define PRIVATE 1\n")
    assert "#define TAPS 7" in assemble("f.frag", {"TAPS": 7}, root).text
    assert declared_defaults("f.frag", root) == {"TAPS"}
    for name in ("PRIVATE", "TAPZ"):
        with pytest.raises(ShaderError, match=f"f.frag: no file of it declares a default for {name}"):
            assemble("f.frag", {name: 1}, root)


def test_a_missing_include_names_the_line_that_wants_it(tmp_path: Path) -> None:
    root = folder(tmp_path, f_dot_frag='\n#include "gone.glsl"\n')
    with pytest.raises(ShaderError, match=r'f\.frag:2: no shader file "gone\.glsl"'):
        assemble("f.frag", root=root)


@pytest.mark.parametrize("name", sorted(path.name for path in GLSL.glob("*.*")))
def test_every_shader_file_assembles(name: str) -> None:
    assert assemble(name).text.startswith("#version 330 core\n")


@pytest.mark.gl
@pytest.mark.parametrize(
    ("vertex", "fragment", "place"),
    [
        (VERTEX, '#include "part.glsl"\nvoid main() { broken(); }\n', "part.glsl:2"),
        ('#include "part.glsl"\n' + VERTEX, "void main() {}\n", "part.glsl:2"),
    ],
)
def test_a_compiler_error_names_file_and_line(gpu: Gpu, tmp_path: Path, vertex: str, fragment: str, place: str) -> None:
    root = folder(
        tmp_path, v_dot_vert=vertex, f_dot_frag=fragment, part_dot_glsl="\nvoid broken() { int x = vec3(1.0); }\n"
    )
    with pytest.raises(ShaderError, match=place):
        Programs(gpu.context, root).get("v.vert", "f.frag")


@pytest.mark.gl
def test_programs_are_compiled_once_per_defines(gpu: Gpu, tmp_path: Path) -> None:
    root = folder(
        tmp_path,
        v_dot_vert=VERTEX,
        f_dot_frag="#define VALUE 1.0  // shown\nout vec4 colour;\nvoid main() { colour = vec4(VALUE); }\n",
    )
    programs = Programs(gpu.context, root)
    assert programs.get("v.vert", "f.frag") is programs.get("v.vert", "f.frag")
    assert programs.get("v.vert", "f.frag", {"VALUE": 2.0}) is programs.get("v.vert", "f.frag", {"VALUE": 2.0})
    assert len(programs.compiled.values) == 2


@pytest.mark.gl
def test_a_program_that_drops_out_is_freed_and_compiled_again(gpu: Gpu, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each takes megabytes, and a number of samples or lights makes a new one."""
    monkeypatch.setattr("fakesss.shader_source.KEPT", 2)
    programs = Programs(gpu.context)
    made: list[Any] = []
    for samples in (1, 2, 3, 1):
        made.append(programs.get("fullscreen.vert", "resolve.frag", {"SAMPLES": samples}))
        feed(made[-1], {"shaded": 0})
    assert list(programs.compiled.values.values()) == made[2:]
    assert [type(program.mglo).__name__ == "InvalidObject" for program in made] == [True, True, False, False]


@pytest.mark.gl
@pytest.mark.parametrize(
    ("uniforms", "sentence"),
    [
        ({"gain": 1.0, "gian": 2.0}, "gian is set but not used by the shader"),
        ({}, "gain is used by the shader but not set"),
    ],
)
def test_uniforms_must_match_exactly(gpu: Gpu, tmp_path: Path, uniforms: dict[str, float], sentence: str) -> None:
    fragment = "uniform float gain;\nout vec4 colour;\nvoid main() { colour = vec4(gain); }\n"
    program = Programs(gpu.context, folder(tmp_path, v_dot_vert=VERTEX, f_dot_frag=fragment)).get("v.vert", "f.frag")
    with pytest.raises(ShaderError, match=sentence):
        feed(program, uniforms)
