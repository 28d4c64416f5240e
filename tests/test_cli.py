"""The command line as a user meets it: a real process, its exit code, its one sentence."""

import json
import os
import socket
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

FACTOR = '[[factor]]\nname = "backlight"\npath = "material.backlight"\nlevels = [1.2, 0.8]\n'
QUESTION = '[[question]]\nname = "translucent"\ntext = "The object looks translucent."\n'
STUDY = f'title = "x"\n[scene]\nobject = "sphere:4000"\nsize = [32, 32]\n{FACTOR}{QUESTION}'


def fakesss(*arguments: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """The command run in a fresh folder, so that a picture without -o lands nowhere that matters."""
    with tempfile.TemporaryDirectory() as folder:
        return run(folder, *arguments, **environment)


def run(folder: str, *arguments: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "fakesss", *map(str, arguments)],
        capture_output=True,
        text=True,
        env={**os.environ, **environment},
        timeout=120,
        cwd=folder,
    )


def expect_sentence(result: subprocess.CompletedProcess[str], *parts: str) -> None:
    """Exit code 2, nothing on standard output, and exactly one line that says what, where and how to mend it."""
    assert result.returncode == 2, result.stderr
    assert result.stdout == ""
    assert result.stderr.count("\n") == 1, result.stderr
    assert result.stderr.startswith("fakesss: ")
    for part in parts:
        assert part in result.stderr


@pytest.fixture
def study(tmp_path: Path) -> Path:
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    return tmp_path


def test_a_misspelt_key(study: Path) -> None:
    (study / "study.toml").write_text(STUDY.replace("size =", "sise ="), encoding="utf-8")
    expect_sentence(fakesss("build", study), "study.toml: scene.sise: unknown key", 'did you mean "size"?')


@pytest.mark.parametrize("table", ["survey", "analysis"])
def test_a_misspelt_key_of_a_later_step_is_said_before_anything_is_drawn(study: Path, table: str) -> None:
    (study / "study.toml").write_text(f"{STUDY}[{table}]\nalpah = 1\n", encoding="utf-8")
    expect_sentence(fakesss("build", study), "study.toml", table, "alpah: unknown key")
    assert not (study / "stimuli").exists()


def test_a_level_out_of_range(study: Path) -> None:
    text = STUDY.replace("material.backlight", "material.shininess").replace("0.8", "-1")
    (study / "study.toml").write_text(text, encoding="utf-8")
    expect_sentence(fakesss("build", study), 'study.toml: factor "backlight": level -1: must be >= 0')


def test_a_missing_mesh(study: Path) -> None:
    (study / "study.toml").write_text(STUDY.replace("sphere:4000", "bunny.ply"), encoding="utf-8")
    expect_sentence(
        fakesss("build", study),
        'study.toml: scene.object "bunny.ply": cannot be read (No such file',
        "check the file's",
    )
    assert not (study / "stimuli").exists()


def test_a_misspelt_object_is_said_before_anything_is_drawn(study: Path) -> None:
    factor = '[[factor]]\nname = "object"\npath = "object"\nlevels = ["sphere:4000", "shpere"]\n'
    (study / "study.toml").write_text(STUDY.replace(FACTOR, factor), encoding="utf-8")
    expect_sentence(
        fakesss("build", study),
        'study.toml: factor "object": level "shpere": object "shpere": is neither',
        'did you mean "sphere"?',
    )
    assert not (study / "stimuli").exists()


def test_a_mesh_with_nan(tmp_path: Path) -> None:
    path = tmp_path / "nan.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv nan 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n")
    expect_sentence(fakesss("render", path), "nan.obj", "not finite")


def test_an_empty_mesh(tmp_path: Path) -> None:
    path = tmp_path / "empty.obj"
    path.write_text("# nothing\n")
    expect_sentence(fakesss("render", path), "empty.obj: holds no triangles; export the object as a triangle mesh")


def test_an_unwritable_folder(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("not a folder")
    expect_sentence(fakesss("new", tmp_path / "file" / "study"), "cannot be made")
    (tmp_path / "study").mkdir()
    (tmp_path / "study" / "study.toml").write_text(STUDY, encoding="utf-8")
    (tmp_path / "study" / "stimuli").write_text("not a folder")
    expect_sentence(fakesss("build", tmp_path / "study"), "stimuli", "cannot be made")
    expect_sentence(
        fakesss("render", "sphere:4000", "--size", "8x8", "-o", tmp_path / "file" / "x.png"), "does not exist; make it"
    )


def test_a_port_in_use(study: Path) -> None:
    assert fakesss("build", study).returncode == 0
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        expect_sentence(fakesss("serve", study, "--port", str(port)), str(port), "in use")


def test_no_opengl(tmp_path: Path) -> None:
    # an empty vendor list is a system with libEGL and no driver
    result = fakesss("render", "sphere:4000", "-o", tmp_path / "x.png", __EGL_VENDOR_LIBRARY_FILENAMES="/nonexistent")
    expect_sentence(result, "OpenGL", "apt-get install")


def test_serving_what_was_never_built(study: Path) -> None:
    expect_sentence(fakesss("serve", study), "manifest.json", "fakesss build")


@pytest.mark.parametrize("kind", ["obj", "ply", "stl", "glb"])
@pytest.mark.parametrize("size", ["512x512", "317x211"])
def test_a_users_mesh_is_drawn_without_a_pixel_that_is_not_finite(tmp_path: Path, kind: str, size: str) -> None:
    mesh = tmp_path / f"cone.{kind}"
    trimesh.creation.cone(radius=1, height=2).export(mesh)
    result = fakesss("render", mesh, "-o", tmp_path / "cone.png", "--size", size, "--json")
    assert result.returncode == 0, result.stderr
    document = json.loads(result.stdout)
    assert f"{document['width']}x{document['height']}" == size
    assert document["non_finite"] == 0
    assert {"image", "gl_renderer", "passes", "warnings", "scene_sha256"} <= document.keys()
    covered = np.ptp(np.asarray(Image.open(tmp_path / "cone.png")), axis=(0, 1))
    assert (covered > 20).all()  # something is in the picture


def test_set_overrides_one_field_and_refuses_an_unknown_one(tmp_path: Path) -> None:
    out = tmp_path / "x.png"
    assert (
        fakesss("render", "sphere:4000", "--size", "16x16", "--set", "material.backlight=0", "-o", out).returncode == 0
    )
    expect_sentence(
        fakesss("render", "sphere:4000", "--set", "material.backlihgt=0", "-o", out),
        'did you mean "material.backlight"?',
    )


def test_explain_needs_no_picture_and_tells_what_is_culled() -> None:
    result = fakesss("explain", "sphere:4000", "--set", "material.backlight=0", "--json")
    passes = {entry["name"]: entry for entry in json.loads(result.stdout)["passes"]}
    assert not passes["second"]["kept"]
    assert "backlight" in passes["second"]["because"] + passes["thickness"]["because"]


def test_doctor_finds_what_this_machine_has() -> None:
    result = fakesss("doctor", "--json")
    document = json.loads(result.stdout)
    assert result.returncode == 0
    assert document["ok"]
    assert {f["name"] for f in document["findings"]} >= {"Python", "OpenGL", "Embree", "database"}


@pytest.mark.parametrize("taken", ["bench.json", "bench.md"])
def test_bench_asks_for_its_folder_before_it_measures(tmp_path: Path, taken: str) -> None:
    (tmp_path / taken).mkdir()
    expect_sentence(fakesss("bench", "--faces", "1000", "-o", tmp_path), f"{taken}: cannot be written", "name a file")
    (tmp_path / "file").write_text("not a folder")
    expect_sentence(fakesss("bench", "-o", tmp_path / "file" / "bench"), "file/bench: cannot be made")
