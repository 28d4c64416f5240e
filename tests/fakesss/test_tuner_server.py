"""The tuner over HTTP: its page, what it starts from, pictures for a grid, a material to start from, objects."""

import io
import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import httpx
import numpy as np
import pytest
import trimesh
from click.testing import CliRunner
from PIL import Image
from tuner_server import Frame, tab, tuned

import fakesss.cli_tune  # noqa: F401  (adds its command)
from fakesss.cli import commands
from fakesss.listening import listening
from fakesss.media import MEDIA
from fakesss.problem import BadInput
from fakesss.renderer import render_file
from fakesss.scene import Scene
from fakesss.tuner import asking, guards
from fakesss.tuner.looks import LOOKS
from fakesss.tuner.uploads import MOST_BYTES

pytestmark = pytest.mark.gl
BASE = Scene(object="sphere:1000", size=(64, 48), material={"backlight": 0.9})  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("tuner")


@pytest.fixture(scope="module")
def http() -> Iterator[httpx.Client]:
    """One for all: each takes long to make."""
    with httpx.Client() as client:
        yield client


@pytest.fixture(scope="module")
def url(folder: Path) -> Iterator[str]:
    before = os.environ.get("FAKESSS_CACHE")
    os.environ["FAKESSS_CACHE"] = str(folder / "cache")
    with tuned(BASE, folder) as address:
        yield address
    os.environ.pop("FAKESSS_CACHE")
    os.environ.update({"FAKESSS_CACHE": before} if before is not None else {})


def refusal(answer: httpx.Response, status: int = 422) -> str:
    """The one sentence of an answer that refuses."""
    assert answer.status_code == status
    assert list(answer.json()) == ["error"]
    return str(answer.json()["error"])


def ply(solid: trimesh.Trimesh) -> bytes:
    content = solid.export(file_type="ply")
    assert isinstance(content, bytes)
    return content


def test_the_page_and_what_it_starts_from(http: httpx.Client, url: str, folder: Path) -> None:
    page = http.get(url)
    assert page.headers["content-type"].startswith("text/html") and "<main" in page.text
    for path in ("static/settings.js", "static/connection.js"):
        assert "javascript" in http.get(url + path).headers["content-type"]
    start = http.get(url + "start.json").json()
    assert Scene.from_dict(start["base"], "start") == BASE
    assert start["views"] == dict(LOOKS) and next(iter(start["views"])) == "picture"
    assert start["folder"] == str(folder) and start["media"].keys() == MEDIA.keys()


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"alpha": True, "camera.azimuth": 40.0},
        {"lights": [{"azimuth": 60.0, "shadows": True}], "material.thickness": "local"},
        {"style": "as published", "supersampling": 1},
        {"quality": "survey"},
    ],
)
def test_what_is_seen_is_what_is_rendered(
    http: httpx.Client, url: str, tmp_path: Path, changes: dict[str, Any]
) -> None:
    """A still frame, the picture of a grid and the file of `fakesss render` of the saved scene have the same bytes."""
    with tab(url) as viewer:
        frame = viewer.finished(changes)
    saved = http.post(url + "save", json={"settings": {"changes": changes}, "file": tmp_path.name}).json()["scene"]
    render_file(Scene.load(saved), tmp_path / "picture.png", timed=False)
    expected = (tmp_path / "picture.png").read_bytes()
    assert frame.image == expected and frame.header["scene_sha256"] == Scene.load(saved).sha256()
    assert http.post(url + "picture", json={"settings": {"changes": changes}}).content == expected


def test_an_effect_forced_on_in_vain_changes_no_byte(http: httpx.Client, url: str) -> None:
    settings = {"changes": {"material.backlight": 0.0}}
    plain, forced = (
        http.post(url + "picture", json={"settings": {**settings, "effects": effects}}).content
        for effects in ({}, {"backlight": "on"})
    )
    assert plain == forced


def test_a_picture_of_a_grid_is_smaller_and_may_be_a_view(http: httpx.Client, url: str) -> None:
    answer = http.post(url + "picture", json={"size": [32, 24]})
    assert answer.headers["content-type"] == "image/png"
    assert Image.open(io.BytesIO(answer.content)).size == (32, 24)
    view = http.post(url + "picture", json={"size": [32, 24], "view": "thickness"})
    assert Image.open(io.BytesIO(view.content)).size == (32, 24) and view.content != answer.content


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ({"size": [128, 48]}, "size 128x48: is more than the scene's own 64x48"),
        ({"size": [0, 4]}, "size"),
        ({"view": "nothing"}, 'view "nothing": there is none'),
        ({"settings": {"changes": {"material.baclight": 1}}}, "material.backlight"),
        ({"settings": {"changes": {"material.backlight": "much"}}}, "material.backlight"),
        ({"settings": {"changes": {"size": [16000, 16000]}}}, "is more than is drawn here"),
        ({"settings": {"changes": {"object": "/etc/passwd"}}}, "is no file of this tuner"),
        ({"settings": {"changes": {"object": "../other.obj"}}}, "is no file of this tuner"),
        ({"setings": {}}, "setings"),
    ],
)
def test_what_is_wrong_is_said_in_one_sentence(http: httpx.Client, url: str, body: dict[str, Any], words: str) -> None:
    said = refusal(http.post(url + "picture", json=body))
    assert words in said and "\n" not in said


def test_a_body_that_is_no_json(http: httpx.Client, url: str) -> None:
    refusal(http.post(url + "picture", content=b"{", headers={"Content-Type": "application/json"}))
    assert http.post(url + "picture", json={}).status_code == 200


def test_a_measured_medium_as_a_start(http: httpx.Client, url: str) -> None:
    marble = http.post(url + "medium", json={"medium": "marble", "size_mm": 30}).json()["changes"]
    thick = http.post(url + "medium", json={"medium": "marble", "size_mm": 60}).json()["changes"]
    assert thick["material.thickness_exponent"] == pytest.approx(2 * marble["material.thickness_exponent"])
    assert http.post(url + "picture", json={"settings": {"changes": marble}}).status_code == 200
    assert 'did you mean "marble"?' in refusal(http.post(url + "medium", json={"medium": "marbel"}))


def test_an_object_is_brought_and_drawn(http: httpx.Client, url: str) -> None:
    content = ply(trimesh.creation.icosphere(subdivisions=2))
    found = http.post(url + "object", params={"name": "My bunny.PLY"}, content=content).json()
    assert (found["faces"], found["vertices"]) == (320, 162)
    again = http.post(url + "object", params={"name": "other.ply"}, content=content).json()
    assert again["object"] == found["object"] and Path(found["object"]).read_bytes() == content
    with tab(url) as viewer:
        header = viewer.finished({"object": found["object"]}).header
    assert header["faces"] == 320
    assert np.abs(header["box"]).max() == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("picture.png", b"x", '"picture.png": is no mesh format'),
        ("bunny.ply", b"no mesh", '"bunny.ply": is not a valid PLY file'),
        ("empty.obj", b"", '"empty.obj"'),
        ("../../up.exe", b"", "is no mesh format"),
    ],
)
def test_what_is_no_object_is_not_kept(
    http: httpx.Client, url: str, folder: Path, name: str, content: bytes, words: str
) -> None:
    before = set((folder / "cache" / "objects").glob("*"))
    said = refusal(http.post(url + "object", params={"name": name}, content=content))
    assert words in said and str(folder) not in said
    assert set((folder / "cache" / "objects").glob("*")) == before


@pytest.mark.parametrize("announced", [True, False])
def test_what_is_too_large_is_refused_and_leaves_nothing(
    http: httpx.Client, folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, announced: bool
) -> None:
    """Also where a body is longer than it said, or did not say how long it is."""
    route = next(route for route in asking.router.routes if route.path == "/object")  # type: ignore[attr-defined]
    assert route.max_body_size == guards.LIMITS["object"] == MOST_BYTES  # type: ignore[attr-defined]
    monkeypatch.setenv("FAKESSS_CACHE", str(tmp_path))
    monkeypatch.setitem(guards.LIMITS, "object", 1 << 20)
    monkeypatch.setattr(route, "max_body_size", 1 << 20)
    large = b"v 0 0 0\n" * (1 << 18)
    with tuned(BASE, folder) as url:
        body = large if announced else iter([large[:1000], large[1000:]])
        answer = http.post(url + "object", params={"name": "large.obj"}, content=body)
        refusal(answer, 413)
        refusal(http.post(url + "picture", content=large, headers={"Content-Type": "application/json"}), 413)
    assert list((tmp_path / "objects").glob("*")) == []


def test_no_such_page(http: httpx.Client, url: str) -> None:
    assert refusal(http.get(url + "nothing"), 404) == "There is no such page."
    assert refusal(http.get(url + "picture"), 405)
    assert http.get(url + "static/../app.py").status_code == 404
    assert http.get(url + "static/%2e%2e/app.py").status_code == 404


LONG = """
import time, stimuli.sweep
from fakesss.cli import main
def written(*arguments):
    print("writing", flush=True)
    time.sleep(3600)
stimuli.sweep.write_sweep = written
main()
"""
COMMAND = [sys.executable, "-c", LONG, "tune"]


def with_interrupts() -> None:
    """A shell ignores Ctrl-C for what it starts in the background, and that is inherited."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def command(tmp_path: Path) -> Iterator["subprocess.Popen[str]"]:
    """The command, with half a minute of rays to cast before its picture is done, and an hour to write a study."""
    environment = {"FAKESSS_CACHE": str(tmp_path / "cache"), "SSH_CONNECTION": "192.0.2.1 50 192.0.2.2 22"}
    arguments = ["sphere:4000", "--size", "32x32", "--port", "0", "--set", "occlusion.rays=65536", "--json"]
    with subprocess.Popen(
        [*COMMAND, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        cwd=tmp_path,
        env={**os.environ, **environment},
        preexec_fn=with_interrupts,
        text=True,
    ) as process:
        yield process
        process.kill()


def posting(address: str, body: dict[str, Any]) -> socket.socket:
    """The connection on which a post's answer will come."""
    text = json.dumps(body)
    line = socket.create_connection(("127.0.0.1", urlsplit(address).port or 0))
    head = (f"POST {urlsplit(address).path} HTTP/1.1", "Host: localhost", f"Content-Length: {len(text)}")
    line.sendall("\r\n".join([*head, "Content-Type: application/json", "", text]).encode())
    return line


def test_ctrl_c_ends_the_command_though_it_works(command: "subprocess.Popen[str]") -> None:
    assert command.stdout is not None
    lines = [command.stdout.readline() for _ in range(4)]
    address = str(json.loads("".join(lines))["url"])
    with tab(address) as viewer:
        viewer.wish()
        while not isinstance(answer := viewer.next(), Frame):
            if answer["type"] == "again":
                viewer.wish()
        assert "65536 rays" in answer.header["stand_in"]
        viewer.message(type="working", what="Occlusion with 65536 rays a vertex", done=False)
        study = {"title": "a", "folder": "a", "factors": [{"name": "a", "path": "light.azimuth", "levels": [0, 90]}]}
        with posting(address + "study", study), posting(address + "picture", {}) as line:
            assert command.stdout.readline() == "writing\n"
            viewer.finished({"occlusion.enabled": False})
            viewer.finished({"occlusion.enabled": False})
            command.send_signal(signal.SIGINT)
            _, said = command.communicate(timeout=60)
            assert b"503" in line.recv(4096)
    assert command.returncode == 130, said
    assert said.endswith("The tuner is stopped.\n")  # no word of the same command, which has another address
    assert "ssh -L" in said and "192.0.2.2" in said
    assert "Traceback" not in said and "ERROR" not in said


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["nothing.obj"], "nothing.obj: no such mesh file"),
        (["spere:1000"], 'did you mean "sphere"?'),
        (["sphere:1"], "must be a whole number of faces"),
        (["sphere:1000", "--port", "{port}"], "cannot be listened on"),
    ],
)
def test_what_cannot_be_tuned_is_said_at_once(arguments: list[str], words: str) -> None:
    with listening("127.0.0.1", 0) as taken:
        port = str(taken.getsockname()[1])
        ended = CliRunner().invoke(commands, ["tune", *(argument.format(port=port) for argument in arguments)])
    assert isinstance(ended.exception, BadInput) and ended.stdout == ""
    assert words in str(ended.exception)
